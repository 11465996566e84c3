//! The crate is built in floors: each folder of `src` imports only from those below it, and files import each other in
//! no circle.
//!
//! The sources are read as text: every path that begins with `crate::` or `super::` counts, in `use` lines and
//! elsewhere, but for comments and for tests inside of the crate.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// From the ground up. `lib.rs` stands on top of all of them.
const FLOORS: [&str; 14] = [
    "math", "color", "texture", "mesh", "light", "vertex", "raster", "span", "shader", "target", "scene", "shape",
    "model", "frame",
];

/// A source file without comments and without its tests.
struct Source {
    floor: &'static str,
    file: String,
    text: String,
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = Vec::new();
    for floor in FLOORS {
        for entry in fs::read_dir(root.join(floor)).unwrap_or_else(|error| panic!("src/{floor}: {error}")) {
            let path = entry.expect("an entry").path();
            let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            let file = path.file_stem().expect("a name").to_string_lossy().into_owned();
            sources.push(Source { floor, file, text: code(&text) });
        }
    }
    sources
}

/// The text up to its tests, without comments.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// All paths that begin with `root`, with the braces of `use` lines resolved.
fn paths(text: &str, root: &str) -> BTreeSet<String> {
    let mut paths = BTreeSet::new();
    for (at, _) in text.match_indices(root) {
        let before = text[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '$') {
            continue;
        }
        expand(String::new(), &text[at..], &mut paths);
    }
    paths
}

/// Adds the paths of the use tree, or of the one path, that `text` begins with; yields what follows it.
fn expand<'t>(prefix: String, text: &'t str, paths: &mut BTreeSet<String>) -> &'t str {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')).unwrap_or(text.len());
    let path = prefix + &text[..end];
    if let (true, Some(mut rest)) = (path.ends_with("::"), text[end..].strip_prefix('{')) {
        loop {
            rest = rest.trim_start_matches([' ', '\n', ',']);
            match rest.strip_prefix('}') {
                Some(rest) => return rest,
                None if rest.is_empty() => return rest,
                None => {
                    let left = expand(path.clone(), rest, paths);
                    rest = if left.len() == rest.len() { &rest[1..] } else { left };
                }
            }
        }
    }
    paths.insert(path);
    &text[end..]
}

/// The floor's number.
fn height(floor: &str) -> Option<usize> {
    FLOORS.iter().position(|name| *name == floor)
}

#[test]
fn no_import_runs_upward() {
    let mut upward = Vec::new();
    let mut seen = 0;
    for source in sources() {
        for path in paths(&source.text, "crate::") {
            let floor = path.split("::").nth(1).unwrap_or_default();
            let Some(other) = height(floor) else {
                upward.push(format!("{}/{}.rs: {path} is on no floor", source.floor, source.file));
                continue;
            };
            seen += 1;
            if Some(other) > height(source.floor) {
                upward.push(format!("{}/{}.rs: {path}", source.floor, source.file));
            }
        }
    }
    assert!(seen > 100, "only {seen} imports were found");
    assert!(upward.is_empty(), "imports that run upward:\n{}", upward.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let sources = sources();
    // Which file of a folder a name comes from that its `mod.rs` hands on.
    let mut home = BTreeMap::new();
    for source in sources.iter().filter(|source| source.file == "mod") {
        for line in source.text.split(';').filter_map(|line| line.split_once("use ")) {
            let mut names = BTreeSet::new();
            expand(String::new(), line.1.trim(), &mut names);
            for name in names {
                if let [file, .., name] = name.split("::").collect::<Vec<_>>()[..] {
                    home.insert((source.floor, name.to_owned()), file.to_owned());
                }
            }
        }
    }
    let files: BTreeSet<_> = sources.iter().map(|source| (source.floor, source.file.clone())).collect();
    let mut imports: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    for source in sources.iter().filter(|source| source.file != "mod") {
        let all = paths(&source.text, "super::").into_iter().chain(paths(&source.text, "crate::"));
        for path in all {
            let parts: Vec<_> = path.split("::").collect();
            let (floor, name) = match parts[..] {
                ["super", name, ..] => (source.floor, name),
                ["crate", floor, name, ..] => (FLOORS[height(floor).expect("a floor")], name),
                _ => continue,
            };
            let file = home.get(&(floor, name.to_owned())).cloned().unwrap_or_else(|| name.to_owned());
            let to = (floor, file);
            if files.contains(&to) && to != (source.floor, source.file.clone()) {
                imports.entry((source.floor, source.file.clone())).or_default().insert(to);
            }
        }
    }
    assert!(imports.len() > 60, "only {} files import others", imports.len());
    // Files that import nothing that is left go, until only circles are left, and what imports them.
    let mut left = imports;
    loop {
        let names: BTreeSet<_> = left.keys().cloned().collect();
        let count = left.len();
        left.retain(|_, to| to.iter().any(|file| names.contains(file)));
        if left.len() == count {
            break;
        }
    }
    let lines: Vec<_> = left
        .iter()
        .map(|((floor, file), to)| {
            let to: Vec<_> = to.iter().filter(|file| left.contains_key(file)).map(|(_, file)| file.as_str()).collect();
            format!("{floor}/{file}.rs imports {}", to.join(", "))
        })
        .collect();
    assert!(
        left.is_empty(),
        "files that import each other in a circle, and those that import them:\n{}",
        lines.join("\n")
    );
}

/// A file that `tests/main.rs` does not name is not built, and its tests do not run.
#[test]
fn every_file_of_tests_is_built() {
    let main = include_str!("main.rs");
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests");
    let files = fs::read_dir(folder).expect("the tests").map(|entry| entry.expect("an entry").path());
    let named = |file: &Path| {
        let name = file.file_stem().and_then(|name| name.to_str()).expect("a name");
        name == "main" || main.contains(&format!("\nmod {name};\n"))
    };
    let missing: Vec<_> =
        files.filter(|file| !file.is_dir() || file.join("mod.rs").exists()).filter(|file| !named(file)).collect();
    assert!(missing.is_empty(), "not in tests/main.rs: {missing:?}");
}

#[test]
fn paths_are_found_where_they_stand() {
    let text = code("use crate::a::{b, c::{D, E}}; // crate::no\n/// [x](crate::neither)\nlet x = crate::f::G::new();");
    let found: Vec<_> = paths(&text, "crate::").into_iter().collect();
    assert_eq!(found, ["crate::a::b", "crate::a::c::D", "crate::a::c::E", "crate::f::G::new"]);
}
