//! Stages, pictures and estimates of models that the library's tests make up.

#[allow(dead_code)]
#[path = "../../../../tests/model/builder.rs"]
mod builder;
#[allow(dead_code)]
#[path = "../../../../tests/model/figures.rs"]
mod figures;

use super::*;
use builder::Builder;

const PANEL: Panel = Panel { width: 120, height: 160, rows: 16, zoom: 100 };

fn container(builder: Builder) -> Container {
    Container::new(builder.build().bytes())
}

fn models() -> [(&'static str, Container); 4] {
    [
        ("textured", figures::textured()),
        ("animated", figures::animated(true)),
        ("many parts", figures::many_parts()),
        ("clustered", figures::clustered()),
    ]
    .map(|(name, builder)| (name, container(builder)))
}

#[test]
fn pictures_are_equal_in_strips_of_any_height() {
    for (name, container) in models() {
        let stage = |rows| Stage::new(&container, Panel { rows, ..PANEL }, Format::Rgb565).expect("a stage");
        let whole = stage(PANEL.height);
        let step = whole.step(5);
        let (expected, stats) = whole.picture(&step).expect("a picture");
        assert!(stats.drawn > 50, "{name}: {stats:?}");
        for rows in [1, 16, 37] {
            let (found, _) = stage(rows).picture(&step).expect("a picture");
            assert!(found == expected, "{name}, strips of {rows} rows");
        }
    }
}

#[test]
fn the_estimate_counts_what_the_library_counts() {
    for (name, container) in models() {
        let stage = Stage::new(&container, PANEL, Format::Rgb565).expect("a stage");
        let estimate = estimate(&stage, 168e6).expect("an estimate");
        let (mut vertices, mut triangles, mut drawn, mut clipped) = (0, 0, 0, 0);
        for number in 0..stage.steps() {
            let (_, stats) = stage.picture(&stage.step(number)).expect("a picture");
            assert_eq!(stats.overflows, 0, "{name}: {stats:?}");
            clipped += stats.clipped;
            vertices = vertices.max(stats.vertices);
            triangles = triangles.max(stats.triangles);
            drawn = drawn.max(stats.drawn);
        }
        assert_eq!(estimate.vertices.worst, f64::from(vertices), "{name}");
        assert_eq!(estimate.triangles.worst, f64::from(triangles), "{name}");
        // The library counts a clipped triangle once, and here each triangle of its fan is one.
        let most = if clipped > 0 { 1.3 } else { 1.0 };
        assert_eq!(clipped > 0, estimate.notes.iter().any(|note| note.contains("clipped")), "{name}");
        // Small triangles that turn out to have no pixel are counted as drawn by the library, and here not.
        let found = estimate.drawn.worst / f64::from(drawn);
        assert!((0.9..=most).contains(&found), "{name}: {} of {drawn}", estimate.drawn.worst);
        let sections: usize = estimate.flash.sections.iter().map(|(_, bytes)| bytes).sum();
        assert_eq!(estimate.flash.total, container.bytes().len(), "{name}");
        assert_eq!(sections, estimate.flash.total, "{name}: {:?}", estimate.flash);
        assert_eq!(estimate.cores.len(), CORES.len(), "{name}");
        for of in &estimate.cores {
            let fps = of.frames_per_second();
            // The mean of equal frames is rounded.
            let exceeds = |less: f64, more: f64| less > more * (1.0 + 1e-12);
            assert!(!exceeds(of.frame.mean, of.frame.worst) && !exceeds(fps.worst, fps.mean), "{name}: {of:?}");
            assert!(fps.worst > 0.0, "{name}: {of:?}");
        }
        assert!(estimate.to_string().contains("RP2040"));
    }
}

#[test]
fn records_of_the_estimate_hold_every_frame() {
    for (name, container) in models() {
        let mut stage = Stage::new(&container, PANEL, Format::Rgb565).expect("a stage");
        let records = estimate(&stage, 168e6).expect("an estimate").ram.records;
        stage.most_records = records / 4;
        for number in 0..stage.steps() {
            let (_, stats) = stage.picture(&stage.step(number)).expect("a picture");
            assert_eq!((stats.overflows, stats.direct_strips), (0, 0), "{name}, frame {number}, {records} bytes");
        }
    }
}

#[test]
fn a_sheet_has_eight_different_pictures_and_is_written_as_a_whole() {
    let container = container(figures::textured());
    let stage = Stage::new(&container, PANEL, Format::Rgb565Be).expect("a stage");
    let sheet = contact_sheet(&stage).expect("a sheet");
    assert_eq!(sheet.size(), (4 * 124 + 4, 2 * 164 + 4));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sheet.png");
    sheet.write_png(&path).expect("a file");
    let read = image::open(&path).expect("a PNG").to_rgb8();
    assert_eq!(read.as_raw(), sheet.pixels().as_flattened());
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1, "no other file is left");
    assert!(matches!(sheet.write_png(&folder.path().join("no/such.png")), Err(PreviewError::Io(..))));
    let shot = |x: u32, y: u32| -> Vec<_> {
        (0..160)
            .flat_map(|row| (0..120).map(move |column| (4 + 124 * x + column, 4 + 164 * y + row)))
            .map(|(x, y)| *read.get_pixel(x, y))
            .collect()
    };
    let shots: Vec<_> = (0..2).flat_map(|y| (0..4).map(move |x| (x, y))).map(|(x, y)| shot(x, y)).collect();
    for (k, one) in shots.iter().enumerate() {
        assert!(shots[..k].iter().all(|other| other != one), "picture {k} is there twice");
    }
}

#[test]
fn clocks_that_no_core_has_are_refused() {
    let model = container(figures::textured());
    let stage = Stage::new(&model, PANEL, Format::Rgb565).expect("a stage");
    for hertz in [f64::NAN, f64::INFINITY, -168e6, 0.0, 1.0] {
        assert!(matches!(estimate(&stage, hertz), Err(PreviewError::Clock(_))), "{hertz}");
    }
}

#[test]
fn a_stage_on_another_panel_is_that_of_a_new_one() {
    let model = container(figures::animated(true));
    let other = Panel { width: 64, height: 48, rows: 5, zoom: 150 };
    let stage = Stage::new(&model, PANEL, Format::Rgb565).expect("a stage");
    let moved = stage.on(other, Format::Gray8).expect("a stage");
    let new = Stage::new(&model, other, Format::Gray8).expect("a stage");
    let step = new.step(3);
    assert_eq!(moved.picture(&step).expect("a picture").0, new.picture(&step).expect("a picture").0);
    assert!(stage.on(Panel { rows: 0, ..other }, Format::Gray8).is_err());
}

#[test]
fn hashes_differ_where_pictures_do() {
    let model = container(figures::animated(true));
    let stage = Stage::new(&model, PANEL, Format::Rgb565).expect("a stage");
    let hash = |step: Option<&Step>| stage.hash(step).expect("a hash").0;
    let steps: Vec<_> = (0..stage.steps()).map(|number| stage.step(number)).collect();
    for (k, one) in steps.iter().enumerate() {
        assert!(hash(Some(one)) != hash(None), "frame {k} is empty");
        let picture = |step| stage.picture(step).expect("a picture").0;
        for other in &steps[..k] {
            assert_eq!(hash(Some(one)) == hash(Some(other)), picture(one) == picture(other), "frame {k}");
        }
    }
}

#[test]
fn wrong_panels_and_files_are_errors_that_name_the_number() {
    let model = container(figures::textured());
    let error = |panel| Stage::new(&model, panel, Format::Rgb565).expect_err("an error").to_string();
    assert_eq!(error(Panel { width: 0, ..PANEL }), "a screen's width of 0; from 1 to 4096 are possible");
    assert_eq!(error(Panel { height: 5000, ..PANEL }), "a screen's height of 5000; from 1 to 4096 are possible");
    assert_eq!(error(Panel { rows: 161, ..PANEL }), "a strip's height of 161; from 1 to 160 are possible");
    assert_eq!(error(Panel { zoom: 0, ..PANEL }), "a zoom of 0; from 1 to 10000 are possible");
    for length in [0, 3, 100, model.bytes().len() - 1] {
        let cut = Container::new(&model.bytes()[..length]);
        let error = Stage::new(&cut, PANEL, Format::Rgb565).expect_err("an error");
        assert!(matches!(error, PreviewError::Model(_)), "{length} bytes: {error}");
    }
}
