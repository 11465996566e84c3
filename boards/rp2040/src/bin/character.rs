//! Shows a figure that walks and runs: a skin, posed once per frame in memory of the program's own.
#![no_std]
#![no_main]
#![forbid(unsafe_code)]

#[path = "../shows.rs"]
mod shows;

use panic_halt as _;
use shows::{BACKGROUND, Going};
use static_cell::ConstStaticCell;
use zstrip_rp2040::player::Player;

static POSE: ConstStaticCell<[u32; Going::WORDS]> = ConstStaticCell::new([0; _]);

#[rp2040_hal::entry]
fn main() -> ! {
    let mut player = Player::start();
    let mut show = Going::new(POSE.take());
    loop {
        let frame = show.next_frame();
        player.show(BACKGROUND, |scene| frame.draw(scene));
    }
}
