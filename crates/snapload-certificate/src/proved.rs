//! What is proved of a run.

use crate::arithmetic::ball::Ball;
use crate::model::State;
use snapload::Stop;

/// An impact that is proved to exist and to be the next event.
#[derive(Clone, Debug)]
pub(crate) struct ProvedImpact {
    /// By index from 0.
    pub(crate) cable: usize,
    pub(crate) t: Ball,
    pub(crate) v_n: Ball,
}

/// A segment with taut cables.
#[derive(Clone, Debug)]
pub(crate) struct ProvedSegment {
    /// By index from 0.
    pub(crate) taut: Vec<usize>,
    pub(crate) from: Ball,
    pub(crate) until: Ball,
    /// The event that ends it, in the notation of a certificate.
    pub(crate) event: String,
}

impl ProvedSegment {
    /// The taut cables, from 1, as a certificate has them.
    pub(crate) fn mode(&self) -> Vec<u8> {
        self.taut.iter().map(|cable| *cable as u8 + 1).collect()
    }
}

/// The events of a run in order.
#[derive(Clone, Debug)]
pub(crate) enum Proved {
    Impact(ProvedImpact),
    Segment(ProvedSegment),
    /// A step of taut motion to this time, within a segment that continues.
    Step(Ball),
}

impl Proved {
    /// The time of the event, or the end of the segment.
    pub(crate) fn time(&self) -> &Ball {
        match self {
            Self::Impact(impact) => &impact.t,
            Self::Segment(segment) => &segment.until,
            Self::Step(t) => t,
        }
    }
}

/// Why a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// A stop rule.
    Stop(Stop),
    /// A cable sticks. This is not a stop rule: the motion continues with a taut cable.
    Sticks,
}

impl Reason {
    /// Its name in certificates.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stop(stop) => stop.name(),
            Self::Sticks => "sticks",
        }
    }

    /// The reason that has a name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let mut all = Stop::ALL.into_iter().map(Self::Stop).chain([Self::Sticks]);
        all.find(|reason| reason.name() == name)
    }
}

/// The proved end of a run.
#[derive(Clone, Debug)]
pub(crate) struct ProvedEnd {
    pub(crate) reason: Reason,
    pub(crate) t: Ball,
    pub(crate) state: State,
}
