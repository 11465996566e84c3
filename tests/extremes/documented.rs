//! Panics that the sources spell out.

use std::fs;
use std::path::{Path, PathBuf};

/// What panics at run time. `const { assert!(..) }` is left out: it fails when a program is compiled.
const PANICS: [&str; 6] = ["panic!", ".unwrap()", ".expect(", "unreachable!", "todo!", "unimplemented!"];

fn sources(folder: &Path, to: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, to);
        } else {
            to.push(path);
        }
    }
}

#[test]
fn functions_that_spell_out_a_panic_document_it() {
    let mut files = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut files);
    let mut found = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).expect("a source");
        let lines: Vec<&str> =
            text.lines().take_while(|line| !["#[cfg(test)]", "#[cfg(doctest)]"].contains(line)).collect();
        for (number, line) in lines.iter().enumerate() {
            if line.trim_start().starts_with("//") || !PANICS.iter().any(|panics| line.contains(panics)) {
                continue;
            }
            let function = lines[..number].iter().rposition(|line| line.contains("fn ")).expect("a function");
            let documentation = lines[..function].iter().rev().map(|line| line.trim_start());
            let documented = documentation
                .take_while(|line| line.starts_with("///") || line.starts_with("#["))
                .any(|line| line == "/// # Panics");
            assert!(documented, "{}:{}: {line}: `{}`", file.display(), number + 1, lines[function].trim());
            found.push(lines[function].trim().to_owned());
        }
    }
    found.dedup();
    // Constructors of constants, and nothing else.
    assert!(found.len() >= 3 && found.iter().all(|line| line.starts_with("pub const fn constant")), "{found:?}");
}
