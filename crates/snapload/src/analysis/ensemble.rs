//! Neighbours of a case: how they end where a single run is beyond its horizon of trust.

use crate::analysis::outcomes::{on_all_threads, outcomes_on_one_thread};
use crate::analysis::progress::{Counter, OnProgress, Unfinished};
use crate::analysis::trust::{START_KEYS, Uncertainty};
use crate::case::Case;
use crate::case::error::CaseError;
use crate::case::key::{Key, Kind};
use crate::case::parameters::{Parameters, natural_inertia};
use crate::case::value::Value;
use crate::model::rules::Stop;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::ops::Range;

/// Cases about a given one, drawn uniformly within its uncertainties.
///
/// Every member is drawn from a stream of its own, so that the first hundred of a thousand are the
/// same as a hundred, on any number of threads. The generator is ChaCha with 8 rounds, of the crate
/// `rand_chacha`: the same numbers on every platform, and streams that can be entered anywhere.
#[derive(Clone, Debug)]
pub struct Ensemble {
    base: Parameters,
    uncertainty: Uncertainty,
    /// Why it is not legal, if it is not.
    illegal: Option<CaseError>,
    /// How many members.
    pub count: u32,
    /// Which members.
    pub seed: u64,
}

/// The key of the error of an uncertainty within which no neighbour is legal.
pub const UNCERTAINTY: &str = "uncertainty";

/// Half-width of the cloud in every start value, unless an uncertainty is given \[L\], \[rad\],
/// \[L/T\], \[rad/T\].
pub const DEFAULT_CLOUD: f64 = 1e-12;

/// The number of members, unless given.
pub const DEFAULT_MEMBERS: u32 = 1000;

/// How many members may be asked for.
pub const MEMBERS: Key = Key::option("members", Kind::Count(0, MOST_MEMBERS));

/// The same where there has to be one.
pub const NONZERO_MEMBERS: Key = Key::option("members", Kind::Count(1, MOST_MEMBERS));

/// Which members may be asked for.
pub const SEED: Key = Key::option("seed", Kind::Count(0, u64::MAX));

const MOST_MEMBERS: u64 = 1_000_000_000;

/// Where the first so many members end alike, it is clear enough how a case ends.
const CLEAR_AFTER: u32 = 200;

/// A member that is not legal, for example because a cable would have to be longer, is drawn again
/// at most this often.
const DRAWS: usize = 1000;

impl Ensemble {
    /// An ensemble about a case, within its uncertainties; where there are none, within
    /// [`DEFAULT_CLOUD`]. An uncertainty that [`Uncertainty::set`] does not accept is the error of
    /// every member.
    pub fn about(case: &Case, uncertainty: &Uncertainty, count: u32, seed: u64) -> Self {
        let (mut uncertainty, illegal) = match uncertainty.checked() {
            Ok(checked) => (checked, None),
            Err(error) => (uncertainty.clone(), Some(error)),
        };
        uncertainty.start = uncertainty.of_start_of(case.parameters());
        if uncertainty.start == [0.0; 6] && uncertainty.keys.is_empty() {
            uncertainty.start = [DEFAULT_CLOUD; 6];
        }
        Self {
            base: *case.parameters(),
            uncertainty,
            illegal,
            count,
            seed,
        }
    }

    /// The uncertainties within which the members are drawn.
    pub fn uncertainty(&self) -> &Uncertainty {
        &self.uncertainty
    }

    /// One member.
    ///
    /// # Errors
    /// A [`CaseError`] if no legal case could be drawn, or the uncertainty is not legal.
    pub fn member(&self, index: u32) -> Result<Case, CaseError> {
        if let Some(error) = &self.illegal {
            return Err(error.clone());
        }
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        generator.set_stream(index.into());
        let mut latest = None;
        for _ in 0..DRAWS {
            match Case::new(self.draw(&mut generator)) {
                Ok(case) => return Ok(case),
                Err(error) => latest = Some(error),
            }
        }
        Err(self.too_large(latest))
    }

    /// An uncertainty within which no legal neighbour was drawn; `latest` is the error of the last.
    fn too_large(&self, latest: Option<CaseError>) -> CaseError {
        let named = |(key, size): &(&str, f64)| format!("{key}={}", Value::Number(*size));
        let moving = START_KEYS.iter().zip(self.uncertainty.start);
        let moving = moving.filter(|(key, _)| self.base.moves_by(key));
        let of_start: Vec<(&str, f64)> = moving.map(|(key, size)| (*key, size)).collect();
        let keys = &self.uncertainty.keys;
        let sizes = match of_start[..] {
            [(_, size), ..] if keys.is_empty() && of_start.iter().all(|(_, s)| *s == size) => {
                Value::Number(size).to_string()
            }
            _ => {
                let given = of_start.iter().filter(|(_, size)| *size > 0.0);
                let given: Vec<String> = given.map(named).chain(keys.iter().map(named)).collect();
                given.join(", ")
            }
        };
        let mut allowed =
            format!("a smaller one, as none of {DRAWS} neighbours within it is legal");
        if let Some(latest) = latest {
            let (key, value) = (latest.key, latest.value);
            allowed += &format!(
                "; the latest has {key} = {value}, but needs {}",
                latest.allowed
            );
        }
        CaseError::value(UNCERTAINTY, sizes, allowed)
    }

    fn draw(&self, generator: &mut ChaCha8Rng) -> Parameters {
        let base = &self.base;
        let drawn = base.map(|key, value| {
            let size = self.size_of(key);
            if size == 0.0 || !base.moves_by(key) {
                return value;
            }
            // 53 random bits, uniform in [−1, 1).
            let side = (generator.next_u64() >> 11) as f64 * (2.0 / (1u64 << 53) as f64) - 1.0;
            value + size * side
        });
        if base.inertia_follows() && self.size_of("inertia") == 0.0 {
            let inertia = natural_inertia(drawn.a, drawn.b);
            Parameters { inertia, ..drawn }
        } else {
            drawn
        }
    }

    fn size_of(&self, key: &str) -> f64 {
        if let Some(component) = START_KEYS.iter().position(|name| *name == key) {
            return self.uncertainty.start[component];
        }
        let given = self.uncertainty.keys.iter().find(|(name, _)| *name == key);
        given.map_or(0.0, |(_, size)| *size)
    }

    /// Runs all members, side by side in the lanes of the processor, on all threads that there are.
    ///
    /// # Errors
    /// A [`CaseError`] if a member could not be drawn, and [`Unfinished::Cancelled`].
    pub fn tally(&self, on_progress: OnProgress) -> Result<EnsembleEnds, Unfinished> {
        let counter = Counter::new("neighbours", 0, self.count.into(), on_progress);
        let (ends, clear) = (self.ends(0..self.count, &counter)?, false);
        Ok(EnsembleEnds { ends, clear })
    }

    /// The same, but if the first 200 members end alike, no more are run.
    ///
    /// # Errors
    /// As for [`Ensemble::tally`].
    pub fn tally_until_clear(&self, on_progress: OnProgress) -> Result<EnsembleEnds, Unfinished> {
        let counter = Counter::new("neighbours", 0, self.count.into(), on_progress);
        let first = self.count.min(CLEAR_AFTER);
        let mut ends = self.ends(0..first, &counter)?;
        let clear = first < self.count && ends.iter().all(|end| *end == ends[0]);
        if !clear {
            ends.extend(self.ends(first..self.count, &counter)?);
        }
        Ok(EnsembleEnds { ends, clear })
    }

    fn ends(&self, members: Range<u32>, counter: &Counter) -> Result<Vec<Stop>, Unfinished> {
        let made = on_all_threads(members.len(), |numbers| {
            let mut refused = None;
            let drawn = numbers.map_while(|k| match self.member(members.start + k as u32) {
                Ok(case) => Some(case),
                Err(error) => {
                    refused = Some(error);
                    None
                }
            });
            let outcomes = outcomes_on_one_thread(drawn, counter)?;
            match refused {
                Some(error) => Err(Unfinished::from(error)),
                None => Ok(outcomes.iter().map(|outcome| outcome.end.reason).collect()),
            }
        })?;
        Ok(made.into_vec())
    }
}

/// How the members of an ensemble end.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsembleEnds {
    ends: Vec<Stop>,
    /// Whether the remaining members were not run because these all ended alike.
    clear: bool,
}

impl EnsembleEnds {
    /// How many members there are.
    pub fn members(&self) -> usize {
        self.ends.len()
    }

    /// The share of each end that occurs, the most frequent first.
    pub fn shares(&self) -> Vec<(Stop, Share)> {
        let mut shares: Vec<(Stop, Share)> = Stop::ALL
            .into_iter()
            .map(|reason| (reason, self.share(|end| end == reason)))
            .filter(|(_, share)| share.count > 0)
            .collect();
        shares.sort_by_key(|(_, share)| std::cmp::Reverse(share.count));
        shares
    }

    /// The share that exceeds: reaches the rotation limit or the upper bound.
    pub fn exceeding(&self) -> Share {
        self.share(Stop::exceeds)
    }

    /// The share that is cut short, of which it is not known whether it would exceed.
    pub fn cut_short(&self) -> Share {
        self.share(Stop::cuts_short)
    }

    fn share(&self, holds: impl Fn(Stop) -> bool) -> Share {
        let count = self.ends.iter().filter(|end| holds(**end)).count();
        Share {
            count,
            of: self.ends.len(),
            clear: self.clear,
        }
    }
}

/// A part of an ensemble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// The number of members in this part.
    pub count: usize,
    /// The number of members that were run.
    pub of: usize,
    /// Whether the remaining members were not run because these all ended alike, which the interval
    /// takes into account.
    pub clear: bool,
}

impl Share {
    /// The share as a number between 0 and 1.
    pub fn part(self) -> f64 {
        self.count as f64 / self.of as f64
    }

    /// The interval that contains the probability with 95 % confidence (E. B. Wilson, *J. Amer.
    /// Statist. Assoc.* 22 (1927) 209); it is meaningful also for a share of none or of all.
    ///
    /// Where the rest was not run because all ended alike, it is the interval of 99 %. With the one
    /// of 95 %, a probability p at its end would give n equal ends in p^n = 2.1 % of all cases, in
    /// addition to the 5 % in which more are run and the interval misses it; with 99 % it is 0.1 %.
    pub fn interval(self) -> [f64; 2] {
        let (n, p) = (self.of as f64, self.part());
        let z = if self.clear { NORMAL_995 } else { NORMAL_975 };
        let z2 = z * z;
        let centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
        let half = z / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
        // At its ends the interval is exact: rounding would leave the share itself out of it.
        [
            if self.count == 0 {
                0.0
            } else {
                (centre - half).max(0.0)
            },
            if self.count == self.of {
                1.0
            } else {
                (centre + half).min(1.0)
            },
        ]
    }
}

/// The 97.5 % quantile of the normal distribution.
const NORMAL_975: f64 = 1.959_963_984_540_054;
/// The 99.5 % quantile.
const NORMAL_995: f64 = 2.575_829_303_548_901;

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of SciPy's `binomtest(count, of).proportion_ci(method="wilson")`.
    #[test]
    fn intervals_are_wilsons() {
        let known = [
            (630, 1000, [0.599_631_7, 0.659_373_3]),
            (0, 20, [0.0, 0.161_125_2]),
            (20, 20, [0.838_874_8, 1.0]),
            // z²/(n + z²)
            (0, 24, [0.0, 0.137_976_2]),
        ];
        for (count, of, [low, high]) in known {
            let share = Share {
                count,
                of,
                clear: false,
            };
            let interval = share.interval();
            assert!((interval[0] - low).abs() < 1e-6, "{interval:?}");
            assert!((interval[0]..=interval[1]).contains(&share.part()));
            assert!((interval[1] - high).abs() < 1e-6, "{interval:?}");
        }
    }

    /// Over all probabilities, intervals miss the probability in 5 % of all cases on average, and
    /// nowhere more often than without the early stop; computed exactly from the binomial
    /// distributions of the members before and after the early stop.
    #[test]
    fn stopping_early_leaves_intervals_that_hold() {
        let (first, all) = (200_usize, 1000_usize);
        let log_factorials: Vec<f64> = std::iter::once(0.0)
            .chain((1..=all).scan(0.0, |sum, k| {
                *sum += (k as f64).ln();
                Some(*sum)
            }))
            .collect();
        let log_choose =
            |n: usize, k: usize| log_factorials[n] - log_factorials[k] - log_factorials[n - k];
        let chance = |n: usize, k: usize, p: f64| -> f64 {
            (log_choose(n, k) + k as f64 * p.ln() + (n - k) as f64 * (1.0 - p).ln()).exp()
        };
        let misses = |count, of, clear, p: f64| {
            let [low, high] = Share { count, of, clear }.interval();
            p < low || p > high
        };
        let (mut sum, mut worst, mut worst_alone) = (0.0, 0.0_f64, 0.0_f64);
        for k in 1..400 {
            let p = 1.0 - 0.1 * f64::from(k) / 400.0;
            let missing = (0..=all).filter(|end| misses(*end, all, false, p));
            let alone: f64 = missing.map(|end| chance(all, end, p)).sum();
            let clear = misses(first, first, true, p);
            let both = alone + if clear { p.powi(200) } else { 0.0 };
            sum += both;
            (worst, worst_alone) = (worst.max(both), worst_alone.max(alone));
        }
        // The coverage of Wilson's own interval oscillates about 95 %, as counts are whole numbers.
        assert!(sum / 399.0 < 0.05, "{sum}");
        assert!(worst < worst_alone + 1e-3, "{worst} {worst_alone}");
    }
}
