//! Pictures as pixels.

use crate::pictures::picture;
use snapload_figures::{FigureError, Plot, energy};

#[test]
fn a_png_has_the_requested_size() {
    let picture = picture(energy(&[[0.0, 1.0], [1.0, 2.0]], None));
    let (width, height) = picture.size_pt();
    assert!((width - 240.94).abs() < 0.01);
    for scale in [1.0_f32, 300.0 / 72.0] {
        let png = picture.png(scale).expect("a PNG");
        let side = |at: usize| {
            f64::from(u32::from_be_bytes([
                png[at],
                png[at + 1],
                png[at + 2],
                png[at + 3],
            ]))
        };
        assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!(side(16), (width * f64::from(scale)).ceil());
        assert_eq!(side(20), (height * f64::from(scale)).ceil());
    }
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e6] {
        assert_eq!(picture.png(scale), Err(FigureError::Scale));
    }
}

#[test]
fn letters_reach_the_pixels() {
    let dark = |plot: Plot| {
        let png = picture(plot).png(2.0).expect("a PNG");
        let mut reader = png::Decoder::new(std::io::Cursor::new(png))
            .read_info()
            .expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut pixels).expect("pixels");
        pixels
            .chunks(3)
            .filter(|rgb| rgb.iter().all(|v| *v < 100))
            .count()
    };
    let plain = energy(&[[0.0, 1.0], [1.0, 2.0]], None);
    let noted = Plot {
        note: "*many* letters".to_string(),
        ..plain.clone()
    };
    assert!(dark(noted) > dark(plain) + 100);
}
