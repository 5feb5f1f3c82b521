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

    /// The surfaces that take an impulse.
    pub fn pulling(&self) -> TautSet {
        match self.kind {
            EventKind::Snap { pulling, .. } => pulling,
            EventKind::Release(_) => TautSet::SLACK,
        }
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
    /// The sequence without the slow snaps that lead to a stick.
    fn without_accumulations(&self) -> Sequence {
        let mut kept: Vec<(Event, f64)> = Vec::new();
        let mut taut = self.sequence.start;
        for (event, speed) in self.sequence.events.iter().zip(&self.speeds) {
            let sticks = event.after.iter().any(|cable| !taut.contains(cable));
            if sticks {
                while let Some((last, slow)) = kept.last()
                    && !last.struck().is_empty()
                    && *slow < ACCUMULATING
                {
                    kept.pop();
                }
            }
            kept.push((*event, *speed));
            taut = event.after;
        }
        Sequence {
            start: self.sequence.start,
            events: kept.into_iter().map(|(event, _)| event).collect(),
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
