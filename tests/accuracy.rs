//! docs/accuracy.md: each row has a test that asserts its bound, and dithering is as even as it says there.

use crate::support::accuracy;
use std::fs;
use std::path::Path;
use zstrip::color::{Dither, Levels};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4};

#[test]
fn every_row_is_held_by_the_test_that_it_names() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for row in accuracy::rows() {
        let (file, test) = row.test.split_once("::").unwrap_or_else(|| panic!("{}: {}", row.name, row.test));
        let source = fs::read_to_string(folder.join(format!("tests/{file}.rs"))).expect("a file of tests");
        let start = source.find(&format!("fn {test}(")).unwrap_or_else(|| panic!("no test {}", row.test));
        let body = source[start..].split("\n}\n").next().unwrap_or_default();
        assert!(body.contains(&format!("\"{}\"", row.name)), "{} does not hold the row `{}`", row.test, row.name);
        assert!(row.seen <= row.bound, "{}: seen {} above the bound", row.name, row.seen);
        count += 1;
    }
    assert!(count >= 20, "only {count} rows");
}

#[test]
fn the_page_is_linked() {
    for page in ["README.md", "src/lib.rs"] {
        let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(page)).expect("a page");
        assert!(text.contains("docs/accuracy.md"), "{page}");
    }
}

/// Largest error of the mean light of a cell of 8×8 pixels, over all greys, in parts of the light between two levels.
fn worst_cell<C: Levels>(dither: Dither<C>, levels: u8) -> f64 {
    let light = |c: f64| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    let of_level = |level: u8| light(f64::from(level) / f64::from(levels - 1));
    let error = |grey: u8| {
        let asked = light(f64::from(grey) / 255.0);
        let above = (1..levels - 1).find(|level| of_level(*level) > asked).unwrap_or(levels - 1);
        let mean = (0..64).map(|k| of_level(dither.level(grey, (k % 8, k / 8)))).sum::<f64>() / 64.0;
        (mean - asked).abs() / (of_level(above) - of_level(above - 1))
    };
    (0..=255).map(error).fold(0.0, f64::max)
}

#[test]
fn cells_of_dithered_greys_have_the_light_of_the_grey() {
    accuracy::check("dither, 2 levels, cells of 8×8", worst_cell(Dither::<BinaryColor>::BAYER_8, 2));
    accuracy::check("dither, 2 levels, cells of 4×4", worst_cell(Dither::<BinaryColor>::BAYER_4, 2));
    let more = |four: Dither<Gray2>, sixteen: Dither<Gray4>| worst_cell(four, 4).max(worst_cell(sixteen, 16));
    accuracy::check("dither, 4 or 16 levels, cells of 8×8", more(Dither::BAYER_8, Dither::BAYER_8));
    accuracy::check("dither, 4 or 16 levels, cells of 4×4", more(Dither::BAYER_4, Dither::BAYER_4));
}
