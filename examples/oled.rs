//! A turning torus on a 128x64 panel with 16 greys, sent strip by strip.
//!
//! As firmware it drives the SSD0323 of the Stellaris LM3S6965 board over SSI, as QEMU's
//! `lm3s6965evb` emulates it. On the host it writes the last frame as it must look on that panel,
//! or, given a screendump of the emulated one, compares the two: `ci/panel` does both.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[allow(dead_code)]
mod firmware;
mod scenes;

use core::convert::Infallible;
use scenes::{Draw, Torus};
use zstrip::color::Dither;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray4, Gray8};
use zstrip::frame::Renderer;
use zstrip::math::Angle16;
use zstrip::target::{Packer, Rows, StripPixels};

const WIDTH: usize = 128;
const HEIGHT: usize = 64;
/// Two pixels to the byte, the left one in the high nibble.
const ROW_BYTES: usize = WIDTH / 2;
const FRAMES: u16 = 8;
/// Rows drawn and sent at once; the host draws the whole picture as one strip.
const ROWS: usize = if cfg!(target_os = "none") { 8 } else { HEIGHT };
const RECORDS: usize = 8 * 1024;

/// Draws frame number `frame` and hands over each strip in the panel's format: two pixels a byte, dithered.
fn draw(frame: u16, buffers: &mut Memory, mut send: impl FnMut(usize, &[u8])) {
    const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);
    let turn = Angle16(frame * (u16::MAX / FRAMES));
    let Memory { color, depth, records, packed } = buffers;
    let renderer = Renderer::<Gray8>::new(SCREEN).expect("rows fit").with_depth(depth).expect("rows fit");
    let mut renderer = renderer.with_records(records);
    let mut packer = Packer::<Rows<Gray4>>::new(SCREEN, ROWS as u32, Dither::BAYER_4, packed).expect("strips fit");
    let sink = |strip: &StripPixels<'_, Gray8>| {
        send(strip.area().top_left.y as usize, packer.pack(strip));
        Ok::<(), Infallible>(())
    };
    let torus = Torus::gouraud(SCREEN, turn);
    renderer
        .frame_to(sink, color, Gray8::new(26), |scene| torus.draw(scene))
        .expect("each call of the closure draws one scene");
}

struct Memory {
    color: [u8; WIDTH * ROWS],
    depth: [u16; WIDTH * ROWS],
    records: [u32; RECORDS],
    packed: [u8; ROW_BYTES * ROWS],
}

impl Memory {
    const NEW: Self = Self { color: [0; _], depth: [0; _], records: [0; _], packed: [0; _] };
}

#[cfg(target_os = "none")]
fn run() {
    use semihosting::println;

    static mut BUFFERS: Memory = Memory::NEW;
    let buffers = &raw mut BUFFERS;
    // SAFETY: `run` is called once; this is the only reference.
    let buffers = unsafe { &mut *buffers };

    let mut panel = panel::Ssd0323::new();
    for frame in 0..FRAMES {
        draw(frame, buffers, |y0, packed| panel.send(y0, packed));
        println!("frame {frame} done");
    }
    println!("all frames done");
    // The picture stays up until whoever looks at it ends the emulation.
    loop {
        cortex_m::asm::wfi();
    }
}

/// The panel and the way to it: SSI0 and, on port C, the pin that tells commands from data.
#[cfg(target_os = "none")]
mod panel {
    use super::{HEIGHT, ROW_BYTES};

    // LM3S6965 data sheet: system control, GPIO port C, SSI0 (an Arm PL022).
    const RCGC1: *mut u32 = 0x400F_E104 as _;
    const RCGC2: *mut u32 = 0x400F_E108 as _;
    const GPIOC_DIR: *mut u32 = 0x4000_6400 as _;
    const GPIOC_DEN: *mut u32 = 0x4000_651C as _;
    /// The address of the data register selects the bits a write changes: bit 7 alone.
    const GPIOC_PIN7: *mut u32 = (0x4000_6000 + (1 << 7 << 2)) as _;
    const SSI_CR0: *mut u32 = 0x4000_8000 as _;
    const SSI_CR1: *mut u32 = 0x4000_8004 as _;
    const SSI_DR: *mut u32 = 0x4000_8008 as _;
    const SSI_SR: *mut u32 = 0x4000_800C as _;
    const SSI_CPSR: *mut u32 = 0x4000_8010 as _;
    const SSI_SR_RECEIVED: u32 = 1 << 2;

    fn write(register: *mut u32, value: u32) {
        // SAFETY: one of the registers above.
        unsafe { register.write_volatile(value) }
    }

    fn read(register: *mut u32) -> u32 {
        // SAFETY: one of the registers above.
        unsafe { register.read_volatile() }
    }

    pub struct Ssd0323(());

    impl Ssd0323 {
        pub fn new() -> Self {
            write(RCGC1, 1 << 4);
            write(RCGC2, 1 << 2);
            write(GPIOC_DIR, 1 << 7);
            write(GPIOC_DEN, 1 << 7);
            write(SSI_CR1, 0);
            write(SSI_CPSR, 2);
            write(SSI_CR0, 7); // frames of 8 bits, mode 0
            write(SSI_CR1, 1 << 1); // on, as master
            let mut panel = Self(());
            // No re-mapping, every row lit, on.
            panel.bytes(false, &[0xA0, 0x00, 0xA8, HEIGHT as u8 - 1, 0xAF]);
            panel
        }

        /// Sends rows from `y0` down.
        pub fn send(&mut self, y0: usize, packed: &[u8]) {
            let y1 = y0 + packed.len() / ROW_BYTES;
            self.bytes(false, &[0x15, 0, ROW_BYTES as u8 - 1, 0x75, y0 as u8, y1 as u8 - 1]);
            self.bytes(true, packed);
        }

        fn bytes(&mut self, is_data: bool, bytes: &[u8]) {
            write(GPIOC_PIN7, u32::from(is_data) << 7);
            for &byte in bytes {
                write(SSI_DR, u32::from(byte));
                // The bus is full duplex: a byte has left when one has come back, and only then
                // may the pin change. QEMU's controller stalls when nobody fetches them.
                while read(SSI_SR) & SSI_SR_RECEIVED == 0 {}
                read(SSI_DR);
            }
        }
    }
}

/// `oled expected.pgm [screendump.ppm]`
#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let expected = args.next().unwrap_or("target/oled.pgm".into());

    let mut buffers = Box::new(Memory::NEW);
    let mut greys = Vec::new(); // 0..=15
    draw(FRAMES - 1, &mut buffers, |_, packed| {
        greys.extend(packed.iter().flat_map(|byte| [byte >> 4, byte & 15]));
    });
    let mut pgm = format!("P5 {WIDTH} {HEIGHT} 15\n").into_bytes();
    pgm.extend(&greys);
    std::fs::write(&expected, pgm)?;
    println!("wrote {expected}");

    if let Some(dump) = args.next() {
        compare(&std::fs::read(&dump)?, &greys)?;
        println!("{dump}: all {} pixels equal", greys.len());
    }
    Ok(())
}

/// Compares QEMU's screendump, four dots to a pixel in both directions, with the greys sent.
#[cfg(not(target_os = "none"))]
fn compare(dump: &[u8], greys: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
    const ZOOM: usize = 4;
    const STEP: u8 = 17; // between two of the 16 greys, in the dump's 8 bits
    let header = format!("P6\n{} {}\n255\n", WIDTH * ZOOM, HEIGHT * ZOOM);
    let dots = dump.strip_prefix(header.as_bytes()).ok_or("not a dump of this panel")?;
    if dots.len() != greys.len() * ZOOM * ZOOM * 3 {
        return Err("the dump is cut short".into());
    }
    let mut different = 0;
    for (i, dot) in dots.chunks(3).enumerate() {
        let (x, y) = (i % (WIDTH * ZOOM) / ZOOM, i / (WIDTH * ZOOM) / ZOOM);
        let level = greys[y * WIDTH + x] * STEP;
        if dot != [level; 3] {
            if different < 10 {
                eprintln!("({x}, {y}): {dot:?}, not {level}");
            }
            different += 1;
        }
    }
    if different == 0 { Ok(()) } else { Err(format!("{different} dots differ").into()) }
}
