//! The README's figures are those of the library.

use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::frame::RamBudget;

const README: &str = include_str!("../README.md");

/// With commas between the thousands.
fn grouped(n: usize) -> String {
    match n {
        0..1000 => n.to_string(),
        _ => format!("{},{:03}", n / 1000, n % 1000),
    }
}

#[test]
fn the_table_of_ram_is_right() {
    let rows = [1, 4, 8, 16, 40, 240].map(|rows| {
        let strip = RamBudget::new::<Rgb565>(320, rows);
        // One draw with one word of varyings: the torus, Gouraud shaded.
        let ample = strip.with_records(1, 240, 512, 1, 512);
        let figures = [strip.color, strip.depth, strip.total(), strip.total() + 4 * 2000, ample.total()];
        let plural = if rows == 1 { "" } else { "s" };
        format!("| {rows} row{plural} | {} |\n", figures.map(grouped).join(" | "))
    });
    let expected = rows.concat();
    assert!(README.contains(&expected), "README.md should say\n{expected}");
}
