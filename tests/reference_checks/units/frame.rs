use crate::reference::frame::*;

#[test]
fn less_wins_and_the_gap_is_to_the_runner_up() {
    let mut frame = Frame::new(2, 1, [0.0; 3]);
    assert!(frame.offer(1, 0.5, [1.0; 3], 1));
    assert_eq!(frame.gap[1], 0.5);
    assert!(!frame.offer(1, 0.5, [0.2; 3], 2), "equal is not less");
    assert_eq!(frame.gap[1], 0.0);
    assert!(frame.offer(1, 0.25, [0.3; 3], 3));
    assert!(!frame.offer(1, 0.375, [0.4; 3], 4));
    assert_eq!((frame.id[1], frame.gap[1]), (3, 0.125));
    assert_eq!((frame.id[0], frame.depth_codes()[0]), (0, 65535));
}

#[test]
fn comparison_leaves_out_what_is_not_clear_cut() {
    let mut a = Frame::new(3, 1, [0.0; 3]);
    let b = a.clone();
    a.offer(0, 0.5, [1.0; 3], 1);
    a.offer(2, 0.5, [1.0; 3], 1);
    a.note_margin(0, 0.001);
    let result = a.compare(&b, 0.01, 0.0);
    assert_eq!((result.compared, result.excluded), (2, 1));
    assert_eq!((result.other_id, result.first_other_id), (1, Some((2, 0))));
}
