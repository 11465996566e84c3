//! Models in containers, looked at before they are flashed: drawn on the host by the library, exactly as firmware draws
//! them.
//!
//! | file | |
//! |---|---|
//! | `stage.rs` | a container, a panel and a format come in, pictures go out |
//! | `picture.rs` | pictures, their PNG files, and the contact sheet |
//! | `estimate/` | instructions and frames per second, flash and RAM, from the tables of costs |

mod error;
mod estimate;
#[path = "../../../../examples/workloads/hash.rs"]
mod hash;
mod picture;
mod stage;
#[cfg(test)]
mod tests;
#[path = "../../../../examples/turntable/mod.rs"]
mod turntable;

pub use error::PreviewError;
pub use estimate::{
    Amount, CORES, Core, CoreEstimate, DRAW_TERMS, DrawCounts, Estimate, Flash, FrameCounts, POSE_TERMS, Ram, estimate,
    work_of,
};
pub use picture::{Picture, contact_sheet};
pub use stage::{Container, Format, LevelUse, Stage};
pub use turntable::{
    MOST_CLUSTERS, MOST_DRAWS, MOST_POSE, MOST_RECORDS, MOST_STRIP, MOST_WORDS, Panel, Step, TURN, Way, show_head,
};
