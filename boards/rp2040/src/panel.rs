//! The panel, an ST7789: a few commands, and two ways to send pixels.

use crate::board::{Bus, ChipSelect, DataCommand, DmaChannel};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiBus;
use rp2040_hal::dma::single_buffer::{Config, Transfer};
use zstrip::bytemuck;
use zstrip::embedded_graphics_core::primitives::Rectangle;

/// The bus and the pins never fail: their error is `Infallible`.
macro_rules! sure {
    ($result:expr) => {
        match $result {
            Ok(value) => value,
            Err(never) => match never {},
        }
    };
}

/// The panel, sent to by the processor.
pub struct Panel {
    bus: Bus,
    pins: Pins,
}

struct Pins {
    dc: DataCommand,
    cs: ChipSelect,
}

impl Panel {
    /// Wakes the panel: 16-bit pixels, high byte first, rows from the top down.
    pub fn start(
        bus: Bus,
        dc: DataCommand,
        cs: ChipSelect,
        mut reset: impl OutputPin<Error = core::convert::Infallible>,
        delay: &mut impl DelayNs,
    ) -> Self {
        let mut panel = Self { bus, pins: Pins { dc, cs } };
        sure!(panel.pins.cs.set_high());
        sure!(reset.set_low());
        delay.delay_us(10);
        sure!(reset.set_high());
        delay.delay_ms(120);
        panel.command(0x11, &[]); // leaves sleep
        delay.delay_ms(5);
        panel.command(0x3A, &[0x55]); // 16 bits per pixel
        panel.command(0x36, &[0x00]); // red first, not turned
        panel.command(0x21, &[]); // inverted, as these panels are built
        panel.command(0x29, &[]); // on
        panel
    }

    /// Sends pixels for a part of the screen, and waits until they are sent.
    pub fn send(&mut self, area: &Rectangle, pixels: &[u8]) {
        self.begin_pixels(area);
        sure!(self.bus.write(pixels));
        self.end_pixels();
    }

    /// Says where the next pixels go, and leaves the panel waiting for them.
    fn begin_pixels(&mut self, area: &Rectangle) {
        let range = |start: i32, length: u32| {
            let [a, b] = (start as u16).to_be_bytes();
            let [c, d] = (start as u16 + length as u16 - 1).to_be_bytes();
            [a, b, c, d]
        };
        self.command(0x2A, &range(area.top_left.x, area.size.width));
        self.command(0x2B, &range(area.top_left.y, area.size.height));
        self.command(0x2C, &[]);
        sure!(self.pins.cs.set_low());
    }

    fn end_pixels(&mut self) {
        sure!(self.bus.flush());
        sure!(self.pins.cs.set_high());
    }

    fn command(&mut self, command: u8, arguments: &[u8]) {
        sure!(self.pins.cs.set_low());
        sure!(self.pins.dc.set_low());
        sure!(self.bus.write(&[command]));
        sure!(self.bus.flush());
        sure!(self.pins.dc.set_high());
        sure!(self.bus.write(arguments));
        sure!(self.bus.flush());
        sure!(self.pins.cs.set_high());
    }
}

/// The panel, sent to by DMA: one buffer is on its way while the processor draws into another.
pub struct DmaPanel {
    /// The panel and the transfer, taken out while one transfer ends and the next one starts.
    state: Option<State>,
}

enum State {
    Idle(Panel, DmaChannel, &'static mut [u8]),
    Sending(Transfer<DmaChannel, &'static mut [u8], Bus>, Pins),
}

impl State {
    /// Waits until the panel has got all pixels.
    fn wait(self) -> (Panel, DmaChannel, &'static mut [u8]) {
        match self {
            Self::Idle(panel, channel, buffer) => (panel, channel, buffer),
            Self::Sending(transfer, pins) => {
                let (channel, buffer, bus) = transfer.wait();
                let mut panel = Panel { bus, pins };
                // The last bytes are still in the FIFO.
                panel.end_pixels();
                (panel, channel, buffer)
            }
        }
    }
}

impl DmaPanel {
    /// Takes the panel, and a buffer for the first exchange.
    pub fn new(panel: Panel, channel: DmaChannel, buffer: &'static mut [u16]) -> Self {
        Self { state: Some(State::Idle(panel, channel, bytemuck::cast_slice_mut(buffer))) }
    }

    /// Waits until the previous buffer is sent, starts sending all of this one, and returns the previous one.
    pub fn send(&mut self, area: &Rectangle, buffer: &'static mut [u16]) -> &'static mut [u16] {
        let state = self.state.take().expect("the state is only taken out here and put back");
        let (mut panel, channel, sent) = state.wait();
        panel.begin_pixels(area);
        let Panel { bus, pins } = panel;
        let transfer = Config::new(channel, bytemuck::cast_slice_mut(buffer), bus).start();
        self.state = Some(State::Sending(transfer, pins));
        bytemuck::cast_slice_mut(sent)
    }

    /// Waits until everything is sent, and returns panel, channel and buffer.
    pub fn finish(self) -> (Panel, DmaChannel, &'static mut [u16]) {
        let (panel, channel, buffer) = self.state.expect("the state is put back").wait();
        (panel, channel, bytemuck::cast_slice_mut(buffer))
    }
}
