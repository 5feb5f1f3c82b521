//! Work that is compiled twice: for all processors of a family, and for those with an instruction
//! that multiplies and adds.
//!
//! [`crate::arithmetic::real::Real::mul_add`] rounds once everywhere, so the bits are the same.
//! Where a processor has no instruction for it, or the compiler may not assume one, it is a
//! function call, which takes longer than a multiplication and an addition.
//!
//! All functions in which such work spends its time are `#[inline(always)]`: one that is only
//! called would be compiled for every processor, without the instruction. Over numbers that have no
//! instructions of their own, functions that are large or called from many places are compiled
//! separately (`apart!`); over numbers with derivatives, which are many doubles side by side, those
//! are compiled twice, too. Over doubles, functions that are large and called from several places
//! are [`Kernel`]s of their own, which another one dispatches: inlined at each call, they would
//! make functions whose compilation takes more than linear time.
#![cfg_attr(
    target_arch = "x86_64",
    expect(
        unsafe_code,
        reason = "a function for one kind of processor; see below"
    )
)]

use crate::arithmetic::real::Real;

/// Work that may be compiled for one kind of processor.
pub(crate) trait Kernel {
    /// Its result.
    type Output;
    /// Does the work; `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// Whether the processor has AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
pub(crate) fn has_fma() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

/// Numbers aligned to a line of the processor's cache. A vector register is then never loaded
/// across two lines, nor across two parts that have just been written separately, which would delay
/// the load.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Aligned<T>(pub(crate) T);

/// Does the work by the best instructions that the processor has for it.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn dispatch<W: Kernel>(kernel: W) -> W::Output {
    #[target_feature(enable = "avx2,fma")]
    fn fused<W: Kernel>(kernel: W) -> W::Output {
        kernel.run()
    }
    if has_fma() {
        // SAFETY: the processor has AVX2 and FMA, as was just asked.
        unsafe { fused(kernel) }
    } else {
        plain(kernel)
    }
}

/// Does the work with the instructions that every processor of the family has.
#[cfg_attr(target_arch = "x86_64", inline(never))]
pub(crate) fn plain<W: Kernel>(kernel: W) -> W::Output {
    kernel.run()
}

/// The same for work over one arithmetic: only for doubles does the difference matter, so that for
/// other numbers the work is compiled once.
#[inline]
pub(crate) fn dispatch_over<T: Real, W: Kernel>(kernel: W) -> W::Output {
    if T::FUSES {
        dispatch(kernel)
    } else {
        kernel.run()
    }
}

/// The body of a function that is inlined everywhere over doubles, and over numbers without
/// instructions of their own compiled once, by itself.
///
/// For those a call costs little compared with the function's work, while inlining the whole motion
/// into one function would take far longer to compile than its pieces.
macro_rules! apart {
    ($number:ty, $work:block) => {
        if <$number as $crate::arithmetic::lane::Lane>::FUSES {
            $work
        } else if <$number as $crate::arithmetic::lane::Lane>::CARRIES_SLOPES
            && $crate::arithmetic::processor::has_fma()
        {
            // Written twice, so that each closure has one caller, into which it is inlined.
            $crate::arithmetic::processor::fused_by_itself(|| $work)
        } else {
            $crate::arithmetic::processor::by_itself(|| $work)
        }
    };
}
pub(crate) use apart;

/// Does the work; see `apart!`.
#[inline(never)]
pub(crate) fn by_itself<R>(work: impl FnOnce() -> R) -> R {
    work()
}

/// The same with the instructions of a processor that [`has_fma`], which the caller has to check.
#[cfg(target_arch = "x86_64")]
pub(crate) fn fused_by_itself<R>(work: impl FnOnce() -> R) -> R {
    #[target_feature(enable = "avx2,fma")]
    #[inline(never)]
    fn fused<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
    assert!(has_fma());
    // SAFETY: the processor has AVX2 and FMA, as was just asked.
    unsafe { fused(work) }
}

/// Always false on other processors, which need only one compilation.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub(crate) fn has_fma() -> bool {
    false
}

/// Never called here.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) fn fused_by_itself<R>(work: impl FnOnce() -> R) -> R {
    by_itself(work)
}

/// Other processors need one compilation: 64-bit Arm always fuses, on the rest `mul_add` is a call.
#[cfg(not(target_arch = "x86_64"))]
#[inline]
pub(crate) fn dispatch<W: Kernel>(kernel: W) -> W::Output {
    plain(kernel)
}

#[cfg(test)]
mod tests {
    /// Products whose rounding before the sum would show, and halfway cases that a wider
    /// intermediate would round twice.
    #[test]
    fn the_platform_fuses_right() {
        let (one, e) = (1.0_f64, f64::EPSILON);
        for (a, b, c, known) in [
            (one + e, one - e, -one, -e * e),
            (one + e, one + e, -(one + 2.0 * e), e * e),
            // 1 + ε/2 is halfway between 1 and its neighbour, so that the smallest difference
            // decides the rounding.
            (e * 0.5, one + e, one, one + e),
            (e * 0.5, one - e, one, one),
            (one + e * 2.0_f64.powi(20), e * 0.5, one + e, one + 2.0 * e),
        ] {
            assert_eq!(
                std::hint::black_box(a).mul_add(b, c),
                known,
                "{a:e} {b:e} {c:e}"
            );
        }
    }
}
