//! The picture a reference renderer draws, with what it takes to compare it fairly.
//!
//! Beside depth, colour and the id of the winner, each pixel keeps how clear its case is: `margin`, the distance in px
//! to the nearest edge or plane that decided it, and `gap`, the distance in depth to the runner-up. A renderer that
//! rounds positions or depths may decide otherwise where one of them is small, and only there.

/// Which faces are dropped; front is counter-clockwise as seen on screen with y up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cull {
    None,
    Back,
    Front,
}

impl Cull {
    /// True if a face of that side is dropped.
    pub fn drops(self, front: bool) -> bool {
        match self {
            Cull::None => false,
            Cull::Back => !front,
            Cull::Front => front,
        }
    }
}

/// A rendered picture, row-major from the top left pixel.
#[derive(Clone, Debug)]
pub struct Frame {
    pub width: u32,
    pub height: u32,
    /// Linear depth, 0 near to 1 far; 1 where nothing was drawn.
    pub depth: Vec<f64>,
    pub color: Vec<[f64; 3]>,
    /// The winner; 0 where nothing was drawn.
    pub id: Vec<u32>,
    /// Distance in px to the nearest edge or plane decision. Infinite if there was none within about 2 px.
    pub margin: Vec<f64>,
    /// Depth between the winner and the next fragment behind it or the clear value; infinite if nothing was drawn.
    pub gap: Vec<f64>,
}

impl Frame {
    /// An empty picture: `background` everywhere, depth 1, id 0.
    pub fn new(width: u32, height: u32, background: [f64; 3]) -> Self {
        let count = width as usize * height as usize;
        Self {
            width,
            height,
            depth: vec![1.0; count],
            color: vec![background; count],
            id: vec![0; count],
            margin: vec![f64::INFINITY; count],
            gap: vec![f64::INFINITY; count],
        }
    }

    /// Place of pixel `(x, y)` in the buffers.
    pub fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }

    /// Depth-tests a fragment (`Less`) and writes it if it passes; says whether it did.
    pub fn offer(&mut self, index: usize, depth: f64, color: [f64; 3], id: u32) -> bool {
        let behind = depth - self.depth[index];
        if behind < 0.0 {
            // The old winner, or the clear value, is now the runner-up.
            self.gap[index] = -behind;
            self.depth[index] = depth;
            self.color[index] = color;
            self.id[index] = id;
            true
        } else {
            self.gap[index] = self.gap[index].min(behind);
            false
        }
    }

    /// Notes that a decision about pixel `index` was taken `distance` px from turning out otherwise.
    pub fn note_margin(&mut self, index: usize, distance: f64) {
        self.margin[index] = self.margin[index].min(distance);
    }

    /// Depths as 16-bit codes: `depth * 65535`, rounded half up.
    pub fn depth_codes(&self) -> Vec<u16> {
        let code = |&depth: &f64| (depth * 65535.0 + 0.5).floor().clamp(0.0, 65535.0) as u16;
        self.depth.iter().map(code).collect()
    }

    /// True if no decision about the pixel came closer than `margin` px, nor any other fragment closer than `gap`.
    pub fn is_clear_cut(&self, index: usize, margin: f64, gap: f64) -> bool {
        self.margin[index] >= margin && self.gap[index] >= gap
    }

    /// Compares the pixels that are clear-cut in both pictures.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn compare(&self, other: &Frame, margin: f64, gap: f64) -> Comparison {
        assert_eq!((self.width, self.height), (other.width, other.height));
        let mut result = Comparison::default();
        for i in 0..self.id.len() {
            if !(self.is_clear_cut(i, margin, gap) && other.is_clear_cut(i, margin, gap)) {
                result.excluded += 1;
                continue;
            }
            result.compared += 1;
            if self.id[i] != other.id[i] {
                result.other_id += 1;
                if result.first_other_id.is_none() {
                    let (x, y) = (i % self.width as usize, i / self.width as usize);
                    result.first_other_id = Some((x as u32, y as u32));
                }
                continue;
            }
            let depth = (self.depth[i] - other.depth[i]).abs();
            result.depth_error = result.depth_error.max(depth);
            for (a, b) in self.color[i].iter().zip(other.color[i]) {
                result.color_error = result.color_error.max((a - b).abs());
            }
        }
        result
    }

    /// The picture as a binary PPM file, for looking at; colours 0 to 1.
    pub fn to_ppm(&self) -> Vec<u8> {
        let mut file = format!("P6 {} {} 255\n", self.width, self.height).into_bytes();
        let channels = self.color.iter().flatten();
        file.extend(channels.map(|c| (c * 255.0 + 0.5).clamp(0.0, 255.0) as u8));
        file
    }
}

/// How two pictures differ where both are clear-cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Pixels compared.
    pub compared: usize,
    /// Pixels left out because one of the pictures was not clear-cut there.
    pub excluded: usize,
    /// Pixels with another winner, and the first of them.
    pub other_id: usize,
    pub first_other_id: Option<(u32, u32)>,
    /// Largest depth difference among pixels of the same winner.
    pub depth_error: f64,
    /// Largest channel difference among pixels of the same winner.
    pub color_error: f64,
}
