//! The colours of maps.

use crate::axis::Span;

/// How many shades a scale has: more are not told apart, and fewer keep a file small.
pub(crate) const LEVELS: usize = 64;

/// Points of the scale viridis of matplotlib (CC0), evenly spaced: its lightness rises evenly, so it is read
/// without red or green, and in grey print.
const VIRIDIS: [[u8; 3]; 10] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x28, 0x78],
    [0x3e, 0x49, 0x89],
    [0x31, 0x68, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x1f, 0x9e, 0x89],
    [0x35, 0xb7, 0x79],
    [0x6e, 0xce, 0x58],
    [0xb5, 0xde, 0x2b],
    [0xfd, 0xe7, 0x25],
];

/// Blue, orange, green, yellow, purple and black of Okabe and Ito, in an order in which neighbours differ in
/// lightness, too.
pub(crate) const CLASSES: [[u8; 3]; 6] = [
    [0x00, 0x72, 0xb2],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x9e, 0x73],
    [0xf0, 0xe4, 0x42],
    [0xcc, 0x79, 0xa7],
    [0x00, 0x00, 0x00],
];

/// The shade of a value, from 0.
pub(crate) fn level(value: f64, (low, high): Span) -> usize {
    let part = (value - low) / (high - low);
    ((part * LEVELS as f64) as usize).min(LEVELS - 1)
}

/// The colour of a shade.
pub(crate) fn shade(level: usize) -> [u8; 3] {
    let intervals = VIRIDIS.len() - 1;
    let along = level * intervals;
    let (k, rest) = (along / (LEVELS - 1), along % (LEVELS - 1));
    let part = rest as f64 / (LEVELS - 1) as f64;
    let (from, to) = (VIRIDIS[k], VIRIDIS[(k + 1).min(intervals)]);
    std::array::from_fn(|c| {
        let (from, to) = (f64::from(from[c]), f64::from(to[c]));
        (from + part * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shades_grow_lighter_from_end_to_end() {
        assert_eq!((shade(0), shade(LEVELS - 1)), (VIRIDIS[0], VIRIDIS[9]));
        let light =
            |[r, g, b]: [u8; 3]| 0.3 * f64::from(r) + 0.59 * f64::from(g) + 0.11 * f64::from(b);
        for k in 1..LEVELS {
            assert!(light(shade(k)) > light(shade(k - 1)), "{k}");
        }
    }

    #[test]
    fn the_ends_of_the_range_have_the_ends_of_the_scale() {
        assert_eq!(level(2.0, (2.0, 4.0)), 0);
        assert_eq!(level(4.0, (2.0, 4.0)), LEVELS - 1);
        assert_eq!(level(3.0, (2.0, 4.0)), LEVELS / 2);
    }
}
