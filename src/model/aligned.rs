//! Bytes that begin where a container may begin.

/// A value that begins at a multiple of 4 bytes.
///
/// ```
/// use zstrip::model::Aligned;
/// static BYTES: &Aligned<[u8]> = &Aligned(*b"not a container");
/// assert_eq!(BYTES.0.as_ptr().align_offset(4), 0);
/// ```
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
pub struct Aligned<T: ?Sized>(
    /// The value.
    pub T,
);

/// Includes a file as a `&'static [u8]` that begins at a multiple of 4 bytes, as
/// [`Model::from_bytes`](crate::model::Model::from_bytes) needs it. Plain `include_bytes!` begins anywhere.
///
/// ```
/// static FILE: &[u8] = zstrip::include_model!("../../Cargo.toml");
/// assert_eq!(FILE.as_ptr().align_offset(4), 0);
/// assert!(zstrip::model::Model::from_bytes(FILE).is_err());
/// ```
#[macro_export]
macro_rules! include_model {
    ($path:expr) => {{
        static MODEL: &$crate::model::Aligned<[u8]> = &$crate::model::Aligned(*include_bytes!($path));
        &MODEL.0
    }};
}
