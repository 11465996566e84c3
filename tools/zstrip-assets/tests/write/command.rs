//! The command line.

use std::process::{Command, Output};

use crate::support::{Folder, png};

fn run(arguments: &[&std::ffi::OsStr]) -> (Output, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_zstrip-assets")).args(arguments).output().expect("a program");
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    (output, out, err)
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

#[test]
fn a_file_is_converted_and_described() {
    let folder = Folder::new().with("square.obj", SQUARE).with("paint.png", png(8, 8));
    let [file, out, paint] = ["square.obj", "model.zstm", "paint.png"].map(|name| folder.path(name));
    let (output, text, err) =
        run(&["convert".as_ref(), file.as_ref(), "-o".as_ref(), out.as_ref(), "--texture".as_ref(), paint.as_ref()]);
    assert!(output.status.success() && text.contains("2 triangles") && err.is_empty(), "{text}{err}");
    let bytes = std::fs::read(&out).expect("a container");
    assert_eq!(&bytes[..4], b"ZSTM");
    assert!(text.contains("textures: 160 bytes"), "{text}");
    let (output, text, _) = run(&["info".as_ref(), file.as_ref()]);
    assert!(output.status.success() && text.contains("worst errors"), "{text}");
    // Nothing but the files and the container is there.
    assert_eq!(std::fs::read_dir(folder.path("")).expect("a folder").count(), 3);
    let source = folder.path("square.rs");
    let (output, ..) = run(&["convert".as_ref(), file.as_ref(), "--rust".as_ref()]);
    assert!(output.status.success());
    let source = std::fs::read_to_string(source).expect("a source");
    assert!(source.contains("pub mod square") && source.contains("\"square.zstm\""), "{source}");
    assert!(folder.path("square.zstm").exists());
}

#[test]
fn mistakes_have_exit_codes_and_places() {
    let folder = Folder::new().with("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n").with("wide.obj", SQUARE);
    let [bad, wide, none] = ["bad.obj", "wide.obj", "none.obj"].map(|name| folder.path(name));
    let code = |arguments: &[&std::ffi::OsStr]| {
        let (output, _, err) = run(arguments);
        (output.status.code(), err)
    };
    let (found, err) = code(&["convert".as_ref(), bad.as_ref()]);
    assert!(found == Some(1) && err.contains("bad.obj:3:"), "{err}");
    let (found, err) = code(&["info".as_ref(), none.as_ref()]);
    assert!(found == Some(1) && err.contains("none.obj"), "{err}");
    let (found, err) = code(&["info".as_ref(), wide.as_ref(), "--scale".as_ref(), "1e6".as_ref()]);
    assert!(found == Some(1) && err.contains("scale the model by"), "{err}");
    for arguments in
        [&["convert"][..], &["turn", "a.obj"], &["info", "a.obj", "--up", "x"], &["info", "a", "--nothing"]]
    {
        let arguments: Vec<&std::ffi::OsStr> = arguments.iter().map(|text| text.as_ref()).collect();
        let (found, err) = code(&arguments);
        assert!(found == Some(2) && err.contains("--help"), "{arguments:?}: {err}");
    }
    // No output is left behind.
    assert_eq!(std::fs::read_dir(folder.path("")).expect("a folder").count(), 2);
}
