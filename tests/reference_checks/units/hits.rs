use crate::reference::conformance::hits::*;
use crate::reference::conformance::records::Table;

fn small() -> Hits {
    Hits::new(&Table { width: 4, height: 2, records: Vec::new() })
}

#[test]
fn verdict_names_the_first_wrong_pixel() {
    let mut hits = small();
    hits.add(1, 2, 1);
    hits.add(1, 2, 1);
    assert_eq!(hits.verdict(|_| (0, 2)), Ok(()));
    let wrong = hits.verdict(|_| (0, 1)).expect_err("two hits");
    assert_eq!(wrong, "pixel (2, 1) hit 2 times, expected 0 to 1; 0 more pixels wrong");
    hits.add(1, 4, 0);
    let wrong = hits.verdict(|_| (0, 2)).expect_err("outside");
    assert_eq!(wrong, "pixel (4, 0) is outside the viewport");
}

#[test]
fn hash_is_of_the_spans() {
    let mut hits = small();
    assert_eq!(hits.hash(), 0xcbf2_9ce4_8422_2325);
    for (x, y) in [(3, 1), (0, 1), (1, 1)] {
        hits.add(1, x, y);
    }
    // FNV-1a of 01 00 00 00 01 00, 01 00 03 00 03 00.
    let bytes = [1, 0, 0, 0, 1, 0, 1, 0, 3, 0, 3, 0];
    let fold = |hash: u64, byte: u64| (hash ^ byte).wrapping_mul(0x0100_0000_01b3);
    assert_eq!(hits.hash(), bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, fold));
}
