//! Extreme values, to every public function that takes numbers: the ends of each integer type, zero sizes, empty and
//! endless lists, and random values between them; and traits that are implemented wrongly. Nothing panics, and nothing
//! runs for ever. Debug builds check overflow of integers as well.

mod constructors;
mod documented;
mod frames;
mod implementations;
mod numbers;

use crate::reference::rng::Rng;
use std::cell::RefCell;
use std::fmt::Debug;
use std::hint::black_box;
use std::panic::{self, AssertUnwindSafe};
use std::process;
use std::sync::{Mutex, Once};
use std::thread;
use std::time::{Duration, Instant};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};

/// Time after which a case counts as endless. Cases take milliseconds.
const ENDLESS: Duration = Duration::from_secs(60);

/// Cases that run at the moment, one per thread: name and start.
static RUNNING: Mutex<Vec<(thread::ThreadId, &'static str, Instant)>> = Mutex::new(Vec::new());

thread_local! {
    /// Message and place of this thread's last panic.
    static LAST_PANIC: RefCell<String> = const { RefCell::new(String::new()) };
    /// Set while this thread runs a case.
    static IN_CASE: RefCell<bool> = const { RefCell::new(false) };
}

/// Keeps the panics of cases quiet and notes them, and ends the process if a case is endless.
fn watch() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if IN_CASE.with(|running| *running.borrow()) {
                LAST_PANIC.with(|last| *last.borrow_mut() = info.to_string().replace('\n', " "));
            } else {
                usual(info);
            }
        }));
        thread::spawn(|| {
            loop {
                thread::sleep(Duration::from_secs(1));
                for (_, name, start) in RUNNING.lock().expect("no panic holds the lock").iter() {
                    if start.elapsed() > ENDLESS {
                        eprintln!("{name} has been running for {ENDLESS:?}");
                        process::exit(101);
                    }
                }
            }
        });
    });
}

/// A list of cases, which fails at its end with the first failure of each kind.
pub struct Table {
    failures: Vec<(&'static str, String)>,
    cases: u32,
}

impl Table {
    pub fn start() -> Self {
        watch();
        Self { failures: Vec::new(), cases: 0 }
    }

    /// Calls a function with some values.
    pub fn case<T>(&mut self, name: &'static str, values: impl Debug, function: impl FnOnce() -> T) -> Option<T> {
        let (mut function, mut result) = (Some(function), None);
        self.run(name, &values, &mut || result = function.take().map(|function| black_box(function())));
        result
    }

    /// Runs a case. It is compiled once, and not for each case.
    fn run(&mut self, name: &'static str, values: &dyn Debug, function: &mut dyn FnMut()) {
        self.cases += 1;
        let thread = thread::current().id();
        RUNNING.lock().expect("no panic holds the lock").push((thread, name, Instant::now()));
        IN_CASE.with(|running| *running.borrow_mut() = true);
        let result = panic::catch_unwind(AssertUnwindSafe(function));
        IN_CASE.with(|running| *running.borrow_mut() = false);
        RUNNING.lock().expect("no panic holds the lock").retain(|(other, ..)| *other != thread);
        if result.is_err() {
            let message = LAST_PANIC.with(|last| last.borrow().clone());
            if !self.failures.iter().any(|(known, failure)| *known == name && failure.ends_with(&message)) {
                self.failures.push((name, format!("{values:?}: {message}")));
            }
        }
    }

    /// Fails if a case failed.
    pub fn finish(self) {
        println!("{} cases", self.cases);
        for (name, failure) in &self.failures {
            println!("{name} {failure}");
        }
        assert!(self.failures.is_empty(), "{} panics", self.failures.len());
        assert!(self.cases > 0, "a table without cases");
    }
}

/// Values around the ends of 32 bits, of 16 bits, and of the formats that are used.
pub const ENDS: [i32; 26] = [
    i32::MIN,
    i32::MIN + 1,
    -0x7FFF_0000,
    -1 << 30,
    -1 << 24,
    -131_071,
    -65_537,
    -65_536,
    -32_769,
    -32_768,
    -257,
    -1,
    0,
    1,
    127,
    128,
    256,
    32_767,
    32_768,
    65_535,
    65_536,
    1 << 23,
    1 << 30,
    0x7FFF_0000,
    i32::MAX - 1,
    i32::MAX,
];

/// Random values, most of them extreme.
pub trait Extreme {
    fn bits(&mut self) -> i32;

    fn size(&mut self) -> u32;

    fn long(&mut self) -> i64;

    fn scalar(&mut self) -> Scalar {
        Scalar::from_bits(self.bits())
    }

    fn pixels(&mut self) -> Pixels {
        Pixels::from_bits(self.bits())
    }

    fn short(&mut self) -> i16 {
        self.bits().clamp(i16::MIN.into(), i16::MAX.into()) as i16
    }

    fn angle(&mut self) -> Angle16 {
        Angle16(self.bits() as u16)
    }

    fn triple(&mut self) -> [i32; 3] {
        [self.bits(), self.bits(), self.bits()]
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from_bits(self.triple())
    }

    fn affine(&mut self) -> Affine {
        Affine::from_rows(self.vector(), self.vector(), self.vector(), self.vector())
    }

    fn projective(&mut self) -> Projective;
}

impl Extreme for Rng {
    fn bits(&mut self) -> i32 {
        if self.one_in(2) { self.pick(&ENDS) } else { self.any_magnitude(31) }
    }

    fn size(&mut self) -> u32 {
        let few = [0, 1, 2, 8, 255, 256, 4095, 4096, 4097, 32_768, 65_535, 65_536, 1 << 31, u32::MAX - 1, u32::MAX];
        self.pick(&few)
    }

    fn long(&mut self) -> i64 {
        match self.below(4) {
            0 => self.pick(&[i64::MIN, i64::MIN + 1, -1 << 62, -1 << 32, -1, 0, 1, 1 << 32, 1 << 62, i64::MAX]),
            1 => i64::from(self.bits()) << 16,
            2 => self.bits().into(),
            _ => {
                let bits = 1 + self.below(64) as u32;
                self.signed_bits(bits)
            }
        }
    }

    fn projective(&mut self) -> Projective {
        match self.below(6) {
            0 => Projective::from_affine(&self.affine()),
            4 => Projective::IDENTITY,
            5 => {
                // A lens, through which something is often seen.
                let near = Scalar::from_bits(1 + self.below(1 << 18) as i32);
                let lens = Projective::perspective(Angle16(0x2000), Size::new(4, 3), near, Scalar::from_num(9));
                lens.unwrap_or_default() * Affine::translation(Vec3::Z * Scalar::from_num(-2))
            }
            1 => {
                let magnitude = 1 + self.below(64) as u32;
                Projective::from_rows([[(); 4]; 4].map(|row| row.map(|()| self.signed_bits(magnitude))))
            }
            _ => Projective::from_rows([[(); 4]; 4].map(|row| row.map(|()| self.long()))),
        }
    }
}
