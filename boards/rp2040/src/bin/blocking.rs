//! Draws a strip, sends it, draws the next one. There is one buffer, and the processor does both.
#![no_std]
#![no_main]
#![forbid(unsafe_code)]

use panic_halt as _;
use static_cell::ConstStaticCell;
use zstrip::Renderer;
use zstrip::color::Rgb565Be;
use zstrip_rp2040::board::Board;
use zstrip_rp2040::scene::{BACKGROUND, SIZE, View};
use zstrip_rp2040::{Colors, Depths, ROWS, Records, WIDTH};

static COLORS: ConstStaticCell<Colors> = ConstStaticCell::new([0; WIDTH * ROWS]);
static DEPTHS: ConstStaticCell<Depths> = ConstStaticCell::new([0; WIDTH * ROWS]);
static RECORDS: ConstStaticCell<Records> = ConstStaticCell::new([0; _]);

#[rp2040_hal::entry]
fn main() -> ! {
    let Board { mut panel, .. } = Board::start();
    let buffer = COLORS.take();
    let renderer = Renderer::<Rgb565Be>::new(SIZE).expect("a screen");
    let mut renderer = renderer.with_depth(DEPTHS.take()).expect("a strip").with_records(RECORDS.take());
    for number in (0..=u16::MAX).cycle() {
        let view = View::new(number);
        let mut frame = renderer.begin(BACKGROUND);
        while let Some(strip) = frame.next_strip(buffer, |scene| view.draw(scene)).expect("the same scene") {
            panel.send(&strip.area(), strip.bytes());
        }
    }
    unreachable!("an endless loop")
}
