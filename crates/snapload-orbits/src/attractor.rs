//! Orbits found from long motions: on the attractor of one start, or from many random starts.

use crate::exponents_text::exponent_text;
use crate::hybrid::{Family, Point, distance};
use crate::lap::SAME;
use crate::moored::{Moored, period_of};
use crate::multipliers::Stability;
use crate::orbit::{NoOrbit, Orbit, OrbitRequest};
use crate::section::{LONGEST_PERIOD, Section, SectionOptions};
use crate::summary::{doubt, periods};
use snapload::analysis::{Counter, OnProgress, Progress, Unfinished, on_all_threads};
use snapload::{Case, Limit, Parameters};

/// Periods that are left out as the transient, and periods that are examined after it.
pub const TRANSIENT: u64 = 400;
const SAMPLED_PERIODS: u64 = 600;
/// The number of all these periods.
pub const ATTRACTOR_PERIODS: u64 = TRANSIENT + SAMPLED_PERIODS;
/// The number of periods up to which a motion is followed that still approaches an orbit.
const MOST_PERIODS: u64 = 16 * ATTRACTOR_PERIODS;

/// The orbit that the motion of a case approaches, if it is periodic.
///
/// # Errors
/// [`NoOrbit`] describes what the motion does instead.
pub fn of_attractor(
    parameters: &Parameters,
    request: &OrbitRequest,
    on_progress: OnProgress,
) -> Result<Result<Orbit, NoOrbit>, Unfinished> {
    let (section, followed) = long_section(parameters, request.phase, on_progress)?;
    if let Some(stop) = section.stop {
        let t = section.end.1;
        return Ok(Err(NoOrbit(format!(
            "the motion from this start stops at t = {t:.4}{}: {}; give a state near an orbit with \
             --start, or search for unstable orbits with --find N",
            doubt(section.stop_is_certain()),
            stop.reason_text()
        ))));
    }
    let Some(period) = section.period() else {
        let largest = section.exponents.first().copied();
        let exponent = exponent_text(largest.unwrap_or([f64::NAN; 2]));
        return Ok(Err(NoOrbit(format!(
            "the motion from this start repeats itself after no number of periods of the forcing up to \
             {LONGEST_PERIOD}, as its first {followed} show (largest Lyapunov exponent \
             {exponent}); search for unstable orbits with --find N, or look at snapload section"
        ))));
    };
    if request
        .periods
        .is_some_and(|periods| period as u32 != periods)
    {
        return Ok(Err(NoOrbit(format!(
            "the motion from this start repeats itself after {} of the forcing, but an orbit of {} was \
             requested; leave the periods out, or give a state near it",
            periods(period),
            periods(request.periods.unwrap_or(1) as usize)
        ))));
    }
    let request = OrbitRequest {
        periods: Some(period as u32),
        ..request.clone()
    };
    let last = section.points.last().copied().unwrap_or(section.end.0);
    let family = Moored::case(*parameters, [None; 2]);
    // If certain snaps are requested, another orbit than that of the motion may be meant.
    let find = match request.struck {
        None => Orbit::find_near_end_of_motion,
        Some(_) => Orbit::find,
    };
    Ok(find(&family, [0.0; 2], &last, &request))
}

/// The last periods of the motion of a case, and after how many it ends: twice as many, again and
/// again, where it still approaches an orbit.
fn long_section(
    parameters: &Parameters,
    phase: f64,
    on_progress: OnProgress,
) -> Result<(Section, u64), Unfinished> {
    let options = SectionOptions {
        phase,
        skip: TRANSIENT,
        keep: SAMPLED_PERIODS,
        exponents: true,
        impacts: false,
    };
    let mut section = Section::of(parameters, &options, on_progress)?;
    let mut followed = ATTRACTOR_PERIODS;
    while followed < MOST_PERIODS && still_approaches(&section) {
        let options = SectionOptions {
            skip: followed - SAMPLED_PERIODS,
            ..options
        };
        let (z, t) = section.end;
        let share = |progress: Progress| {
            let of = ATTRACTOR_PERIODS as f64;
            on_progress(Progress::new(
                progress.doing,
                of * progress.done / progress.of,
                of,
            ))
        };
        section = Section::from(parameters, (t, &z), &options, &share)?;
        followed *= 2;
    }
    Ok((section, followed))
}

/// Whether a motion does not repeat itself yet, although deviations certainly shrink: it approaches
/// an orbit slowly.
fn still_approaches(section: &Section) -> bool {
    let shrinks = |[mean, error]: &[f64; 2]| mean + 2.0 * error < 0.0;
    let alone = section.stop.is_none() && section.period().is_none();
    alone && section.exponents.first().is_some_and(shrinks)
}

/// Starts for each unit of work.
const BATCH: usize = 16;
/// Starts from which orbits are searched for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Starts<'a> {
    /// The number of random starts.
    pub count: usize,
    /// The seed of the random starts.
    pub seed: u64,
    /// Given starts, used before the random ones, such as the orbits of a case nearby.
    pub near: &'a [Point],
}

/// All admissible orbits that Newton's method finds from given starts and from random ones in the
/// box |x| ≤ w, −w ≤ y ≤ h, |v| ≤ 1, |θ| ≤ π/3, |θ̇| ≤ 2, with w half the cables' length, or less.
/// Each is listed once, whichever of its periods it was found in, the most stable ones first. An
/// orbit that repeats itself after fewer periods than requested is left out.
///
/// # Errors
/// [`Unfinished`] if the case is not legal, or the work is cancelled.
pub fn find_orbits(
    parameters: &Parameters,
    starts: &Starts,
    request: &OrbitRequest,
    on_progress: OnProgress,
) -> Result<Vec<Orbit>, Unfinished> {
    period_of(parameters)?;
    let family = Moored::case(*parameters, [None; 2]);
    let all = starts.near.len() + starts.count;
    let counter = Counter::new("starts", 0, all as u64, on_progress);
    let batches = all.div_ceil(BATCH);
    let start = |k: usize| match k.checked_sub(starts.near.len()) {
        None => starts.near.get(k).copied(),
        Some(k) => random_start(parameters, starts.seed, k as u64),
    };
    let made =
        on_all_threads(batches, |numbers| {
            let mut made = Vec::new();
            for batch in numbers {
                let first = batch * BATCH;
                let last = (first + BATCH).min(all);
                let mut found: Vec<Orbit> = Vec::new();
                for k in first..last {
                    found.extend(start(k).and_then(|z| {
                        crate::orbit_search::find_from_far_start(&family, &z, request)
                    }));
                }
                counter.add((last - first) as u64)?;
                made.push(found);
            }
            Ok::<_, snapload::analysis::Cancelled>(made)
        })?;
    let mut orbits: Vec<Orbit> = Vec::new();
    let mut seen: Vec<Point> = Vec::new();
    let is_in = |points: &[Point], z: &Point| points.iter().any(|p| distance(p, z) < SAME);
    for orbit in made.into_vec().into_iter().flatten() {
        if is_in(&seen, &orbit.z) {
            continue;
        }
        if orbit.smallest_periods == orbit.periods {
            seen.extend(sections(&family, &orbit));
            orbits.push(orbit);
        }
    }
    orbits.sort_by(|a, b| a.multipliers.largest().total_cmp(&b.multipliers.largest()));
    Ok(orbits)
}

/// The states at all sections of an orbit.
fn sections(family: &Moored, orbit: &Orbit) -> Vec<Point> {
    let system = family.plain(orbit.at);
    let (lap, legs) = orbit.lap_of(family, &system);
    lap.sections(&system, &legs)
}

/// The k-th random start; none where it is not legal.
fn random_start(p: &Parameters, seed: u64, k: u64) -> Option<Point> {
    let mut state =
        seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ k.wrapping_mul(0xD1B5_4A32_D192_ED03);
    let mut within = |low: f64, high: f64| low + (high - low) * uniform(&mut state);
    let wide = (0.5 * p.r).min(0.6);
    let turns = f64::from(u8::from(!p.is_point()));
    let top = p.rules().limits.of(Limit::UpperBound).unwrap_or(wide);
    let start = Parameters {
        x: within(-wide, wide),
        y: within(-0.1, top),
        theta: turns * within(-1.05, 1.05),
        vx: within(-1.0, 1.0),
        vy: within(-1.0, 1.0),
        vtheta: turns * within(-2.0, 2.0),
        ..*p
    };
    Case::new(start)
        .ok()
        .map(|case| crate::section::start_of(case.parameters()))
}

/// SplitMix64 (G. L. Steele, D. Lea & C. H. Flood, OOPSLA 2014), as a number from 0 to 1.
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Whether neighbours of an orbit return to it.
pub fn attracts(orbit: &Orbit) -> bool {
    matches!(
        orbit.stability(),
        Stability::Stable | Stability::Superstable
    )
}
