//! Shapes of many sizes of triangles, in each material that models have: what a draw takes.

use super::{Show, panel};
use std::f64::consts::TAU;
use std::fmt::Write;
use zstrip_assets::preview::Container;
use zstrip_assets::{
    AlphaMode, Image, Import, Material, Options, Texture, TextureKind, Wrap, WriteOptions, import, write,
};

/// A surface that is round both ways: its columns, its rows, and the distance of its middle line from the axis; a
/// sphere's is 0.
#[derive(Clone, Copy)]
struct Shape {
    columns: usize,
    rows: usize,
    middle: f64,
    /// True if each quad has corners of its own.
    own: bool,
}

const fn shape(columns: usize, rows: usize, middle: f64, own: bool) -> Shape {
    Shape { columns, rows, middle, own }
}

/// Triangles of 2 to 100 px; the last but two are long and thin.
const SHAPES: [Shape; 11] = [
    shape(6, 4, 0.0, false),
    shape(12, 8, 0.0, false),
    shape(22, 15, 0.0, false),
    shape(48, 32, 0.0, false),
    shape(8, 5, 1.6, false),
    shape(20, 12, 1.6, false),
    shape(44, 26, 1.6, false),
    shape(36, 3, 0.0, false),
    shape(6, 30, 1.6, false),
    shape(16, 10, 0.0, true),
    shape(30, 18, 1.6, true),
];

impl Shape {
    /// Returns the shape as an OBJ file.
    fn obj(self) -> String {
        let Self { columns, rows, middle, own } = self;
        let mut text = String::new();
        // Writing to a string does not fail.
        let mut corner = |column: usize, row: usize| {
            let (u, v) = (column as f64 / columns as f64, row as f64 / rows as f64);
            let across = if middle > 0.0 { v * TAU } else { 0.2 + v * (TAU / 2.0 - 0.4) };
            let ((sin, cos), (out, up)) = ((u * TAU).sin_cos(), across.sin_cos());
            let (radius, n) = (middle + out, [out * sin, up, out * cos]);
            _ = writeln!(text, "v {} {} {}\nvt {u} {v}\nvn {} {} {}", radius * sin, up, radius * cos, n[0], n[1], n[2]);
        };
        let quad = |corners: [usize; 4]| {
            let [a, b, c, d] = corners.map(|k| k + 1).map(|k| format!("{k}/{k}/{k}"));
            format!("f {a} {b} {c}\nf {a} {c} {d}\n")
        };
        let mut faces = String::new();
        if own {
            for k in 0..columns * rows {
                let (x, y) = (k % columns, k / columns);
                for (x, y) in [(x, y), (x, y + 1), (x + 1, y + 1), (x + 1, y)] {
                    corner(x, y);
                }
                faces += &quad([4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3]);
            }
        } else {
            for k in 0..(columns + 1) * (rows + 1) {
                corner(k % (columns + 1), k / (columns + 1));
            }
            for k in 0..columns * rows {
                let first = k / columns * (columns + 1) + k % columns;
                faces += &quad([first, first + columns + 1, first + columns + 2, first + 1]);
            }
        }
        text + &faces
    }
}

/// A material, by its name in the table of costs.
struct Kind {
    name: &'static str,
    textures: Option<TextureKind>,
    alpha: AlphaMode,
}

const CUTOUT: AlphaMode = AlphaMode::Mask { cutoff: 0.5 };

const KINDS: [Kind; 12] = [
    Kind { name: "flat", textures: None, alpha: AlphaMode::Opaque },
    Kind { name: "gouraud", textures: None, alpha: AlphaMode::Opaque },
    Kind { name: "blended", textures: None, alpha: AlphaMode::Blend },
    Kind { name: "textured", textures: Some(TextureKind::Rgb565), alpha: AlphaMode::Opaque },
    Kind { name: "palette", textures: Some(TextureKind::Palette), alpha: AlphaMode::Opaque },
    Kind { name: "packed_palette", textures: Some(TextureKind::Palette16), alpha: AlphaMode::Opaque },
    Kind { name: "gray", textures: Some(TextureKind::Gray), alpha: AlphaMode::Opaque },
    Kind { name: "masked", textures: Some(TextureKind::Mask), alpha: CUTOUT },
    Kind { name: "cutout", textures: Some(TextureKind::Rgb565), alpha: CUTOUT },
    Kind { name: "cutout_palette", textures: Some(TextureKind::Palette), alpha: CUTOUT },
    Kind { name: "glass", textures: Some(TextureKind::Rgb565), alpha: AlphaMode::Blend },
    Kind { name: "glass_palette", textures: Some(TextureKind::Palette), alpha: AlphaMode::Blend },
];

/// Returns an image of many colours; a quarter of it is transparent.
fn image() -> Image {
    const SIDE: usize = 64;
    let texel = |k: usize| {
        let (x, y) = (k % SIDE, k / SIDE);
        let alpha = if x / 8 % 2 + y / 8 % 2 == 0 { 0 } else { 128 + (k * 13) % 128 };
        [x * 255 / SIDE, y * 255 / SIDE, (x * y / 16) % 256, alpha].map(|c| c as u8)
    };
    let texels = (0..SIDE * SIDE).flat_map(texel).collect();
    Image { name: "colours".to_owned(), width: SIDE as u32, height: SIDE as u32, texels }
}

impl Kind {
    /// Returns the shape in the material.
    fn dress(&self, shape: &Import) -> Import {
        let mut dressed = shape.clone();
        let texture = self.textures.map(|_| Texture { image: 0, wrap: [Wrap::Repeat; 2], nearest: false });
        let opacity = if self.name == "blended" { 0.5 } else { 1.0 };
        let color = [1.0, 0.8, 0.6, opacity];
        dressed.materials = vec![Material { color, texture, alpha: self.alpha, ..Material::default() }];
        dressed.images = if texture.is_some() { vec![image()] } else { vec![] };
        for mesh in &mut dressed.meshes {
            mesh.material = Some(0);
            if self.name == "flat" {
                mesh.vertices.normals.clear();
            }
        }
        dressed
    }
}

/// Returns all shapes in all materials: in one strip and in many, of two sizes.
pub fn shows() -> Result<Vec<Show>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut shows = vec![];
    for (number, shape) in SHAPES.into_iter().enumerate() {
        let file = folder.path().join("shape.obj");
        std::fs::write(&file, shape.obj()).map_err(|error| error.to_string())?;
        let (import, _) = import(&file, &Options::default()).map_err(|error| error.to_string())?;
        for kind in &KINDS {
            let textures = kind.textures.unwrap_or(TextureKind::Rgb565);
            let options = WriteOptions { textures, ..WriteOptions::default() };
            let written = write(&kind.dress(&import), &options).map_err(|error| format!("{}: {error}", kind.name))?;
            shows.push(Show {
                name: format!("shape {number}, {}", kind.name),
                container: Container::new(&written.bytes),
                panels: vec![panel(240, 110), panel(240, 45), panel(16, 110), panel(16, 45)],
            });
        }
    }
    Ok(shows)
}
