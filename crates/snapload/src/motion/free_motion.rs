//! The motion without cable forces as differential equations of the first order, for integrators of
//! one's own: of elastic lines, or of other forces of the state.

use crate::arithmetic::processor::{Kernel, dispatch};
use crate::model::floating::{Channel, Complex, Floating};
use crate::model::state::State;
use crate::model::system::System;
use crate::motion::waves::Waves;

/// The equations of a system's motion without cable forces (docs/model.md section 3, and
/// docs/floating.md where the body floats).
#[derive(Clone, Debug)]
pub struct FreeMotion {
    system: System,
    waves: Waves,
    channels: Vec<Channel<f64>>,
}

impl FreeMotion {
    /// The equations for a system.
    pub fn new(system: &System) -> Self {
        let channels = system.floating.iter().flat_map(Floating::channels);
        Self {
            system: system.clone(),
            waves: Waves::new(system),
            channels: channels.collect(),
        }
    }

    /// The accelerations (ẍ, ÿ, θ̈) at a time and state, given that of the water's memory, whose
    /// rates of change are written to `rates`; both in the order of [`System::memory_at_rest`], and
    /// what is beyond it is left as it is. The body's mass is 1.
    #[must_use]
    pub fn rates(
        &mut self,
        t: f64,
        state: &State,
        memory: &[Complex<f64>],
        rates: &mut [Complex<f64>],
    ) -> [f64; 3] {
        dispatch(Rates {
            motion: self,
            t,
            state,
            memory,
            rates,
        })
    }
}

/// The rates at one instant.
struct Rates<'r> {
    motion: &'r mut FreeMotion,
    t: f64,
    state: &'r State,
    memory: &'r [Complex<f64>],
    rates: &'r mut [Complex<f64>],
}

impl Kernel for Rates<'_> {
    type Output = [f64; 3];
    #[inline(always)]
    fn run(self) -> [f64; 3] {
        let FreeMotion {
            system,
            waves,
            channels,
        } = self.motion;
        let mut held = [0.0; 3];
        for ((channel, z), rate) in channels.iter().zip(self.memory).zip(self.rates) {
            *rate = channel.rate(self.state, *z);
            channel.add_force(*z, &mut held);
        }
        waves.cover(self.t, self.t);
        let around = waves.at(system, self.t);
        system.free_acceleration(&around, self.state, held)
    }
}
