//! The command line.

use std::process::{Command, Output};

use crate::support::{Folder, png};

fn run(arguments: &[&std::ffi::OsStr]) -> (Output, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_zstrip-assets")).args(arguments).output().expect("a program");
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    (output, out, err)
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

#[test]
fn a_file_is_converted_and_described() {
    let folder = Folder::new().with("square.obj", SQUARE).with("paint.png", png(8, 8));
    let [file, out, paint] = ["square.obj", "model.zstm", "paint.png"].map(|name| folder.path(name));
    let (output, text, err) =
        run(&["convert".as_ref(), file.as_ref(), "-o".as_ref(), out.as_ref(), "--texture".as_ref(), paint.as_ref()]);
    assert!(output.status.success() && text.contains("2 triangles") && err.is_empty(), "{text}{err}");
    let bytes = std::fs::read(&out).expect("a container");
    assert_eq!(&bytes[..4], b"ZSTM");
    assert!(text.contains("textures: 160 bytes"), "{text}");
    let (output, text, _) = run(&["info".as_ref(), file.as_ref()]);
    assert!(output.status.success() && text.contains("worst errors"), "{text}");
    // Nothing but the files and the container is there.
    assert_eq!(std::fs::read_dir(folder.path("")).expect("a folder").count(), 3);
    let source = folder.path("square.rs");
    let (output, ..) = run(&["convert".as_ref(), file.as_ref(), "--rust".as_ref()]);
    assert!(output.status.success());
    let source = std::fs::read_to_string(source).expect("a source");
    assert!(source.contains("pub mod square") && source.contains("\"square.zstm\""), "{source}");
    assert!(folder.path("square.zstm").exists());
}

#[test]
fn mistakes_have_exit_codes_and_places() {
    let folder = Folder::new().with("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n").with("wide.obj", SQUARE);
    let [bad, wide, none] = ["bad.obj", "wide.obj", "none.obj"].map(|name| folder.path(name));
    let code = |arguments: &[&std::ffi::OsStr]| {
        let (output, _, err) = run(arguments);
        (output.status.code(), err)
    };
    let (found, err) = code(&["convert".as_ref(), bad.as_ref()]);
    assert!(found == Some(1) && err.contains("bad.obj:3:"), "{err}");
    let (found, err) = code(&["info".as_ref(), none.as_ref()]);
    assert!(found == Some(1) && err.contains("none.obj"), "{err}");
    let (found, err) = code(&["info".as_ref(), wide.as_ref(), "--scale".as_ref(), "1e6".as_ref()]);
    assert!(found == Some(1) && err.contains("scale the model by"), "{err}");
    for arguments in
        [&["convert"][..], &["turn", "a.obj"], &["info", "a.obj", "--up", "x"], &["info", "a", "--nothing"]]
    {
        let arguments: Vec<&std::ffi::OsStr> = arguments.iter().map(|text| text.as_ref()).collect();
        let (found, err) = code(&arguments);
        assert!(found == Some(2) && err.contains("--help"), "{arguments:?}: {err}");
    }
    // No output is left behind.
    assert_eq!(std::fs::read_dir(folder.path("")).expect("a folder").count(), 2);
}

/// The square, and a copy of it as a container.
fn square() -> Folder {
    let folder = Folder::new().with("square.obj", SQUARE).with("paint.png", png(64, 64));
    let [file, out] = ["square.obj", "square.zstm"].map(|name| folder.path(name));
    let (output, ..) = run(&["convert".as_ref(), file.as_ref(), "-o".as_ref(), out.as_ref()]);
    assert!(output.status.success());
    folder
}

/// Runs a command with words, the second of which is a file of the folder, and returns code, output and errors.
fn run_in(folder: &Folder, words: &str) -> (Option<i32>, String, String) {
    let mut words: Vec<std::ffi::OsString> = words.split(' ').map(Into::into).collect();
    for word in &mut words {
        if word.to_string_lossy().contains('.') && !word.to_string_lossy().starts_with('-') {
            *word = folder.path(&word.to_string_lossy()).into();
        }
    }
    let (output, out, err) = run(&words.iter().map(|word| word.as_ref()).collect::<Vec<_>>());
    (output.status.code(), out, err)
}

#[test]
fn models_and_containers_are_checked() {
    let folder = square();
    let (code, text, err) = run_in(&folder, "check square.obj --texture paint.png --screen 64x80 --sheet sheet.png");
    assert_eq!(code, Some(0), "{err}");
    // What is lost, what it takes, and how fast it is.
    for part in ["worst errors", "flash, bytes", "records", "pose", "RP2040", "RP2350", "Cortex-M4", "ESP32-C3, C6"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let sheet = image::open(folder.path("sheet.png")).expect("a PNG");
    assert_eq!((sheet.width(), sheet.height()), (4 * 68 + 4, 2 * 84 + 4));
    let (code, of_container, err) = run_in(&folder, "check square.zstm --screen 64x80");
    assert!(code == Some(0) && of_container.contains("a container already"), "{err}");
    let (_, of_model, _) = run_in(&folder, "check square.obj --screen 64x80");
    let costs = |text: &str| text[text.find("per frame").expect("costs")..].to_owned();
    assert_eq!(costs(&of_container), costs(&of_model));
    // Options of a conversion have no effect on a container.
    let (code, _, err) = run_in(&folder, "check square.zstm --scale 2");
    assert!(code == Some(2) && err.contains("--scale"), "{err}");
    let (code, _, err) = run_in(&folder, "check square.obj --screen 4096x4096 --sheet no.png");
    assert!(code == Some(1) && err.contains("16404 x 8204") && !folder.path("no.png").exists(), "{err}");
}

#[test]
fn numbers_out_of_range_are_refused_before_anything_is_drawn() {
    let folder = square();
    for words in [
        "check square.obj --m4-clock NaN",
        "check square.obj --m4-clock=-5",
        "check square.obj --screen 0x80",
        "check square.obj --screen 80",
        "check square.obj --rows 321",
        "view square.obj --zoom 0",
        "view square.obj --clip Run",
        "view square.obj --rows -1",
        "info square.obj --scale NaN",
        "convert square.obj --max-texture 0",
        "check square.obj --key-error=-1",
        "bench square.obj --rows 0",
        "bench square.obj --core m7",
        "bench square.obj --format gray8",
        "bench",
        "frob square.obj",
        "--frob",
    ] {
        let (code, out, err) = run_in(&folder, words);
        assert!(code == Some(2) && out.is_empty() && err.contains("--help"), "{words}: {code:?} {out}{err}");
    }
    let (output, _, err) = run(&[]);
    assert!(output.status.code() == Some(2) && err.contains("convert, info, check, view and bench"), "{err}");
    for command in ["", "convert ", "info ", "check ", "view ", "bench "] {
        let (code, out, _) = run_in(&folder, &format!("{command}--help"));
        assert!(code == Some(0) && out.contains("zstrip-assets") && out.contains("--texture FILE"), "{command}");
    }
}

#[test]
fn mistakes_are_told_by_the_name_of_the_option_or_of_the_file() {
    let folder = square().with("empty.zstm", "").with("cut.zstm", "ZSTM").with("picture.glb", png(8, 8));
    let folder = folder.with("wide.obj", SQUARE.replace("1 1 0", "20000 20000 0"));
    for (words, expected, part) in [
        ("check square.obj --rows 1e3", 2, "--rows takes a whole number from 0 to 4294967295"),
        ("view square.obj --turn NaN", 2, "--turn takes a whole number"),
        ("view square.obj --time 99999999999", 2, "--time takes a whole number from 0 to 4294967295"),
        ("convert square.obj --scale big", 2, "--scale takes a number"),
        ("convert square.obj --scale inf", 2, "the scale is inf, and must be above 0 and finite"),
        ("convert square.obj --max-texture 0", 2, "the size of textures is 0, and must be 1 to 32768"),
        ("view square.obj --clip Run", 2, "there is no clip \"Run\": the model has no clips"),
        ("check empty.zstm", 1, "empty.zstm: not a container: it does not begin with ZSTM"),
        ("view cut.zstm", 1, "cut.zstm: not a container of a model: 4 bytes"),
        ("bench cut.zstm", 1, "cut.zstm: not a container of a model: 4 bytes"),
        ("info square.zstm", 1, "square.zstm: a container already"),
        ("convert square.zstm", 1, "square.zstm: a container already"),
        ("check wide.obj", 1, "must be below 32768; convert the model with a smaller --scale"),
        ("info picture.glb", 1, "picture.glb: neither GLB nor the JSON of glTF"),
    ] {
        let (code, out, err) = run_in(&folder, words);
        assert!(code == Some(expected) && out.is_empty() && err.contains(part), "{words}: {code:?} {out}{err}");
    }
}

#[test]
fn files_of_a_model_are_never_written_over() {
    let folder = square().with("painted.obj", format!("mtllib paint.mtl\nusemtl a\n{SQUARE}"));
    let folder = folder.with("paint.mtl", "newmtl a\nmap_Kd paint.png\n");
    let names = ["square.obj", "square.zstm", "painted.obj", "paint.mtl", "paint.png"];
    let read = || names.map(|name| std::fs::read(folder.path(name)).expect("a file"));
    let before = read();
    for words in [
        "convert square.obj -o square.obj",
        "convert square.obj -o ./square.obj",
        "convert square.obj -o paint.png --texture paint.png",
        "convert painted.obj -o paint.mtl",
        "convert painted.obj -o paint.png",
        "convert painted.obj --rust -o square.zstm",
        "check painted.obj --sheet paint.png",
        "check square.zstm --sheet square.zstm",
        "view square.obj --png square.obj",
        "view square.obj --gif paint.png --texture paint.png",
        "view square.obj --png new.png --gif new.png",
    ] {
        let (code, out, err) = run_in(&folder, words);
        let says = err.contains("another name") && err.contains("the output");
        assert!(code == Some(2) && out.is_empty() && says, "{words}: {code:?} {out}{err}");
        assert!(read() == before && !folder.path("new.png").exists(), "{words}");
    }
}

#[test]
fn a_screen_lower_than_a_strip_is_one_strip() {
    let folder = square();
    for (words, code) in [("--screen 8x1", 0), ("--screen 8x15", 0), ("--rows 16 --screen 8x15", 2)] {
        let (found, _, err) = run_in(&folder, &format!("check square.obj {words}"));
        assert_eq!(found, Some(code), "{words}: {err}");
    }
    let (code, out, _) = run_in(&folder, "--version");
    assert!(code == Some(0) && out == concat!("zstrip-assets ", env!("CARGO_PKG_VERSION"), "\n"), "{out}");
}

#[test]
fn firmware_refuses_models_that_it_has_no_memory_for_and_says_why() {
    let folder = square().with("large.png", png(2048, 2048));
    let (code, _, err) = run_in(&folder, "bench square.obj --texture large.png --max-texture 2048 --no-mips");
    assert!(code == Some(1) && err.contains("memory for 8388480") && err.contains("container"), "{err}");
    let (code, _, err) = run_in(&folder, "bench square.obj --screen 4000x320 --rows 320");
    assert!(code == Some(1) && err.contains("pixels of a strip: 1280000"), "{err}");
    let (code, _, err) = run_in(&folder, "bench square.obj --zstrip no.where");
    assert!(code == Some(1) && err.contains("--zstrip DIR"), "{err}");
}

/// Returns the frames of a GIF file: their delays and their pictures as indices and palettes.
fn frames(folder: &Folder, name: &str) -> Vec<(u16, Vec<u8>)> {
    let file = std::fs::File::open(folder.path(name)).expect("a file");
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(file).expect("a GIF");
    let mut frames = vec![];
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        frames.push((frame.delay, frame.buffer.to_vec()));
    }
    frames
}

#[test]
fn pictures_that_move_begin_where_they_are_told_to() {
    let folder = square();
    for (name, turn) in [("a", 0), ("b", 90), ("c", -270), ("d", 450)] {
        let (code, _, err) =
            run_in(&folder, &format!("view square.obj --screen 32x40 --gif {name}.gif --png {name}.png --turn={turn}"));
        assert_eq!(code, Some(0), "{err}");
    }
    let [a, b, c, d] = ["a.gif", "b.gif", "c.gif", "d.gif"].map(|name| frames(&folder, name));
    assert_eq!(a.len(), 120);
    assert_eq!(a.iter().map(|(delay, _)| u32::from(*delay)).sum::<u32>(), 600, "six seconds");
    assert!(a[0] != b[0] && a[30] == b[0], "a quarter of a turn");
    assert!(b == c && c == d, "whole turns do not matter");
    // The picture shows the first frame.
    let picture = image::open(folder.path("b.png")).expect("a PNG").to_rgba8();
    let differ = picture.as_raw().iter().zip(&b[0].1).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    assert_eq!(differ, 0);
}

#[test]
fn a_time_without_clips_is_refused() {
    let folder = square();
    let (code, _, err) = run_in(&folder, "view square.obj --time 5 --png there.png");
    assert!(code == Some(2) && err.contains("no clips") && !folder.path("there.png").exists(), "{err}");
    let (code, _, err) = run_in(&folder, "view square.obj --time 0 --png there.png");
    assert_eq!(code, Some(0), "{err}");
}

#[test]
fn levels_of_detail_are_printed_and_one_thing_is_no_plural() {
    let folder = square();
    let (code, text, err) = run_in(&folder, "check square.obj --lods 2");
    assert!(code == Some(0) && text.contains("1 mesh\n") && text.contains(", 1 part\n"), "{text}{err}");
    assert!(!text.contains("levels of detail   triangles"), "a square has none: {text}");
}
