//! The proof of a run, from its case alone: flights, impacts and motion with taut cables, one after
//! the other.

use crate::arithmetic::ball::Ball;
use crate::case::ExactCase;
use crate::model::Model;
use crate::proved::{Proved, ProvedEnd, ProvedImpact, ProvedSegment, Reason};
use crate::run::{Next, Run, Stick, Struck};
use crate::slack::search::{Zero, Zeros};
use crate::taut::law::{Law, after};
use crate::taut::run::{Event, StartData, enclose_taut_motion};
use crate::taut::snap::Pair;
use crate::taut::start::{Instants, hull_of};
use crate::verdict::ProofFailure;
use snapload::Stop;
use std::ops::ControlFlow;

/// Receives each proved event as the proof proceeds.
pub(crate) type OnProved<'a> = dyn FnMut(Proved) -> ControlFlow<ProofFailure> + 'a;

/// Proves a run with numbers of `limbs` limbs; `on_proved` receives each proved event in order.
/// Where a cable sticks and no rule stops the run, it ends as `sticks` unless `taut` asks for the
/// motion from there.
///
/// # Errors
/// What could not be decided, and at which time.
pub(crate) fn prove(
    case: &ExactCase,
    limbs: usize,
    taut: bool,
    on_proved: &mut OnProved<'_>,
) -> Result<ProvedEnd, ProofFailure> {
    let fine = Model::new(case, limbs)?;
    let coarse = Model::new(case, limbs.div_ceil(3).max(2))?;
    let mut run = Run::from_start(case, &fine, &coarse)?;
    let mut report = |proved| match on_proved(proved) {
        ControlFlow::Break(failure) => Err(failure),
        ControlFlow::Continue(()) => Ok(()),
    };
    if run.is_at_rest() {
        let now = resting(&run, taut).map_err(|failure| failure.at(0.0))?;
        let now = match now {
            ControlFlow::Break(end) => return Ok(*end),
            ControlFlow::Continue(now) => now,
        };
        if let Some(end) =
            follow_taut(&mut run, now, &mut report).map_err(|failure| failure.at(0.0))?
        {
            return Ok(end);
        }
    }
    loop {
        let t = run.t.to_f64();
        match run.next_event().map_err(|failure| failure.at(t))? {
            Next::End(end) => return Ok(*end),
            Next::Impact(crossing) => {
                let struck = run
                    .apply_impact(&crossing)
                    .map_err(|failure| failure.at(t))?;
                let Struck {
                    impact, end, stick, ..
                } = struck;
                let t = impact.t.to_f64();
                report(Proved::Impact(impact))?;
                match (end, stick) {
                    (_, Some(stick)) if taut => {
                        let end = follow_taut(&mut run, TautState::from(stick), &mut report);
                        if let Some(end) = end.map_err(|failure| failure.at(t))? {
                            return Ok(end);
                        }
                    }
                    (Some(end), _) => return Ok(end),
                    (None, _) => {}
                }
            }
        }
    }
}

/// The beginning of a motion with taut cables: the states at that instant, before the laws of the
/// event that causes it, and how the other cables leave.
struct TautState {
    taut: Vec<usize>,
    instants: Instants,
    laws: Vec<Law>,
    zeros: Zeros,
}

impl From<Stick> for TautState {
    fn from(Stick { cable, instants }: Stick) -> Self {
        Self {
            taut: vec![cable],
            instants,
            laws: vec![Law::One {
                cable,
                share: Ball::integer(1),
            }],
            zeros: Zeros::new(),
        }
    }
}

/// How a run continues that starts at rest with both cables closed, or its end.
fn resting(
    run: &Run<'_>,
    taut: bool,
) -> Result<ControlFlow<Box<ProvedEnd>, TautState>, ProofFailure> {
    let instants = run.start();
    let (state, t) = hull_of(&instants);
    let (cables, zeros) = Pair::new(run.fine, &state, &t, [0, 1])?.resting()?;
    if cables.len() == 2 && run.case.stop_when_settled {
        let reason = Reason::Stop(Stop::Settled);
        return Ok(ControlFlow::Break(Box::new(ProvedEnd { reason, t, state })));
    }
    if !cables.is_empty() && !taut {
        let what =
            "cables are taut from the start, but a proof of slack flight alone was requested";
        return Err(ProofFailure::not_covered(what));
    }
    Ok(ControlFlow::Continue(TautState {
        taut: cables,
        instants,
        laws: Vec::new(),
        zeros,
    }))
}

/// The motion from where a cable sticks until no cable is taut, or to the end of the run.
fn follow_taut(
    run: &mut Run<'_>,
    mut now: TautState,
    report: &mut dyn FnMut(Proved) -> Result<(), ProofFailure>,
) -> Result<Option<ProvedEnd>, ProofFailure> {
    while !now.taut.is_empty() {
        let (_, from) = hull_of(&now.instants);
        let start = StartData {
            taut: &now.taut,
            instants: &now.instants,
            laws: &now.laws,
            zeros: &now.zeros,
        };
        let end = enclose_taut_motion(run.fine, &start, &mut |t| report(Proved::Step(t.clone())));
        let end = end.map_err(|failure| failure.at(from.to_f64()))?;
        let (state, t) = hull_of(&end.instants);
        report(Proved::Segment(ProvedSegment {
            taut: now.taut.clone(),
            from,
            until: t.clone(),
            event: event_name(end.event),
        }))?;
        now = match end.event {
            Event::Stop(stop) => {
                let reason = Reason::Stop(stop);
                return Ok(Some(ProvedEnd { reason, t, state }));
            }
            Event::Released(cable) => {
                run.slow_row.end();
                now.taut.retain(|other| *other != cable);
                TautState {
                    taut: now.taut,
                    instants: end.instants,
                    laws: Vec::new(),
                    zeros: vec![(cable, Zero::Released)],
                }
            }
            Event::Struck(cable) => {
                let snap = snapped(run, [cable, 1 - cable], end.instants);
                let (impact, next) = snap.map_err(|failure| failure.at(t.to_f64()))?;
                report(Proved::Impact(impact))?;
                match next {
                    ControlFlow::Break(end) => return Ok(Some(*end)),
                    ControlFlow::Continue(next) => next,
                }
            }
        };
    }
    run.continue_slack(&now.instants, &now.laws, now.zeros)?;
    Ok(None)
}

/// An impact, and how the motion continues, or its end.
type Snapped = (ProvedImpact, ControlFlow<Box<ProvedEnd>, TautState>);

/// The impact of a cable while the other one is taut.
fn snapped(
    run: &mut Run<'_>,
    [struck, taut]: [usize; 2],
    instants: Instants,
) -> Result<Snapped, ProofFailure> {
    let (state, t) = hull_of(&instants);
    let pair = Pair::new(run.fine, &state, &t, [struck, taut])?;
    run.impacts += 1;
    let may_stick = run.is_slow(&pair.struck.v_n, struck, &t)? || run.fine.e.is_zero();
    let snap = pair.after(may_stick, run.slow_row.alternates())?;
    let impact = ProvedImpact {
        cable: struck,
        t: t.clone(),
        v_n: pair.struck.v_n.clone(),
    };
    let sticks = snap.taut.contains(&struck);
    let next = match run.stop_at_impact(&state[1], sticks, snap.taut.len())? {
        Some(stop) => {
            let lost = || ProofFailure::undecided("the state after an impact");
            ControlFlow::Break(Box::new(ProvedEnd {
                reason: Reason::Stop(stop),
                t,
                state: after(&snap.rebound, run.fine, &state).ok_or_else(lost)?,
            }))
        }
        None => ControlFlow::Continue(TautState {
            taut: snap.taut,
            instants,
            laws: snap.continuing_laws,
            zeros: snap.zeros,
        }),
    };
    Ok((impact, next))
}

/// The event that ends a segment, in the notation of a certificate.
fn event_name(event: Event) -> String {
    match event {
        Event::Released(cable) => format!("tension {}", cable + 1),
        Event::Struck(cable) => format!("impact {}", cable + 1),
        Event::Stop(stop) => stop.name().to_owned(),
    }
}
