//! The standard case, its geometry and its impact law, after docs/model.md.

pub const R: f64 = 1.5;
pub const A: f64 = 0.1;
pub const E: f64 = 0.9;
pub const F_O: f64 = 0.3;
pub const NU: f64 = 0.5;
pub const OMEGA: f64 = 0.9;
pub const INERTIA: f64 = A * A;
/// sqrt(r^2 - (1 - a)^2)
pub const HEIGHT: f64 = 1.2;
/// x, y, theta and their rates.
pub const START: [f64; 6] = [0.0, 0.1, 0.0, 0.0, 0.0, 0.0];
pub const V_STICK: f64 = 1e-6;
pub const SETTLING_HEIGHT: f64 = 0.05;
pub const ROTATION_LIMIT: f64 = std::f64::consts::FRAC_PI_2;
pub const T_END: f64 = 10.0;
/// A guard: the true run has 290.
pub const MAX_IMPACTS: usize = 2000;

/// What a peer reports.
#[derive(Default)]
pub struct Run {
    /// Time, cable and normal velocity.
    pub impacts: Vec<(f64, usize, f64)>,
    pub kind: &'static str,
    pub t: f64,
}

impl Run {
    pub fn ended(mut self, kind: &'static str, t: f64) -> Self {
        (self.kind, self.t) = (kind, t);
        self
    }

    pub fn report(&self, version: &str, seconds: f64) -> serde_json::Value {
        serde_json::json!({
            "version": version,
            "impacts": self.impacts,
            "end": { "kind": self.kind, "t": self.t },
            "seconds": seconds,
        })
    }
}

/// A cable, by the sign of its anchor's x.
#[derive(Clone, Copy)]
pub struct Cable(f64);

impl Cable {
    pub const RIGHT: Self = Self(1.0);
    pub const LEFT: Self = Self(-1.0);

    fn lever(self, u: &[f64]) -> [f64; 2] {
        let (sin, cos) = u[2].sin_cos();
        [self.0 * A * cos, self.0 * A * sin]
    }

    pub fn gap(self, u: &[f64]) -> f64 {
        let [lx, ly] = self.lever(u);
        let (dx, dy) = (u[0] + lx - self.0, u[1] + ly - HEIGHT);
        dx * dx + dy * dy - R * R
    }

    fn normal_and_arm(self, u: &[f64]) -> ([f64; 2], f64) {
        let [lx, ly] = self.lever(u);
        let n = [(u[0] + lx - self.0) / R, (u[1] + ly - HEIGHT) / R];
        (n, lx * n[1] - ly * n[0])
    }

    /// Newton's law in the mass metric, where the cable closes; the normal velocity before.
    pub fn strike(self, u: &mut [f64]) -> f64 {
        let (n, arm) = self.normal_and_arm(u);
        let v_n = n[0] * u[3] + n[1] * u[4] + arm * u[5];
        if v_n > 0.0 {
            let impulse = (1.0 + E) * v_n / (1.0 + arm * arm / INERTIA);
            u[3] -= impulse * n[0];
            u[4] -= impulse * n[1];
            u[5] -= impulse * arm / INERTIA;
        }
        v_n
    }

    /// The end, if an impact this slow lets the cable stick.
    pub fn sticks(self, t: f64, u: &[f64], v_n: f64) -> Option<&'static str> {
        if v_n >= V_STICK || !self.would_pull(t, u) {
            return None;
        }
        Some(if u[1] < SETTLING_HEIGHT {
            "settled"
        } else {
            "sliding_start"
        })
    }

    fn would_pull(self, t: f64, u: &[f64]) -> bool {
        let [lx, ly] = self.lever(u);
        let (n, _) = self.normal_and_arm(u);
        let (sin, cos) = (OMEGA * t).sin_cos();
        let a = [
            F_O * cos - u[5] * u[5] * lx,
            NU * F_O * sin - 1.0 - u[5] * u[5] * ly,
        ];
        let p = [u[3] - u[5] * ly, u[4] + u[5] * lx];
        (p[0] * p[0] + p[1] * p[1]) / R + n[0] * a[0] + n[1] * a[1] > 0.0
    }

    /// Moves the body along the cable until its gap is `-inside`, so that the restart is on the
    /// slack side.
    pub fn place_inside(self, u: &mut [f64], inside: f64) {
        if inside > 0.0 {
            let (n, _) = self.normal_and_arm(u);
            let back = (self.gap(u) + inside) / (2.0 * R);
            u[0] -= back * n[0];
            u[1] -= back * n[1];
        }
    }
}
