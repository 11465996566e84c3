//! Rust source of a model: a module that includes a container.

use std::collections::HashSet;
use std::fmt::Write;

use crate::model::Import;
use crate::write::{WriteError, WriteOptions, Written, write};

/// Returns the Rust source that includes the container in the file `container`, which stands beside it, and the
/// container.
///
/// The source is a module `name` with `BYTES`, `DRAWS`, `POSE_WORDS`, `model()`, and the numbers of clips, if there are
/// any, in a module `clips`.
///
/// # Errors
///
/// Those of [`write`](crate::write()).
pub fn write_rust(
    import: &Import,
    name: &str,
    container: &str,
    options: &WriteOptions,
) -> Result<(String, Written), WriteError> {
    let written = write(import, options)?;
    let report = &written.report;
    let name = identifier(name);
    let (bytes, triangles) = (report.bytes, report.triangles);
    let mut source = String::new();
    // Writing to a string does not fail.
    let _ = write!(
        source,
        "/// A model of {triangles} triangles, in {bytes} bytes.
#[allow(dead_code)]
pub mod {name} {{
    /// The container.
    pub static BYTES: &[u8] = ::zstrip::include_model!({container:?});
    /// Number of places that `Model::place` takes.
    pub const DRAWS: usize = {};
    /// Number of words that a pose takes.
    pub const POSE_WORDS: usize = {};

    /// Reads the model.
    ///
    /// # Errors
    /// If another version of the library reads it.
    pub fn model() -> Result<::zstrip::model::Model<'static>, ::zstrip::model::ModelError> {{
        ::zstrip::model::Model::from_bytes(BYTES)
    }}
",
        report.draws, report.pose_words
    );
    if !report.clips.is_empty() {
        source.push_str("\n    /// Numbers of clips.\n    pub mod clips {\n");
        let mut known = HashSet::new();
        for (number, (clip, duration, ..)) in report.clips.iter().enumerate() {
            let mut constant = identifier(clip).to_uppercase();
            if clip.is_empty() || known.contains(&constant) {
                constant = format!("CLIP_{number}");
            }
            // Another clip may have that name.
            while !known.insert(constant.clone()) {
                constant.push('_');
            }
            let _ = write!(
                source,
                "        /// {clip:?}: {duration} ms.\n        pub const {constant}: usize = {number};\n"
            );
        }
        source.push_str("    }\n");
    }
    source.push_str("}\n");
    Ok((source, written))
}

/// Returns a name of Rust: small letters, digits and underscores.
pub(crate) fn identifier(name: &str) -> String {
    let letters = name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' });
    let name: String = letters.collect();
    let is_keyword = [
        "", "_", "as", "async", "await", "box", "break", "const", "continue", "crate", "do", "dyn", "else", "enum",
        "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod",
        "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super", "trait",
        "true", "try", "type", "typeof", "union", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
        "abstract", "become",
    ]
    .contains(&&name[..]);
    if is_keyword || name.starts_with(|c: char| c.is_ascii_digit()) { format!("model_{name}") } else { name }
}
