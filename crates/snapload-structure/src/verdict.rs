//! The answer in words, and how far it can be trusted.

use crate::assess::{Assessment, Outcome, quantile};
use crate::structure::Water;
use snapload::Stop;
use snapload::analysis::HorizonCause;

/// How it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// No line's breaking load is reached.
    Holds,
    /// A line's breaking load is reached.
    Breaks,
    /// The body turned over or touched the floor.
    Exceeds,
    /// A tension or a breaking load is not known.
    Unknown,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// In one word.
    pub standing: Standing,
    /// In a sentence or two.
    pub words: String,
}

/// Why a run stopped, as an engineer would say it.
pub fn end_words(stop: Stop) -> &'static str {
    match stop {
        Stop::EndTime => "ran to the end of the time",
        Stop::RotationLimit => "stopped where the body had turned by 90 degrees",
        Stop::UpperBound => "stopped where the body touched the floor",
        Stop::ImpactLimit => "stopped at the largest number of snaps allowed",
        Stop::Settled | Stop::SlidingStart => "stopped",
    }
}

/// Of fewer neighbours there is no telling what 90 % of them do.
const FEW: usize = 10;

impl Assessment {
    /// Whether the lines go slack, how hard they snap, and whether one breaks.
    pub fn verdict(&self) -> Verdict {
        let structure = &self.prepared.structure;
        let outcome = &self.outcome;
        if outcome.stop.exceeds() {
            let words = format!(
                "The mooring fails: the run {} at {:.1} s.",
                end_words(outcome.stop),
                outcome.end_s
            );
            return Verdict {
                standing: Standing::Exceeds,
                words,
            };
        }
        let slack = outcome.lines.iter().any(|line| line.slack_fraction > 0.0);
        let snaps: u64 = outcome.lines.iter().map(|line| line.snaps).sum();
        let begins = match (slack, snaps) {
            (false, _) => "No line goes slack.".to_owned(),
            (true, 0) => "Lines go slack, and none snaps at 1 cm/s or more.".to_owned(),
            (true, _) => format!(
                "Lines go slack and snap, at up to {:.2} m/s.",
                outcome.speed_m_s()
            ),
        };
        let utilisations = outcome.utilisations(structure);
        let worst = utilisations
            .iter()
            .enumerate()
            .filter_map(|(line, utilisation)| utilisation.map(|u| (line, u)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let unknown = utilisations.iter().any(Option::is_none);
        let (standing, says) = match worst {
            Some((_, u)) if u >= 1.0 => (Standing::Breaks, self.breaking_words(&utilisations)),
            _ if outcome.stop == Stop::ImpactLimit => (
                Standing::Unknown,
                "Whether a line breaks is not known.".to_owned(),
            ),
            Some((line, u)) if !unknown => (
                Standing::Holds,
                format!("No line breaks: the largest estimated tension, in line {}, is {u:.2} of its breaking load, without any factor of safety.", line + 1),
            ),
            _ => (
                Standing::Unknown,
                "Whether a line breaks is not known: give each line type and diameter, or stiffness and breaking_load.".to_owned(),
            ),
        };
        Verdict {
            standing,
            words: format!(
                "{begins} {says}{}{}",
                self.transient_words(),
                self.cut_words()
            ),
        }
    }

    /// Every line that would break, and how.
    fn breaking_words(&self, utilisations: &[Option<f64>]) -> String {
        let lines = self.outcome.lines.iter().zip(utilisations).enumerate();
        let broken: Vec<String> = lines
            .filter_map(|(line, (outcome, utilisation))| {
                let u = utilisation.filter(|u| *u >= 1.0)?;
                let in_a_snap = outcome.peak_n.is_some_and(|peak| peak >= outcome.held_n);
                let how = if in_a_snap { "in a snap" } else { "while taut" };
                Some(format!("line {} ({u:.2}, {how})", line + 1))
            })
            .collect();
        format!(
            "Would break, by estimated tension over breaking load: {}.",
            broken.join(", ")
        )
    }

    /// That a run was cut short, where it was.
    fn cut_words(&self) -> String {
        match self.outcome.stop {
            Stop::EndTime => String::new(),
            stop => format!(
                " The run {} at {:.0} s and tells nothing of what follows.",
                end_words(stop),
                self.outcome.end_s
            ),
        }
    }

    /// What the verdict leaves out, where that is harder than what it judges.
    fn transient_words(&self) -> String {
        let structure = &self.prepared.structure;
        let early = self
            .snaps
            .iter()
            .filter(|snap| snap.t_s < structure.transient_s);
        let hardest = early.max_by(|a, b| a.speed_m_s.total_cmp(&b.speed_m_s));
        match hardest {
            Some(snap) if snap.speed_m_s > self.outcome.speed_m_s() && snap.counts() => {
                let about = snap.peak_n.map_or(String::new(), |peak| {
                    format!(", about {:.0} kN", peak / 1e3)
                });
                format!(
                    " Not judged: in the first {:.0} s, as the waves begin at once on a body at rest, line {} snaps at {:.2} m/s{about}.",
                    structure.transient_s,
                    snap.line + 1,
                    snap.speed_m_s
                )
            }
            _ => String::new(),
        }
    }

    /// How far the run can be trusted, with the numbers.
    pub fn trust_words(&self) -> String {
        let single = match (self.horizon_s(), self.trust.horizon) {
            (Some(t), Some(horizon)) => {
                let why = match horizon.cause {
                    HorizonCause::Tolerance => {
                        "rounding has grown past a thousandth of the anchors' half distance"
                    }
                    HorizonCause::Graze { .. } | HorizonCause::NearMiss { .. } => {
                        "a line comes so near to being taut, or snaps so softly, that a neighbour may do otherwise"
                    }
                    HorizonCause::Simultaneous => {
                        "lines snap at one instant, and which is first decides what follows"
                    }
                    HorizonCause::Start { .. } | HorizonCause::StopRule => {
                        "a neighbour may start or stop otherwise"
                    }
                };
                format!("Taken by itself this run is certain up to t = {t:.1} s: there {why}.")
            }
            _ => "The whole run is certain to three digits, as far as rounding goes.".to_owned(),
        };
        let Some(spread) = self.spread() else {
            return single;
        };
        let irregular = matches!(self.prepared.structure.water, Water::Sea(_));
        let failing = self.neighbours.iter().filter(|n| n.stop.exceeds()).count();
        if failing > 0 {
            return format!(
                "{single} Of {} neighbours in waves that differ by at most 1e-6 of their height {failing} turn over or touch the floor.",
                self.neighbours.len()
            );
        }
        let advice = if spread[2] > 1.02 * spread[0] {
            "Single peaks mean little here; take the distribution."
        } else if irregular {
            "The peak of this record is not in doubt, but another record of the same sea has another: see snapload seas."
        } else if self.trust.horizon.is_none() {
            "The peak is not in doubt."
        } else {
            "The peak is not in doubt, even where the motion in detail is."
        };
        if self.neighbours.len() < FEW {
            return format!(
                "{single} Of {} in waves that differ by at most 1e-6 of their height the largest tension in a snap is {:.0} to {:.0} kN.",
                if self.neighbours.len() == 1 {
                    "one neighbour".to_owned()
                } else {
                    format!("{} neighbours", self.neighbours.len())
                },
                spread[0] / 1e3,
                spread[2] / 1e3,
            );
        }
        format!(
            "{single} Among {} neighbours in waves that differ by at most 1e-6 of their height the largest tension in a snap is {:.0} kN in the median, {:.0} to {:.0} kN in 90 % of them. {advice}",
            self.neighbours.len(),
            spread[1] / 1e3,
            spread[0] / 1e3,
            spread[2] / 1e3,
        )
    }

    /// 5 %, 50 % and 95 % of the neighbours' largest tension in a snap; none where there is none \[N\].
    pub fn spread(&self) -> Option<[f64; 3]> {
        let lines = &self.prepared.structure.lines;
        if lines.iter().any(|line| line.stiffness_n.is_none()) {
            return None;
        }
        let peak = |outcome: &Outcome| outcome.peak_n().unwrap_or(0.0);
        let mut peaks: Vec<f64> = self.neighbours.iter().map(peak).collect();
        peaks.sort_by(f64::total_cmp);
        Some([
            quantile(&peaks, 0.05)?,
            quantile(&peaks, 0.5)?,
            quantile(&peaks, 0.95)?,
        ])
    }
}
