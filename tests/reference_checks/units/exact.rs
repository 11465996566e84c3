use crate::reference::exact::*;

fn picture(tri: Triangle, width: u32, height: u32) -> String {
    let mut rows = vec![vec!['.'; width as usize]; height as usize];
    for_each_pixel(tri, width, height, |x, y| {
        rows[y as usize][x as usize] = '#';
    });
    let rows: Vec<String> = rows.iter().map(|row| row.iter().collect()).collect();
    rows.join("\n")
}

#[test]
fn top_and_left_edges_own_their_samples() {
    // Corners on the centres of (1,1), (4,1), (1,4): left and top edges count, the diagonal does not.
    let tri = [center(1, 1), center(4, 1), center(1, 4)];
    assert_eq!(picture(tri, 5, 5), ".....\n.###.\n.##..\n.#...\n.....");
    // The other half of the square gets the diagonal; its right and bottom edges are left out.
    let other = [center(4, 1), center(4, 4), center(1, 4)];
    assert_eq!(picture(other, 5, 5), ".....\n.....\n...#.\n..##.\n.....");
}

#[test]
fn winding_and_first_vertex_do_not_matter() {
    let tri = [[130, 128], [1100, 384], [384, 1152]];
    let expected = picture(tri, 6, 6);
    let [a, b, c] = tri;
    for same in [[b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
        assert_eq!(picture(same, 6, 6), expected, "{same:?}");
    }
}

#[test]
fn zero_area_covers_nothing() {
    assert!(!covers([center(0, 0); 3], 0, 0));
    assert!(!covers([center(0, 0), center(2, 2), center(4, 4)], 1, 1));
}

#[test]
fn box_does_not_lose_pixels() {
    let tri = [[-700, -900], [1700, 300], [200, 1500]];
    let mut found = Vec::new();
    for_each_pixel(tri, 7, 7, |x, y| found.push((x, y)));
    let all = (0..7).flat_map(|y| (0..7).map(move |x| (x, y)));
    let expected: Vec<(u32, u32)> = all.filter(|&(x, y)| covers(tri, x.into(), y.into())).collect();
    assert_eq!(found, expected);
}

#[test]
fn depth_is_the_plane_and_halves_go_up() {
    let tri = [center(0, 0), center(4, 0), center(0, 4)];
    assert_eq!(depth_rounded(tri, [10, 50, 10], 1, 0), 20);
    assert_eq!(depth_rounded(tri, [10, 50, 10], 4, 0), 50);
    // Half way between 0 and 1, and between -1 and 0.
    assert_eq!(depth_rounded(tri, [0, 1, 0], 2, 0), 1);
    assert_eq!(round_half_up((-1, 2)), 0);
    assert_eq!(round_half_up((-3, 2)), -1);
    let [a, b, c] = tri;
    assert_eq!(depth_rounded([a, c, b], [10, 10, 50], 1, 0), 20);
}

#[test]
fn equal_w_makes_perspective_affine() {
    let tri = [[3, 9], [2000, 77], [140, 1777]];
    let at = center(2, 2);
    let (n, d) = perspective_at(tri, [5, 5, 5], [-8, 90, 41], at);
    let (an, ad) = affine_at(tri, [-8, 90, 41], at);
    assert_eq!(n * ad, an * d);
    // Half way on screen between w = 1 and w = 3 is a quarter of the way in space.
    let tri = [[0, 0], [512, 0], [0, 512]];
    let (n, d) = perspective_at(tri, [1, 3, 1], [0, 100, 0], [256, 0]);
    assert_eq!(n, 25 * d);
}
