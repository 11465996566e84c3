//! Types that say which buffers a renderer has beside its colours: a program links only the loops that it needs.

/// Choice of a depth buffer, said by a type: [`WithDepth`], [`WithOcclusion`], [`WithSamples`] or [`WithoutDepth`].
pub trait DepthChoice: sealed::Sealed {
    /// True if there is a depth buffer.
    const DEPTH: bool;

    /// Number of samples per pixel.
    const SAMPLES: usize = 1;

    /// True if hidden draws are left out, by coarse depths in the depth buffer.
    const OCCLUDES: bool = false;

    /// The colours of samples 1 and up, one sample after the other; nothing with one sample per pixel.
    type Further<'a, R: 'a>: Further<R>;

    /// Lends memory for them.
    #[doc(hidden)]
    fn lend<R>(pixels: &mut [R]) -> Self::Further<'_, R>;

    /// Returns the first `length` of these colours, or all.
    #[doc(hidden)]
    fn first<'r, R>(further: &'r mut Self::Further<'_, R>, length: usize) -> Self::Further<'r, R>;
}

/// Memory for the colours of samples 1 and up: [`Samples`], or nothing.
pub trait Further<R>: sealed::Sealed {
    /// Returns the colours of all samples, and the number of the one that is drawn into.
    #[doc(hidden)]
    fn samples(&mut self) -> (&mut [R], usize);

    /// Sets the number of the sample that is drawn into.
    #[doc(hidden)]
    fn select(&mut self, sample: usize);
}

/// Colours of samples 1 and up, one sample after the other.
#[derive(Debug)]
pub struct Samples<'a, R> {
    pixels: &'a mut [R],
    sample: usize,
}

/// No colours: there is one sample per pixel.
#[derive(Clone, Copy, Debug)]
pub struct NoSamples;

impl<R> Further<R> for NoSamples {
    fn samples(&mut self) -> (&mut [R], usize) {
        (&mut [], 0)
    }

    fn select(&mut self, _: usize) {}
}

impl<R> Further<R> for Samples<'_, R> {
    fn samples(&mut self) -> (&mut [R], usize) {
        (self.pixels, self.sample)
    }

    fn select(&mut self, sample: usize) {
        self.sample = sample;
    }
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

/// Marks a renderer or strip with a depth buffer and coarse depths, by which hidden draws are left out. See
/// [`Renderer::with_occlusion`](crate::frame::Renderer::with_occlusion).
#[derive(Clone, Copy, Debug)]
pub struct WithOcclusion;

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
    type Further<'a, R: 'a> = NoSamples;

    fn lend<R>(_: &mut [R]) -> NoSamples {
        NoSamples
    }

    fn first<R>(_: &mut NoSamples, _: usize) -> NoSamples {
        NoSamples
    }
}

impl DepthChoice for WithOcclusion {
    const DEPTH: bool = true;
    const OCCLUDES: bool = true;
    type Further<'a, R: 'a> = NoSamples;

    fn lend<R>(_: &mut [R]) -> NoSamples {
        NoSamples
    }

    fn first<R>(_: &mut NoSamples, _: usize) -> NoSamples {
        NoSamples
    }
}

macro_rules! with_samples {
    ($($count:literal)*) => {$(
        impl DepthChoice for WithSamples<$count> {
            const DEPTH: bool = true;
            const SAMPLES: usize = $count;
            type Further<'a, R: 'a> = Samples<'a, R>;

            fn lend<R>(pixels: &mut [R]) -> Samples<'_, R> {
                Samples { pixels, sample: 0 }
            }

            fn first<'r, R>(further: &'r mut Samples<'_, R>, length: usize) -> Samples<'r, R> {
                let length = length.min(further.pixels.len());
                Self::lend(further.pixels.get_mut(..length).unwrap_or_default())
            }
        }
    )*};
}

with_samples!(1 2 4 8);

impl DepthChoice for WithoutDepth {
    const DEPTH: bool = false;
    type Further<'a, R: 'a> = NoSamples;

    fn lend<R>(_: &mut [R]) -> NoSamples {
        NoSamples
    }

    fn first<R>(_: &mut NoSamples, _: usize) -> NoSamples {
        NoSamples
    }
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
    impl Sealed for super::WithOcclusion {}
    impl<const N: usize> Sealed for super::WithSamples<N> {}
    impl Sealed for super::WithoutDepth {}
    impl Sealed for super::NoSamples {}
    impl<R> Sealed for super::Samples<'_, R> {}
    impl Sealed for super::WithRecords {}
    impl Sealed for super::WithCarriedState {}
    impl Sealed for super::WithoutRecords {}
}
