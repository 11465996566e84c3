//! Shows a part from CAD, turning, from a container in flash.
#![no_std]
#![no_main]
#![forbid(unsafe_code)]

#[path = "../shows.rs"]
mod shows;

use panic_halt as _;
use shows::{BACKGROUND, Turning};
use zstrip_rp2040::player::Player;

#[rp2040_hal::entry]
fn main() -> ! {
    let mut player = Player::start();
    let mut show = Turning::part();
    loop {
        let frame = show.next_frame();
        player.show(BACKGROUND, |scene| frame.draw(scene));
    }
}
