use crate::reference::rng::*;

#[test]
fn sequence_is_the_published_one() {
    let mut rng = Rng::new(1_234_567);
    assert_eq!(rng.next_u64(), 6_457_827_717_110_365_317);
    assert_eq!(rng.next_u64(), 3_203_168_211_198_807_973);
    assert_eq!(rng.seed(), 1_234_567);
}

#[test]
fn ranges_are_reached_and_kept() {
    let mut rng = Rng::new(7);
    let mut seen = [false; 5];
    for _ in 0..1000 {
        let value = rng.between(-2, 2);
        seen[(value + 2) as usize] = true;
        assert!((0.0..1.0).contains(&rng.unit()));
        assert!(rng.any_magnitude(4).abs() <= 16);
    }
    assert_eq!(seen, [true; 5]);
    assert_eq!(rng.between(i32::MIN, i32::MIN), i32::MIN);
    rng.between(i32::MIN, i32::MAX);
}
