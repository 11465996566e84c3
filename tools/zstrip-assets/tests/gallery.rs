//! The containers of the library's examples, made anew from their sources.

#[path = "../examples/gallery/containers.rs"]
mod containers;
#[path = "../examples/gallery/figure.rs"]
mod figure;
#[path = "../examples/gallery/flange.rs"]
mod flange;

#[test]
fn containers_that_are_checked_in_are_those_of_their_sources() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in containers::NAMES {
        let written = containers::convert(name, folder.path()).expect("a container");
        let kept = std::fs::read(containers::path(name)).expect("a container that is checked in");
        let first = kept.iter().zip(&written.bytes).position(|(a, b)| a != b);
        assert!(
            first.is_none() && kept.len() == written.bytes.len(),
            "{name}: {} bytes, not {}, the first other one is {first:?}; cargo run --example gallery",
            kept.len(),
            written.bytes.len(),
        );
    }
}
