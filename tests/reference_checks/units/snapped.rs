use crate::reference::frame::{Cull, Frame};
use crate::reference::homogeneous;
use crate::reference::rng::Rng;
use crate::reference::snapped::*;

fn random(rng: &mut Rng) -> [SnappedVertex; 3] {
    [(); 3].map(|()| SnappedVertex {
        position: [rng.between(-2000, 10_000), rng.between(-2000, 10_000)],
        depth: rng.between(0, 65535) as u16,
        color: [rng.unit(), rng.unit(), rng.unit()],
    })
}

/// The same triangle in clip space, with w = 1.
fn unsnap(tri: &[SnappedVertex; 3]) -> [homogeneous::Vertex<3>; 3] {
    tri.map(|v| {
        let [x, y] = v.position.map(|c| f64::from(c) / 4096.0 - 1.0);
        homogeneous::Vertex { position: [x, -y, f64::from(v.depth) / 65535.0, 1.0], attributes: v.color }
    })
}

#[test]
fn agrees_with_homogeneous_rasterization() {
    let seed = 5;
    let mut rng = Rng::new(seed);
    for cull in [Cull::None, Cull::Back, Cull::Front] {
        let tris: Vec<_> = (0..30).map(|_| random(&mut rng)).collect();
        let snapped = render((32, 32), [0.0; 3], cull, Shading::Gouraud, &tris);
        let mut other = Frame::new(32, 32, [0.0; 3]);
        let viewport = homogeneous::Viewport::new(32, 32);
        for (tri, id) in tris.iter().zip(1..) {
            homogeneous::draw(&mut other, &viewport, cull, &unsnap(tri), id, |s| s.linear);
        }
        let result = snapped.compare(&other, 1e-6, 1.5 / 65535.0);
        assert_eq!(result.other_id, 0, "seed {seed} {cull:?}: {result:?}");
        assert!(result.compared > 900, "{result:?}");
        assert!(result.depth_error < 0.501 / 65535.0, "{result:?}");
        assert!(result.color_error < 1e-9, "{result:?}");
    }
}

#[test]
fn flat_takes_the_first_vertex_and_ties_keep_the_first_triangle() {
    let mut rng = Rng::new(9);
    let mut tri = random(&mut rng);
    tri[0].position = [0, 0];
    tri[1].position = [2560, 0];
    tri[2].position = [0, 2560];
    let mut second = tri;
    second[0].color = [9.0; 3];
    let frame = render((8, 8), [0.0; 3], Cull::None, Shading::Flat, &[tri, second]);
    assert_eq!((frame.id[0], frame.color[0]), (1, tri[0].color));
    assert_eq!(frame.gap[0], 0.0);
    assert_eq!(frame.id[63], 0);
}
