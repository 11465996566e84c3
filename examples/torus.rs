mod scenes;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let idx = scenes::SCENES.iter().position(|s| s.name == args[1]).unwrap();
    let rows: usize = args[2].parse().unwrap();
    let rec: usize = args[3].parse().unwrap();
    let mut out = vec![0u16; 320 * 240];
    let (mut c, mut d, mut r) = (vec![0; 320 * rows], vec![0; 320 * rows], vec![0; rec]);
    let stats = scenes::draw(
        idx,
        args.get(5).map_or(0, |t| t.parse().unwrap()),
        [320, 240],
        &mut c,
        &mut d,
        &mut r,
        |y, s| out[y * 320..y * 320 + s.len()].copy_from_slice(s),
    );
    println!("{stats:?}");
    let mut bytes = vec![];
    for p in out {
        bytes.extend([
            ((p >> 11) << 3) as u8,
            ((p >> 5 & 63) << 2) as u8,
            ((p & 31) << 3) as u8,
        ]);
    }
    let mut e = png::Encoder::new(std::fs::File::create(&args[4]).unwrap(), 320, 240);
    e.set_color(png::ColorType::Rgb);
    e.write_header().unwrap().write_image_data(&bytes).unwrap();
}
