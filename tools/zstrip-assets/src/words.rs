//! Numbers of things in English.

/// Returns a number with its noun: 1 mesh, 2 meshes, 0 vertices.
pub(crate) fn count(number: usize, noun: &str) -> String {
    let noun = match noun {
        _ if number == 1 => noun.to_owned(),
        "vertex" => "vertices".to_owned(),
        "matrix" => "matrices".to_owned(),
        _ if noun.ends_with('h') || noun.ends_with('x') || noun.ends_with('s') => format!("{noun}es"),
        _ => format!("{noun}s"),
    };
    format!("{number} {noun}")
}

/// Returns the form of a verb that goes with a number of things: `one` for 1, otherwise `more`.
pub(crate) fn verb<'v>(number: usize, one: &'v str, more: &'v str) -> &'v str {
    if number == 1 { one } else { more }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nouns_and_verbs_agree_with_their_numbers() {
        let found = [(0, "mesh"), (1, "mesh"), (2, "mesh"), (1, "vertex"), (3, "vertex"), (2, "part")];
        let expected = ["0 meshes", "1 mesh", "2 meshes", "1 vertex", "3 vertices", "2 parts"];
        assert_eq!(found.map(|(number, noun)| count(number, noun)), expected);
        assert_eq!([0, 1, 2].map(|number| verb(number, "joins", "join")), ["join", "joins", "join"]);
    }
}
