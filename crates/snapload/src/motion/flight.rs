//! Slack flight, in closed form.

use crate::arithmetic::plane::{Rotation, Vector2};
use crate::arithmetic::processor::apart;
use crate::arithmetic::real::Real;
use crate::model::forcing::Harmonic;
use crate::model::rules::Rules;
use crate::model::state::State;
use crate::model::system::System;
use crate::model::taut_set::TautSet;
use crate::motion::attachment::{Attachment, GapJet, Instant};
use crate::motion::contact::{Contact, Contacts};
use crate::motion::events::{EventFunction, HasEvents, Jet, Jets};
use crate::motion::limits::Limits;
use crate::motion::limits::law::Flying;

/// The free motion from a state, with no cable taut (docs/model.md section 4; any sum of
/// sinusoids).
#[derive(Clone, Debug)]
pub(crate) struct Flight<T> {
    start: State<T>,
    sine: T,
    cosine: T,
    constant: Vector2<T>,
    harmonics: Vec<Harmonic<T>>,
    attachments: Vec<Attachment<T>>,
    /// The cables that are known to be closed and at rest at the start.
    resting: TautSet,
    limits: Limits<T>,
}

impl<T: Real> Flight<T> {
    /// A flight not yet begun, with room for the forcing of `system`.
    pub(crate) fn new(system: &System<T>, rules: &Rules<T>) -> Self {
        Self {
            start: State::default(),
            sine: T::ZERO,
            cosine: T::ONE,
            constant: system.forcing.constant,
            harmonics: system.forcing.harmonics.clone(),
            attachments: Vec::with_capacity(system.cables.len()),
            resting: TautSet::SLACK,
            limits: Limits::of(system, rules),
        }
    }

    /// Begins the flight at time `t` from `start`, the state after an event; `before` is the state
    /// before it.
    #[inline(always)]
    pub(crate) fn begin(
        &mut self,
        system: &System<T>,
        t: T,
        start: &State<T>,
        before: &State<T>,
        contacts: &Contacts<T>,
    ) {
        apart!(T, {
            self.start = *start;
            let rotation = Rotation::by(start.theta);
            (self.sine, self.cosine) = (rotation.sine, rotation.cosine);
            for (local, harmonic) in self.harmonics.iter_mut().zip(&system.forcing.harmonics) {
                *local = harmonic.shifted(t);
            }
            let force = system.forcing.bounds();
            let speed =
                |state: &State<T>, reach: T| state.velocity().length() + state.vtheta.abs() * reach;
            self.resting = TautSet::SLACK;
            self.attachments.clear();
            for (index, cable) in system.cables.iter().enumerate() {
                let contact: &Contact<T> = &contacts[index];
                let reach = cable.fairlead().length();
                let speed = speed(start, reach).max(speed(before, reach));
                let known = [contact.gap, contact.error];
                let mut attachment =
                    Attachment::new(cable, reach, start, &rotation, known, speed, force);
                if contact.resting {
                    attachment.gap_rate = T::ZERO;
                    self.resting = self.resting.with(index);
                }
                self.attachments.push(attachment);
            }
        })
    }

    #[inline(always)]
    fn instant(&self, s: T) -> Instant<T> {
        let mut flight = Instant::at(s, self.constant, self.start.vtheta);
        for harmonic in &self.harmonics {
            flight = flight.with(harmonic, s);
        }
        flight
    }

    /// The state a time `s` into the flight.
    #[inline(always)]
    pub(crate) fn state(&self, s: T) -> State<T> {
        self.instant(s).state(&self.start, s)
    }

    /// The gap of a cable a time `s` into the flight.
    #[inline(always)]
    pub(crate) fn contact(&self, cable: usize, s: T) -> Contact<T> {
        let jet = self.attachments[cable].jet(s, &self.instant(s));
        Contact {
            gap: jet.value,
            error: jet.noise,
            resting: false,
        }
    }

    /// g and ġ of a cable a time `s` into the flight.
    #[inline(always)]
    pub(crate) fn gap_and_rate(&self, cable: usize, s: T) -> (T, T) {
        let jet = self.attachments[cable].jet(s, &self.instant(s));
        (jet.value, jet.rate)
    }

    /// ġ and g̈ of a cable a time `s` into the flight.
    #[inline(always)]
    pub(crate) fn gap_rate_and_acceleration(&self, cable: usize, s: T) -> (T, T) {
        let jet = self.attachments[cable].jet(s, &self.instant(s));
        (jet.rate, jet.accel)
    }

    /// Bound on |g⃛| of a cable within a flight of length `s`.
    pub(crate) fn gap_jerk_bound(&self, cable: usize, s: T) -> T {
        self.attachments[cable].third(s)
    }

    /// The gap of a cable at the flight's start, with its error.
    pub(crate) fn contact_at_start(&self, cable: usize) -> Contact<T> {
        let attachment = &self.attachments[cable];
        Contact {
            gap: attachment.gap,
            error: attachment.gap_error,
            resting: false,
        }
    }

    /// Whether a cable was known to be closed and at rest at the start.
    pub(crate) fn rested(&self, cable: usize) -> bool {
        self.resting.contains(cable)
    }

    /// g, ġ, g̈ of a cable, with |g⃛| ≤ 2 (3 |Ṗ||P̈| + r |P⃛|) from there on.
    /// |P − A| ≤ r holds up to the first crossing, and the bound is used only up to there. |Ṗ|
    /// grows by at most |P̈| σ.
    #[inline(always)]
    fn gap_jet(&self, cable: usize, s: T, jet: &GapJet<T>) -> Jet<T> {
        let attachment = &self.attachments[cable];
        let [a, j, _] = attachment.bounds;
        Jet {
            third: (jet.velocity.length() * a * 3.0 + attachment.length * j) * 2.0,
            fourth: a * a * 6.0,
            noise: jet.noise,
            start_noise: attachment.start_noise(s),
            ..Jet::new(EventFunction::Gap(cable), jet.value, jet.rate, jet.accel)
        }
    }

    /// The jet of a cable known to be closed and at rest, at the start of the flight: with ġ = 0
    /// exact, g⃛ exact, and |g⁗| ≤ 2 (3 |P̈|² + 4 |Ṗ||P⃛| + r |P⁗|).
    fn resting_jet(&self, cable: usize, jerk: T, jet: Jet<T>) -> Jet<T> {
        let attachment = &self.attachments[cable];
        let [a, j, k] = attachment.bounds;
        // Over one unit of time; a longer first step is never needed.
        let speed = attachment.velocity.length() + a;
        Jet {
            resting: true,
            start_noise: attachment.length.squared() * T::EPSILON * 4.0,
            jerk,
            fourth: (a * a * 3.0 + speed * j * 4.0 + attachment.length * k) * 2.0,
            ..jet
        }
    }

    #[inline(always)]
    fn limit_jets(&self, s: T, now: &Instant<T>, jets: &mut Jets<T>) {
        let Rotation { sine, cosine, .. } = now.rotation;
        self.limits.in_flight(
            &Flying {
                state: &now.state(&self.start, s),
                sine: self.sine * cosine + self.cosine * sine,
                cosine: self.cosine * cosine - self.sine * sine,
                push: &now.push,
            },
            jets,
        );
    }
}

impl<T: Real> HasEvents<T> for Flight<T> {
    #[inline(always)]
    fn jets_at(&self, s: T, jets: &mut Jets<T>) {
        let now = self.instant(s);
        for cable in 0..self.attachments.len() {
            let seen = self.attachments[cable].jet(s, &now);
            let jet = self.gap_jet(cable, s, &seen);
            let at_rest = s == T::ZERO && self.resting.contains(cable);
            jets.push(if at_rest {
                self.resting_jet(cable, seen.jerk, jet)
            } else {
                jet
            });
        }
        self.limit_jets(s, &now, jets);
    }
}
