//! All tests of the library from outside, as one program: it is linked once, and the tests of all
//! files run side by side.
#![allow(clippy::unwrap_used, clippy::panic)]

mod agrees_with_closed_forms;
mod agrees_with_oracle;
mod agrees_with_published;
mod agrees_with_table_6_1;
mod architecture;
mod billiards;
mod bounces;
mod bouncing_ball;
mod case_parameters;
mod common;
mod corners;
mod drag;
mod floating;
mod floating_random;
mod floating_trust;
mod held_bodies;
mod horizons;
mod invariants;
mod limits;
mod linearised_motion;
mod loose_starts;
mod many_cables;
mod near_events;
mod outcomes;
mod progress;
mod refusals;
mod same_bits;
mod standstill;
mod starts;
mod ties;
mod touches;
mod trust;
mod uncertain_parameters;
