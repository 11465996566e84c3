//! A flange as CAD would export it: a plate with six countersunk bolt holes, and a hub with a bore. Millimetres, z up.

use earcut::Earcut;
use zstrip::math::Angle16;

type Point = [f64; 3];

/// Steps of circles around the axis, and of bolt holes.
const AROUND: usize = 48;
const HOLE: usize = 16;
const HOLES: usize = 6;

/// The outline from the outer edge of the plate's bottom, up and inwards to the fillet, radius and height.
const RIM: [[f64; 2]; 4] = [[48.0, 0.0], [50.0, 2.0], [50.0, 10.0], [48.0, 12.0]];
/// The radius at which the fillet between plate and hub begins; it ends at the hub's radius.
const FILLET: f64 = 27.0;
const FILLET_RADIUS: f64 = 5.0;
/// The outline from the hub's top to the bottom of its bore.
const BORE: [[f64; 2]; 5] = [[22.0, 32.0], [20.0, 34.0], [15.0, 34.0], [13.5, 32.5], [13.5, 1.5]];
/// The last point: where the bore meets the bottom of the plate.
const BORE_END: [f64; 2] = [15.0, 0.0];
/// The outline of a bolt hole from the top down.
const BOLT: [[f64; 2]; 3] = [[7.0, 12.0], [5.0, 10.0], [5.0, 0.0]];
const BOLT_CIRCLE: f64 = 38.0;

/// Returns a point of a circle at a part of a turn. The library's sine is the same on all hosts.
fn on_circle(radius: f64, step: usize, steps: usize) -> [f64; 2] {
    let angle = Angle16((step % steps * 65_536 / steps) as u16);
    [angle.cos(), angle.sin()].map(|c| c.to_num::<f64>() * radius)
}

/// Adds the faces of an outline that turns around an axis, with the solid to its left.
fn turn(triangles: &mut Vec<[Point; 3]>, outline: &[[f64; 2]], center: [f64; 2], steps: usize) {
    let at = |[radius, z]: [f64; 2], step: usize| {
        let [x, y] = on_circle(radius, step, steps);
        [center[0] + x, center[1] + y, z]
    };
    for pair in outline.windows(2) {
        for step in 0..steps {
            let [a, b] = [step, step + 1].map(|step| at(pair[0], step));
            let [d, c] = [step, step + 1].map(|step| at(pair[1], step));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
}

/// Adds a level ring with holes.
fn ring(triangles: &mut Vec<[Point; 3]>, outer: f64, inner: f64, hole: f64, z: f64, up: bool) {
    let mut flat: Vec<[f64; 2]> = (0..AROUND).map(|step| on_circle(outer, step, AROUND)).collect();
    let mut starts = vec![AROUND as u32];
    flat.extend((0..AROUND).map(|step| on_circle(inner, step, AROUND)));
    for bolt in 0..HOLES {
        let center = on_circle(BOLT_CIRCLE, bolt, HOLES);
        starts.push(flat.len() as u32);
        flat.extend((0..HOLE).map(|step| on_circle(hole, step, HOLE)).map(|[x, y]| [center[0] + x, center[1] + y]));
    }
    let mut ears: Vec<u32> = Vec::new();
    Earcut::new().earcut(flat.iter().copied(), &starts, &mut ears);
    for ear in ears.as_chunks::<3>().0 {
        let [a, b, c] = ear.map(|k| flat[k as usize]);
        let is_up = (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]);
        let [b, c] = if is_up == up { [b, c] } else { [c, b] };
        triangles.push([a, b, c].map(|[x, y]| [x, y, z]));
    }
}

/// Returns the flange as a binary STL file.
pub fn stl() -> Vec<u8> {
    let mut triangles = Vec::new();
    turn(&mut triangles, &RIM, [0.0; 2], AROUND);
    ring(&mut triangles, RIM[3][0], FILLET, BOLT[0][0], RIM[3][1], true);
    // A quarter of a circle around a point above the plate and beside the hub, in four steps.
    let mut outline: Vec<[f64; 2]> = (0..=4)
        .map(|step| {
            let [cos, sin] = on_circle(FILLET_RADIUS, step, 16);
            [FILLET - sin, RIM[3][1] + FILLET_RADIUS - cos]
        })
        .collect();
    outline.extend(BORE);
    outline.push(BORE_END);
    turn(&mut triangles, &outline, [0.0; 2], AROUND);
    for bolt in 0..HOLES {
        turn(&mut triangles, &BOLT, on_circle(BOLT_CIRCLE, bolt, HOLES), HOLE);
    }
    ring(&mut triangles, RIM[0][0], BORE_END[0], BOLT[2][0], 0.0, false);

    let mut file = vec![0; 80];
    file.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        // Normals may be zero: readers make them from the corners.
        file.extend([0; 12]);
        file.extend(corners.as_flattened().iter().flat_map(|c| (*c as f32).to_le_bytes()));
        file.extend([0; 2]);
    }
    file
}
