//! The references against the conformance data, and the checker against rasterizers that are wrong on purpose.

mod units;

use crate::reference::conformance::records::Table;
use crate::reference::conformance::{CheckError, Outcome, Rasterizer, check_file};
use crate::reference::exact;
use crate::reference::homogeneous::{Vertex, Viewport, for_each_sample};
use crate::reference::mistakes::Mistake;
use crate::reference::model::Model;
use std::path::{Path, PathBuf};

const CHECKED: [&str; 13] = [
    "msaa4",
    "lines",
    "points",
    "tri_random",
    "tri_sliver",
    "tri_special",
    "tri_far",
    "tri_bulk_hash",
    "mesh_once",
    "depth",
    "nearclip",
    "nearclip_pairs",
    "persp",
];

/// The folder with the data: the public sample, or the one named by `CONFORMANCE_DIR`.
fn data(stem: &str) -> PathBuf {
    let sample = || concat!(env!("CARGO_MANIFEST_DIR"), "/tests/conformance").into();
    let folder = std::env::var_os("CONFORMANCE_DIR").map_or_else(sample, PathBuf::from);
    folder.join(format!("{stem}.csv"))
}

fn check(stem: &str, rasterizer: &mut dyn Rasterizer) -> Outcome {
    check_file(&data(stem), rasterizer).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn model_passes_every_record() {
    for stem in CHECKED {
        let outcome = check(stem, &mut Model);
        println!("{stem}: {outcome:?}");
        assert!(outcome.is_right(), "{stem}: {outcome:?}");
    }
}

#[test]
fn exact_model_gives_the_perspective_samples() {
    let text = std::fs::read_to_string(data("persp")).expect("the data");
    let mut count = 0;
    for record in &Table::parse(&text, (128, 128)).records {
        let tri = exact::widen(record.triangle(1).expect("a triangle"));
        let [w, u, v] = record.triangle(7).expect("w, u and v");
        for sample in record.list::<i64>(17).expect("samples").chunks_exact(4) {
            let at = exact::center(sample[0], sample[1]);
            let fixed = |values: [i64; 3]| exact::perspective_at(tri, w, values.map(|value| 4096 * value), at);
            assert_eq!(exact::round_half_up(fixed(u)), sample[2], "line {}: {sample:?}", record.line);
            assert_eq!(exact::round_half_up(fixed(v)), sample[3], "line {}: {sample:?}", record.line);
            count += 1;
        }
    }
    assert!(count > 500);
}

/// The margins against the classes of the data: `must` is inside by more than 1/128 px, `ambiguous` within 1/128 px.
#[test]
fn homogeneous_margins_agree_with_the_clipping_data() {
    let text = std::fs::read_to_string(data("nearclip")).expect("the data");
    let viewport = Viewport { clip_y_down: true, ..Viewport::new(64, 64) };
    for record in &Table::parse(&text, (64, 64)).records {
        let tri = record.triangle::<f64, 4>(2).expect("a triangle");
        let tri = tri.map(|position| Vertex { position, attributes: [] });
        let must = record.spans(17, (64, 64)).expect("spans");
        let ambiguous = record.spans(18, (64, 64)).expect("spans");
        let holds = |spans: &[(u32, u32, u32)], x, y| {
            let mut spans = spans.iter();
            spans.any(|&(row, x0, x1)| row == y && (x0..=x1).contains(&x))
        };
        for_each_sample(&viewport, (64, 64), &tri, |s| {
            let clear = s.margin > 1.0 / 128.0;
            let case = format!("line {}: {s:?}", record.line);
            assert_eq!(s.covered && clear, holds(&must, s.x, s.y), "{case}");
            // Beyond the tips, the margin is less than the distance; so only this way.
            assert!(!(clear && holds(&ambiguous, s.x, s.y)), "{case}");
        });
    }
}

/// A file without most of its records where there are hundreds, which take long with slow rasterizers.
fn thinned(stem: &str, folder: &Path) -> PathBuf {
    if stem != "tri_bulk_hash" {
        return data(stem);
    }
    let text = std::fs::read_to_string(data(stem)).expect("the data");
    let kept: Vec<&str> = text.lines().step_by(10).collect();
    let path = folder.join(format!("{stem}.csv"));
    std::fs::write(&path, kept.join("\n")).expect("a file for the test");
    path
}

#[test]
fn every_mistake_is_found() {
    let folder = std::env::temp_dir().join(format!("mistakes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    use Mistake::*;
    let coverage =
        |m: Mistake| matches!(m, ShiftedByOne | FirstMissing | TwiceOnce | Culled | LeavesViewport | Nothing);
    for mistake in Mistake::ALL {
        let must_find: Vec<&str> = match mistake {
            // Depth scenes report one winner per pixel, and so hide what is drawn twice or outside; so do coordinates.
            TwiceOnce | LeavesViewport => CHECKED.into_iter().filter(|s| !["depth", "persp"].contains(s)).collect(),
            // Lines and points have no winding.
            Culled => CHECKED.into_iter().filter(|s| !matches!(*s, "lines" | "points")).collect(),
            m if coverage(m) => CHECKED.to_vec(),
            CentredSamples => vec!["msaa4"],
            CoarseGrid => vec!["tri_random", "tri_sliver", "tri_bulk_hash", "mesh_once", "lines"],
            // Samples exactly on an edge are rare in the bulk file, and all of it takes long.
            AllEdgesOwn => vec!["tri_special", "tri_far"],
            BottomRight => vec!["tri_special", "tri_far", "points"],
            Backward => vec!["lines"],
            Overflowing => vec!["tri_far"],
            // `LessEqual` is not among them: where depths tie, the file allows either winner.
            Greater | DepthOff | NoDepthTest => vec!["depth"],
            NoPerspective | CoordinatesOff => vec!["persp"],
            NoNearPlane | DropsCrossing => vec!["nearclip", "nearclip_pairs"],
            SecondShifted => vec!["nearclip_pairs"],
            _ => unreachable!("listed above"),
        };
        for stem in must_find {
            let mut rasterizer = mistake;
            let outcome =
                check_file(&thinned(stem, &folder), &mut rasterizer).unwrap_or_else(|error| panic!("{error}"));
            println!("{mistake:?}: {outcome:?}");
            assert!(!outcome.is_right(), "{stem} does not find {mistake:?}");
        }
    }
    std::fs::remove_dir_all(&folder).expect("the folder can go");
}

#[test]
fn unknown_broken_and_empty_files_are_errors() {
    let folder = std::env::temp_dir().join(format!("conformance-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    let error_of = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("a file for the test");
        check_file(&path, &mut Model).expect_err(name)
    };
    assert!(matches!(error_of("tri_random.txt", ""), CheckError::UnknownFile { .. }));
    assert!(matches!(error_of("triangles.csv", ""), CheckError::UnknownFile { .. }));
    assert!(matches!(error_of("tri_random.csv", "# only a comment\n"), CheckError::NoRecords { .. }));
    let missing = check_file(&folder.join("tri_far.csv"), &mut Model);
    assert!(matches!(missing, Err(CheckError::Unreadable { .. })));
    let broken = [
        ("tri_random.csv", "1,0,0,256,0,0,256,1,LS\n"),
        ("tri_random.csv", "1,0,0,256,0,0,256,2,LS,0 0-0\n"),
        ("tri_bulk_hash.csv", "1,0,0,256,0,0,256,1,LS,xyz\n"),
        ("mesh_once.csv", "1,fan,3,1,0 0 256 0 0 256,0 1 3,0*4096\n"),
        ("depth.csv", "T,0,0,256,0,0,256,1,2,3\n"),
        ("depth.csv", "S,1,0,general\nW,0*4096\nA1,0*4096\nA4,0*4096\n"),
        ("nearclip.csv", "1,0,0,0,0,0,0,0,0,0,0,0,0,0,1,1,L,0 0-0,0 0-0\n"),
        ("nearclip_pairs.csv", "1,2,3\n"),
        ("lines.csv", "1,centre,0,0,256,0,0,0.0 9,=,-,=,-,=,-\n"),
        ("lines.csv", "1,centre,0,0,256,0,0,0.0 4,=,-,=,-,=,-\n"),
        ("points.csv", "1,0,0,256,0,1,0\n"),
        ("msaa4.csv", "1,0,0,256,0,0,256,2,LS,0 0-0,-,-,-\n"),
    ];
    for (name, text) in broken {
        let error = error_of(name, text);
        assert!(matches!(error, CheckError::BadRecord { .. }), "{text}: {error}");
        assert!(error.to_string().contains(&format!("{name}:1: ")), "{error}");
    }
    std::fs::remove_dir_all(&folder).expect("the folder can go");
}
