//! Sinks that fail, frames that are dropped, buffers that are too short, and scenes that change while a frame is drawn.
//! Afterwards, the same renderer draws the next frame as a new one does.

use crate::Hash;
use crate::scenes::{Plan, assert_alike, strip_rows, strips};
use crate::source::Source;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::frame::{FrameError, Renderer};
use zstrip::target::{StripPixels, WithDepth, WithRecords};

type Pixels = Vec<<Rgb565 as PixelFormat>::Raw>;

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let ways: [u8; 3] = core::array::from_fn(|_| source.u8());
    let (rows, words) = (source.u8(), usize::from(source.u16()) % 500);
    let plan = Plan::new(&mut source);
    let mut other = Plan::new(&mut source);
    other.screen = plan.screen;
    let (width, rows) = (usize::from(plan.screen.0), strip_rows(rows, plan.screen.1));

    let expected = fresh(&plan, width * rows, words);
    let (mut color, mut depth, mut records) = (vec![0; width * rows], vec![9; width * rows], vec![!0; words]);
    let renderer = Renderer::<Rgb565>::new(plan.size()).expect("a renderer").with_depth(&mut depth).expect("depths");
    let mut renderer = renderer.with_records(&mut records);
    for way in ways {
        disturb(&mut renderer, &mut color, way, &plan, &other);
        let found = strips(&mut renderer, &mut color, &plan);
        assert_alike(&found, &expected, plan.screen, &("after", way));
    }
    let mut hash = Hash::default();
    hash.bytes(zstrip::bytemuck::cast_slice(&expected));
    hash.0
}

/// What a new renderer draws, whose memory has other contents.
fn fresh(plan: &Plan, pixels: usize, words: usize) -> Pixels {
    let (mut color, mut depth, mut records) = (vec![7; pixels], vec![7; pixels], vec![7; words]);
    let renderer = Renderer::<Rgb565>::new(plan.size()).expect("a renderer").with_depth(&mut depth).expect("depths");
    strips(&mut renderer.with_records(&mut records), &mut color, plan)
}

/// Begins a frame, and does not bring it to its end as one should.
fn disturb(
    renderer: &mut Renderer<'_, Rgb565, WithDepth, WithRecords>,
    color: &mut [u16],
    way: u8,
    plan: &Plan,
    other: &Plan,
) {
    let after = usize::from(way >> 3) % 8;
    match way & 7 {
        // The sink fails at a strip.
        0 | 1 => {
            let mut sent = 0;
            let sink = |_: &StripPixels<'_, Rgb565>| {
                sent += 1;
                if sent > after { Err(sent) } else { Ok(()) }
            };
            match renderer.frame_to(sink, color, plan.background, |scene| plan.draw(scene)) {
                Ok(stats) => assert!(stats.strips as usize <= after),
                Err(error) => assert_eq!(error, FrameError::Sink(after + 1)),
            }
        }
        // The frame is dropped after some strips, of this scene or of another one.
        2 | 3 => {
            let scene = if way & 1 == 0 { plan } else { other };
            let mut frame = renderer.begin(plan.background);
            for _ in 0..after {
                let _ = frame.next_strip(color, |s| scene.draw(s)).expect("the same scene");
            }
        }
        // A strip's buffer is too short, and then it is long enough.
        4 => {
            let mut frame = renderer.begin(plan.background);
            let _ = frame.next_strip(color, |s| plan.draw(s)).expect("the same scene");
            let short = frame.next_strip(&mut [], |s| plan.draw(s));
            assert!(matches!(short, Ok(None) | Err(FrameError::BufferTooShort { .. })), "{:?}", short.err());
            while frame.next_strip(color, |s| plan.draw(s)).expect("the same scene").is_some() {}
        }
        // The scene changes between two calls: an error or a picture, no panic.
        5 | 6 => {
            let mut frame = renderer.begin(plan.background);
            let mut call = 0;
            loop {
                let strip = frame.next_strip(color, |s| {
                    if call > after {
                        other.draw(s)
                    } else {
                        plan.draw(s)
                    }
                    call += 1;
                });
                match strip {
                    Ok(Some(_)) => {}
                    Ok(None) | Err(FrameError::SceneChanged { .. }) => break,
                    Err(error) => panic!("{error:?}"),
                }
            }
        }
        // Nothing is wrong, but the scene is another one.
        _ => {
            let _ = strips(renderer, color, other);
        }
    }
}
