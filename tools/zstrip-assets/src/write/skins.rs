//! Skins: joints that move vertices, without those that move none.

use zstrip::model::container::{Influence, Joint, SectionKind, Skin};

use super::parts::Piece;
use super::quantize::{Cube, Extent, fixed, float, fraction_box};
use super::report::{WriteError, WriteNote, WriteReport};
use super::sections::Sections;
use crate::model::Import;

/// The most joints of a skin.
const MOST_JOINTS: usize = 256;

/// Returns, for each skin, the cube that all of its parts share, and the numbers that its joints get.
pub(super) fn skins(
    import: &Import,
    pieces: &[Piece],
    report: &mut WriteReport,
) -> Result<Vec<(Cube, Vec<u16>)>, WriteError> {
    let mut skins = Vec::new();
    let mut unused = 0;
    for (k, skin) in import.skins.iter().enumerate() {
        let (mut extent, mut longest) = (Extent::EMPTY, 0.0_f64);
        let mut used = vec![false; skin.joints.len()];
        for piece in pieces.iter().filter(|piece| piece.skin == Some(k)) {
            let (own, length) = piece.extent();
            extent.join(&own);
            longest = longest.max(length);
            for (joints, weights) in piece.vertices.joints.iter().zip(&piece.vertices.weights) {
                for (joint, weight) in joints.iter().zip(weights) {
                    used[usize::from(*joint)] |= *weight > 0.0;
                }
            }
        }
        // A skin has one joint at least. Vertices without weights follow the first one.
        used[0] |= !used.contains(&true) || pieces.iter().any(|piece| piece.skin == Some(k) && weightless(piece));
        let found = used.iter().filter(|is_used| **is_used).count();
        if found > MOST_JOINTS {
            return Err(WriteError::TooMany { what: "joints of a skin", found, most: MOST_JOINTS });
        }
        unused += used.len() - found;
        let mut next = 0..;
        let numbers = used.iter().map(|is_used| if *is_used { next.next() } else { None }.unwrap_or(u16::MAX));
        skins.push((Cube::around(&extent, longest, &format!("the size of skins[{k}]"))?, numbers.collect()));
    }
    report.note(unused, |joints| WriteNote::UnusedJoints { joints });
    Ok(skins)
}

/// Returns whether a vertex has no weight at all.
fn weightless(piece: &Piece) -> bool {
    piece.vertices.weights.iter().any(|weights| weights.iter().all(|w| *w <= 0.0))
}

/// Writes the joints, with boxes around the vertices that they move.
pub(super) fn write(
    import: &Import,
    pieces: &[Piece],
    written: &[(Vec<[i16; 3]>, Vec<Influence>)],
    skins: &[(Cube, Vec<u16>)],
    nodes: &[u16],
    to: &mut Sections,
) -> Result<(), WriteError> {
    for (k, (skin, (cube, numbers))) in import.skins.iter().zip(skins).enumerate() {
        let mut moved = vec![Vec::new(); numbers.len().min(MOST_JOINTS)];
        let of_skin = pieces.iter().zip(written).filter(|(piece, _)| piece.skin == Some(k));
        for (piece, (points, influences)) in of_skin {
            // Morph targets move vertices before joints do.
            let corners = |v: usize| {
                let extent = piece.reach_of(v);
                [cube.point(extent.low), cube.point(extent.high), points[v]]
            };
            for (v, influence) in influences.iter().enumerate() {
                let weights = [1, influence.weights[0], influence.weights[1], influence.weights[2]];
                for (joint, _) in influence.joints.iter().zip(weights).filter(|(_, weight)| *weight > 0) {
                    moved[usize::from(*joint)].extend(corners(v));
                }
            }
        }
        let first_joint = to.count(SectionKind::Joints);
        for (j, number) in numbers.iter().enumerate().filter(|(_, number)| **number != u16::MAX) {
            let points = &moved[usize::from(*number)];
            let (center, half) = fraction_box(points.iter().copied());
            // Columns of the matrix, after scale and offset of the cube.
            let bind = skin.inverse_binds[j].map(|column| column.map(f64::from));
            let mut rows = [[0; 4]; 3];
            for (row, to) in rows.iter_mut().enumerate() {
                let place = || format!("skins[{k}], inverse bind matrix {j}");
                for column in 0..3 {
                    to[column] = fixed(bind[column][row] * float(cube.scale), place)?;
                }
                let offset: f64 = (0..3).map(|c| bind[c][row] * float(cube.offset[c])).sum();
                to[3] = fixed(bind[3][row] + offset, place)?;
            }
            let item = Joint {
                inverse_bind: rows,
                center,
                half,
                node: nodes[skin.joints[j]],
                used: u16::from(!points.is_empty()),
            };
            to.add(SectionKind::Joints, &[item]);
        }
        let joints = to.count(SectionKind::Joints) - first_joint;
        to.add(SectionKind::Skins, &[Skin { first_joint, joints }]);
    }
    Ok(())
}
