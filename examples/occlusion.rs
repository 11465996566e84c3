//! What leaving out hidden draws saves and costs: firmware that counts. `ci/occlusion` runs it and prints the counts.
//!
//! It prints, for each run, `scene how/rows ticks drawn culled hash`. How is `records` or `direct`, with `+` for
//! occlusion; rows are those of a strip; ticks are SysTick's over a frame (instructions on RISC-V). Triangles drawn,
//! draws that were left out, and a hash of the picture follow.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
#[path = "workloads/hash.rs"]
mod hash;
#[cfg(target_os = "none")]
mod scenes;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;

#[cfg(target_os = "none")]
mod counting {
    use super::count;
    use super::hash::Hash;
    use super::scenes::street::Street;
    use super::scenes::{BACKGROUND, Draw, Torus};
    use core::hint::black_box;
    use semihosting::println;
    use zstrip::embedded_graphics_core::geometry::Size;
    use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
    use zstrip::frame::{Renderer, RendererError};
    use zstrip::math::Angle16;
    use zstrip::target::{
        DepthChoice, RecordsChoice, Stats, Strip, WithDepth, WithOcclusion, WithRecords, WithoutRecords, occlusion_len,
    };

    const SCREEN: Size = Size::new(320, 240);
    const PIXELS: usize = 320 * 240;

    struct Memory {
        color: [u16; PIXELS],
        depth: [u16; PIXELS + occlusion_len(320, 240)],
        records: [u32; 256 * 1024],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _] };

    /// The ways to draw a frame.
    trait Ways:
        for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithRecords>>
        + for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithoutRecords>>
        + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithRecords>>
        + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithoutRecords>>
    {
    }

    impl<T> Ways for T where
        T: for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithRecords>>
            + for<'p> Draw<Strip<'p, Rgb565, WithDepth, WithoutRecords>>
            + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithRecords>>
            + for<'p> Draw<Strip<'p, Rgb565, WithOcclusion, WithoutRecords>>
    {
    }

    fn frame<D: DepthChoice, R: RecordsChoice>(
        renderer: &mut Renderer<'_, Rgb565, D, R>,
        color: &mut [u16],
        drawing: &impl for<'p> Draw<Strip<'p, Rgb565, D, R>>,
        sink: &mut dyn FnMut(&[u16]),
    ) -> Stats {
        let mut frame = renderer.begin(BACKGROUND);
        while let Ok(Some(strip)) = frame.next_strip(color, |scene| drawing.draw(scene)) {
            sink(strip.pixels());
        }
        frame.stats()
    }

    fn count<D: DepthChoice, R: RecordsChoice>(
        mut renderer: Renderer<'_, Rgb565, D, R>,
        color: &mut [u16],
        drawing: &impl for<'p> Draw<Strip<'p, Rgb565, D, R>>,
        (scene, how, rows): (&str, &str, usize),
    ) {
        let ticks = count::ticks_of(|| {
            frame(&mut renderer, color, drawing, &mut |strip| {
                black_box(strip);
            })
        });
        let mut hash = Hash::NEW;
        let Stats { drawn, culled, .. } = frame(&mut renderer, color, drawing, &mut |strip| hash.add(strip));
        println!("{scene} {how}/{rows} {ticks} {drawn} {culled} {:08x}", hash.0);
    }

    fn renderer(depth: &mut [u16]) -> Result<Renderer<'_, Rgb565, WithDepth>, RendererError> {
        Renderer::new(SCREEN)?.with_depth(depth)
    }

    #[inline(never)]
    fn report(memory: &mut Memory, scene: &str, drawing: &impl Ways) {
        for rows in [240, 16] {
            let pixels = 320 * rows;
            let Memory { color, depth, records } = memory;
            let (color, depth) = (&mut color[..pixels], &mut depth[..pixels + occlusion_len(320, rows)]);
            let Ok(plain) = renderer(depth) else { return };
            count(plain, color, drawing, (scene, "direct", rows));
            let Ok(plain) = renderer(depth) else { return };
            count(plain.with_records(records), color, drawing, (scene, "records", rows));
            let Ok(occluding) = renderer(depth).and_then(Renderer::with_occlusion) else { return };
            count(occluding, color, drawing, (scene, "direct+", rows));
            let Ok(occluding) = renderer(depth).and_then(Renderer::with_occlusion) else { return };
            count(occluding.with_records(records), color, drawing, (scene, "records+", rows));
        }
    }

    pub fn run() {
        let memory = &raw mut MEMORY;
        // SAFETY: `run` is called once; this is the only reference.
        let memory = unsafe { &mut *memory };
        if !count::start() {
            return;
        }
        let turn = Angle16(0);
        report(memory, "street_behind_a_wall", &Street::behind_a_wall(SCREEN, turn));
        report(memory, "street", &Street::open(SCREEN, turn));
        report(memory, "street_far_first", &Street::far_first(SCREEN, turn));
        report(memory, "torus", &Torus::gouraud(SCREEN, turn));
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/occlusion builds it");
}
