//! The crate against the conformance files: draws of scenes, in one strip and in many, recorded and direct.

use crate::reference::conformance::check_file;
use crate::reference::subject::Subject;
use std::path::PathBuf;

/// Files whose records a depth buffer of one strip is enough for.
const COVERAGE: [&str; 8] =
    ["tri_random", "tri_sliver", "tri_special", "tri_far", "tri_bulk_hash", "mesh_once", "nearclip", "nearclip_pairs"];

/// The folder with the data: the public sample, or the one named by `CONFORMANCE_DIR`.
fn data(stem: &str) -> PathBuf {
    let sample = || concat!(env!("CARGO_MANIFEST_DIR"), "/tests/conformance").into();
    let folder = std::env::var_os("CONFORMANCE_DIR").map_or_else(sample, PathBuf::from);
    folder.join(format!("{stem}.csv"))
}

fn assert_right(stem: &str, mut subject: Subject) {
    let case = format!("{stem}, strips of {} rows, {} records", subject.strip_rows, subject.records);
    let outcome = check_file(&data(stem), &mut subject).unwrap_or_else(|error| panic!("{case}: {error}"));
    assert!(outcome.is_right(), "{case}: {outcome:?}");
    println!("{case}: {outcome:?}");
}

#[test]
fn every_file_is_right_in_whole_frames() {
    for stem in COVERAGE.into_iter().chain(["depth", "persp", "lines", "points", "msaa4"]) {
        assert_right(stem, Subject::default());
    }
}

#[test]
fn coverage_is_right_in_strips_of_1_7_and_16_rows() {
    for (strip_rows, stem) in [1, 7, 16].into_iter().flat_map(|rows| COVERAGE.map(|stem| (rows, stem))) {
        assert_right(stem, Subject { strip_rows, records: 2000 });
    }
}

#[test]
fn coverage_is_right_without_records() {
    for stem in COVERAGE {
        assert_right(stem, Subject { strip_rows: 16, records: 0 });
    }
    // Lines are checked in the order of their pixels, which strips would change.
    assert_right("lines", Subject { records: 0, ..Subject::default() });
}

#[test]
fn points_are_right_in_strips() {
    for (strip_rows, records) in [(1, 2000), (7, 2000), (16, 0)] {
        assert_right("points", Subject { strip_rows, records });
    }
}
