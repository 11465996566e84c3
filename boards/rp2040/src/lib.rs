//! A turning torus on a Raspberry Pi Pico with an ST7789 panel of 240×240 pixels, drawn in strips of 16 rows.
//!
//! ```text
//! Pico  GP16 -> D/C   GP17 -> CS   GP18 -> SCK   GP19 -> SDA (MOSI)   GP20 -> RESET
//! ```
//! `src/bin` has two programs that show it: `blocking` waits until a strip is sent and then draws the next one; `dma`
//! draws the next one meanwhile. A third, `measure`, tells a logic analyser how long drawing and sending take by
//! themselves.
//!
//! Three more show models from containers in flash: `model` a textured cow, `character` a figure that walks and runs,
//! and `part` a flange. `shows` takes them from zstrip's own `examples/models`: leave these four out in a copy, or name
//! a container of your own.
//!
//! To begin a program of your own, copy this folder, name a version of zstrip in `Cargo.toml`, and change `scene`.
#![no_std]
#![deny(unsafe_code)]

pub mod board;
pub mod panel;
pub mod player;
pub mod scene;

/// Pixels of a row.
pub const WIDTH: usize = scene::SIZE.width as usize;

/// Rows of a strip. All strips have the same number of rows, so that a whole buffer can be sent.
pub const ROWS: usize = zstrip::frame::RamBudget::even_rows(scene::SIZE.height, 16) as usize;

/// Colours of a strip, as the panel wants their bytes.
pub type Colors = [u16; WIDTH * ROWS];

/// Depths of a strip.
pub type Depths = [u16; WIDTH * ROWS];

/// Records: enough for the torus, so that its vertices are transformed once per frame.
pub type Records = [u32; 4 * 1024];
