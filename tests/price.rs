//! The benchmark's workloads, drawn by shaders of a user's own and in other states than the default, look as the
//! benchmark's own do. `ci/bench --price` counts what that costs.

#[path = "../examples/workloads/mod.rs"]
mod workloads;

use workloads::price::{self, By, PRICED, Priced, Under};
use workloads::{Buffers, HEIGHT};

const RECORDS: usize = 256 * 1024;

/// Colours and depths of a frame in one strip.
fn picture(workload: Priced, by: By, under: Under) -> (Vec<u16>, Vec<u16>) {
    let pixels = workload.width() * HEIGHT;
    let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; RECORDS]);
    let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
    let stats = price::draw(workload, by, under, buffers, &mut |_| {});
    assert!(stats.drawn > 400, "{workload:?}: only {} triangles were drawn", stats.drawn);
    (color, depth)
}

/// Returns whether no channel of two pixels differs by more than one step.
fn is_near(a: u16, b: u16) -> bool {
    let channels = |pixel: u16| [pixel >> 11, pixel >> 5 & 63, pixel & 31];
    channels(a).iter().zip(channels(b)).all(|(a, b)| a.abs_diff(b) <= 1)
}

const STATES: [Under; 4] = [Under::Usual, Under::LessEqual, Under::AllFaces, Under::Biased];

#[test]
fn a_shader_that_passes_everything_on_draws_the_same_pixels_and_depths() {
    for (name, workload) in PRICED {
        for under in STATES {
            let (usual, passed_on) = (picture(workload, By::Usual, under), picture(workload, By::PassedOn, under));
            assert!(usual == passed_on, "{name} {under:?}");
        }
    }
}

#[test]
fn a_shader_with_its_own_fragments_covers_the_same_pixels_at_the_same_depths() {
    for (name, workload) in PRICED {
        for under in STATES {
            let (usual, own) = (picture(workload, By::Usual, under), picture(workload, By::OwnFragment, under));
            assert!(usual.1 == own.1, "{name} {under:?}: depths differ");
            if let Priced::W5 | Priced::W9 | Priced::ColoredW9 = workload {
                // Packed channels along a span may be another step than those per pixel.
                let far_off = usual.0.iter().zip(&own.0).filter(|(a, b)| !is_near(**a, **b)).count();
                assert_eq!(far_off, 0, "{name} {under:?}: pixels differ by more than a step");
            } else {
                assert!(usual.0 == own.0, "{name} {under:?}: colours differ");
            }
        }
    }
}

#[test]
fn an_opaque_blend_draws_the_fragments_as_they_are() {
    for (name, workload) in PRICED {
        let (own, blended) =
            (picture(workload, By::OwnFragment, Under::Usual), picture(workload, By::Blended, Under::Usual));
        assert!(own == blended, "{name}");
    }
}
