//! Draws a strip while the one before is sent by DMA. There are two buffers, and a frame takes only as long as the
//! longer of drawing alone and sending alone.
#![no_std]
#![no_main]
#![forbid(unsafe_code)]

use panic_halt as _;
use static_cell::ConstStaticCell;
use zstrip::Renderer;
use zstrip::color::Rgb565Be;
use zstrip_rp2040::board::Board;
use zstrip_rp2040::panel::DmaPanel;
use zstrip_rp2040::scene::{BACKGROUND, SIZE, View};
use zstrip_rp2040::{Colors, Depths, ROWS, Records, WIDTH};

static COLORS: ConstStaticCell<[Colors; 2]> = ConstStaticCell::new([[0; WIDTH * ROWS]; 2]);
static DEPTHS: ConstStaticCell<Depths> = ConstStaticCell::new([0; WIDTH * ROWS]);
static RECORDS: ConstStaticCell<Records> = ConstStaticCell::new([0; _]);

#[rp2040_hal::entry]
fn main() -> ! {
    let Board { panel, dma, .. } = Board::start();
    let [free, other] = COLORS.take();
    let mut free: &'static mut [u16] = free;
    let mut panel = DmaPanel::new(panel, dma, other);
    let renderer = Renderer::<Rgb565Be>::new(SIZE).expect("a screen");
    let mut renderer = renderer.with_depth(DEPTHS.take()).expect("a strip").with_records(RECORDS.take());
    for number in (0..=u16::MAX).cycle() {
        let view = View::new(number);
        let mut frame = renderer.begin(BACKGROUND);
        // The strip only borrows the buffer, so that it can move into the transfer afterwards.
        while let Some(strip) = frame.next_strip(&mut *free, |scene| view.draw(scene)).expect("the same scene") {
            let area = strip.area();
            free = panel.send(&area, free);
        }
    }
    unreachable!("an endless loop")
}
