//! What a scene keeps while it draws, off the stack: a matrix has 128 bytes, a lit material as many. Firmware that watches its
//! stack has them in static memory, and so have the scenes; programs with an allocator have them on the heap.

use core::ops::Deref;

#[cfg(not(target_os = "none"))]
pub struct Kept<T>(Box<T>);

#[cfg(not(target_os = "none"))]
pub fn kept<T>(make: impl FnOnce() -> T) -> Kept<T> {
    Kept(Box::new(make()))
}

#[cfg(not(target_os = "none"))]
impl<T> Deref for Kept<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

#[cfg(target_os = "none")]
pub use firmware::kept;

#[cfg(target_os = "none")]
mod firmware {
    use super::Deref;
    use core::mem::{MaybeUninit, align_of, size_of};
    use core::ptr::NonNull;

    /// Bytes for all that is kept at a time.
    const ROOM: usize = 512;

    #[repr(align(8))]
    struct Room(MaybeUninit<[u8; ROOM]>);

    static mut PLACES: Room = Room(MaybeUninit::uninit());
    /// Bytes in use. What was kept last is given back first; in another order, places stay in use.
    static mut USED: usize = 0;

    /// A value, and how many bytes were in use before.
    pub struct Kept<T>(NonNull<T>, usize);

    /// Bytes that a value takes.
    const fn room<T>() -> usize {
        size_of::<T>().next_multiple_of(8)
    }

    /// Makes a value in the next free place. A scene that keeps more than there is room for stops here.
    #[inline(never)]
    pub fn kept<T>(make: impl FnOnce() -> T) -> Kept<T> {
        const { assert!(align_of::<T>() <= 8) };
        // SAFETY: firmware of one thread, whose interrupts draw nothing: nobody else is at `USED`.
        let before = unsafe { USED };
        while before + room::<T>() > ROOM {
            core::hint::spin_loop();
        }
        let places = (&raw mut PLACES).cast::<u8>();
        // SAFETY: inside of the room, and of no other value, as all of them are below `USED`; aligned, as all sizes are multiples
        // of 8.
        unsafe {
            let place = places.add(before).cast::<T>();
            USED = before + room::<T>();
            place.write(make());
            Kept(NonNull::new_unchecked(place), before)
        }
    }

    impl<T> Deref for Kept<T> {
        type Target = T;

        fn deref(&self) -> &T {
            // SAFETY: it was written, and nobody else has its place.
            unsafe { self.0.as_ref() }
        }
    }

    impl<T> Drop for Kept<T> {
        #[inline(never)]
        fn drop(&mut self) {
            // SAFETY: see `kept`; the value is not used any more.
            unsafe {
                self.0.drop_in_place();
                if USED == self.1 + room::<T>() {
                    USED = self.1;
                }
            }
        }
    }
}
