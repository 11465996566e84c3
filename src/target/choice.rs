//! Types that say which buffers a renderer has beside its colours: a program links only the loops that it needs.

/// Says by its type if there is a depth buffer: [`WithDepth`] or [`WithoutDepth`].
pub trait DepthChoice: sealed::Sealed {
    /// True if there is a depth buffer.
    const DEPTH: bool;
}

/// Says by its type if there may be records: [`WithRecords`] or [`WithoutRecords`].
pub trait RecordsChoice: sealed::Sealed {
    /// True if there may be records.
    const RECORDS: bool;
}

/// There is a depth buffer.
#[derive(Clone, Copy, Debug)]
pub struct WithDepth;

/// There is no depth buffer: every depth test passes, and what is drawn later covers what is there.
#[derive(Clone, Copy, Debug)]
pub struct WithoutDepth;

/// There may be records.
#[derive(Clone, Copy, Debug)]
pub struct WithRecords;

/// There are no records: the closure is called once per strip, and the code that records and replays is not linked.
#[derive(Clone, Copy, Debug)]
pub struct WithoutRecords;

impl DepthChoice for WithDepth {
    const DEPTH: bool = true;
}

impl DepthChoice for WithoutDepth {
    const DEPTH: bool = false;
}

impl RecordsChoice for WithRecords {
    const RECORDS: bool = true;
}

impl RecordsChoice for WithoutRecords {
    const RECORDS: bool = false;
}

mod sealed {
    pub trait Sealed {}

    impl Sealed for super::WithDepth {}
    impl Sealed for super::WithoutDepth {}
    impl Sealed for super::WithRecords {}
    impl Sealed for super::WithoutRecords {}
}
