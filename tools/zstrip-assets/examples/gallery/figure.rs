//! A figure with a skeleton, and three clips: it stands, walks and runs. Its skin is a smooth surface around capsules,
//! found on a grid; its vertices follow the joints that are near, with weights that change smoothly.
//!
//! y is up, the figure looks along z, its left is x. Units are metres.

use serde_json::{Value, json};
use zstrip::math::Angle16;

type Point = [f64; 3];
type Quaternion = [f64; 4];

/// A joint, at rest without a rotation.
struct Joint {
    name: &'static str,
    parent: Option<usize>,
    at: Point,
}

const fn joint(name: &'static str, parent: usize, at: Point) -> Joint {
    Joint { name, parent: Some(parent), at }
}

/// Numbers of joints; of pairs, the left one.
const HIPS: usize = 0;
const SPINE: usize = 1;
const HEAD: usize = 2;
const ARMS: usize = 3;
const FOREARMS: usize = 5;
const THIGHS: usize = 7;
const SHINS: usize = 9;
const FEET: usize = 11;

/// The skeleton; pairs are left and right.
const JOINTS: [Joint; 13] = [
    Joint { name: "hips", parent: None, at: [0.0, 0.95, 0.0] },
    joint("spine", HIPS, [0.0, 1.06, 0.0]),
    joint("head", SPINE, [0.0, 1.48, 0.0]),
    joint("left arm", SPINE, [0.18, 1.40, 0.0]),
    joint("right arm", SPINE, [-0.18, 1.40, 0.0]),
    joint("left forearm", ARMS, [0.39, 1.20, 0.0]),
    joint("right forearm", ARMS + 1, [-0.39, 1.20, 0.0]),
    joint("left thigh", HIPS, [0.10, 0.92, 0.0]),
    joint("right thigh", HIPS, [-0.10, 0.92, 0.0]),
    joint("left shin", THIGHS, [0.12, 0.52, 0.01]),
    joint("right shin", THIGHS + 1, [-0.12, 0.52, 0.01]),
    joint("left foot", SHINS, [0.14, 0.10, -0.01]),
    joint("right foot", SHINS + 1, [-0.14, 0.10, -0.01]),
];

/// Colours as glTF has them: linear light.
const SHIRT: [f32; 3] = [0.75, 0.12, 0.06];
const TROUSERS: [f32; 3] = [0.05, 0.10, 0.28];
const SKIN: [f32; 3] = [0.78, 0.45, 0.28];
const SHOES: [f32; 3] = [0.05, 0.04, 0.04];
const HAIR: [f32; 3] = [0.12, 0.05, 0.02];

/// A capsule whose radius changes from end to end.
struct Capsule {
    joint: usize,
    ends: [Point; 2],
    radii: [f64; 2],
    color: [f32; 3],
}

const fn capsule(joint: usize, ends: [Point; 2], radii: [f64; 2], color: [f32; 3]) -> Capsule {
    Capsule { joint, ends, radii, color }
}

/// The capsules of the middle and of the left. Those of the right are mirror images.
const BODY: [Capsule; 12] = [
    capsule(HIPS, [[-0.06, 0.96, 0.0], [0.06, 0.96, 0.0]], [0.12, 0.12], TROUSERS),
    capsule(SPINE, [[0.0, 1.06, 0.0], [0.0, 1.42, 0.0]], [0.11, 0.09], SHIRT),
    capsule(HEAD, [[0.0, 1.48, 0.0], [0.0, 1.56, 0.01]], [0.05, 0.05], SKIN),
    capsule(HEAD, [[0.0, 1.64, 0.0], [0.0, 1.68, 0.01]], [0.10, 0.115], SKIN),
    capsule(HEAD, [[0.0, 1.66, 0.10], [0.0, 1.64, 0.11]], [0.015, 0.02], SKIN),
    capsule(SPINE, [[0.06, 1.06, 0.0], [0.11, 1.36, 0.0]], [0.10, 0.10], SHIRT),
    capsule(ARMS, [[0.19, 1.39, 0.0], [0.39, 1.20, 0.0]], [0.065, 0.05], SHIRT),
    capsule(FOREARMS, [[0.39, 1.20, 0.0], [0.54, 1.06, 0.02]], [0.05, 0.036], SKIN),
    capsule(FOREARMS, [[0.57, 1.03, 0.02], [0.61, 0.99, 0.03]], [0.045, 0.035], SKIN),
    capsule(THIGHS, [[0.10, 0.90, 0.0], [0.12, 0.52, 0.01]], [0.10, 0.068], TROUSERS),
    capsule(SHINS, [[0.12, 0.52, 0.01], [0.14, 0.12, -0.01]], [0.068, 0.05], TROUSERS),
    capsule(FEET, [[0.14, 0.06, -0.04], [0.155, 0.05, 0.13]], [0.055, 0.045], SHOES),
];

/// Cells of the grid, and how far capsules flow into each other.
const CELL: f64 = 0.044;
const FLOW: f64 = 0.05;
/// Samples of the grid: from -x to x, from the floor up, from back to front.
const SAMPLES: [usize; 3] = [33, 45, 12];
const ORIGIN: Point = [-16.0 * CELL, -0.05, -5.0 * CELL];

fn plus(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[k] + b[k])
}

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[k] - b[k])
}

fn times(a: Point, factor: f64) -> Point {
    a.map(|c| c * factor)
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Capsule {
    fn distance(&self, p: Point) -> f64 {
        let (along, from) = (minus(self.ends[1], self.ends[0]), minus(p, self.ends[0]));
        let part = (dot(from, along) / dot(along, along)).clamp(0.0, 1.0);
        let away = minus(from, times(along, part));
        dot(away, away).sqrt() - (self.radii[0] + (self.radii[1] - self.radii[0]) * part)
    }
}

/// Returns all capsules.
fn body() -> Vec<Capsule> {
    let mirrored = BODY.into_iter().filter(|capsule| capsule.ends[1][0] > 0.07).map(|capsule| {
        let ends = capsule.ends.map(|[x, y, z]| [-x, y, z]);
        let joint = if capsule.joint < ARMS { capsule.joint } else { capsule.joint + 1 };
        Capsule { joint, ends, ..capsule }
    });
    BODY.into_iter().chain(mirrored).collect()
}

/// Returns the distance from the skin: below 0 inside.
fn distance(body: &[Capsule], p: Point) -> f64 {
    body.iter().map(|capsule| capsule.distance(p)).fold(f64::INFINITY, |a, b| {
        let near = (FLOW - (a - b).abs()).max(0.0) / FLOW;
        a.min(b) - near * near * FLOW / 4.0
    })
}

/// Returns the outward normal of the skin.
fn normal(body: &[Capsule], p: Point) -> Point {
    let slope = std::array::from_fn(|k| {
        let mut step = [0.0; 3];
        step[k] = 0.004;
        distance(body, plus(p, step)) - distance(body, minus(p, step))
    });
    times(slope, 1.0 / dot(slope, slope).sqrt())
}

/// Returns points of the skin and quads between them: one point in each cell that the skin runs through ("surface
/// nets"), one quad around each edge of the grid that it cuts.
fn skin(body: &[Capsule]) -> (Vec<Point>, Vec<[u32; 4]>) {
    let [nx, ny, _] = SAMPLES;
    let place = |s: [usize; 3]| std::array::from_fn::<f64, 3, _>(|k| ORIGIN[k] + s[k] as f64 * CELL);
    let number = |[x, y, z]: [usize; 3]| (z * ny + y) * nx + x;
    let all = |size: [usize; 3]| {
        (0..size[2]).flat_map(move |z| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y, z])))
    };
    let values: Vec<f64> = all(SAMPLES).map(|s| distance(body, place(s))).collect();
    let (mut points, mut cells) = (Vec::new(), vec![u32::MAX; values.len()]);
    for s in all(SAMPLES.map(|n| n - 1)) {
        let corner = |k: usize| [s[0] + (k & 1), s[1] + (k >> 1 & 1), s[2] + (k >> 2)];
        let (mut sum, mut cuts) = ([0.0; 3], 0.0);
        for (a, b) in (0..8).flat_map(|a| [1, 2, 4].map(|bit| (a, a | bit))).filter(|(a, b)| a != b) {
            let [va, vb] = [a, b].map(|k| values[number(corner(k))]);
            if (va < 0.0) != (vb < 0.0) {
                let [pa, pb] = [a, b].map(|k| place(corner(k)));
                sum = plus(sum, plus(pa, times(minus(pb, pa), va / (va - vb))));
                cuts += 1.0;
            }
        }
        if cuts > 0.0 {
            cells[number(s)] = points.len() as u32;
            let p = times(sum, 1.0 / cuts);
            points.push(minus(p, times(normal(body, p), distance(body, p))));
        }
    }
    let mut quads = Vec::new();
    for s in all(SAMPLES.map(|n| n - 1)).filter(|s| s.iter().all(|c| *c > 0)) {
        for axis in 0..3 {
            let mut next = s;
            next[axis] += 1;
            let [inside, other] = [s, next].map(|s| values[number(s)] < 0.0);
            if inside == other {
                continue;
            }
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let cell = |du: usize, dv: usize| {
                let mut c = s;
                (c[u], c[v]) = (c[u] - du, c[v] - dv);
                cells[number(c)]
            };
            let quad = [cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)];
            quads.push(if inside { quad } else { [quad[3], quad[2], quad[1], quad[0]] });
        }
    }
    (points, quads)
}

/// Returns the joints that a point follows, and their weights: the nearest one, its parent and its children.
fn influences(body: &[Capsule], p: Point) -> ([u8; 4], [f32; 4]) {
    let mut far = [f64::INFINITY; JOINTS.len()];
    for capsule in body {
        far[capsule.joint] = far[capsule.joint].min(capsule.distance(p));
    }
    let nearest = (0..far.len()).min_by(|a, b| far[*a].total_cmp(&far[*b])).unwrap_or(0);
    let linked = |k: &usize| *k == nearest || JOINTS[*k].parent == Some(nearest) || JOINTS[nearest].parent == Some(*k);
    let weight = |k: usize| (0.05 / (far[k].max(0.0) + 0.05)).powi(3);
    let mut all: Vec<(usize, f64)> = (0..far.len()).filter(linked).map(|k| (k, weight(k))).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.retain(|(_, weight)| *weight > 0.02);
    all.truncate(4);
    let sum: f64 = all.iter().map(|(_, weight)| weight).sum();
    let at = |k: usize| all.get(k).copied().unwrap_or((0, 0.0));
    (std::array::from_fn(|k| at(k).0 as u8), std::array::from_fn(|k| (at(k).1 / sum) as f32))
}

/// Returns the colour of a point: that of the nearest capsule, but for hair, and for a belt line that is level.
fn color(body: &[Capsule], [x, y, z]: Point) -> [f32; 3] {
    let nearest = body.iter().min_by(|a, b| a.distance([x, y, z]).total_cmp(&b.distance([x, y, z])));
    match nearest {
        _ if y > 1.72 || y > 1.60 && z < 0.02 => HAIR,
        Some(capsule) if capsule.joint <= SPINE => {
            if y < 1.04 {
                TROUSERS
            } else {
                SHIRT
            }
        }
        Some(capsule) => capsule.color,
        None => SKIN,
    }
}

/// Returns sine and cosine of an angle in degrees. The library's sine is the same on all hosts.
fn sin_cos(degrees: f64) -> [f64; 2] {
    let angle = Angle16((degrees / 360.0 * 65_536.0).round() as i64 as u16);
    [angle.sin(), angle.cos()].map(|c| c.to_num())
}

/// Returns the rotation around an axis of length 1.
fn turn([x, y, z]: Point, degrees: f64) -> Quaternion {
    let [sin, cos] = sin_cos(degrees / 2.0);
    [x * sin, y * sin, z * sin, cos]
}

/// Returns the rotation by `b`, and then by `a`.
fn then([ax, ay, az, aw]: Quaternion, [bx, by, bz, bw]: Quaternion) -> Quaternion {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// A way to move, in degrees: the most, or the mean and the most.
struct Gait {
    name: &'static str,
    seconds: f32,
    thigh: [f64; 2],
    knee: [f64; 2],
    arm: f64,
    elbow: f64,
    lean: f64,
    breath: f64,
    twist: f64,
    /// Metres that a step leaves the ground by.
    flight: f64,
}

const GAITS: [Gait; 3] = [
    Gait {
        name: "stand",
        seconds: 3.0,
        thigh: [2.0, 0.0],
        knee: [4.0, 0.0],
        arm: 0.0,
        elbow: 12.0,
        lean: 0.0,
        breath: 1.5,
        twist: 0.0,
        flight: 0.0,
    },
    Gait {
        name: "walk",
        seconds: 1.0,
        thigh: [5.0, 25.0],
        knee: [6.0, 48.0],
        arm: 24.0,
        elbow: 20.0,
        lean: 2.0,
        breath: 0.0,
        twist: 5.0,
        flight: 0.0,
    },
    Gait {
        name: "run",
        seconds: 0.7,
        thigh: [14.0, 42.0],
        knee: [18.0, 85.0],
        arm: 42.0,
        elbow: 85.0,
        lean: 9.0,
        breath: 0.0,
        twist: 9.0,
        flight: 0.06,
    },
];

/// Steps of a clip.
const STEPS: usize = 16;

const X: Point = [1.0, 0.0, 0.0];
const Y: Point = [0.0, 1.0, 0.0];
const Z: Point = [0.0, 0.0, 1.0];

/// The rotations of a leg around x: thigh, knee, ankle. A leg swings forwards against the sense of x.
fn leg(gait: &Gait, degrees: f64) -> [f64; 3] {
    let thigh = gait.thigh[0] + gait.thigh[1] * sin_cos(degrees)[0];
    // The knee bends while the leg swings forwards.
    let swing = sin_cos(degrees + 30.0)[1].max(0.0);
    let knee = gait.knee[0] + gait.knee[1] * swing * swing;
    [-thigh, knee, ((thigh - knee) * 0.8).clamp(-22.0, 22.0)]
}

/// Returns the height of the lowest point of a foot's sole, from the hips' joint.
fn lowest(angles: [f64; 3]) -> f64 {
    let (mut turned, mut at) = (0.0, [JOINTS[THIGHS].at[1] - JOINTS[HIPS].at[1], 0.0]);
    let mut low = f64::INFINITY;
    let sole = [[-0.10, -0.07], [-0.10, 0.17]];
    for (k, angle) in angles.into_iter().enumerate() {
        turned += angle;
        let [sin, cos] = sin_cos(turned);
        let ahead = |[y, z]: [f64; 2]| [at[0] + y * cos - z * sin, at[1] + y * sin + z * cos];
        if k == 2 {
            low = sole.into_iter().map(|point| ahead(point)[0]).fold(low, f64::min);
        } else {
            let [from, to] = [[THIGHS, SHINS], [SHINS, FEET]][k].map(|joint| JOINTS[joint].at);
            at = ahead([to[1] - from[1], to[2] - from[2]]);
        }
    }
    low
}

/// Returns the height of the hips and the rotations of all joints, at a part of a clip.
fn pose(gait: &Gait, step: usize) -> (f64, [Quaternion; JOINTS.len()]) {
    let degrees = step as f64 * 360.0 / STEPS as f64;
    let [sin, _] = sin_cos(degrees);
    let mut turns = [[0.0, 0.0, 0.0, 1.0]; JOINTS.len()];
    let lean = gait.lean + gait.breath * sin;
    turns[HIPS] = turn(Y, -gait.twist * sin);
    turns[SPINE] = then(turn(Y, 2.0 * gait.twist * sin), turn(X, lean));
    turns[HEAD] = then(turn(Y, -gait.twist * sin), turn(X, -lean));
    let mut low = f64::INFINITY;
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        let angles = leg(gait, degrees + 180.0 * side as f64);
        low = low.min(lowest(angles));
        for (joint, angle) in [THIGHS, SHINS, FEET].into_iter().zip(angles) {
            turns[joint + side] = turn(X, angle);
        }
        // Arms hang, and swing against the legs.
        let swing = gait.arm * sin * sign;
        turns[ARMS + side] = then(turn(X, swing), turn(Z, -38.0 * sign));
        let half = 0.5_f64.sqrt();
        let bend = gait.elbow - 0.4 * swing;
        turns[FOREARMS + side] = turn([-half, -half * sign, 0.0], bend);
    }
    // Both feet are off the ground twice in a turn, before they land.
    let [flight, _] = sin_cos(2.0 * degrees + 60.0);
    (gait.flight * flight.max(0.0) - low, turns)
}

/// The binary part of a GLB file, and what the document says of it.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds an accessor, and returns its number.
    fn add(
        &mut self,
        kind: &str,
        component: u32,
        count: usize,
        bytes: Vec<u8>,
        bounds: Option<[Vec<f32>; 2]>,
    ) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut accessor =
            json!({ "bufferView": self.views.len() - 1, "componentType": component, "count": count, "type": kind });
        if let Some([min, max]) = bounds {
            (accessor["min"], accessor["max"]) = (json!(min), json!(max));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, kind: &str, rows: &[[f32; N]]) -> usize {
        let bounds = |pick: fn(f32, f32) -> f32| {
            (0..N).map(|k| rows.iter().map(|row| row[k]).reduce(pick).unwrap_or(0.0)).collect()
        };
        let bytes = rows.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
        let bounds = [bounds(f32::min), bounds(f32::max)];
        self.add(kind, 5126, rows.len(), bytes, Some(bounds))
    }
}

fn single<const N: usize>(numbers: [f64; N]) -> [f32; N] {
    numbers.map(|c| c as f32)
}

/// Returns a clip.
fn animation(buffer: &mut Buffer, gait: &Gait) -> Value {
    let times: Vec<[f32; 1]> = (0..=STEPS).map(|step| [gait.seconds * step as f32 / STEPS as f32]).collect();
    let input = buffer.floats("SCALAR", &times);
    let poses: Vec<_> = (0..=STEPS).map(|step| pose(gait, step % STEPS)).collect();
    let heights: Vec<[f32; 3]> = poses.iter().map(|(height, _)| single([0.0, *height, 0.0])).collect();
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    let mut add = |node: usize, path: &str, output: usize| {
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
        samplers.push(json!({ "input": input, "output": output }));
    };
    add(HIPS, "translation", buffer.floats("VEC3", &heights));
    for node in 0..JOINTS.len() {
        let turns: Vec<[f32; 4]> = poses.iter().map(|(_, turns)| single(turns[node])).collect();
        add(node, "rotation", buffer.floats("VEC4", &turns));
    }
    json!({ "name": gait.name, "samplers": samplers, "channels": channels })
}

/// Returns the figure as a GLB file.
pub fn glb() -> Vec<u8> {
    let body = body();
    let (points, quads) = skin(&body);
    let far = |a: u32, b: u32| {
        let along = minus(points[a as usize], points[b as usize]);
        dot(along, along)
    };
    let triangles: Vec<u32> = quads
        .iter()
        .flat_map(
            |[a, b, c, d]| {
                if far(*a, *c) <= far(*b, *d) { [*a, *b, *c, *a, *c, *d] } else { [*a, *b, *d, *b, *c, *d] }
            },
        )
        .collect();
    let (joints, weights): (Vec<_>, Vec<_>) = points.iter().map(|p| influences(&body, *p)).unzip();

    let mut buffer = Buffer::default();
    let each = |value: &dyn Fn(Point) -> [f32; 3]| points.iter().map(|p| value(*p)).collect::<Vec<_>>();
    let attributes = json!({
        "POSITION": buffer.floats("VEC3", &each(&single)),
        "NORMAL": buffer.floats("VEC3", &each(&|p| single(normal(&body, p)))),
        "COLOR_0": buffer.floats("VEC3", &each(&|p| color(&body, p))),
        "JOINTS_0": buffer.add("VEC4", 5121, points.len(), joints.concat(), None),
        "WEIGHTS_0": buffer.floats("VEC4", &weights),
    });
    let indices = triangles.iter().flat_map(|k| k.to_le_bytes()).collect();
    let indices = buffer.add("SCALAR", 5125, triangles.len(), indices, None);
    // Columns of matrices that move a joint to the origin.
    let binds: Vec<[f32; 16]> = JOINTS
        .iter()
        .map(|joint| {
            let [x, y, z] = single(joint.at).map(|c| -c);
            [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0]
        })
        .collect();
    let binds = buffer.floats("MAT4", &binds);
    let mut nodes: Vec<Value> = (0..JOINTS.len())
        .map(|k| {
            let from = JOINTS[k].parent.map_or([0.0; 3], |parent| JOINTS[parent].at);
            let mut node = json!({ "name": JOINTS[k].name, "translation": single(minus(JOINTS[k].at, from)) });
            let children: Vec<_> = (0..JOINTS.len()).filter(|child| JOINTS[*child].parent == Some(k)).collect();
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            node
        })
        .collect();
    nodes.push(json!({ "name": "figure", "mesh": 0, "skin": 0 }));
    let animations: Vec<_> = GAITS.iter().map(|gait| animation(&mut buffer, gait)).collect();
    let document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [HIPS, JOINTS.len()] }],
        "nodes": nodes,
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": indices }] }],
        "skins": [{ "inverseBindMatrices": binds, "joints": (0..JOINTS.len()).collect::<Vec<_>>() }],
        "animations": animations,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + buffer.bytes.len();
    let mut file = b"glTF".to_vec();
    file.extend([2, length as u32, text.len() as u32].into_iter().flat_map(u32::to_le_bytes));
    file.extend(b"JSON");
    file.extend(text);
    file.extend((buffer.bytes.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(buffer.bytes);
    file
}
