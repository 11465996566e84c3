//! A model, a panel and a format of pixels come in; frames go out, drawn as firmware draws them: in strips, with a
//! depth buffer, records and a pose in memory that is lent.

use super::hash::Hash;
use super::turntable::{self, BACKGROUND, Panel, Step, Turntable};
use super::{Picture, PreviewError};
use std::path::Path;
use zstrip::bytemuck::{Pod, Zeroable, cast_slice, cast_slice_mut};
use zstrip::color::{Dithered, PixelFormat, Rgb565Be};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888};
use zstrip::frame::Renderer;
use zstrip::light::Sunlit;
use zstrip::mesh::Mesh;
use zstrip::model::container::{Header, Part, Section, SectionKind};
use zstrip::model::{Model, Placed, Pose};
use zstrip::scene::Scene;
use zstrip::target::{Stats, Strip, WithDepth, WithRecords, records_len};
use zstrip::vertex::Viewport;

/// The bytes of a container, which begin at a multiple of 4.
#[derive(Clone, Debug)]
pub struct Container {
    words: Vec<u32>,
    length: usize,
}

impl Container {
    /// Copies bytes. Whether they are a container shows when a [`Stage`] is made of them.
    #[must_use]
    pub fn new(bytes: &[u8]) -> Self {
        let mut words = vec![0; bytes.len().div_ceil(4)];
        cast_slice_mut(&mut words)[..bytes.len()].copy_from_slice(bytes);
        Self { words, length: bytes.len() }
    }

    /// Reads a file.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn read(path: &Path) -> Result<Self, PreviewError> {
        let bytes = std::fs::read(path).map_err(|error| PreviewError::Io(path.to_owned(), error))?;
        Ok(Self::new(&bytes))
    }

    /// Returns the bytes.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &cast_slice(&self.words)[..self.length]
    }
}

/// A format of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 16 bits in the processor's byte order.
    Rgb565,
    /// 16 bits, the higher byte first, as most panels take them.
    Rgb565Be,
    /// 24 bits.
    Rgb888,
    /// Grey of 8 bits.
    Gray8,
    /// 16 bits, dithered.
    Dithered,
}

impl Format {
    /// All formats whose costs are known, with their names on the command line and in the table of costs.
    pub const ALL: [(Self, &'static str, &'static str); 5] = [
        (Self::Rgb565, "rgb565", "Rgb565"),
        (Self::Rgb565Be, "rgb565be", "Rgb565Be"),
        (Self::Rgb888, "rgb888", "Rgb888"),
        (Self::Gray8, "gray8", "Gray8"),
        (Self::Dithered, "dithered", "Dithered<Rgb565>"),
    ];

    /// Returns the bytes of a pixel.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Rgb565 | Self::Rgb565Be | Self::Dithered => 2,
            Self::Rgb888 => 3,
            Self::Gray8 => 1,
        }
    }
}

/// A level of detail, of all parts that have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelUse {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// The largest error of a part, in units of its mesh.
    pub error: f64,
    /// Draws in the frames of a turn.
    pub draws: usize,
}

/// The most words of records that a frame is drawn with: 64 MB.
const MOST_RECORDS: usize = 1 << 24;

/// A checked model, ready to be drawn on a panel.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'m> {
    pub(super) bytes: &'m [u8],
    pub(super) model: Model<'m>,
    pub(super) panel: Panel,
    pub(super) format: Format,
    pub(super) table: Turntable,
    /// Words of records that the model takes at most, unless triangles are clipped.
    pub(super) most_records: usize,
}

/// Takes the colours of a strip, and the number of its first row.
type PutStrip<'p, P> = dyn FnMut(u32, &[<P as PixelFormat>::Raw]) + 'p;

/// The closure of a frame.
pub(super) type DrawScene<'d, P> = dyn FnMut(&mut Scene<'_, Strip<'_, P, WithDepth, WithRecords>>) + 'd;

impl<'m> Stage<'m> {
    /// Checks a model and a panel.
    ///
    /// # Errors
    ///
    /// If the bytes are not a container, a number of the panel is out of its range, or the model is beyond the range
    /// of the library's numbers.
    pub fn new(container: &'m Container, panel: Panel, format: Format) -> Result<Self, PreviewError> {
        Self::check(&panel)?;
        let bytes = container.bytes();
        let model = Model::from_bytes(bytes)?;
        Self::of(bytes, model, panel, format)
    }

    /// Returns the model on another panel, or in another format. It is not checked again.
    ///
    /// # Errors
    ///
    /// If a number of the panel is out of its range.
    pub fn on(&self, panel: Panel, format: Format) -> Result<Self, PreviewError> {
        if panel == self.panel {
            return Ok(Self { format, ..*self });
        }
        Self::check(&panel)?;
        Self::of(self.bytes, self.model, panel, format)
    }

    fn check(panel: &Panel) -> Result<(), PreviewError> {
        let most = u32::from(Viewport::MAX_SIZE);
        for (what, number, most) in [
            ("a screen's width", panel.width, most),
            ("a screen's height", panel.height, most),
            ("a strip's height", panel.rows, panel.height),
            ("a zoom", panel.zoom, 10_000),
        ] {
            if !(1..=most).contains(&number) {
                return Err(PreviewError::Panel(what, number, 1..=most));
            }
        }
        Ok(())
    }

    fn of(bytes: &'m [u8], model: Model<'m>, panel: Panel, format: Format) -> Result<Self, PreviewError> {
        let table = Turntable::new(&model, &panel)?;
        let mut stage = Self { bytes, model, panel, format, table, most_records: 0 };
        let strips = panel.height.div_ceil(panel.rows) as usize;
        stage.most_records = stage.nodes_parts().fold(strips, |words, part| {
            let mesh = stage.model.mesh(part);
            let (vertices, triangles) = mesh.map_or((0, 0), |mesh| (mesh.vertex_count(), mesh.triangle_count()));
            words.saturating_add(records_len(0, 1, vertices, 4, triangles)).min(MOST_RECORDS)
        });
        Ok(stage)
    }

    /// Returns the panel.
    #[must_use]
    pub const fn panel(&self) -> Panel {
        self.panel
    }

    /// Returns the hash of a frame in RGB565, as the firmware that counts prints it, and the statistics of the frame.
    /// `None` is a frame without a model.
    ///
    /// # Errors
    ///
    /// Those of [`picture`](Self::picture).
    pub fn hash(&self, step: Option<&Step>) -> Result<(u32, Stats), PreviewError> {
        let mut hash = Hash::NEW;
        let rows = self.panel.rows;
        let stats = match step {
            Some(step) => self.posed(step, |placed, _| {
                self.frame::<Rgb565>(rows, &mut |_, pixels| hash.add(pixels), &mut |scene| placed.draw(scene))
            })??,
            None => self.frame::<Rgb565>(rows, &mut |_, pixels| hash.add(pixels), &mut |_| {})?,
        };
        Ok((hash.0, stats))
    }

    /// Returns the model.
    #[must_use]
    pub const fn model(&self) -> Model<'m> {
        self.model
    }

    /// Returns the levels of detail of all parts, the finest first, and how many draws of a turn each has.
    ///
    /// # Errors
    ///
    /// Those of [`picture`](Self::picture).
    pub fn levels(&self) -> Result<Vec<LevelUse>, PreviewError> {
        let parts = self.items::<Part>(SectionKind::Parts);
        let mut levels: Vec<LevelUse> = Vec::new();
        let mut level_of = vec![None; parts.len()];
        for first in self.nodes_parts() {
            let (mut number, mut level) = (first, 0);
            // A level has a higher number than the one before it, so this ends.
            while let Some(part) = parts.get(number).filter(|_| level_of[number].is_none()) {
                if levels.len() == level {
                    levels.push(LevelUse::default());
                }
                level_of[number] = Some(level);
                let sum = &mut levels[level];
                sum.vertices += part.vertices as usize;
                sum.triangles += part.triangles as usize;
                sum.error = sum.error.max(f64::from(part.error) / 65_536.0);
                (number, level) = (part.coarser.into(), level + 1);
            }
        }
        for step in 0..self.steps() {
            let drawn =
                self.posed(&self.step(step), |placed, _| placed.draws().map(|(_, part)| part).collect::<Vec<_>>())?;
            for level in drawn.into_iter().filter_map(|part| *level_of.get(part)?) {
                levels[level].draws += 1;
            }
        }
        Ok(levels)
    }

    /// Returns the number of clusters of all draws, each of the level of detail that has most of them: as many nodes as
    /// `Placed::cull_clusters` may use.
    #[must_use]
    pub fn clusters(&self) -> usize {
        let parts = self.items::<Part>(SectionKind::Parts);
        self.nodes_parts().filter_map(|part| parts.get(part)).map(|part| usize::from(part.clusters)).sum()
    }

    /// Returns the number of frames in which the model turns round and plays its clips.
    #[must_use]
    pub fn steps(&self) -> u32 {
        turntable::steps(&self.model)
    }

    /// Returns one of these frames.
    #[must_use]
    pub fn step(&self, number: u32) -> Step {
        turntable::step(&self.model, number)
    }

    /// Draws a frame.
    ///
    /// # Errors
    ///
    /// If the library does not draw it, which is a fault.
    pub fn picture(&self, step: &Step) -> Result<(Picture, Stats), PreviewError> {
        match self.format {
            Format::Rgb565 => self.picture_in::<Rgb565>(step),
            Format::Rgb565Be => self.picture_in::<Rgb565Be>(step),
            Format::Rgb888 => self.picture_in::<Rgb888>(step),
            Format::Gray8 => self.picture_in::<Gray8>(step),
            Format::Dithered => self.picture_in::<Dithered<Rgb565>>(step),
        }
    }

    fn picture_in<P: PixelFormat>(&self, step: &Step) -> Result<(Picture, Stats), PreviewError> {
        let mut picture = Picture::new(self.panel.width, self.panel.height);
        let stats = self.posed(step, |placed, _| {
            let put = &mut |row, pixels: &[P::Raw]| picture.put(row, &mut pixels.iter().map(|raw| P::unpack(*raw)));
            self.frame::<P>(self.panel.rows, put, &mut |scene| placed.draw(scene))
        })??;
        Ok((picture, stats))
    }

    /// Places the model in a frame, and hands it on with the meshes of its pose.
    pub(super) fn posed<T>(
        &self,
        step: &Step,
        then: impl for<'p> FnOnce(&Placed<'p, Sunlit>, &dyn Fn(usize) -> Option<Mesh<'p>>) -> T,
    ) -> Result<T, PreviewError> {
        let mut places = vec![None; Model::draws(self.bytes)];
        let world = self.table.world(step.turn);
        let (camera, sun) = (&self.table.camera, &self.table.sun);
        match step.motion {
            Some(motion) => {
                let mut words = vec![0; Pose::words(self.bytes)];
                let mut pose = self.model.pose(&mut words)?;
                pose.play(motion);
                let placed = pose.place(&world, camera, sun, &mut places)?;
                Ok(then(&placed, &|part| pose.mesh(part)))
            }
            None => {
                let placed = self.model.place(&world, camera, sun, &mut places)?;
                Ok(then(&placed, &|part| self.model.mesh(part)))
            }
        }
    }

    /// Draws a frame in strips of `rows` rows, and hands on their colours with the number of their first row.
    pub(super) fn frame<P: PixelFormat>(
        &self,
        rows: u32,
        put: &mut PutStrip<'_, P>,
        draw: &mut DrawScene<'_, P>,
    ) -> Result<Stats, PreviewError> {
        let fault = |error: &dyn std::fmt::Display| PreviewError::Frame(error.to_string());
        let pixels = self.panel.width as usize * rows as usize;
        let (mut color, mut depth) = (vec![P::Raw::zeroed(); pixels], vec![0; pixels]);
        let mut records = vec![0; self.most_records];
        let renderer = Renderer::<P>::new(self.panel.screen()).map_err(|error| fault(&error))?;
        let renderer = renderer.with_depth(&mut depth).map_err(|error| fault(&error))?;
        let mut renderer = renderer.with_records(&mut records);
        let mut frame = renderer.begin(BACKGROUND);
        while let Some(strip) = frame.next_strip(&mut color, &mut *draw).map_err(|error| fault(&error))? {
            let first = strip.area().top_left.y as u32;
            put(first, strip.pixels());
        }
        Ok(frame.stats())
    }

    /// Returns the items of a section, which the library has checked.
    pub(super) fn items<T: Pod>(&self, kind: SectionKind) -> &'m [T] {
        let Section { offset, count } = self.header().table[kind as usize];
        let items = self.bytes.get(offset as usize..).and_then(|rest| rest.get(..count as usize * size_of::<T>()));
        items.and_then(|bytes| zstrip::bytemuck::try_cast_slice(bytes).ok()).unwrap_or_default()
    }

    pub(super) fn header(&self) -> Header {
        let head = self.bytes.get(..size_of::<Header>());
        head.map_or_else(Header::zeroed, zstrip::bytemuck::pod_read_unaligned)
    }

    /// Returns the parts that nodes draw, one for each draw.
    pub(super) fn nodes_parts(&self) -> impl Iterator<Item = usize> {
        let nodes = self.items::<zstrip::model::container::Node>(SectionKind::Nodes);
        nodes.iter().flat_map(|node| (0..node.parts).map(|k| usize::from(node.first_part) + usize::from(k)))
    }
}
