//! The proof of a run, from nothing but its case: flights, impacts and motion with one taut cable,
//! one after the other.

use crate::arithmetic::ball::Ball;
use crate::case::ExactCase;
use crate::model::Model;
use crate::proved::{Proved, ProvedEnd, ProvedImpact, ProvedStretch, Reason};
use crate::run::{Next, Run, Stick, Struck};
use crate::slack::impact::Impact;
use crate::slack::search::Zero;
use crate::taut::run::{Begin, Event, TautEnd, beside_a_taut_cable, slide};
use crate::verdict::Trouble;
use snapload::Stop;
use std::ops::ControlFlow;

/// What a proof tells as it goes.
pub(crate) type OnProved<'a> = dyn FnMut(Proved) -> ControlFlow<Trouble> + 'a;

/// Proves a run with numbers of so many limbs; `on_proved` is shown all of it in order. Where a cable
/// sticks and no rule stops the run, it ends as `sticks` unless `taut` asks for the motion from there.
///
/// # Errors
/// What could not be decided, and when.
pub(crate) fn prove(
    case: &ExactCase,
    limbs: usize,
    taut: bool,
    on_proved: &mut OnProved<'_>,
) -> Result<ProvedEnd, Trouble> {
    let fine = Model::new(case, limbs)?;
    let coarse = Model::new(case, limbs.div_ceil(3).max(2))?;
    let mut run = Run::begin(case, &fine, &coarse)?;
    let mut tell = |proved| match on_proved(proved) {
        ControlFlow::Break(trouble) => Err(trouble),
        ControlFlow::Continue(()) => Ok(()),
    };
    loop {
        let t = run.t.to_f64();
        match run.fly().map_err(|trouble| trouble.at(t))? {
            Next::End(end) => return Ok(*end),
            Next::Impact(crossing) => {
                let Struck { impact, end, stick } =
                    run.strike(&crossing).map_err(|trouble| trouble.at(t))?;
                let t = impact.t.to_f64();
                tell(Proved::Impact(impact))?;
                match (end, stick) {
                    (_, Some(stick)) if taut => {
                        let end = hang(&mut run, stick, &mut tell);
                        if let Some(end) = end.map_err(|trouble| trouble.at(t))? {
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

/// The motion from where a cable sticks to where it flies again, or to the end of the run.
fn hang(
    run: &mut Run<'_>,
    mut stick: Stick,
    tell: &mut dyn FnMut(Proved) -> Result<(), Trouble>,
) -> Result<Option<ProvedEnd>, Trouble> {
    let mut other_opens = false;
    loop {
        let cable = stick.cable;
        let begin = Begin {
            cable,
            t: &stick.t,
            state: &stick.state,
            other_opens,
        };
        let TautEnd { t, state, event } =
            slide(run.fine, &begin).map_err(|trouble| trouble.at(stick.t.to_f64()))?;
        tell(Proved::Stretch(ProvedStretch {
            cable,
            from: stick.t.clone(),
            until: t.clone(),
            event: words(event, cable),
        }))?;
        match event {
            Event::Stop(stop) => {
                let reason = Reason::Stop(stop);
                return Ok(Some(ProvedEnd { reason, t, state }));
            }
            Event::Released => {
                run.take_off(&t, state, vec![(cable, Zero::Released)]);
                return Ok(None);
            }
            Event::Struck => {
                let end = TautEnd { t, state, event };
                let (impact, after, stays) = struck(run, cable, end)?;
                let t = impact.t.clone();
                let count = run.impacts > run.case.max_impacts;
                let other = impact.cable;
                tell(Proved::Impact(impact))?;
                if count {
                    let reason = Reason::Stop(Stop::ImpactLimit);
                    let state = after;
                    return Ok(Some(ProvedEnd { reason, t, state }));
                }
                if !stays {
                    let zeros = vec![(cable, Zero::Opening), (other, Zero::Opening)];
                    run.take_off(&t, after, zeros);
                    return Ok(None);
                }
                other_opens = true;
                stick = Stick {
                    cable,
                    t,
                    state: after,
                };
            }
        }
    }
}

/// The impact of the other cable while one is taut: it, the state after it, and whether the taut one
/// stays so.
fn struck(
    run: &mut Run<'_>,
    taut: usize,
    TautEnd { t, state, .. }: TautEnd,
) -> Result<(ProvedImpact, [Ball; 6], bool), Trouble> {
    let other = 1 - taut;
    let model = run.fine;
    let impact = Impact::new(model, other, &state)?;
    let at_rest = Impact::new(model, taut, &state)?;
    run.impacts += 1;
    let over = &impact.v_n - &model.v_stick;
    if over.is_negative() || run.case.number("e").is_zero() {
        let what = "a snap beside a taut cable that may leave both at rest";
        return Err(Trouble::beyond(what).at(t.to_f64()));
    }
    if !over.is_positive() {
        return Err(Trouble::undecided("v_n against v_stick").at(t.to_f64()));
    }
    let ([vx, vy, spin], stays) = beside_a_taut_cable(model, &impact, &at_rest, &state)?;
    let [x, y, theta, ..] = state;
    let impact = ProvedImpact {
        cable: other,
        t,
        v_n: impact.v_n,
    };
    Ok((impact, [x, y, theta, vx, vy, spin], stays))
}

/// What ends a stretch, as a certificate has it.
fn words(event: Event, cable: usize) -> String {
    match event {
        Event::Released => format!("tension {}", cable + 1),
        Event::Struck => format!("impact {}", 2 - cable),
        Event::Stop(stop) => stop.name().to_owned(),
    }
}
