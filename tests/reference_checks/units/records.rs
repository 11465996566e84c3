use crate::reference::conformance::records::*;

fn record(text: &str) -> Record<'_> {
    Table::parse(text, (1, 1)).records.remove(0)
}

#[test]
fn comments_may_stand_anywhere_and_tell_the_viewport() {
    let text = "# msaa 4x at +-32768 px\n1,2\n# in a 64x48 viewport, not 9x9\r\n\n3,-4 \r\n#";
    let table = Table::parse(text, (8, 8));
    assert_eq!((table.width, table.height), (64, 48));
    let lines: Vec<usize> = table.records.iter().map(|r| r.line).collect();
    assert_eq!(lines, [2, 5]);
    assert_eq!(table.records[1].numbers(0), Ok([3, -4]));
    assert_eq!(Table::parse("1", (8, 6)).height, 6);
}

#[test]
fn spans_are_read_and_checked() {
    let read = |text: &str| record(text).spans(0, (64, 64)).map_err(|e| e.reason);
    assert_eq!(read("-"), Ok(vec![]));
    assert_eq!(read("7 1-1 . 2-3;5-9"), Ok(vec![(7, 1, 1), (9, 2, 3), (9, 5, 9)]));
    for wrong in ["- 3", "x 1-2", "7 3-2", "7 0-64", "64 1-1", "7 1-5;5-6", "7 1", "7 -1-2", "7 1-2;"] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
    assert_eq!(pixel_count(&[(7, 1, 1), (9, 2, 3)]), 3);
}

#[test]
fn run_lengths_must_fill_the_viewport() {
    let read = |text: &str| record(text).run_lengths(0, 6).map_err(|e| e.reason);
    assert_eq!(read("0*2 7 1*3"), Ok(vec![0, 0, 7, 1, 1, 1]));
    for wrong in ["0*5", "0*7", "0*-1 0*7", "a*6", ",", "0*18446744073709551615"] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn errors_name_the_line_and_the_field() {
    let error = record("\n\n5,x").number::<i32>(1);
    let reason = "field 2: `x` is not a number in range".to_string();
    assert_eq!(error, Err(BadRecord { line: 3, reason }));
    assert!(record("1,2").expect_fields(3).is_err());
    assert!(record("99999999999").number::<i32>(0).is_err());
}
