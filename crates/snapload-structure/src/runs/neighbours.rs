//! Neighbours of a run, which differ from it as little as rounding does: in the height of the
//! waves, all of whose components they multiply by one number near 1.

use super::design::{Answer, Check};
use super::outcome::Outcome;
use super::quantile::{quantile, sorted};
use crate::physics::sea::uniform;
use crate::structure::Structure;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// The distance of neighbours from the run, as a part of the waves' height.
pub const NEIGHBOUR: f64 = 1e-6;

/// With fewer neighbours, no statement about 90 % of them is made, and what they have in common is
/// not known of others.
pub(crate) const FEWEST_NEIGHBOURS: usize = 10;

/// As many neighbours as wanted; none in still water, where there are no waves to vary.
pub(super) fn count_of_neighbours(structure: &Structure, wanted: u32) -> usize {
    match structure.has_waves() {
        true => wanted as usize,
        false => 0,
    }
}

/// The height of the waves of a neighbour, as a multiple of that of the case.
pub(super) fn height_of_neighbour(index: usize) -> f64 {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    generator.set_stream(index as u64);
    1.0 + NEIGHBOUR * (2.0 * uniform(&mut generator) - 1.0)
}

/// 5 %, 50 % and 95 % quantiles of a number of each neighbour; none if there are no neighbours, or
/// one of them ended before the judged time.
pub(super) fn spread(neighbours: &[Outcome], number: impl Fn(&Outcome) -> f64) -> Option<[f64; 3]> {
    if neighbours.iter().any(Outcome::is_unjudged) {
        return None;
    }
    let numbers = sorted(neighbours.iter().map(number));
    let [low, middle, high] = [0.05, 0.5, 0.95].map(|part| quantile(&numbers, part));
    Some([low?, middle?, high?])
}

/// Each check of a run with the number of neighbours that have its answer. One that the run passes
/// and a neighbour does not is open, as the verdict is then.
pub(super) fn with_agreeing(own: Vec<Check>, neighbours: &[Vec<Check>]) -> Vec<(Check, usize)> {
    let with_count = |(index, mut check): (usize, Check)| {
        let same = |other: &&Vec<Check>| other[index].answer == check.answer;
        let count = neighbours.iter().filter(same).count();
        if check.answer == Answer::Passes && count < neighbours.len() {
            check.answer = Answer::Open;
        }
        (check, count)
    };
    own.into_iter().enumerate().map(with_count).collect()
}
