//! The linearised motion of one bounce ([`crate::motion::bounce`]), of one run or of several side
//! by side: [`crate::motion::tangent`], which treats any step, written out for a flight that ends
//! with the impact of one cable.
//!
//! With n and s of the cable that snaps, t = n turned by a quarter, and c = n·ρ, a deviation (δx,
//! δy, δθ) with the attachment at the cable's end turns its normal by κ: δn = κ t, δs = c (κ − δθ),
//! with κ = (t·(δx, δy) + c δθ)/r. So the law's derivative is the identity and three products of
//! rank one:
//!
//! ```text
//! δv_n = G δv + κ t·v + c (κ − δθ) θ̇        δw = 2 s c (κ − δθ)/I
//! δp = (1 + e) (δv_n/w − v_n δw/w²)
//! δv⁺ = δv − n δp − p κ t                    δθ̇⁺ = δθ̇ − (s δp + p c (κ − δθ))/I
//! ```
#![expect(
    clippy::needless_range_loop,
    reason = "a deviation is an entry of every row"
)]

use crate::arithmetic::lane::Lane;
use crate::arithmetic::plane::Vector2;
use crate::model::cable::Normal;
use crate::model::state::State;
use crate::motion::bounce::{Bounce, FlightFacts};
use crate::motion::two_cable_flight::EARLY;
use crate::motion::two_cables::{AfterImpact, TwoCableSystem};

/// Deviations (w, τ) side by side: a row for each of their seven components.
pub(crate) type Rows<L, const N: usize> = [[L; N]; 7];

/// A bounce that has been made, and its beginning.
#[derive(Clone, Copy)]
pub(crate) struct Bounced<'a, L: Lane> {
    pub(crate) two_cables: &'a TwoCableSystem<L>,
    pub(crate) from: &'a AfterImpact<L>,
    /// When it ended.
    pub(crate) t: L,
    /// Whether the second cable snapped, instead of the first.
    pub(crate) second: L::Mask,
    pub(crate) before: &'a State<L>,
    pub(crate) after: &'a State<L>,
    pub(crate) v_n: L,
    pub(crate) impulse: L,
    /// Value and error of the gap that did not close, at the end.
    pub(crate) other_gap: [L; 2],
    pub(crate) facts: &'a FlightFacts<L>,
}

impl<'a, L: Lane> Bounced<'a, L> {
    /// The bounce that began at `from`.
    #[inline(always)]
    pub(crate) fn of(
        two_cables: &'a TwoCableSystem<L>,
        from: &'a AfterImpact<L>,
        bounce: &'a Bounce<L>,
    ) -> Self {
        let [first, second] = bounce.next.gaps;
        let other = |k: usize| L::select(bounce.second, first[k], second[k]);
        Self {
            two_cables,
            from,
            t: bounce.next.t,
            second: bounce.second,
            before: &bounce.before,
            after: &bounce.next.state,
            v_n: bounce.v_n,
            impulse: bounce.impulse,
            other_gap: [other(0), other(1)],
            facts: &bounce.facts,
        }
    }

    /// A function of the cable that snapped and of the other one, in this order.
    #[inline(always)]
    pub(crate) fn each(&self, of: impl Fn(usize) -> L) -> [L; 2] {
        let [first, second] = [of(0), of(1)];
        [
            L::select(self.second, second, first),
            L::select(self.second, first, second),
        ]
    }

    /// The largest value of a gap in the early part of a flight of length `s`, given that at its
    /// start and a bound on its slope; what is compared with neighbours that spread from zero, if
    /// it was closed.
    #[inline(always)]
    pub(crate) fn largest_early(gap: L, slope: L, s: L) -> L {
        let largest = gap.larger(slope.mul_add(s * EARLY, gap));
        L::select(gap.below(L::ZERO), largest, slope * s)
    }

    /// Whether the gap that closes is below zero by more than a margin, given its square, up to its
    /// last rise.
    #[inline(always)]
    pub(crate) fn is_open_before_last_rise(&self, square_of_margin: L) -> L::Mask {
        let (facts, s) = (self.facts, self.t - self.from.t);
        let [gap, _] = self.each(|k| self.from.gaps[k][0]);
        let [length, _] = self.each(|k| self.two_cables.cables[k].length());
        let largest = Self::largest_early(gap, facts.struck_slope, s).larger(-facts.depth);
        let risen = facts.depth * length * self.v_n * 2.0;
        largest.below(L::ZERO)
            & square_of_margin.below(largest * largest)
            & (square_of_margin * facts.bend * facts.bend).below(risen * risen)
    }
}

/// The effect of a bounce on small deviations.
#[derive(Clone, Copy)]
pub(crate) struct BounceMap<L> {
    s: L,
    /// ż₋ − Φ ż₊ of x, y, ẋ and ẏ; a free flight does not change θ̇.
    lag: [L; 4],
    /// n·ρ of the cable that snaps.
    swing: L,
    /// ẋ, ẏ and θ̇ before the impact, and after it.
    velocities: [[L; 3]; 2],
    /// The acceleration at the end.
    force: Vector2<L>,
    /// −∇h/ḣ.
    delay: [L; 3],
    normal: Normal<L>,
    /// The derivatives of κ by x, y and θ.
    turn: [L; 3],
    /// The derivatives of δv_n by κ and by κ − δθ.
    closing: [L; 2],
    /// The derivatives of δp by G δv, by κ and by κ − δθ.
    gains: [L; 3],
    impulse: L,
    /// p c.
    impulse_arm: L,
    inverse_inertia: L,
}

impl<L: Lane> BounceMap<L> {
    #[inline(always)]
    pub(crate) fn of(bounced: &Bounced<L>) -> Self {
        let (start, before, after) = (&bounced.from.state, bounced.before, bounced.after);
        let FlightFacts {
            forces: [first, last],
            normal,
            swing,
            ..
        } = *bounced.facts;
        let two_cables = bounced.two_cables;
        let inverse_inertia = two_cables.inverse_inertia;
        let s = bounced.t - bounced.from.t;
        let sooner = L::ONE / bounced.v_n;
        let [per_length, _] = bounced.each(|k| two_cables.cables[k].per_length());
        let across = normal.n.quarter_turn();
        let w = normal.coupling(&normal, inverse_inertia);
        let turns = normal.arm * 2.0 * swing * inverse_inertia;
        let law = two_cables.contact;
        let by_normal_velocity = law.impulse_per_velocity(w);
        let closing = [across.dot(before.velocity()), swing * before.vtheta];
        Self {
            s,
            lag: [
                before.vx - first.x.mul_add(s, start.vx),
                before.vy - first.y.mul_add(s, start.vy),
                last.x - first.x,
                last.y - first.y,
            ],
            swing,
            velocities: [before, after].map(|state| [state.vx, state.vy, state.vtheta]),
            force: last,
            delay: [normal.n.x, normal.n.y, normal.arm].map(|g| -(g * sooner)),
            normal,
            turn: [across.x, across.y, swing].map(|part| part * per_length),
            closing,
            gains: [
                by_normal_velocity,
                by_normal_velocity * closing[0],
                law.snap_slope([bounced.v_n, w], [closing[1], turns]),
            ],
            impulse: bounced.impulse,
            impulse_arm: bounced.impulse * swing,
            inverse_inertia,
        }
    }

    /// Carries deviations along the flight: to (w, τ) just before the impact, at the previous
    /// event's time.
    #[inline(always)]
    pub(crate) fn along<const N: usize>(&self, rows: &mut Rows<L, N>) {
        self.drift(rows);
        for k in 0..N {
            let tau = rows[6][k];
            for (row, lag) in [0, 1, 3, 4].into_iter().zip(self.lag) {
                rows[row][k] = lag.mul_add(tau, rows[row][k]);
            }
        }
    }

    #[inline(always)]
    fn drift<const N: usize>(&self, rows: &mut Rows<L, N>) {
        for i in 0..3 {
            for k in 0..N {
                rows[i][k] = rows[i + 3][k].mul_add(self.s, rows[i][k]);
            }
        }
    }

    /// Carries them to the impact's own time; returns the delays.
    #[inline(always)]
    pub(crate) fn meet<const N: usize>(&self, rows: &mut Rows<L, N>) -> [L; N] {
        let [dx, dy, dtheta] = self.delay;
        let [vx, vy, vtheta] = self.velocities[0];
        let mut all = [L::ZERO; N];
        for k in 0..N {
            let later = dx.mul_add(rows[0][k], dy.mul_add(rows[1][k], dtheta * rows[2][k]));
            let rates = [vx, vy, vtheta, self.force.x, self.force.y];
            for (row, rate) in rows.iter_mut().zip(rates) {
                row[k] = rate.mul_add(later, row[k]);
            }
            rows[6][k] = rows[6][k] + later;
            all[k] = later;
        }
        all
    }

    /// The displacement along the other cable, of deviations at the impact's own time with these
    /// delays: at the previous event's time, and at the impact's.
    #[inline(always)]
    pub(crate) fn along_other<const N: usize>(
        &self,
        bounced: &Bounced<L>,
        rows: &Rows<L, N>,
        later: &[L; N],
    ) -> [[L; N]; 2] {
        let Normal { n, arm } = bounced.facts.other;
        let [vx, vy, vtheta] = self.velocities[0];
        let rate = n.x.mul_add(vx, n.y.mul_add(vy, arm * vtheta));
        let mut all = [[L::ZERO; N]; 2];
        for k in 0..N {
            let [x, y, theta, ..] = column(rows, k);
            let now = n.x.mul_add(x, n.y.mul_add(y, arm * theta));
            all[0][k] = (-rate).mul_add(later[k], now);
            all[1][k] = now;
        }
        all
    }

    /// Carries them through the law of impact; returns δv_n of each.
    #[inline(always)]
    pub(crate) fn through<const N: usize>(&self, rows: &mut Rows<L, N>) -> [L; N] {
        let Normal { n, arm } = self.normal;
        let [tx, ty, ttheta] = self.turn;
        let [by_velocity, ..] = self.gains;
        let [by_kappa, by_relative_turn] = self.closing;
        let mut all = [L::ZERO; N];
        for k in 0..N {
            let [x, y, theta, vx, vy, vtheta, _] = column(rows, k);
            let kappa = tx.mul_add(x, ty.mul_add(y, ttheta * theta));
            let along = n.x.mul_add(vx, n.y.mul_add(vy, arm * vtheta));
            let relative_turn = kappa - theta;
            all[k] = by_kappa.mul_add(kappa, by_relative_turn.mul_add(relative_turn, along));
            let change = self.law_of_turning(along * by_velocity, kappa, relative_turn);
            rows[3][k] = vx + change[0];
            rows[4][k] = vy + change[1];
            rows[5][k] = vtheta + change[2];
        }
        all
    }

    /// δ(ẋ, ẏ, θ̇) after the impact, where the impulse changes by `along` in addition, the normal
    /// turns by κ, and `relative_turn` is κ − δθ.
    #[inline(always)]
    pub(crate) fn law_of_turning(&self, along: L, kappa: L, relative_turn: L) -> [L; 3] {
        let [_, by_turning, by_relative_turn] = self.gains;
        let Normal { n, arm } = self.normal;
        let dp = by_turning.mul_add(kappa, by_relative_turn.mul_add(relative_turn, along));
        let aside = self.impulse * kappa;
        let spin = arm.mul_add(dp, self.impulse_arm * relative_turn) * self.inverse_inertia;
        [
            n.y.mul_add(aside, -(n.x * dp)),
            -(n.x.mul_add(aside, n.y * dp)),
            -spin,
        ]
    }
}

impl BounceMap<f64> {
    /// The whole bounce for many deviations, each at one common time at its start and at its end.
    #[inline(always)]
    pub(crate) fn at_one_time<const N: usize>(&self, rows: &mut Rows<f64, N>) {
        self.drift(rows);
        rows[6] = [0.0; N];
        let later = self.meet(rows);
        self.through(rows);
        let [vx, vy, vtheta] = self.velocities[1];
        let rates = [vx, vy, vtheta, self.force.x, self.force.y];
        for (row, rate) in rows.iter_mut().zip(rates) {
            for (entry, later) in row.iter_mut().zip(later) {
                *entry = (-rate).mul_add(later, *entry);
            }
        }
    }

    /// See [`crate::motion::step_map::StepMap::magnification_squared`].
    #[inline(always)]
    pub(crate) fn magnification_squared(&self) -> f64 {
        let [[vx, vy, vtheta], after] = self.velocities;
        let (ax, ay) = (self.force.x, self.force.y);
        let mut rate = [vx, vy, vtheta, ax, ay, 0.0, 0.0].map(|component| [component]);
        self.through(&mut rate);
        let jump = [
            after[0] - vx,
            after[1] - vy,
            after[2] - vtheta,
            ax - rate[3][0],
            ay - rate[4][0],
            -rate[5][0],
        ];
        let square = |parts: &[f64]| parts.iter().map(|part| part * part).sum::<f64>();
        square(&jump) * square(&self.delay)
    }

    /// Whether the normal acceleration n·f + |Ṗ|²/r − θ̇² n·ρ is above zero by far more than
    /// rounding, even without its second summand.
    #[inline(always)]
    pub(crate) fn certainly_accelerates(&self) -> bool {
        let Vector2 { x, y } = self.force;
        let [[_, _, spin], _] = self.velocities;
        let turning = spin * spin * self.swing;
        let along = self.normal.n.dot(self.force);
        along - turning > 1e-9 * (x.abs() + y.abs() + turning.abs())
    }

    /// ż just before the impact.
    pub(crate) fn rate(&self) -> [f64; 6] {
        let [vx, vy, vtheta] = self.velocities[0];
        [vx, vy, vtheta, self.force.x, self.force.y, 0.0]
    }

    /// −∇h/ḣ: the delay of the impact per deviation just before it.
    pub(crate) fn delay(&self) -> [f64; 6] {
        let [x, y, theta] = self.delay;
        [x, y, theta, 0.0, 0.0, 0.0]
    }
}

/// One deviation of several.
#[inline(always)]
fn column<L: Lane, const N: usize>(rows: &Rows<L, N>, k: usize) -> [L; 7] {
    let mut column = [L::ZERO; 7];
    for (entry, row) in column.iter_mut().zip(rows) {
        *entry = row[k];
    }
    column
}
