//! The quantities in which a run is reported: their names, symbols, units and meanings.

/// A quantity of the motion, as it is called in tables, files, pictures and other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Its name in files and in programs.
    pub name: &'static str,
    /// Its symbol in the text of the model.
    pub symbol: &'static str,
    /// Its unit, from the length L, mass m, force F and time T of the model; empty where it has
    /// none.
    pub unit: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
}

const fn of(
    name: &'static str,
    symbol: &'static str,
    unit: &'static str,
    meaning: &'static str,
) -> Quantity {
    Quantity {
        name,
        symbol,
        unit,
        meaning,
    }
}

/// All of them.
#[rustfmt::skip] // one row a quantity
pub const QUANTITIES: [Quantity; 19] = [
    of("t", "*t*", "T", "time"),
    of("x", "*x*", "L", "horizontal position of the centre"),
    of("y", "*y*", "L", "vertical position of the centre"),
    of("theta", "*θ*", "rad", "rotation"),
    of("vx", "*ẋ*", "L/T", "horizontal velocity of the centre"),
    of("vy", "*ẏ*", "L/T", "vertical velocity of the centre"),
    of("vtheta", "*θ̇*", "rad/T", "angular velocity"),
    of("v_n", "*v*ₙ", "L/T", "normal velocity just before the impact"),
    of("impulse", "*p*", "m L/T", "impulse in the cable"),
    of("energy_lost", "Δ*E*", "F L", "energy lost in the impact"),
    of("tension", "*T*", "F", "tension of a cable"),
    of("energy", "*E*", "F L", "kinetic energy, and potential energy in the constant force"),
    of("digits", "digits", "", "decimal digits expected to be right"),
    of("rho1", "ρ₁", "L/T", "largest v_n of a snap"),
    of("rho2", "ρ₂", "L/T", "sum of v_n up to t = 10"),
    of("rho3", "ρ₃", "L/T", "sum of v_n"),
    of("y_max", "*y*ₘₐₓ", "L", "highest y of the centre"),
    of("theta_max", "|*θ*|ₘₐₓ", "rad", "largest rotation"),
    of("exponent", "*λ*", "1/T", "Lyapunov exponent"),
];

/// A meaning in short: the part before a colon, a semicolon or a comma.
pub fn title_of(meaning: &str) -> &str {
    meaning.split([':', ';', ',']).next().unwrap_or(meaning)
}

/// The quantity of this name.
pub const fn quantity(name: &str) -> Option<&'static Quantity> {
    let mut k = 0;
    while k < QUANTITIES.len() {
        if same(QUANTITIES[k].name.as_bytes(), name.as_bytes()) {
            return Some(&QUANTITIES[k]);
        }
        k += 1;
    }
    None
}

const fn same(a: &[u8], b: &[u8]) -> bool {
    if a.len() != b.len() {
        return false;
    }
    let mut k = 0;
    while k < a.len() {
        if a[k] != b[k] {
            return false;
        }
        k += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_there_once() {
        for known in &QUANTITIES {
            assert_eq!(quantity(known.name), Some(known));
        }
        assert_eq!(quantity("nothing"), None);
    }
}
