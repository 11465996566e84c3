//! The error budget of docs/accuracy.md: its rows are the bounds that tests assert.

/// A row of the page's table.
pub struct Row {
    pub name: &'static str,
    pub unit: &'static str,
    pub bound: f64,
    pub seen: f64,
    pub test: &'static str,
}

/// The page.
pub const PAGE: &str = include_str!("../../docs/accuracy.md");

/// The rows of the first table that have a number for a bound.
pub fn rows() -> impl Iterator<Item = Row> {
    PAGE.split("\n## ").next().unwrap_or_default().lines().filter_map(|line| {
        let mut cells = line.strip_prefix('|')?.split('|').map(str::trim);
        let mut next = || cells.next().unwrap_or_default();
        let (name, unit, bound, seen, test) = (next(), next(), next(), next(), next());
        Some(Row { name, unit, bound: bound.parse().ok()?, seen: seen.parse().ok()?, test: test.trim_matches('`') })
    })
}

/// Prints the worst error that a test has seen, and holds it to the page: to the bound, and to the worst value there.
#[track_caller]
pub fn check(name: &str, worst: f64) {
    let row = rows().find(|row| row.name == name).unwrap_or_else(|| panic!("docs/accuracy.md has no row `{name}`"));
    println!("accuracy: {name}: worst {worst:.4} {}, bound {}", row.unit, row.bound);
    assert!(worst <= row.bound, "{name}: {worst} {} is above the bound of {}", row.unit, row.bound);
    let printed = format!("{worst:.4}").parse::<f64>().expect("a number");
    assert!(printed <= row.seen, "{name}: {worst} {} is worse than docs/accuracy.md has seen: {}", row.unit, row.seen);
}
