//! Checks a rasterizer against the conformance files: exact coverage, meshes, depth and near-plane clipping.
//!
//! In: the path of a CSV file, which is known by its name, and a [`Rasterizer`]. Out: how many records came out right,
//! and what was wrong with the first that did not. A file that cannot be read or understood is an error, never a pass.
//!
//! | file | what must hold |
//! |---|---|
//! | `tri_random`, `tri_sliver`, `tri_special`, `tri_far` | exactly these pixels, each once |
//! | `tri_bulk_hash` | the same, by a hash of the spans |
//! | `mesh_once` | every pixel from exactly this triangle and no other |
//! | `depth` | winner and depth (±1) wherever no other fragment is within 1 step |
//! | `nearclip` | `must` pixels once, `ambiguous` ones at most once, others never |
//! | `nearclip_pairs` | the same for two triangles together |
//! | `lines` | exactly these pixels, in drawing order |
//! | `points` | exactly this rectangle |
//! | `persp` | u and v within 1/16 of a unit |
//! | `msaa4` | exactly the pixels of each sample |

use std::fmt;
use std::path::Path;

// Paths are given because an example program may reach this file by a path of its own.
#[path = "hits.rs"]
pub mod hits;
#[path = "records.rs"]
pub mod records;

use hits::{Hits, Verdict, mask_of};
pub use records::BadRecord;
use records::{Record, Table, pixel_count};

/// Three screen positions: 1/256 px, x right, y down, either winding.
pub type ScreenTriangle = [[i32; 2]; 3];

/// Three clip-space vertices: x, y, z, w in 1/65536.
///
/// These files have clip-space **y down**: screen X = (x/w + 1) * width/2 and Y = (y/w + 1) * height/2.
pub type ClipTriangle = [[i32; 4]; 3];

/// A triangle on the screen with clip w (1/65536) and texture coordinates at its vertices.
#[derive(Clone, Copy, Debug)]
pub struct PerspectiveTriangle {
    pub v: ScreenTriangle,
    pub w: [i32; 3],
    pub u: [i32; 3],
    pub t: [i32; 3],
}

/// What a rasterizer must offer to be checked. Nothing is culled, pixels outside the viewport are not reported.
pub trait Rasterizer {
    /// Covers one triangle: calls `hit(x, y)` once for every pixel.
    fn triangle(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(u32, u32));

    /// Covers one triangle at four samples per pixel, at the standard places: calls `hit(sample, x, y)` once for every
    /// sample.
    fn samples(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(usize, u32, u32));

    /// Draws triangles with depth codes in order (test `Less`, clear value 65535), and returns, per pixel in rows, the
    /// winner (0 = none, else 1-based) and the stored depth.
    fn depth_scene(&mut self, width: u32, height: u32, tris: &[(ScreenTriangle, [u16; 3])]) -> (Vec<u32>, Vec<u16>);

    /// Perspective-correct u and t at the centres of the pixels that a triangle covers, in rows; `None` at others.
    fn perspective(&mut self, width: u32, height: u32, triangle: &PerspectiveTriangle) -> Vec<Option<[f64; 2]>>;

    /// Clips and covers triangles without a depth test: calls `hit(triangle index, x, y)` for every pixel of each.
    fn clip_triangles(&mut self, width: u32, height: u32, tris: &[ClipTriangle], hit: &mut dyn FnMut(usize, u32, u32));

    /// Draws an aliased line of one pixel's width: calls `hit(x, y)` for every pixel, in drawing order.
    fn line(&mut self, width: u32, height: u32, ends: [[i32; 2]; 2], hit: &mut dyn FnMut(u32, u32));

    /// Draws a point as a square with sides of `side` / 256 px: calls `hit(x, y)` for every pixel.
    fn point(&mut self, width: u32, height: u32, center: [i32; 2], side: u32, hit: &mut dyn FnMut(u32, u32));
}

/// What became of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// `right` of `total` records (scenes, in the depth file) came out right.
    Checked { right: usize, total: usize, first_wrong: Option<String> },
}

impl Outcome {
    /// True if every record was checked and right.
    pub fn is_right(&self) -> bool {
        let Outcome::Checked { right, total, .. } = self;
        right == total
    }
}

/// Why a file could not be checked.
#[derive(Debug)]
pub enum CheckError {
    Unreadable {
        file: String,
        error: std::io::Error,
    },
    /// No file of the conformance set has this name.
    UnknownFile {
        file: String,
    },
    BadRecord {
        file: String,
        bad: BadRecord,
    },
    NoRecords {
        file: String,
    },
}

impl fmt::Display for CheckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CheckError::Unreadable { file, error } => write!(f, "{file}: cannot be read: {error}"),
            CheckError::UnknownFile { file } => {
                write!(f, "{file}: not the name of a conformance file")
            }
            CheckError::BadRecord { file, bad } => write!(f, "{file}:{}: {}", bad.line, bad.reason),
            CheckError::NoRecords { file } => write!(f, "{file}: holds no records"),
        }
    }
}

impl std::error::Error for CheckError {}

/// Checks the records of one file.
///
/// # Errors
/// If the file cannot be read, has an unknown name, cannot be parsed, or holds no records.
pub fn check_file(path: &Path, rasterizer: &mut dyn Rasterizer) -> Result<Outcome, CheckError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.strip_suffix(".csv").unwrap_or("");
    type Check = fn(&Table, &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord>;
    let (check, side): (Check, u32) = match stem {
        "tri_random" | "tri_sliver" | "tri_special" | "tri_far" => (check_spans, 128),
        "tri_bulk_hash" => (check_hashes, 256),
        "mesh_once" => (check_meshes, 64),
        "depth" => (check_depth, 64),
        "nearclip" => (check_near_clip, 64),
        "nearclip_pairs" => (check_near_clip_pairs, 64),
        "lines" => (check_lines, 64),
        "points" => (check_points, 64),
        "persp" => (check_perspective, 128),
        "msaa4" => (check_samples, 64),
        _ => {
            return Err(CheckError::UnknownFile { file: path.display().to_string() });
        }
    };
    let file = path.display().to_string();
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) => return Err(CheckError::Unreadable { file, error }),
    };
    let verdicts = match check(&Table::parse(&text, (side, side)), rasterizer) {
        Ok(verdicts) if verdicts.is_empty() => return Err(CheckError::NoRecords { file }),
        Ok(verdicts) => verdicts,
        Err(bad) => return Err(CheckError::BadRecord { file, bad }),
    };
    let wrong = |(id, verdict): &(String, Verdict)| verdict.as_ref().err().map(|e| format!("{name} {id}: {e}"));
    Ok(Outcome::Checked {
        right: verdicts.iter().filter(|v| v.1.is_ok()).count(),
        total: verdicts.len(),
        first_wrong: verdicts.iter().find_map(wrong),
    })
}

fn draw_one(table: &Table, rasterizer: &mut dyn Rasterizer, v: ScreenTriangle) -> Hits {
    let mut hits = Hits::new(table);
    rasterizer.triangle(table.width, table.height, v, &mut |x, y| hits.add(1, x, y));
    hits
}

fn check_spans(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(10)?;
        let spans = record.spans(9, (table.width, table.height))?;
        let expected = mask_of(record, table, &spans, record.number(7)?)?;
        let hits = draw_one(table, rasterizer, record.triangle(1)?);
        Ok((format!("id {}", record.text(0)?), hits.verdict(|i| (expected[i].into(), expected[i].into()))))
    };
    table.records.iter().map(check).collect()
}

fn check_samples(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(13)?;
        let mut hits = [(); 4].map(|()| Hits::new(table));
        let v = record.triangle(1)?;
        rasterizer.samples(table.width, table.height, v, &mut |sample, x, y| hits[sample].add(1, x, y));
        let (mut verdict, mut count) = (Ok(()), 0);
        for (sample, hits) in hits.iter().enumerate() {
            let spans = record.spans(9 + sample, (table.width, table.height))?;
            let expected = mask_of(record, table, &spans, pixel_count(&spans))?;
            count += pixel_count(&spans);
            let of_sample = hits.verdict(|i| (expected[i].into(), expected[i].into()));
            verdict = verdict.and(of_sample.map_err(|wrong| format!("sample {sample}: {wrong}")));
        }
        if count != record.number::<usize>(7)? {
            return Err(record.bad(format!("{count} samples in the spans, not as many as announced")));
        }
        Ok((format!("id {}", record.text(0)?), verdict))
    };
    table.records.iter().map(check).collect()
}

fn check_hashes(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(10)?;
        let (count, text): (usize, _) = (record.number(7)?, record.text(9)?);
        let wrong = |_| record.bad(format!("`{text}` is not a hash"));
        let expected = u64::from_str_radix(text, 16).map_err(wrong)?;
        let hits = draw_one(table, rasterizer, record.triangle(1)?);
        let verdict = hits.verdict(|_| (0, 1)).and_then(|()| {
            let drawn = hits.counts.iter().filter(|&&n| n > 0).count();
            match (drawn == count, hits.hash() == expected) {
                (true, true) => Ok(()),
                (true, false) => Err(format!("{drawn} pixels as expected, but not the same ones")),
                (false, _) => Err(format!("{drawn} pixels, expected {count}")),
            }
        });
        Ok((format!("id {}", record.text(0)?), verdict))
    };
    table.records.iter().map(check).collect()
}

fn check_meshes(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(7)?;
        let (kind, [vertex_count, count]) = (record.text(1)?, record.numbers::<usize, 2>(2)?);
        let (vertices, indices) = (record.list::<i32>(4)?, record.list::<usize>(5)?);
        if vertices.len() != 2 * vertex_count || indices.len() != 3 * count {
            return Err(record.bad("the lists are not as long as announced"));
        }
        if indices.iter().any(|&i| i >= vertex_count) {
            return Err(record.bad("an index has no vertex"));
        }
        let ids = record.run_lengths(6, table.width as usize * table.height as usize)?;
        if ids.iter().any(|&id| id as usize > count || (id == 0 && kind == "grid")) {
            return Err(record.bad("the expected ids do not fit the mesh"));
        }
        let mut hits = Hits::new(table);
        for (triangle, id) in indices.chunks(3).zip(1..) {
            let corner = |i: usize| [vertices[2 * triangle[i]], vertices[2 * triangle[i] + 1]];
            let v = [corner(0), corner(1), corner(2)];
            rasterizer.triangle(table.width, table.height, v, &mut |x, y| hits.add(id, x, y));
        }
        let expected = |i: usize| u32::from(ids[i] != 0);
        let verdict = hits.verdict(|i| (expected(i), expected(i))).and_then(|()| {
            let other = (0..ids.len()).find(|&i| hits.last[i] != ids[i]);
            other.map_or(Ok(()), |i| {
                let ((x, y), got, want) = (hits.position(i), hits.last[i], ids[i]);
                Err(format!("pixel ({x}, {y}) belongs to triangle {got}, expected {want}"))
            })
        });
        Ok((format!("id {} ({kind})", record.text(0)?), verdict))
    };
    table.records.iter().map(check).collect()
}

fn check_perspective(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(18)?;
        let [w, u, t] = record.triangle(7)?;
        let samples = record.list::<u32>(17)?;
        if samples.len() != 4 * record.number::<usize>(16)? {
            return Err(record.bad("not as many samples as announced"));
        }
        let triangle = PerspectiveTriangle { v: record.triangle(1)?, w, u, t };
        let got = rasterizer.perspective(table.width, table.height, &triangle);
        let wrong = samples.chunks_exact(4).find_map(|sample| {
            let value = got.get((sample[1] * table.width + sample[0]) as usize).copied().flatten();
            let expected = [sample[2], sample[3]].map(|value| f64::from(value) / 4096.0);
            let off = value.map(|value| (value[0] - expected[0]).abs().max((value[1] - expected[1]).abs()));
            match off {
                // The data is rounded, too.
                Some(off) if off <= 1.0 / 16.0 + 0.5 / 4096.0 => None,
                _ => Some(format!("({}, {}) is {value:?}, expected {expected:?}", sample[0], sample[1])),
            }
        });
        Ok((format!("id {}", record.text(0)?), wrong.map_or(Ok(()), Err)))
    };
    table.records.iter().map(check).collect()
}

fn check_depth(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let starts_scene = |record: &Record| record.fields[0] == "S";
    if let Some(first) = table.records.first().filter(|r| !starts_scene(r)) {
        return Err(first.bad("a scene must start with S"));
    }
    let scenes = table.records.chunk_by(|_, next| !starts_scene(next));
    scenes.map(|scene| check_depth_scene(table, rasterizer, scene)).collect()
}

/// One scene: `S`, `T`s, then `W`, `A1`, `A4`, `Z` in any order.
fn check_depth_scene(
    table: &Table,
    rasterizer: &mut dyn Rasterizer,
    scene: &[Record],
) -> Result<(String, Verdict), BadRecord> {
    let pixels = table.width as usize * table.height as usize;
    let header = &scene[0];
    header.expect_fields(4)?;
    let mut tris = Vec::new();
    let [mut winners, mut ambiguous, mut wider] = [None, None, None];
    let mut samples: Option<Vec<u16>> = None;
    for record in &scene[1..] {
        record.expect_fields(if record.fields[0] == "T" { 10 } else { 2 })?;
        let repeated = match record.fields[0] {
            "T" => {
                tris.push((record.triangle(1)?, record.numbers(7)?));
                false
            }
            "W" => winners.replace(record.run_lengths(1, pixels)?).is_some(),
            "A1" => ambiguous.replace(record.run_lengths(1, pixels)?).is_some(),
            "A4" => wider.replace(record.run_lengths(1, pixels)?).is_some(),
            "Z" => samples.replace(record.list(1)?).is_some(),
            other => return Err(record.bad(format!("`{other}` is no record of a depth scene"))),
        };
        if repeated {
            return Err(record.bad("the scene has this record already"));
        }
    }
    let (Some(winners), Some(ambiguous), Some(_), Some(samples)) = (winners, ambiguous, wider, samples) else {
        return Err(header.bad("the scene lacks W, A1, A4 or Z"));
    };
    // Depths are given at x = 1, 5, 9, .. and y = 2, 6, 10, ..
    let rows = (2..table.height as usize).step_by(4);
    let at = rows.flat_map(|y| (1..table.width as usize).step_by(4).map(move |x| y * table.width as usize + x));
    let at: Vec<usize> = at.collect();
    if tris.len() != header.number::<usize>(2)? || samples.len() != at.len() {
        return Err(header.bad("not as many triangles or depths as announced"));
    }

    let (got, depths) = rasterizer.depth_scene(table.width, table.height, &tris);
    let place = |i: usize| (i % table.width as usize, i / table.width as usize);
    let verdict = if got.len() != pixels || depths.len() != pixels {
        Err("the buffers returned do not have the size of the viewport".to_string())
    } else if let Some(i) = (0..pixels).find(|&i| ambiguous[i] == 0 && got[i] != winners[i]) {
        Err(format!("pixel {:?} shows {}, expected {}", place(i), got[i], winners[i]))
    } else {
        let is_off = |&(i, z): &(usize, u16)| ambiguous[i] == 0 && depths[i].abs_diff(z) > 1;
        let off = at.into_iter().zip(samples).find(is_off);
        off.map_or(Ok(()), |(i, z)| Err(format!("depth at {:?} is {}, expected {z} +-1", place(i), depths[i])))
    };
    Ok((format!("scene {} ({})", header.text(1)?, header.text(3)?), verdict))
}

/// The last fields of a clipping record, from `index`: what must be hit once and what may be hit at most once.
fn clip_expectation(record: &Record, table: &Table, counts: usize, spans: usize) -> Result<Vec<(u32, u32)>, BadRecord> {
    let mask = |i: usize| {
        let rows = record.spans(spans + i, (table.width, table.height))?;
        mask_of(record, table, &rows, record.number(counts + i)?)
    };
    let (must, may) = (mask(0)?, mask(1)?);
    let pixels = must.iter().zip(&may);
    if pixels.clone().any(|(must, may)| *must && *may) {
        return Err(record.bad("a pixel is both certain and ambiguous"));
    }
    Ok(pixels.map(|(&must, &may)| (must.into(), (must || may).into())).collect())
}

fn draw_clipped(table: &Table, rasterizer: &mut dyn Rasterizer, tris: &[ClipTriangle]) -> Hits {
    let mut hits = Hits::new(table);
    let mut hit = |triangle: usize, x, y| hits.add(triangle as u32 + 1, x, y);
    rasterizer.clip_triangles(table.width, table.height, tris, &mut hit);
    hits
}

fn check_near_clip(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(19)?;
        let allowed = clip_expectation(record, table, 14, 17)?;
        let hits = draw_clipped(table, rasterizer, &[record.triangle(2)?]);
        let id = format!("id {} (kind {})", record.text(0)?, record.text(1)?);
        Ok((id, hits.verdict(|i| allowed[i])))
    };
    table.records.iter().map(check).collect()
}

fn check_near_clip_pairs(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(21)?;
        let allowed = clip_expectation(record, table, 17, 19)?;
        let [v0, v1, v2] = record.triangle(1)?;
        let v3 = record.numbers(13)?;
        let hits = draw_clipped(table, rasterizer, &[[v0, v1, v2], [v3, v2, v1]]);
        Ok((format!("id {}", record.text(0)?), hits.verdict(|i| allowed[i])))
    };
    table.records.iter().map(check).collect()
}

fn check_lines(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(14)?;
        let [a, b] = [record.numbers(2)?, record.numbers(4)?];
        let expected = record.chain(7)?;
        let mut drawn = Vec::new();
        rasterizer.line(table.width, table.height, [a, b], &mut |x, y| drawn.push((x, y)));
        let other = drawn.iter().zip(&expected).position(|(d, e)| d != e);
        let verdict = match other {
            Some(k) => Err(format!("pixel {k} is {:?}, expected {:?}", drawn[k], expected[k])),
            None if drawn.len() == expected.len() => Ok(()),
            None => Err(format!("{} pixels, expected {}", drawn.len(), expected.len())),
        };
        Ok((format!("id {} ({})", record.text(0)?, record.text(1)?), verdict))
    };
    table.records.iter().map(check).collect()
}

fn check_points(table: &Table, rasterizer: &mut dyn Rasterizer) -> Result<Vec<(String, Verdict)>, BadRecord> {
    let check = |record: &Record| {
        record.expect_fields(9)?;
        let [x0, x1, y0, y1] = record.numbers::<i64, 4>(4)?;
        let mut hits = Hits::new(table);
        let hit = &mut |x, y| hits.add(1, x, y);
        rasterizer.point(table.width, table.height, record.numbers(1)?, record.number(3)?, hit);
        let verdict = hits.verdict(|i| {
            let (x, y) = (i as i64 % i64::from(table.width), i as i64 / i64::from(table.width));
            let inside = u32::from((x0..=x1).contains(&x) && (y0..=y1).contains(&y));
            (inside, inside)
        });
        Ok((format!("id {}", record.text(0)?), verdict))
    };
    table.records.iter().map(check).collect()
}
