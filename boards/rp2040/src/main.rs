//! A turning torus on a Raspberry Pi Pico with an ST7789 panel of 240x240, strip by strip.
//!
//! ```text
//! Pico  GP16 -> D/C   GP17 -> CS   GP18 -> SCK   GP19 -> SDA (MOSI)   GP20 -> RESET
//!       GP2: high while a strip is sent     GP3: high while a frame is drawn and sent
//! ```
//! GP2 and GP3 are for a logic analyser; under emulation `emulate.mjs` reads them, and splits
//! a frame's cycles into rendering and sending.
#![no_std]
#![no_main]

#[path = "../../../examples/scenes/mod.rs"]
mod scenes;

use embedded_hal::{digital::OutputPin, spi::MODE_0};
use embedded_hal_bus::spi::ExclusiveDevice;
use mipidsi::{
    Builder,
    dcs::{InterfaceExt, SetColumnAddress, SetPageAddress, WriteMemoryStart},
    interface::{Interface, SpiInterface},
    models::ST7789,
    options::ColorInversion,
};
use panic_halt as _;
use rp2040_hal::{
    Clock, Sio, Spi, Timer, Watchdog,
    clocks::init_clocks_and_plls,
    fugit::RateExtU32,
    gpio::{FunctionSpi, Pins},
    pac,
};
use zstrip::color::Rgb565Be;
use zstrip::frame::{Buffers, Renderer};
use zstrip::math::Angle16;
use zstrip::target::StripPixels;

#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_GENERIC_03H;

const CRYSTAL_HZ: u32 = 12_000_000;

const SIZE: usize = 240;
const ROWS: usize = 16;
/// How far the torus turns from frame to frame, in binary angle; `ci/rp2040` knows it too.
const TURN: u16 = 1024;

/// Bytes of a row, the block that the driver passes on in one go.
const ROW_BYTES: usize = 2 * SIZE;

struct Memory {
    color: [u16; SIZE * ROWS],
    depth: [u16; SIZE * ROWS],
    records: [u32; 4 * 1024],
    wire: [u8; ROW_BYTES],
}

static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _], wire: [0; _] };

#[rp2040_hal::entry]
fn main() -> ! {
    let mut pac = pac::Peripherals::take().unwrap();
    let mut watchdog = Watchdog::new(pac.WATCHDOG);
    let clocks = init_clocks_and_plls(
        CRYSTAL_HZ,
        pac.XOSC,
        pac.CLOCKS,
        pac.PLL_SYS,
        pac.PLL_USB,
        &mut pac.RESETS,
        &mut watchdog,
    )
    .ok()
    .unwrap();
    let mut timer = Timer::new(pac.TIMER, &mut pac.RESETS, &clocks);
    let sio = Sio::new(pac.SIO);
    let pins = Pins::new(pac.IO_BANK0, pac.PADS_BANK0, sio.gpio_bank0, &mut pac.RESETS);

    let mut sending = pins.gpio2.into_push_pull_output();
    let mut in_frame = pins.gpio3.into_push_pull_output();
    let dc = pins.gpio16.into_push_pull_output();
    let cs = pins.gpio17.into_push_pull_output();
    let reset = pins.gpio20.into_push_pull_output();
    let sck = pins.gpio18.into_function::<FunctionSpi>();
    let mosi = pins.gpio19.into_function::<FunctionSpi>();

    let bus = Spi::<_, _, _, 8>::new(pac.SPI0, (mosi, sck)).init(
        &mut pac.RESETS,
        clocks.peripheral_clock.freq(),
        62_500_000.Hz(),
        MODE_0,
    );
    let device = ExclusiveDevice::new(bus, cs, timer).unwrap();

    let memory = &raw mut MEMORY;
    // SAFETY: `main` runs once; this is the only reference.
    let Memory { color, depth, records, wire } = unsafe { &mut *memory };
    let mut display = Builder::new(ST7789, SpiInterface::new(device, dc, wire))
        .display_size(SIZE as u16, SIZE as u16)
        .invert_colors(ColorInversion::Inverted)
        .reset_pin(reset)
        .init(&mut timer)
        .unwrap();

    let screen = (SIZE as u16, SIZE as u16);
    let buffers = Buffers { color, depth, records };
    let mut renderer = Renderer::<Rgb565Be>::new(screen, buffers).unwrap();
    let mut turn = 0;
    loop {
        in_frame.set_high().unwrap();
        let send = |strip: &StripPixels<'_, Rgb565Be>| {
            sending.set_high().unwrap();
            let y0 = strip.area().top_left.y as u16;
            let y1 = y0 + strip.area().size.height as u16 - 1;
            // SAFETY: the window and its pixels are the driver's own commands; no setting changes.
            let panel = unsafe { display.dcs() };
            panel.write_command(SetColumnAddress::new(0, SIZE as u16 - 1))?;
            panel.write_command(SetPageAddress::new(y0, y1))?;
            panel.write_command(WriteMemoryStart)?;
            // The bytes are what the panel expects: they go out in whole rows, not pixel by pixel.
            let rows = strip.bytes().as_chunks::<ROW_BYTES>().0;
            let sent = panel.send_pixels(rows.iter().copied());
            sending.set_low().unwrap();
            sent
        };
        let frame = renderer.frame_to(send, scenes::BACKGROUND, |scene| scenes::torus_gouraud(scene, Angle16(turn)));
        if frame.is_err() {
            panic!("the panel does not answer");
        }
        in_frame.set_low().unwrap();
        turn = turn.wrapping_add(TURN);
    }
}
