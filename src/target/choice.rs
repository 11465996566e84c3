//! Types that say which buffers a renderer has beside its colours: a program links only the loops that it needs.

/// Choice of a depth buffer, said by a type: [`WithDepth`], [`WithSamples`] or [`WithoutDepth`].
pub trait DepthChoice: sealed::Sealed {
    /// True if there is a depth buffer.
    const DEPTH: bool;

    /// Number of samples per pixel.
    const SAMPLES: usize = 1;
}

/// Choice of records, said by a type: [`WithRecords`], [`WithCarriedState`] or [`WithoutRecords`].
pub trait RecordsChoice: sealed::Sealed {
    /// True if there may be records.
    const RECORDS: bool;

    /// True if the state of small triangles is carried on from strip to strip, beside the records.
    const CARRIES: bool = false;
}

/// Marks a renderer or strip with a depth buffer.
#[derive(Clone, Copy, Debug)]
pub struct WithDepth;

/// Marks a renderer or strip with `N` samples per pixel, each with a colour and a depth: 1, 2, 4 or 8. See
/// [`Renderer::with_samples`](crate::frame::Renderer::with_samples).
#[derive(Clone, Copy, Debug)]
pub struct WithSamples<const N: usize>;

/// Marks a renderer or strip without a depth buffer: every depth test passes, and later drawings cover earlier ones.
#[derive(Clone, Copy, Debug)]
pub struct WithoutDepth;

/// Marks a renderer or strip that may have records.
#[derive(Clone, Copy, Debug)]
pub struct WithRecords;

/// Marks a renderer or strip that may have records, beside which the state of small triangles is carried on.
#[derive(Clone, Copy, Debug)]
pub struct WithCarriedState;

/// Marks a renderer or strip without records: the closure is called once per strip, and the code that records and
/// replays is not linked.
#[derive(Clone, Copy, Debug)]
pub struct WithoutRecords;

impl DepthChoice for WithDepth {
    const DEPTH: bool = true;
}

impl DepthChoice for WithSamples<1> {
    const DEPTH: bool = true;
}

impl DepthChoice for WithSamples<2> {
    const DEPTH: bool = true;
    const SAMPLES: usize = 2;
}

impl DepthChoice for WithSamples<4> {
    const DEPTH: bool = true;
    const SAMPLES: usize = 4;
}

impl DepthChoice for WithSamples<8> {
    const DEPTH: bool = true;
    const SAMPLES: usize = 8;
}

impl DepthChoice for WithoutDepth {
    const DEPTH: bool = false;
}

impl RecordsChoice for WithRecords {
    const RECORDS: bool = true;
}

impl RecordsChoice for WithCarriedState {
    const RECORDS: bool = true;

    const CARRIES: bool = true;
}

impl RecordsChoice for WithoutRecords {
    const RECORDS: bool = false;
}

mod sealed {
    pub trait Sealed {}

    impl Sealed for super::WithDepth {}
    impl<const N: usize> Sealed for super::WithSamples<N> {}
    impl Sealed for super::WithoutDepth {}
    impl Sealed for super::WithRecords {}
    impl Sealed for super::WithCarriedState {}
    impl Sealed for super::WithoutRecords {}
}
