//! Steps compiled twice: for any processor of a family, and for one that fuses a multiply with an add.
//!
//! All on the way of a step is `#[inline(always)]`, and loops stand where a closure would: what is only called is compiled for
//! the other processors.
//!
//! [`crate::Real::mul_add`] rounds once everywhere, so the bits are the same. Where a processor has no instruction for it, or
//! the compiler may not assume one, it is a function, which takes longer than both operations.
#![cfg_attr(
    target_arch = "x86_64",
    expect(
        unsafe_code,
        reason = "a function for one kind of processor; see below"
    )
)]

use crate::{Simulation, Step};

/// Whether the processor has AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
pub(crate) fn is_here() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

/// The next step of a motion of doubles, by the best instructions for it.
#[cfg(target_arch = "x86_64")]
pub(crate) fn step(simulation: &mut Simulation<f64>) -> Option<Step<f64>> {
    #[target_feature(enable = "avx2,fma")]
    fn fused(simulation: &mut Simulation<f64>) -> Option<Step<f64>> {
        simulation.step_here()
    }
    if is_here() {
        // SAFETY: the processor has AVX2 and FMA, as was just asked.
        unsafe { fused(simulation) }
    } else {
        simulation.step_here()
    }
}

/// Other families are compiled once: 64-bit Arm always fuses, elsewhere it is a function.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) fn step(simulation: &mut Simulation<f64>) -> Option<Step<f64>> {
    simulation.step_here()
}

#[cfg(test)]
mod tests {
    use crate::{Case, Parameters, Simulation};

    /// Fused by an instruction or by a function: flights, impacts, sliding and rocking have the same bits.
    #[test]
    fn both_compilations_give_the_same_bits() {
        let mut modes = [0; 3];
        for f_o in [0.1, 0.27, 0.3] {
            let case = Case::new(Parameters {
                f_o,
                t_end: 12.0,
                stop_when_settled: false,
                ..Parameters::STANDARD
            });
            let mut fused = case.expect("a legal case").simulation();
            let mut plain = fused.clone();
            let bits = |simulation: &Simulation| simulation.state().components().map(f64::to_bits);
            while let Some(step) = super::step(&mut fused) {
                modes[step.taut.len()] += 1;
                assert!(plain.step_here().is_some());
                assert_eq!(fused.time().to_bits(), plain.time().to_bits());
                assert_eq!(bits(&fused), bits(&plain));
            }
            assert_eq!(fused.stop(), plain.stop());
        }
        assert!(modes.iter().all(|steps| *steps > 0), "{modes:?}");
    }
}
