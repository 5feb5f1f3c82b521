//! Waves of tension: the crests and troughs of a line's tension.
//!
//! A wave of tension lasts from one upcrossing of the tension at rest to the next, as a wave of the
//! sea lasts from one upcrossing of the still water to the next. Its crest is the largest tension
//! within it, including that of a counted snap, its trough the smallest, 0 if the line goes slack.

use super::equilibrium::Equilibrium;

/// Finds the waves of one line from its tension, which is passed interval by interval.
#[derive(Clone, Debug)]
pub(crate) struct WavesOfTension {
    rest_n: f64,
    /// Whether the tension has been below that at rest since the last upcrossing.
    below: bool,
    /// Crest and trough since the last upcrossing; none before the first.
    now: Option<[f64; 2]>,
}

impl WavesOfTension {
    /// For every line of a body at rest, by the tensions about which the motion goes.
    pub(crate) fn of_lines(rest: &Equilibrium) -> Vec<Self> {
        rest.inextensible_tensions_n()
            .iter()
            .map(|rest_n| Self::new(*rest_n))
            .collect()
    }

    /// For a line with this tension at rest.
    fn new(rest_n: f64) -> Self {
        Self {
            rest_n,
            below: false,
            now: None,
        }
    }

    /// Takes in an interval within which the tension was between two values, or an instant; returns
    /// crest and trough of a wave that ends there.
    pub(crate) fn add(&mut self, [least, largest]: [f64; 2]) -> Option<[f64; 2]> {
        let rises = self.below && largest > self.rest_n;
        let mut ended = None;
        if rises {
            ended = self.now.replace([largest, f64::INFINITY]);
        }
        // In a rising interval the values below the tension at rest belong to the wave before.
        let least = if rises { least.max(self.rest_n) } else { least };
        self.below = least < self.rest_n || (self.below && !rises);
        if let Some([crest, trough]) = &mut self.now {
            *crest = crest.max(largest);
            *trough = trough.min(least);
        }
        ended
    }
}

#[cfg(test)]
mod tests {
    use super::WavesOfTension;

    /// A tension of 2 + sin t, passed in short intervals, has crests of 3 and troughs of 1.
    #[test]
    fn a_sinusoid_has_its_crests_and_troughs() {
        let mut waves = WavesOfTension::new(2.0);
        let tension = |k: u32| 2.0 + (f64::from(k) * 0.01).sin();
        let ended: Vec<[f64; 2]> = (0..4000)
            .filter_map(|k| {
                let (a, b) = (tension(k), tension(k + 1));
                waves.add([a.min(b), a.max(b)])
            })
            .collect();
        // 40/2π is 6.4 periods: the first upcrossing is at 2π, as the tension begins above that at
        // rest.
        assert_eq!(ended.len(), 5);
        for [crest, trough] in ended {
            assert!((crest - 3.0).abs() < 1e-4 && (trough - 1.0).abs() < 1e-4);
        }
    }

    /// A line that goes slack and snaps has a trough of zero, and the peak of its snap as its
    /// crest.
    #[test]
    fn a_snap_is_a_crest() {
        let mut waves = WavesOfTension::new(1.0);
        let mut ended = Vec::new();
        for stretch in [[0.0, 0.0], [5.0, 5.0], [0.8, 2.0], [0.0, 0.0], [3.0, 3.0]] {
            ended.extend(waves.add(stretch));
        }
        assert_eq!(ended, [[5.0, 0.0]]);
    }
}
