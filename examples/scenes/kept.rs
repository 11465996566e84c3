//! Keeps the scene of a frame off the stack: a matrix has 128 bytes, and a lit material about as many.
//!
//! A program with an allocator keeps a scene in a `Box`. Firmware that watches its stack keeps it in static memory.

use super::{Draw, Drawing, Target};

#[cfg(not(target_os = "none"))]
pub type Kept<T> = Box<T>;

/// Makes a value.
#[cfg(not(target_os = "none"))]
pub fn kept<T>(make: impl FnOnce() -> T) -> Kept<T> {
    Box::new(make())
}

/// Makes the scene of a frame.
#[cfg(not(target_os = "none"))]
pub fn kept_drawing<S: for<'p> Draw<Target<'p>> + 'static>(make: impl FnOnce() -> S) -> Kept<Drawing> {
    Box::new(make())
}

/// Makes `count` values, one after the other.
#[cfg(not(target_os = "none"))]
pub fn kept_list<T>(count: usize, make: impl FnMut(usize) -> T) -> Kept<[T]> {
    (0..count).map(make).collect()
}

#[cfg(target_os = "none")]
pub use firmware::{Kept, kept, kept_drawing, kept_list};

#[cfg(target_os = "none")]
mod firmware {
    use super::{Draw, Drawing, Target};
    use core::mem::{ManuallyDrop, MaybeUninit, align_of};
    use core::ops::Deref;
    use core::ptr::NonNull;

    /// Bytes of all values that are kept at a time. The largest scene has the matrices of 56 trees; the scenes for
    /// chips of 16 KB have few matrices.
    const ROOM: usize = if cfg!(any(small_ram = "bare", small_ram = "records")) { 640 } else { 8 * 1024 };

    #[repr(align(8))]
    struct Room(MaybeUninit<[u8; ROOM]>);

    static mut PLACES: Room = Room(MaybeUninit::uninit());
    /// Bytes in use. The value that was kept last must be dropped first: in another order, its place stays in use.
    static mut USED: usize = 0;

    /// A value in static memory.
    pub struct Kept<T: ?Sized> {
        value: NonNull<T>,
        /// [`USED`] without the value, and with it.
        before: usize,
        after: usize,
    }

    /// Reserves the next free place. A program that keeps more than there is room for stops here.
    fn reserve<T>(count: usize) -> Kept<T> {
        const { assert!(align_of::<T>() <= 8) };
        // SAFETY: firmware of one thread, whose interrupts draw nothing: nobody else is at `USED`.
        let before = unsafe { USED };
        let after = before + (count * size_of::<T>()).next_multiple_of(8);
        while after > ROOM {
            core::hint::spin_loop();
        }
        // SAFETY: inside of the room; aligned, as all sizes are multiples of 8.
        let value = unsafe { NonNull::new_unchecked((&raw mut PLACES).cast::<u8>().add(before)) };
        // SAFETY: as above.
        unsafe { USED = after };
        Kept { value: value.cast(), before, after }
    }

    /// Makes a value.
    #[inline(never)]
    pub fn kept<T>(make: impl FnOnce() -> T) -> Kept<T> {
        let place = reserve::<T>(1);
        // SAFETY: a place of its own: all other values are below `before` or above `after`.
        unsafe { place.value.write(make()) };
        place
    }

    /// Makes the scene of a frame.
    pub fn kept_drawing<S: for<'p> Draw<Target<'p>> + 'static>(make: impl FnOnce() -> S) -> Kept<Drawing> {
        let scene = ManuallyDrop::new(kept(make));
        Kept { value: scene.value, before: scene.before, after: scene.after }
    }

    /// Makes `count` values, one after the other.
    #[inline(never)]
    pub fn kept_list<T>(count: usize, mut make: impl FnMut(usize) -> T) -> Kept<[T]> {
        let place = ManuallyDrop::new(reserve::<T>(count));
        for k in 0..count {
            // SAFETY: inside of the place that was reserved for `count` values.
            unsafe { place.value.add(k).write(make(k)) };
        }
        let value = NonNull::slice_from_raw_parts(place.value, count);
        Kept { value, before: place.before, after: place.after }
    }

    impl<T: ?Sized> Deref for Kept<T> {
        type Target = T;

        fn deref(&self) -> &T {
            // SAFETY: it was written, and nobody else has its place.
            unsafe { self.value.as_ref() }
        }
    }

    impl<T: ?Sized> Drop for Kept<T> {
        fn drop(&mut self) {
            // SAFETY: see `reserve`; the value is not used any more.
            unsafe {
                self.value.drop_in_place();
                if USED == self.after {
                    USED = self.before;
                }
            }
        }
    }
}
