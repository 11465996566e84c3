//! Parts of the crate that its own tests, examples and measurements look at. They are no part of its interface: they change
//! without notice.

pub use crate::raster::*;
