//! The quantities in which long motions, basins and branches are reported, besides those of a run.

use snapload::Quantity;

const fn of(name: &'static str, unit: &'static str, meaning: &'static str) -> Quantity {
    Quantity {
        name,
        symbol: name,
        unit,
        meaning,
    }
}

/// All of them except those whose unit depends on the keys that vary: `lim`, `if` and `iim` of a
/// basin, its cell, and the knee of an erosion.
#[rustfmt::skip] // one row a quantity
pub const QUANTITIES: [Quantity; 23] = [
    of("phase", "", "phase of the forcing, in periods"),
    of("period", "", "period of the motion, in periods of the forcing"),
    of("snaps", "", "snaps per period of the forcing"),
    of("stop_t", "T", "time at which a limit stopped the motion"),
    of("exponent_se", "1/T", "standard error of a Lyapunov exponent"),
    of("gim", "", "global integrity: safe part of the legal cells"),
    of("fraction", "", "safe part of the legal cells"),
    of("interval95", "", "95 % interval of the safe part"),
    of("low", "", "lower end of its 95 % interval"),
    of("high", "", "upper end of its 95 % interval"),
    of("legal", "", "legal cells"),
    of("safe", "", "safe cells"),
    of("undecided", "", "undecided cells"),
    of("cut_short", "", "cells whose run is cut short"),
    of("past_horizon", "", "cells whose horizon of trust comes before their end"),
    of("decided_fraction", "", "safe part of the decided cells"),
    of("fractions", "", "part of the legal cells that reaches each attractor"),
    of("arclength", "", "length along the branch, a norm of numbers in scales"),
    of("multipliers", "", "Floquet multipliers"),
    of("largest_multiplier", "", "largest |multiplier|"),
    of("return_error", "", "error of a simulated lap, a norm of numbers in scales"),
    of("normal_acceleration", "L/T^2", "normal acceleration at a graze"),
    of("sqrt_coefficient", "L^(1/2)/T", "velocity jump per square root of length"),
];

#[cfg(test)]
mod tests {
    use super::QUANTITIES;

    #[test]
    fn every_name_is_there_once_and_is_none_of_a_run() {
        for (place, known) in QUANTITIES.iter().enumerate() {
            let others = &QUANTITIES[place + 1..];
            assert!(others.iter().all(|other| other.name != known.name));
            assert_eq!(snapload::quantity(known.name), None, "{}", known.name);
        }
    }
}
