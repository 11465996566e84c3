//! Comments keep to the width that code has, and summaries to one form: those of functions begin with a verb in the
//! third person, no other with a word that leaves open what it is about.

use std::fs;
use std::path::{Path, PathBuf};

/// Columns that a line may have, as `rustfmt.toml` sets them for code.
const MAX_WIDTH: usize = 120;

/// Beginnings that name nothing.
const VAGUE: [&str; 8] = ["What ", "The same ", "As ", "Where ", "Whether ", "It ", "So many ", "How "];

/// Verbs in the third person that do not end in a plain s, and words that end in s and are none.
const NO_VERBS: [&str; 10] = ["Is", "As", "Its", "This", "Plus", "Others", "Always", "Thus", "Pixels", "Axis"];

/// All sources below some folders.
fn sources(folders: &[&str]) -> Vec<PathBuf> {
    let mut left: Vec<_> = folders.iter().map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).collect();
    let mut found = Vec::new();
    while let Some(path) = left.pop() {
        if path.is_dir() {
            left.extend(fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("an entry").path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The first line of each documented item's comment: its number, its text, and the line that the item begins with.
fn summaries(text: &str) -> Vec<(usize, &str, &str)> {
    let mut summaries = Vec::new();
    let mut lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim()));
    let mut first = None;
    let mut attribute = false;
    for (number, line) in &mut lines {
        if let Some(comment) = line.strip_prefix("///") {
            first.get_or_insert((number, comment.trim()));
        } else if attribute || line.starts_with("#[") {
            attribute = !line.ends_with(']');
        } else if let Some((number, summary)) = first.take() {
            summaries.push((number, summary, line));
        }
    }
    summaries
}

/// Whether an item is a function that its readers call or implement: a public one, or one of a trait.
fn is_function(item: &str, text: &str, number: usize) -> bool {
    let name = item.trim_start_matches("pub ").trim_start_matches("const ");
    name.starts_with("fn ") && (item.starts_with("pub ") || is_in_trait(text, number))
}

/// Whether the block that line `number` stands in is a public trait.
fn is_in_trait(text: &str, number: usize) -> bool {
    let before: Vec<_> = text.lines().take(number - 1).collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let own = text.lines().nth(number - 1).map_or(0, indent);
    let opening =
        before.iter().rev().find(|line| !line.trim().is_empty() && indent(line) < own && !line.starts_with('}'));
    opening.is_some_and(|line| line.trim_start().starts_with("pub trait "))
}

fn is_verb(word: &str) -> bool {
    word.ends_with('s') && !NO_VERBS.contains(&word) && word.chars().next().is_some_and(char::is_uppercase)
}

#[test]
fn comments_keep_to_the_width_of_code() {
    let mut wide = Vec::new();
    let tool = ["src", "tests", "examples", "fuzz/src"].map(|folder| format!("tools/zstrip-assets/{folder}"));
    let folders = ["src", "tests", "examples", "boards/rp2040/src"].into_iter().chain(tool.iter().map(String::as_str));
    for path in sources(&folders.collect::<Vec<_>>()) {
        let text = fs::read_to_string(&path).expect("a source");
        for (k, line) in text.lines().enumerate() {
            // A row of a table cannot be broken.
            let is_row = line.trim_start().trim_start_matches(['/', '!']).trim_start().starts_with('|');
            if line.contains("//") && line.chars().count() > MAX_WIDTH && !is_row {
                wide.push(format!("{}:{}: {} columns", path.display(), k + 1, line.chars().count()));
            }
        }
    }
    assert!(wide.is_empty(), "{} lines of more than {MAX_WIDTH} columns:\n{}", wide.len(), wide.join("\n"));
}

#[test]
fn summaries_say_what_they_are_about() {
    let (mut wrong, mut functions) = (Vec::new(), 0);
    for path in sources(&["src", "tools/zstrip-assets/src"]) {
        let text = fs::read_to_string(&path).expect("a source");
        for (number, summary, item) in summaries(&text) {
            let word = summary.split([' ', ',', ':', ';', '.']).next().unwrap_or_default();
            let function = is_function(item, &text, number);
            functions += usize::from(function);
            if VAGUE.iter().any(|vague| summary.starts_with(vague)) || function && !is_verb(word) {
                wrong.push(format!("{}:{number}: {summary}", path.display()));
            }
        }
    }
    assert!(functions > 100, "only {functions} functions were found");
    assert!(wrong.is_empty(), "{} summaries:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn summaries_are_found_where_they_stand() {
    let text =
        "/// Draws.\n/// More.\n#[inline]\npub fn draw() {}\n\npub trait Seam {\n    /// Who.\n    fn ask();\n}\n";
    let found = summaries(text);
    assert_eq!(found, [(1, "Draws.", "pub fn draw() {}"), (7, "Who.", "fn ask();")]);
    assert!(is_function(found[0].2, text, found[0].0) && is_function(found[1].2, text, found[1].0));
    assert!(is_verb("Draws") && !is_verb("Draw") && !is_verb("This"));
}
