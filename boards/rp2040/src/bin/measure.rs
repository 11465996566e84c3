//! Draws without sending, and sends without drawing, with GP2 high meanwhile. Four frames are drawn, one is sent by
//! the processor, one by DMA. A logic analyser, or `emulate.mjs`, tells how long each takes.
#![no_std]
#![no_main]
#![forbid(unsafe_code)]

use core::convert::Infallible;
use core::hint::black_box;
use embedded_hal::digital::OutputPin;
use panic_halt as _;
use static_cell::ConstStaticCell;
use zstrip::Renderer;
use zstrip::color::Rgb565Be;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip_rp2040::board::Board;
use zstrip_rp2040::panel::DmaPanel;
use zstrip_rp2040::scene::{BACKGROUND, SIZE, View};
use zstrip_rp2040::{Colors, Depths, ROWS, Records, WIDTH};

static COLORS: ConstStaticCell<[Colors; 2]> = ConstStaticCell::new([[0; WIDTH * ROWS]; 2]);
static DEPTHS: ConstStaticCell<Depths> = ConstStaticCell::new([0; WIDTH * ROWS]);
static RECORDS: ConstStaticCell<Records> = ConstStaticCell::new([0; _]);

/// The parts of the screen that strips cover.
fn areas() -> impl Iterator<Item = Rectangle> {
    let strip = Size::new(SIZE.width, ROWS as u32);
    (0..SIZE.height as i32).step_by(ROWS).map(move |y| Rectangle::new(Point::new(0, y), strip))
}

/// Keeps the pin high while `work` runs.
fn marked<T>(pin: &mut impl OutputPin<Error = Infallible>, work: impl FnOnce() -> T) -> T {
    let Ok(()) = pin.set_high();
    let result = work();
    let Ok(()) = pin.set_low();
    result
}

#[rp2040_hal::entry]
fn main() -> ! {
    let Board { mut panel, dma, mut mark } = Board::start();
    let [buffer, other] = COLORS.take();
    let renderer = Renderer::<Rgb565Be>::new(SIZE).expect("a screen");
    let mut renderer = renderer.with_depth(DEPTHS.take()).expect("a strip").with_records(RECORDS.take());
    for number in 0..4 {
        marked(&mut mark, || {
            let view = View::new(number);
            let mut frame = renderer.begin(BACKGROUND);
            while let Some(strip) = frame.next_strip(buffer, |scene| view.draw(scene)).expect("the same scene") {
                black_box(strip.bytes());
            }
        });
    }

    let bytes: &[u8] = zstrip::bytemuck::cast_slice(buffer);
    marked(&mut mark, || areas().for_each(|area| panel.send(&area, bytes)));

    let mut free: &'static mut [u16] = buffer;
    let mut panel = DmaPanel::new(panel, dma, other);
    marked(&mut mark, || {
        for area in areas() {
            free = panel.send(&area, core::mem::take(&mut free));
        }
        panel.finish()
    });
    loop {
        core::hint::spin_loop();
    }
}
