//! Zeros and largest values of functions of one variable.

/// The most iterations by which a place is refined.
const MOST_REFINEMENTS: usize = 60;
/// The accuracy of an extreme's position, as a part of the interval's width; its value is known to
/// the square of that.
const POSITION_ERROR: f64 = 1e-5;

/// The zero of a function between two places at which it has opposite signs: regula falsi
/// (Illinois).
pub(crate) fn root(of: &dyn Fn(f64) -> f64, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
    for _ in 0..MOST_REFINEMENTS {
        let mut middle = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        if !middle.is_finite() {
            middle = 0.5 * (a.0 + b.0);
        }
        let value = of(middle);
        if value == 0.0 {
            return middle;
        }
        if (value > 0.0) == (b.1 > 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = (middle, value);
        if (a.0 - b.0).abs() <= 1e-15 * (a.0.abs() + b.0.abs()) {
            break;
        }
    }
    b.0
}

/// The largest value of a unimodal function between 0 and `width`, by golden section.
pub(crate) fn golden(of: &dyn Fn(f64) -> f64, width: f64) -> (f64, f64) {
    const PART: f64 = 0.618_033_988_749_894_8;
    let (mut low, mut high) = (0.0, width);
    let mut inner = [high - PART * (high - low), low + PART * (high - low)];
    let mut values = inner.map(of);
    for _ in 0..MOST_REFINEMENTS {
        if high - low <= POSITION_ERROR * width {
            break;
        }
        if values[0] > values[1] {
            high = inner[1];
            inner = [high - PART * (high - low), inner[0]];
            values = [of(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + PART * (high - low)];
            values = [values[1], of(inner[1])];
        }
    }
    let k = usize::from(values[1] > values[0]);
    (inner[k], values[k])
}
