//! Sequences of events, which are the symbol of an orbit.

use snapload::TautSet;

/// What happens at an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// Surfaces are struck; those of `pulling` take impulses.
    Snap {
        /// The ones that are struck.
        struck: TautSet,
        /// These, and held ones that the impulse loads.
        pulling: TautSet,
    },
    /// Held surfaces lose their tension.
    Release(TautSet),
}

/// An event, and which surfaces are held after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// What happens.
    pub kind: EventKind,
    /// The held surfaces after it.
    pub after: TautSet,
}

/// A sequence of events from one section to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sequence {
    /// The held surfaces at the section.
    pub start: TautSet,
    /// The events.
    pub events: Vec<Event>,
}

/// A sequence with the time from each event to the next; the first is counted from the section.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timed {
    /// The sequence.
    pub sequence: Sequence,
    /// A time for each event.
    pub durations: Vec<f64>,
    /// The closing velocity of each event; 0 of a release.
    pub speeds: Vec<f64>,
}

/// Snaps slower than this before a stick belong to an accumulation, whose number of snaps has no
/// meaning.
const ACCUMULATING: f64 = 0.01;

impl Sequence {
    /// The held surfaces of each leg: from the section to the first event, and so on, to the
    /// section.
    pub fn taut_sets(&self) -> Vec<TautSet> {
        let after = self.events.iter().map(|event| event.after);
        std::iter::once(self.start).chain(after).collect()
    }

    /// The held surfaces at the end.
    pub fn last(&self) -> TautSet {
        self.events.last().map_or(self.start, |event| event.after)
    }

    /// How many surfaces are struck.
    pub fn snaps(&self) -> usize {
        self.events.iter().map(|event| event.struck().len()).sum()
    }

    /// The surfaces struck, one after the other, from 0.
    pub fn struck(&self) -> Vec<usize> {
        let struck = self.events.iter().flat_map(|event| event.struck().iter());
        struck.collect()
    }

    /// As text: `2` is a snap of cable 2, `stick 2` that it stays taut, `release 2` that it lets
    /// go.
    pub fn symbol(&self) -> Vec<String> {
        let mut parts = Vec::new();
        for (event, before) in self.events.iter().zip(self.taut_sets()) {
            parts.extend(event.struck().iter().map(|cable| (cable + 1).to_string()));
            let gone = before.iter().filter(|&cable| !event.after.contains(cable));
            parts.extend(gone.map(|cable| format!("release {}", cable + 1)));
            let new = event.after.iter().filter(|&cable| !before.contains(cable));
            parts.extend(new.map(|cable| format!("stick {}", cable + 1)));
        }
        parts
    }
}

impl Event {
    /// The surfaces struck.
    pub fn struck(&self) -> TautSet {
        match self.kind {
            EventKind::Snap { struck, .. } => struck,
            EventKind::Release(_) => TautSet::SLACK,
        }
    }

    /// The surfaces whose tension has fallen to zero.
    pub(crate) fn released(&self) -> TautSet {
        match self.kind {
            EventKind::Snap { .. } => TautSet::SLACK,
            EventKind::Release(released) => released,
        }
    }

    /// The surfaces that take an impulse.
    pub fn pulling(&self) -> TautSet {
        match self.kind {
            EventKind::Snap { pulling, .. } => pulling,
            EventKind::Release(_) => TautSet::SLACK,
        }
    }

    /// The surfaces that it brings to rest and does not hold: those that take an impulse and
    /// neither stay nor rebound.
    pub(crate) fn stops(&self, rebounds: bool) -> TautSet {
        let struck = self.struck();
        let rests = |surface: &usize| !(rebounds && struck.contains(*surface));
        let pulling = self.pulling().iter().filter(rests);
        pulling.filter(|&s| !self.after.contains(s)).collect()
    }

    /// The surface whose gap, or whose tension, is zero at the event.
    pub fn surface(&self) -> usize {
        let set = match self.kind {
            EventKind::Snap { struck, .. } => struck,
            EventKind::Release(released) => released,
        };
        set.iter().next().unwrap_or(0)
    }
}

impl Timed {
    /// Which events are slow snaps that lead to a stick.
    fn accumulating(&self) -> Vec<bool> {
        let events = &self.sequence.events;
        let taut_sets = self.sequence.taut_sets();
        let mut marks = vec![false; events.len()];
        for (k, event) in events.iter().enumerate() {
            if !event
                .after
                .iter()
                .any(|cable| !taut_sets[k].contains(cable))
            {
                continue;
            }
            let is_slow = |i: &usize| {
                !marks[*i] && !events[*i].struck().is_empty() && self.speeds[*i] < ACCUMULATING
            };
            let first = (0..k).rev().take_while(is_slow).last().unwrap_or(k);
            marks[first..k].fill(true);
        }
        marks
    }

    /// Whether slow snaps lead to a stick.
    pub(crate) fn accumulates(&self) -> bool {
        self.accumulating().contains(&true)
    }

    /// Whether the slowest snap is one of those that lead to a stick, or that stick itself.
    pub(crate) fn is_slowest_in_accumulation(&self) -> bool {
        let marks = self.accumulating();
        let events = self.sequence.events.iter().zip(&self.speeds).enumerate();
        let snaps = events.filter(|(_, (event, _))| !event.struck().is_empty());
        let slowest = snaps.min_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b));
        slowest.is_some_and(|(k, _)| marks[k] || k > 0 && marks[k - 1])
    }

    /// The sequence without the slow snaps that lead to a stick.
    fn without_accumulations(&self) -> Sequence {
        let marks = self.accumulating();
        let kept = self.sequence.events.iter().zip(marks);
        let kept = kept.filter(|(_, accumulates)| !accumulates);
        Sequence {
            start: self.sequence.start,
            events: kept.map(|(event, _)| *event).collect(),
        }
    }

    /// Whether the events are the same, apart from the number of snaps in an accumulation.
    pub fn same_events(&self, other: &Self) -> bool {
        self.sequence == other.sequence
            || self.without_accumulations().symbol() == other.without_accumulations().symbol()
    }
}

/// A symbol in one line.
pub fn symbol_text(sequence: &Sequence) -> String {
    let symbol = sequence.symbol();
    if symbol.is_empty() {
        "none".to_owned()
    } else {
        symbol.join(", ")
    }
}
