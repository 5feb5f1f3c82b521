//! What pulls at a body beside its lines, in waves of many sinusoids.
//!
//! The integrator asks for forces some fifteen times a step, and a step is a small part of the
//! period of the quickest wave. So the sum over all sinusoids is taken once in each stretch of time
//! of length 2/ω, ω being the largest frequency, as a Taylor polynomial about its middle: what is
//! left out is at most (ω s)^18/18! of the amplitudes with ω s ≤ 1, which is rounding. The stretches
//! are the same whatever is asked for first, so that the same case has the same numbers.

use snapload::{Harmonic, State, System};
use std::cell::RefCell;

/// Coefficients of a polynomial.
const TERMS: usize = 18;
/// Fewer sinusoids are summed up each time.
const FEW: usize = 8;

/// A system whose waves are polynomials of time.
pub(super) struct Surroundings<'a> {
    system: &'a System,
    /// Half a stretch of time; none where the sinusoids are few.
    half: Option<f64>,
    now: RefCell<Stretch>,
}

/// One stretch of time.
struct Stretch {
    middle: f64,
    /// Force and velocity of the water, x and y of each, over powers of the time from the middle in
    /// halves of the stretch.
    force: [[f64; TERMS]; 2],
    water: [[f64; TERMS]; 2],
    /// The system with what they are at one instant.
    at_once: System,
}

impl<'a> Surroundings<'a> {
    pub(super) fn new(system: &'a System) -> Self {
        let water = system.drag.iter().flat_map(|drag| &drag.water);
        let all = || system.forcing.harmonics.iter().chain(water.clone());
        let quickest = all().map(|wave| wave.omega.abs()).fold(0.0, f64::max);
        let many = all().count() > FEW && quickest > 0.0;
        let mut at_once = system.clone();
        if many {
            at_once.forcing.harmonics.clear();
            for drag in at_once
                .drag
                .iter_mut()
                .filter(|drag| !drag.water.is_empty())
            {
                drag.water = vec![steady([0.0; 2])];
            }
        }
        Self {
            system,
            half: many.then(|| 1.0 / quickest),
            now: RefCell::new(Stretch {
                middle: f64::NAN,
                force: [[0.0; TERMS]; 2],
                water: [[0.0; TERMS]; 2],
                at_once,
            }),
        }
    }

    /// The acceleration without lines, as [`System::free_acceleration`] has it.
    pub(super) fn free_acceleration(
        &self,
        t: f64,
        state: &State,
        memory_force: [f64; 3],
    ) -> [f64; 3] {
        let Some(half) = self.half else {
            return self.system.free_acceleration(t, state, memory_force);
        };
        let mut now = self.now.borrow_mut();
        let middle = ((t / (2.0 * half)).floor() + 0.5) * (2.0 * half);
        if now.middle != middle {
            now.expand(self.system, middle, half);
        }
        let s = (t - middle) / half;
        let [x, y] = now.force.map(|terms| value(&terms, s));
        now.at_once.forcing.constant = self.system.forcing.constant + [x, y].into();
        let velocity = now.water.map(|terms| value(&terms, s));
        for wave in now.at_once.drag.iter_mut().flat_map(|drag| &mut drag.water) {
            *wave = steady(velocity);
        }
        now.at_once.free_acceleration(t, state, memory_force)
    }
}

impl Stretch {
    /// Sums up the sinusoids about a time.
    fn expand(&mut self, system: &System, middle: f64, half: f64) {
        let water = system.drag.iter().flat_map(|drag| &drag.water);
        self.middle = middle;
        self.force = sum(system.forcing.harmonics.iter(), middle, half);
        self.water = sum(water, middle, half);
    }
}

/// c' cos ωs + d' sin ωs = Σ over k of c', d', −c', −d', … times (ωs)^k/k!.
fn sum<'a>(waves: impl Iterator<Item = &'a Harmonic>, middle: f64, half: f64) -> [[f64; TERMS]; 2] {
    let mut terms = [[0.0; TERMS]; 2];
    for wave in waves {
        let here = wave.shifted(middle);
        let (cosine, sine) = (here.cosine.components(), here.sine.components());
        let mut factor = 1.0;
        for k in 0..TERMS {
            let sign = if k % 4 < 2 { factor } else { -factor };
            for (terms, (c, d)) in terms.iter_mut().zip(cosine.into_iter().zip(sine)) {
                terms[k] += sign * if k % 2 == 0 { c } else { d };
            }
            factor *= wave.omega * half / (k + 1) as f64;
        }
    }
    terms
}

fn value(terms: &[f64; TERMS], s: f64) -> f64 {
    terms
        .iter()
        .rev()
        .fold(0.0, |sum: f64, term| sum.mul_add(s, *term))
}

/// What does not change.
fn steady(value: [f64; 2]) -> Harmonic {
    Harmonic {
        omega: 0.0,
        cosine: value.into(),
        sine: [0.0; 2].into(),
    }
}

#[cfg(test)]
mod tests {
    use super::Surroundings;
    use snapload::{Body, Drag, Forcing, Harmonic, Shape, State, System};

    /// A sea of 60 sinusoids, with drag: the same as summed up one by one, at any time and in any
    /// order.
    #[test]
    fn many_waves_are_what_they_are_one_by_one() {
        let wave = |k: u32, size: f64| {
            let (k, part) = (f64::from(k), size / f64::from(k));
            Harmonic {
                omega: 0.07 * k,
                cosine: [part * (k * 1.3).cos(), part * (k * 0.7).sin()].into(),
                sine: [part * (k * 2.1).sin(), part * (k * 0.3).cos()].into(),
            }
        };
        let system = System {
            body: Body::rigid(Shape::Circle { radius: 0.2 }, 0.1),
            cables: Vec::new(),
            forcing: Forcing {
                constant: [0.1, -1.0].into(),
                harmonics: (1..=60).map(|k| wave(k, 0.5)).collect(),
            },
            drag: Some(Drag {
                linear: 0.1,
                quadratic: 0.4,
                turning: 0.02,
                water: (1..=60).map(|k| wave(k, 0.3)).collect(),
            }),
            floating: None,
            restitution: 0.5,
        };
        let around = Surroundings::new(&system);
        for k in 0..4000_u32 {
            let t = f64::from(k * 7919 % 4000) * 0.2517;
            let state = State {
                vx: 0.3 * (t * 0.9).sin(),
                vy: -0.2 * (t * 0.4).cos(),
                vtheta: 0.1,
                ..State::default()
            };
            let known = system.free_acceleration(t, &state, [0.0; 3]);
            let found = around.free_acceleration(t, &state, [0.0; 3]);
            for (found, known) in found.into_iter().zip(known) {
                assert!((found - known).abs() < 2e-13, "{t}: {found} {known}");
            }
        }
    }
}
