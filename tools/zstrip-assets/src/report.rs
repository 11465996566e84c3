//! The report of an import: what was repaired, dropped or noticed.

use std::fmt;
use std::path::PathBuf;

use crate::model::Bounds;
use crate::words::{count, verb};

/// Sizes of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Meshes.
    pub meshes: usize,
}

/// The report of an import.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Sizes as read: vertices that the file lists, and its triangles after polygons were divided.
    pub before: Counts,
    /// Sizes as imported.
    pub after: Counts,
    /// The box around the model in its pose without animation, after options moved it.
    pub bounds: Option<Bounds>,
    /// The files that were read, the model's own first.
    pub files: Vec<PathBuf>,
    /// The files that the model names, and that are not there.
    pub missing: Vec<PathBuf>,
    /// Everything that was repaired, dropped or noticed, in the order in which it was found.
    pub notes: Vec<Note>,
}

/// The most letters of a reason in a note.
const REASON_LETTERS: usize = 400;

/// Something that was repaired, dropped or noticed.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// Polygons of more than three corners were divided into triangles.
    Triangulated {
        /// The number of polygons.
        polygons: usize,
    },
    /// Polygons cross themselves, or have no plane; they were divided as fans.
    Crossed {
        /// The number of polygons.
        polygons: usize,
    },
    /// Vertices up to the weld distance from each other were moved together.
    Moved {
        /// The number of vertices that moved.
        vertices: usize,
    },
    /// Equal vertices became one, or vertices were left out because no triangle uses them.
    Welded {
        /// The number of vertices that are gone.
        vertices: usize,
    },
    /// Triangles without area were dropped.
    Degenerate {
        /// The number of triangles.
        triangles: usize,
    },
    /// Triangles that stand in the same place as an earlier one, and face the same way, were dropped.
    Duplicate {
        /// The number of triangles.
        triangles: usize,
    },
    /// Triangles were turned over.
    Flipped {
        /// The number of triangles.
        triangles: usize,
    },
    /// Normals of the file point to the back of triangles.
    Opposed {
        /// The number of triangles.
        triangles: usize,
    },
    /// Edges have a triangle on one side only, so the back of the model can be seen through them.
    OpenEdges {
        /// The number of edges.
        edges: usize,
    },
    /// More than two triangles meet at edges.
    NonManifold {
        /// The number of edges.
        edges: usize,
    },
    /// Two neighbours face opposite ways.
    Inconsistent {
        /// The number of edges between them.
        edges: usize,
    },
    /// Normals were made.
    NormalsMade {
        /// The number of corners of triangles.
        corners: usize,
    },
    /// Corners meet in points at which too many triangles meet to compare them all, so they are smooth at any angle.
    CrowdedPoints {
        /// The number of points.
        points: usize,
    },
    /// The model was simplified.
    Simplified {
        /// Triangles before.
        from: usize,
        /// Triangles after.
        to: usize,
        /// The budget.
        budget: usize,
        /// The largest distance that the surface moved, in units of the file.
        error: f32,
    },
    /// Meshes have fewer levels of detail than were asked for, because simplifying them further leaves nearly as many
    /// triangles.
    LevelsEnded {
        /// The number of meshes.
        meshes: usize,
    },
    /// Meshes that joints or morph targets move have no levels of detail.
    LevelsOfMoved {
        /// The number of meshes.
        meshes: usize,
    },
    /// A mesh had too many vertices and was split.
    Split {
        /// Its name.
        mesh: String,
        /// The number of meshes that it became.
        parts: usize,
    },
    /// Vertices follow more than four joints. The four of the largest weights stay.
    WeightsDropped {
        /// The number of vertices.
        vertices: usize,
        /// The largest sum of weights that one vertex lost.
        most: f32,
    },
    /// Vertices have weights whose sum is 0, or no weights. They follow the first joint.
    WeightsMissing {
        /// The number of vertices.
        vertices: usize,
    },
    /// An extension of glTF is not known, and not required. It was ignored.
    ExtensionIgnored {
        /// Its name.
        name: String,
    },
    /// Parts of the file mean nothing here.
    Ignored {
        /// Their name.
        what: String,
        /// Their number.
        count: usize,
    },
    /// A texture is not used, because its image is missing or cannot be read.
    TextureMissing {
        /// The image, and why it is not used.
        reason: String,
    },
    /// A material is not used, because it is missing or cannot be read.
    MaterialMissing {
        /// The material or file, and why it is not used.
        reason: String,
    },
    /// Text is not UTF-8. Its strange letters were replaced.
    NotUtf8 {
        /// The number of lines.
        lines: usize,
    },
    /// Nodes mirror their meshes, which turns front and back around.
    Mirrored {
        /// The number of nodes.
        nodes: usize,
    },
    /// Rotations were not unit quaternions, and were made so.
    RotationsNormalized {
        /// The number of rotations.
        rotations: usize,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangulated { polygons } => write!(f, "{} divided into triangles", count(*polygons, "polygon")),
            Self::Crossed { polygons } => write!(
                f,
                "{} with crossing sides or without a plane divided as fans, so look at them",
                count(*polygons, "polygon")
            ),
            Self::Moved { vertices } => {
                write!(f, "{} moved to others within the weld distance", count(*vertices, "vertex"))
            }
            Self::Welded { vertices } => write!(f, "{} left out as equal or unused", count(*vertices, "vertex")),
            Self::Degenerate { triangles } => write!(f, "{} without area dropped", count(*triangles, "triangle")),
            Self::Duplicate { triangles } => write!(f, "{} dropped as duplicates", count(*triangles, "triangle")),
            Self::Flipped { triangles } => write!(f, "{} turned over", count(*triangles, "triangle")),
            Self::Opposed { triangles } => write!(
                f,
                "{} with normals that point to the back; --fix-winding (Winding::FromNormals) turns such triangles over",
                count(*triangles, "triangle")
            ),
            Self::OpenEdges { edges } => {
                write!(f, "{}; the inside can be seen through open edges", count(*edges, "open edge"))
            }
            Self::NonManifold { edges } => {
                write!(f, "{} {} more than two triangles", count(*edges, "edge"), verb(*edges, "joins", "join"))
            }
            Self::Inconsistent { edges } => {
                let joins = verb(*edges, "joins", "join");
                write!(f, "{} {joins} triangles that face opposite ways", count(*edges, "edge"))
            }
            Self::NormalsMade { corners } => write!(f, "normals made for {}", count(*corners, "corner")),
            Self::CrowdedPoints { points } => {
                let joins = verb(*points, "joins", "join");
                write!(f, "{} {joins} so many triangles that all look smooth", count(*points, "point"))
            }
            Self::Simplified { from, to, budget, error } => {
                let to = count(*to, "triangle");
                write!(f, "simplified from {from} to {to} (budget {budget}); moved by {error} at most")
            }
            Self::LevelsEnded { meshes } => write!(
                f,
                "{} with fewer levels of detail than --lods asks for: seams and borders leave no more to simplify",
                count(*meshes, "mesh")
            ),
            Self::LevelsOfMoved { meshes } => write!(
                f,
                "{} without levels of detail: those that joints or morph targets move cannot have any",
                count(*meshes, "mesh")
            ),
            Self::Split { mesh, parts } => write!(f, "mesh {mesh:?} has too many vertices; split into {parts}"),
            Self::WeightsDropped { vertices, most } => {
                let follows = verb(*vertices, "follows", "follow");
                let vertices = count(*vertices, "vertex");
                write!(f, "{vertices} {follows} more than 4 joints; weights of {most} at most dropped")
            }
            Self::WeightsMissing { vertices } => {
                let follow = verb(*vertices, "follows", "follow");
                write!(f, "{} without weights {follow} the first joint", count(*vertices, "vertex"))
            }
            Self::ExtensionIgnored { name } => write!(f, "extension {name} ignored"),
            Self::Ignored { what, count } => write!(f, "{count} × {what} ignored"),
            Self::TextureMissing { reason } => write!(f, "texture left out: {reason}"),
            Self::MaterialMissing { reason } => write!(f, "material left out: {reason}"),
            Self::NotUtf8 { lines } => {
                let is = verb(*lines, "is", "are");
                write!(f, "{} {is} not UTF-8; save the file as UTF-8 to keep names", count(*lines, "line"))
            }
            Self::Mirrored { nodes } => {
                write!(f, "{} {} meshes", count(*nodes, "node"), verb(*nodes, "mirrors", "mirror"))
            }
            Self::RotationsNormalized { rotations } => {
                write!(f, "{} brought to length 1", count(*rotations, "rotation"))
            }
        }
    }
}

impl Report {
    /// Adds a note, unless it counts nothing. A note of a kind that is there already adds to that one's count.
    pub(crate) fn add(&mut self, note: Note) {
        use Note::{
            Crossed, CrowdedPoints, Degenerate, Duplicate, Flipped, Inconsistent, LevelsEnded, LevelsOfMoved,
            MaterialMissing, Mirrored, Moved, NonManifold, NormalsMade, NotUtf8, OpenEdges, Opposed,
            RotationsNormalized, TextureMissing, Triangulated, WeightsMissing, Welded,
        };
        fn number_of(note: &mut Note) -> Option<&mut usize> {
            match note {
                Triangulated { polygons: n }
                | Crossed { polygons: n }
                | Moved { vertices: n }
                | Welded { vertices: n }
                | Degenerate { triangles: n }
                | Duplicate { triangles: n }
                | Flipped { triangles: n }
                | Opposed { triangles: n }
                | OpenEdges { edges: n }
                | NonManifold { edges: n }
                | Inconsistent { edges: n }
                | NormalsMade { corners: n }
                | CrowdedPoints { points: n }
                | LevelsEnded { meshes: n }
                | LevelsOfMoved { meshes: n }
                | WeightsMissing { vertices: n }
                | NotUtf8 { lines: n }
                | Mirrored { nodes: n }
                | RotationsNormalized { rotations: n } => Some(n),
                _ => None,
            }
        }
        let mut note = note;
        if let TextureMissing { reason } | MaterialMissing { reason } = &mut note
            && let Some((end, _)) = reason.char_indices().nth(REASON_LETTERS)
        {
            // A file may name one long name in many places.
            reason.truncate(end);
            reason.push('…');
        }
        if let Some(&mut more) = number_of(&mut note) {
            let same = |other: &&mut Note| std::mem::discriminant(*other) == std::mem::discriminant(&note);
            if more == 0 {
                return;
            }
            if let Some(n) = self.notes.iter_mut().find(same).and_then(number_of) {
                *n += more;
                return;
            }
        }
        self.notes.push(note);
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = |f: &mut fmt::Formatter<'_>, name: &str, counts: &Counts| {
            let Counts { vertices, triangles, meshes } = counts;
            let [vertices, triangles] = [count(*vertices, "vertex"), count(*triangles, "triangle")];
            writeln!(f, "{name}: {vertices}, {triangles}, {}", count(*meshes, "mesh"))
        };
        line(f, "read", &self.before)?;
        line(f, "imported", &self.after)?;
        if let Some(Bounds { min, max }) = self.bounds {
            writeln!(f, "box: {min:?} to {max:?}")?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "- {note}"))
    }
}
