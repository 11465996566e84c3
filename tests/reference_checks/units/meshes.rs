use crate::reference::exact;
use crate::reference::meshes::*;
use crate::reference::rng::Rng;

/// Front area of every triangle is positive, and no pixel is hit twice; returns the pixels hit.
fn check_mesh(mesh: &Mesh<[i32; 2]>, width: u32, height: u32, case: &str) -> usize {
    let mut hits = vec![0; (width * height) as usize];
    for index in 0..mesh.triangles.len() {
        let tri = exact::widen(mesh.triangle(index));
        assert!(exact::area2(tri) < 0, "{case}: triangle {index} is turned over");
        exact::for_each_pixel(tri, width, height, |x, y| hits[(y * width + x) as usize] += 1);
    }
    assert!(hits.iter().all(|&n| n <= 1), "{case}: a pixel is hit twice");
    hits.iter().filter(|&&n| n == 1).count()
}

#[test]
fn meshes_do_not_overlap_and_grids_leave_no_hole() {
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let case = format!("seed {seed}");
        let snap_to = rng.pick(&[1, 16, 128]);
        let mesh = grid(&mut rng, 3, 4, 37, 50, snap_to);
        assert_eq!(check_mesh(&mesh, 37, 50, &case), 37 * 50, "{case}: hole in the grid");
        let count = rng.between(5, 20) as u16;
        assert!(check_mesh(&fan(&mut rng, count, 40, 30), 40, 30, &case) > 40);
        assert!(check_mesh(&strip(&mut rng, count, 40, 30), 40, 30, &case) > 40);
    }
}

#[test]
fn lifted_meshes_project_back_exactly() {
    let mut rng = Rng::new(8);
    for (width, height) in [(64, 64), (320, 240), (37, 50)] {
        let mesh = grid(&mut rng, 4, 4, width, height, 1);
        let lifted = lift(&mut rng, &mesh, width, height);
        for (&[sx, sy], &[x, y, z, w]) in mesh.vertices.iter().zip(&lifted.vertices) {
            assert!(w > 0 && (0..=w).contains(&z));
            // X = (x/w + 1) * width/2 px, multiplied out.
            let [x, y, w] = [x, y, w].map(i64::from);
            assert_eq!(i64::from(sx) * w, (x + w) * i64::from(width) * 128);
            assert_eq!(i64::from(sy) * w, (w - y) * i64::from(height) * 128);
        }
    }
}
