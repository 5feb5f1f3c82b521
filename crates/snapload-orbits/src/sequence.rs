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

/// Snaps slower than this that lead to rest belong to an accumulation: their number, and the order
/// in which those of several surfaces come, have no meaning.
const ACCUMULATING: f64 = 0.01;
/// What is left of an accumulation where it is cut off takes no longer than this, so that it moves
/// the body by little more than rounding.
const AT_ONCE: f64 = 1e-5;

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

    /// The same in whole words. Snaps of one cable that follow each other are counted: where
    /// impacts accumulate they are many.
    pub fn in_words(&self) -> String {
        let event = |same: &[String]| match (same[0].split_once(' '), same.len()) {
            (None, 1) => format!("snap of cable {}", same[0]),
            (None, count) => format!("{count} snaps of cable {}", same[0]),
            (Some((what, cable)), _) => format!("{what} of cable {cable}"),
        };
        let symbol = self.symbol();
        let are_snaps_of_one = |one: &String, next: &String| one == next && !one.contains(' ');
        let all: Vec<String> = symbol.chunk_by(are_snaps_of_one).map(event).collect();
        match all.is_empty() {
            true => "none".to_owned(),
            false => all.join(", "),
        }
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
    /// The rows of snaps, each slower than `v`, at whose end all surfaces are held that were struck
    /// in them: the places of the first and the last one.
    fn rows_to_rest(&self, v: f64) -> Vec<[usize; 2]> {
        let events = &self.sequence.events;
        let is_slow = |k: &usize| !events[*k].struck().is_empty() && self.speeds[*k] < v;
        let mut rows = Vec::new();
        let mut first = 0;
        while first < events.len() {
            let mut struck = TautSet::SLACK;
            let mut rests = |k: &usize| {
                struck = struck.union(events[*k].struck());
                struck.intersection(events[*k].after) == struck
            };
            let slow = (first..events.len()).take_while(is_slow);
            let last = slow.filter(|k| rests(k)).last();
            rows.extend(last.map(|last| [first, last]));
            first = last.unwrap_or(first) + 1;
        }
        rows
    }

    /// The accumulations: rows of several slow snaps that lead to rest.
    fn accumulations(&self) -> impl Iterator<Item = [usize; 2]> {
        let rows = self.rows_to_rest(ACCUMULATING).into_iter();
        rows.filter(|[first, last]| first < last)
    }

    /// Whether slow snaps lead to rest.
    pub(crate) fn accumulates(&self) -> bool {
        self.accumulations().next().is_some()
    }

    /// Which events belong to an accumulation.
    pub(crate) fn accumulating(&self) -> Vec<bool> {
        let mut marks = vec![false; self.sequence.events.len()];
        for [first, last] in self.accumulations() {
            marks[first..=last].fill(true);
        }
        marks
    }

    /// Whether all snaps of accumulations close, one after the other and before the next event.
    pub(crate) fn accumulates_in_order(&self) -> bool {
        self.accumulations().all(|[first, last]| {
            let mut speeds = self.speeds[first..=last].iter();
            let mut durations = self.durations.iter().take(last + 2).skip(first + 1);
            speeds.all(|v| *v > 0.0) && durations.all(|s| *s >= 0.0)
        })
    }

    /// The same with the surfaces at rest from the first snap on that is slower than `v`, where all
    /// snaps from there to their rest are: those have no more meaning than the ones left out, and
    /// rounding decides about them.
    pub(crate) fn cut_off(mut self, v: f64) -> Self {
        for [first, last] in self.rows_to_rest(v).into_iter().rev() {
            let rest = |k: usize| self.durations[k + 1..=last].iter().sum::<f64>();
            let first = (first..last).find(|k| rest(*k) <= AT_ONCE);
            let Some((first, rest)) = first.map(|first| (first, rest(first))) else {
                continue;
            };
            self.sequence.events[first].after = self.sequence.events[last].after;
            self.sequence.events.drain(first + 1..=last);
            self.speeds.drain(first + 1..=last);
            self.durations.drain(first + 1..=last);
            if let Some(next) = self.durations.get_mut(first + 1) {
                *next += rest;
            }
        }
        self
    }

    /// The sequence with one snap of the surfaces that come to rest in place of each accumulation.
    fn without_accumulations(&self) -> Sequence {
        let mut sequence = self.sequence.clone();
        let taut_sets = self.sequence.taut_sets();
        let rows: Vec<_> = self.accumulations().collect();
        for [first, last] in rows.into_iter().rev() {
            let rest = self.sequence.events[last].after.iter();
            let struck = rest.filter(|&s| !taut_sets[first].contains(s)).collect();
            let pulling = struck;
            sequence.events[last].kind = EventKind::Snap { struck, pulling };
            sequence.events.drain(first..last);
        }
        sequence
    }

    /// Whether the events are the same, apart from the snaps within accumulations.
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

#[cfg(test)]
mod tests {
    use super::{Event, EventKind, Sequence};
    use snapload::TautSet;

    #[test]
    fn snaps_of_one_cable_in_a_row_are_counted() {
        let snap = |cable: usize, after: TautSet| Event {
            kind: EventKind::Snap {
                struck: TautSet::only(cable),
                pulling: TautSet::only(cable),
            },
            after,
        };
        let slack = TautSet::SLACK;
        let let_go = Event {
            kind: EventKind::Release(TautSet::only(0)),
            after: slack,
        };
        let accumulation = [snap(0, slack), snap(0, slack), snap(0, TautSet::only(0))];
        let others = [let_go, snap(0, slack), snap(1, slack)];
        let events = accumulation.into_iter().chain(others).collect();
        let sequence = Sequence {
            start: slack,
            events,
        };
        let words = "3 snaps of cable 1, stick of cable 1, release of cable 1, snap of cable 1, \
                     snap of cable 2";
        assert_eq!(sequence.in_words(), words);
        assert_eq!(Sequence::default().in_words(), "none");
    }
}
