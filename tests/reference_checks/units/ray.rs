use crate::reference::homogeneous::{self, Vertex, Viewport};
use crate::reference::ray::*;
use crate::reference::rng::Rng;

const LIGHT: Light = Light { ambient: 0.2, diffuse: 0.8, direction: [0.0, 0.6, 0.8] };
const LENSES: [Lens; 2] = [Lens::Perspective { tan_half_fov: 0.5 }, Lens::Orthographic { half_height: 2.5 }];

fn scene(triangles: Vec<Triangle>, quadrics: Vec<Quadric>, cull: Cull) -> Scene {
    let background = [0.0; 3];
    Scene { triangles, quadrics, light: LIGHT, background, cull }
}

fn camera(lens: Lens) -> Camera {
    let mut camera = Camera::look_at([1.0, 2.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], lens, 1.5);
    (camera.near, camera.far) = (2.0, 9.0);
    camera
}

/// The same picture by homogeneous rasterization.
fn rasterize(scene: &Scene, camera: &Camera, width: u32, height: u32) -> Frame {
    let mut frame = Frame::new(width, height, scene.background);
    let viewport = Viewport::new(width, height);
    for t in &scene.triangles {
        let [a, b, c] = t.corners;
        let normal = normalize(cross(sub(b, a), sub(c, a)));
        let vertices = t.corners.map(|p| Vertex { position: camera.clip_position(p), attributes: p });
        homogeneous::draw(&mut frame, &viewport, scene.cull, &vertices, t.id, |s| {
            let side = if s.front { normal } else { normal.map(|n| -n) };
            // The attributes are the position in the world: the ray through this pixel must pass there.
            let ray = camera.ray((width, height), f64::from(s.x) + 0.5, f64::from(s.y) + 0.5);
            let distance = dot(sub(s.perspective, ray.origin), camera.forward);
            let miss = sub(ray.at(distance), s.perspective);
            assert!(dot(miss, miss) < 1e-16, "{s:?}");
            scene.light.shade(t.color, side)
        });
    }
    frame
}

#[test]
fn agrees_with_homogeneous_rasterization() {
    let (mut drawn, mut near, mut beyond) = (0, 0, 0);
    for seed in 0..24 {
        let mut rng = Rng::new(seed);
        let lens = rng.pick(&LENSES);
        let cull = rng.pick(&[Cull::None, Cull::Back, Cull::Front]);
        let mut coordinate = || rng.unit() * 14.0 - 7.0;
        // Large enough to cross the near and far planes, and to reach behind the eye.
        let triangles = (1..=9).map(|id| Triangle {
            corners: [(); 3].map(|()| [coordinate(), coordinate(), coordinate()]),
            color: [coordinate(), coordinate(), coordinate()],
            id,
        });
        let scene = scene(triangles.collect(), Vec::new(), cull);
        let camera = camera(lens);
        let rays = scene.render(&camera, 48, 32);
        let raster = rasterize(&scene, &camera, 48, 32);
        let result = rays.compare(&raster, 1e-6, 1e-9);
        let case = format!("seed {seed} {lens:?} {cull:?}: {result:?}");
        assert_eq!(result.other_id, 0, "{case}");
        assert!(result.compared >= 48 * 32 - 3, "{case}");
        assert!(result.depth_error < 1e-9 && result.color_error < 1e-9, "{case}");
        // Margins are measured alike, but the rasterizer does not look far beyond the tips of a triangle.
        for (a, b) in rays.margin.iter().zip(&raster.margin).filter(|(a, _)| **a < 1.0) {
            assert!(*b > a - 1e-6, "{case}");
            near += 1;
            beyond += u32::from(*b > a + 1e-6);
        }
        drawn += rays.id.iter().filter(|&&id| id != 0).count();
    }
    // Half the pixels show something, and enough of them are near an edge.
    assert!((10_000..30_000).contains(&drawn), "{drawn}");
    assert!(near > 3000 && beyond * 50 < near, "{beyond} of {near}");
}

#[test]
fn sphere_is_a_disc_of_the_right_size_and_shade() {
    let light = Light { direction: [0.0, 0.0, 1.0], ..LIGHT };
    let sphere = Quadric::sphere([0.0; 3], 1.0, [1.0; 3], 4);
    let scene = Scene { light, ..scene(Vec::new(), vec![sphere], Cull::Back) };
    let lens = Lens::Orthographic { half_height: 1.25 };
    let camera = Camera::look_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], lens, 1.0);
    let frame = scene.render(&camera, 80, 80);
    for y in 0..80 {
        for x in 0..80 {
            let i = frame.index(x, y);
            // 32 px to the unit.
            let radius = (f64::from(x) - 39.5).hypot(f64::from(y) - 39.5) / 32.0;
            assert_eq!(frame.id[i] == 4, radius < 1.0);
            assert!(frame.margin[i] > 0.0);
            if (radius - 1.0).abs() < 0.05 {
                let distance = (radius - 1.0).abs() * 32.0;
                assert!((frame.margin[i] / distance - 1.0).abs() < 0.06);
            }
            if radius < 1.0 {
                let height = (1.0 - radius * radius).sqrt();
                assert!((frame.color[i][0] - 0.2 - 0.8 * height).abs() < 1e-9);
                assert!((frame.depth[i] - camera.depth(5.0 - height)).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn cylinder_shows_its_inside_unless_culled() {
    let cylinder = Quadric::cylinder([0.0; 3], 1.0, 0.5, [1.0; 3], 1);
    let from_above = Ray { origin: [0.0, 2.0, 3.0], direction: [0.0, -0.5, -1.0] };
    let open = scene(Vec::new(), vec![cylinder], Cull::None);
    // Over the front rim (y = 1 at z = 1), down to the inside of the back (y = 0 at z = -1).
    let (hit, _) = open.nearest(&from_above, 0.0, 9.0).expect("the inside");
    assert_eq!((hit.t, hit.front, hit.normal), (4.0, false, [0.0, 0.0, 1.0]));
    let culled = scene(Vec::new(), vec![cylinder], Cull::Back);
    assert_eq!(culled.nearest(&from_above, 0.0, 9.0), None);
    let level = Ray { origin: [0.0, 0.0, 3.0], direction: [0.0, 0.0, -1.0] };
    let (hit, _) = culled.nearest(&level, 0.0, 9.0).expect("the outside");
    assert_eq!((hit.t, hit.point), (2.0, [0.0, 0.0, 1.0]));
    assert!(hit.front);
}

#[test]
fn mesh_of_a_sphere_tends_to_the_sphere() {
    let radii = [1.5, 1.0, 0.75];
    let corner = |i: u32, j: u32| {
        let (lon, lat) = (f64::from(i) * 0.1, f64::from(j) * 0.1 - 1.6);
        let (lon, lat) = (lon * std::f64::consts::PI / 3.2, lat * std::f64::consts::PI / 3.2);
        let unit = [lat.cos() * lon.sin(), lat.sin(), lat.cos() * lon.cos()];
        [unit[0] * radii[0], unit[1] * radii[1], unit[2] * radii[2]]
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..64).flat_map(|i| (0..32).map(move |j| (i, j))) {
        let [a, b] = [corner(i, j), corner(i + 1, j)];
        let [c, d] = [corner(i, j + 1), corner(i + 1, j + 1)];
        for corners in [[a, b, d], [a, d, c]] {
            triangles.push(Triangle { corners, color: [1.0; 3], id: 1 });
        }
    }
    let mesh = scene(triangles, Vec::new(), Cull::Back);
    let quadric = Quadric::ellipsoid([0.0; 3], radii, [1.0; 3], 1);
    let quadric = scene(Vec::new(), vec![quadric], Cull::Back);
    for lens in LENSES {
        let camera = camera(lens);
        let mesh = rasterize(&mesh, &camera, 48, 32);
        let exact = quadric.render(&camera, 48, 32);
        // The mesh's inner edges say nothing about its silhouette: take the margin of the quadric alone.
        let mesh = Frame { margin: vec![9.0; 48 * 32], ..mesh };
        let result = exact.compare(&mesh, 0.1, 0.0);
        assert_eq!(result.other_id, 0, "{lens:?} {result:?}");
        assert!(result.compared > 1450, "{lens:?} {result:?}");
        assert!(result.depth_error < 0.01, "{lens:?} {result:?}");
        assert!(result.color_error < 0.08, "{lens:?} {result:?}");
    }
}
