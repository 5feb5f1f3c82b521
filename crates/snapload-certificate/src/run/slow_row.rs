//! Rows of slow snaps, after which two cables come to rest together (docs/model.md, section 6).

use crate::arithmetic::ball::Ball;
use crate::arithmetic::decimal::Decimal;
use crate::case::ExactCase;
use crate::model::Model;
use crate::verdict::ProofFailure;
use snapload::{SLOW_FLIGHT, SLOW_SNAPS};

/// The latest snaps, all of them slower than `v_stick` and each soon after the one before.
pub(crate) struct SlowRow {
    /// Their cables, by index from 0.
    cables: Vec<usize>,
    /// When the latest of them was.
    latest: Ball,
}

impl SlowRow {
    /// No snap in a row.
    pub(crate) fn empty() -> Self {
        Self {
            cables: Vec::new(),
            latest: Ball::zero(),
        }
    }

    /// Ends the row, because of a faster snap or another event.
    pub(crate) fn end(&mut self) {
        self.cables.clear();
    }

    /// Adds a slow snap at a time, which begins another row if it comes too late for this one.
    pub(crate) fn add(
        &mut self,
        cable: usize,
        t: &Ball,
        case: &ExactCase,
        model: &Model,
    ) -> Result<(), ProofFailure> {
        if !self.cables.is_empty() {
            let flight = (t - &self.latest) * largest_force(case, model);
            let late = flight - &model.v_stick * &Ball::double(SLOW_FLIGHT);
            match (late.is_positive(), late.is_negative()) {
                (true, _) => self.cables.clear(),
                (_, true) => {}
                _ => {
                    let what = "whether a slow snap belongs to the row of those before";
                    return Err(ProofFailure::undecided(what));
                }
            }
        }
        self.cables.push(cable);
        self.latest = t.clone();
        Ok(())
    }

    /// Whether it is long enough for an accumulation, and includes both cables.
    pub(crate) fn alternates(&self) -> bool {
        let both = self.cables.contains(&0) && self.cables.contains(&1);
        both && self.cables.len() >= SLOW_SNAPS as usize
    }
}

/// The weight and the largest force of the wave, |f_o| max(1, |ν|).
fn largest_force(case: &ExactCase, model: &Model) -> Ball {
    let wave = model.f_o.abs();
    let beyond = case.number("nu").abs().minus(&Decimal::integer(1));
    let wave = match beyond.is_positive() {
        true => wave * model.nu.abs(),
        false => wave,
    };
    wave + Ball::integer(1)
}
