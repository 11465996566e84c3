//! The functions that a state needs of stages 8 to 11 of [the pipeline](crate#the-pipeline).

use super::painter::RasterHooks;
use super::replay::{ShaderDrawer, fits};
use super::state::State;
use crate::span::{
    Carrying, DepthBias, DepthDyn, DepthLess, DepthOff, DepthState, DepthTest, Sampled, Shader, SmallResult,
};
use crate::target::Framebuffer;
use crate::vertex::Varyings;

impl<F: Framebuffer, S: Shader<F::Format>> RasterHooks<F, S> {
    /// Functions under one depth test.
    ///
    /// Small triangles have a way of their own if the shader [`fits`] it.
    const fn by<D: StateTest>() -> Self {
        Self {
            spans: |painter, set_up, centre| painter.spans(set_up, centre, D::of(painter.test())),
            // Without varyings both ways draw the same, and one triangle by itself gains little.
            small: if fits::<F, S>() && S::Varyings::LEN > 0 {
                |painter, v, varyings, flat| {
                    let test = D::of(painter.test());
                    if F::CARRIES {
                        painter.small(v, varyings, flat, Carrying(test))
                    } else if F::SAMPLES > 1 {
                        painter.small(v, varyings, flat, Sampled(test))
                    } else {
                        painter.small(v, varyings, flat, test)
                    }
                }
            } else {
                |_, _, _, _| SmallResult::Large
            },
            replay: |scene, state, hooks, shader, waiting| {
                if F::RECORDS {
                    let (test, varyings) = (D::of(state.depth), [S::Varyings::ZERO; 3]);
                    // One kind of test for all small triangles, so that each of their loops is linked once.
                    if F::CARRIES {
                        let mut drawer = ShaderDrawer { state, hooks, shader, test: Carrying(test), varyings };
                        scene.replay(state, hooks.bias, waiting, &mut drawer);
                    } else if F::SAMPLES > 1 {
                        let mut drawer = ShaderDrawer { state, hooks, shader, test: Sampled(test), varyings };
                        scene.replay(state, hooks.bias, waiting, &mut drawer);
                    } else {
                        let mut drawer = ShaderDrawer { state, hooks, shader, test, varyings };
                        scene.replay(state, hooks.bias, waiting, &mut drawer);
                    }
                }
            },
            bias: None,
        }
    }

    /// Functions for [`State::DEFAULT`].
    pub(super) const DEFAULT: Self = if F::DEPTH { Self::by::<DepthLess>() } else { Self::OVER };

    /// Functions without a depth test.
    const OVER: Self = Self::by::<DepthOff>();

    /// Functions for any state.
    pub(super) const ANY: Self = if F::DEPTH {
        Self {
            spans: |painter, set_up, centre| (Self::of_test(painter.test()).spans)(painter, set_up, centre),
            small: |painter, v, varyings, flat| (Self::of_test(painter.test()).small)(painter, v, varyings, flat),
            replay: |scene, state, hooks, shader, waiting| {
                (Self::of_test(state.depth).replay)(scene, state, hooks, shader, waiting)
            },
            bias: Some(DepthBias::steps),
        }
    } else {
        Self { bias: Some(DepthBias::steps), ..Self::OVER }
    };

    /// Returns the functions for a test.
    fn of_test(depth: DepthState) -> Self {
        match depth {
            DepthState::LESS => Self::by::<DepthLess>(),
            DepthState::OFF => Self::OVER,
            _ => Self::by::<DepthDyn>(),
        }
    }

    /// Chooses the functions for a state.
    #[inline(always)]
    pub(super) fn of(state: &State) -> Self {
        let by_test = match state.depth {
            DepthState::LESS => Self::DEFAULT,
            DepthState::OFF => Self::OVER,
            _ => Self::ANY,
        };
        Self { bias: if state.bias.is_none() { None } else { Self::ANY.bias }, ..by_test }
    }
}

/// A depth test that a state may ask for.
trait StateTest: DepthTest {
    /// Returns the test of a state.
    fn of(state: DepthState) -> Self;
}

impl StateTest for DepthLess {
    #[inline(always)]
    fn of(_: DepthState) -> Self {
        Self
    }
}

impl StateTest for DepthOff {
    #[inline(always)]
    fn of(_: DepthState) -> Self {
        Self
    }
}

impl StateTest for DepthDyn {
    #[inline(always)]
    fn of(state: DepthState) -> Self {
        Self::new(state)
    }
}
