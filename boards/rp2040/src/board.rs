//! The Pico: clocks, pins, SPI and DMA.

use crate::panel::Panel;
use embedded_hal::spi::MODE_3;
use rp2040_hal::clocks::init_clocks_and_plls;
use rp2040_hal::dma::{CH0, Channel, DMAExt};
use rp2040_hal::fugit::RateExtU32;
use rp2040_hal::gpio::bank0::{Gpio2, Gpio16, Gpio17, Gpio18, Gpio19};
use rp2040_hal::gpio::{FunctionSioOutput, FunctionSpi, Pin, Pins, PullDown};
use rp2040_hal::spi::Enabled;
use rp2040_hal::{Clock, Sio, Spi, Timer, Watchdog, pac};

/// The second stage of the boot code, which sets the flash chip up. The boot ROM wants it in a section of its own,
/// and naming a section is `unsafe` in Rust.
#[allow(unsafe_code)]
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT2: [u8; 256] = rp2040_boot2::BOOT_LOADER_GENERIC_03H;

const CRYSTAL_HZ: u32 = 12_000_000;

/// The panel's bus.
pub type Bus = Spi<Enabled, pac::SPI0, (Pin<Gpio19, FunctionSpi, PullDown>, Pin<Gpio18, FunctionSpi, PullDown>)>;
/// The pin that tells the panel commands from data.
pub type DataCommand = Pin<Gpio16, FunctionSioOutput, PullDown>;
/// The pin that selects the panel.
pub type ChipSelect = Pin<Gpio17, FunctionSioOutput, PullDown>;
/// The DMA channel that sends strips.
pub type DmaChannel = Channel<CH0>;

/// The parts of the board that a program uses.
pub struct Board {
    /// The panel, ready to take pixels.
    pub panel: Panel,
    /// The DMA channel, which sends pixels while the processor draws.
    pub dma: DmaChannel,
    /// A pin for a logic analyser.
    pub mark: Pin<Gpio2, FunctionSioOutput, PullDown>,
}

impl Board {
    /// Starts the board: 125 MHz, SPI at 62.5 MHz. Panics if that has been done before.
    pub fn start() -> Self {
        let mut pac = pac::Peripherals::take().expect("the board is started once");
        let mut watchdog = Watchdog::new(pac.WATCHDOG);
        let clocks = init_clocks_and_plls(
            CRYSTAL_HZ,
            pac.XOSC,
            pac.CLOCKS,
            pac.PLL_SYS,
            pac.PLL_USB,
            &mut pac.RESETS,
            &mut watchdog,
        );
        let clocks = clocks.ok().expect("the crystal swings");
        let mut timer = Timer::new(pac.TIMER, &mut pac.RESETS, &clocks);
        let sio = Sio::new(pac.SIO);
        let pins = Pins::new(pac.IO_BANK0, pac.PADS_BANK0, sio.gpio_bank0, &mut pac.RESETS);

        // In modes 1 and 3 bytes follow one another without a gap; the panel reads at rising edges, as in mode 0.
        let spi = Spi::<_, _, _, 8>::new(pac.SPI0, (pins.gpio19.into_function(), pins.gpio18.into_function()));
        let bus = spi.init(&mut pac.RESETS, clocks.peripheral_clock.freq(), 62_500_000.Hz(), MODE_3);
        let (dc, cs) = (pins.gpio16.into_push_pull_output(), pins.gpio17.into_push_pull_output());
        let panel = Panel::start(bus, dc, cs, pins.gpio20.into_push_pull_output(), &mut timer);
        Self { panel, dma: pac.DMA.split(&mut pac.RESETS).ch0, mark: pins.gpio2.into_push_pull_output() }
    }
}
