//! The panel with all buffers, for programs that show one frame after the other.

use crate::board::Board;
use crate::panel::DmaPanel;
use crate::{Colors, Depths, ROWS, WIDTH, scene};
use core::mem::take;
use static_cell::ConstStaticCell;
use zstrip::color::Rgb565Be;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::target::{Strip, WithDepth, WithRecords};
use zstrip::{Renderer, Scene};

static COLORS: ConstStaticCell<[Colors; 2]> = ConstStaticCell::new([[0; WIDTH * ROWS]; 2]);
static DEPTHS: ConstStaticCell<Depths> = ConstStaticCell::new([0; WIDTH * ROWS]);
/// Enough for the models of `shows`, so that they are transformed once per frame.
static RECORDS: ConstStaticCell<[u32; 32 * 1024]> = ConstStaticCell::new([0; _]);

/// Draws a strip while the one before is sent by DMA, as `src/bin/dma.rs` does.
pub struct Player {
    renderer: Renderer<'static, Rgb565Be, WithDepth, WithRecords>,
    panel: DmaPanel,
    free: &'static mut [u16],
}

impl Player {
    /// Starts the board. Panics if that has been done before.
    pub fn start() -> Self {
        let Board { panel, dma, .. } = Board::start();
        let [free, other] = COLORS.take();
        let renderer = Renderer::new(scene::SIZE).expect("a screen").with_depth(DEPTHS.take()).expect("a strip");
        Self { renderer: renderer.with_records(RECORDS.take()), panel: DmaPanel::new(panel, dma, other), free }
    }

    /// Draws a frame and sends it. `draw` is called at least once per strip.
    pub fn show(
        &mut self,
        background: impl Into<Rgb888>,
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565Be, WithDepth, WithRecords>>),
    ) {
        let mut frame = self.renderer.begin(background.into());
        while let Some(strip) = frame.next_strip(&mut *self.free, &mut draw).expect("the same scene") {
            let area = strip.area();
            self.free = self.panel.send(&area, take(&mut self.free));
        }
    }
}
