//! The thesis's breakwater and the oracle's files, for the integration tests.

use serde_json::Value;
use snapload::{
    Body, Harmonic, Limit, LimitBounds, Matrix, Rules, Shape, Simulation, State, StepMap, System,
    Trajectory,
};
use std::f64::consts::FRAC_PI_2;

/// The breakwater of docs/model.md, with everything that its cases vary.
#[derive(Clone, Copy, Debug)]
pub struct Breakwater {
    pub r: f64,
    pub e: f64,
    pub a: f64,
    pub b: f64,
    pub f_o: f64,
    pub nu: f64,
    pub omega: f64,
    pub start: State,
    pub t_end: f64,
    pub v_stick: f64,
    pub settle: bool,
    pub stop_when_sliding: bool,
}

pub const STANDARD: Breakwater = Breakwater {
    r: 1.5,
    e: 0.9,
    a: 0.1,
    b: 0.0,
    f_o: 0.3,
    nu: 0.5,
    omega: 0.9,
    start: State {
        x: 0.0,
        y: 0.1,
        theta: 0.0,
        vx: 0.0,
        vy: 0.0,
        vtheta: 0.0,
    },
    t_end: 100.0,
    v_stick: 1e-6,
    settle: true,
    stop_when_sliding: false,
};

impl Breakwater {
    pub fn h(&self) -> f64 {
        snapload::anchor_height(self.r, self.a)
    }

    pub fn inertia(&self) -> f64 {
        if self.b > 0.0 {
            (self.a * self.a + self.b * self.b) / 3.0
        } else {
            self.a * self.a
        }
    }

    pub fn system(&self) -> System {
        System::moored_breakwater(
            Body::rigid(Shape::of_half_sizes(self.a, self.b), self.inertia()),
            [self.a, self.b],
            self.r,
            self.e,
            Harmonic::ellipse(self.f_o, self.nu, self.omega),
        )
    }

    pub fn rules(&self) -> Rules {
        Rules {
            limits: LimitBounds::none()
                .with(Limit::Rotation, FRAC_PI_2)
                .with(Limit::UpperBound, self.h() + self.b),
            settled_below: self.settle.then_some(0.05),
            sliding_above: self.stop_when_sliding.then_some(0.05),
            t_end: self.t_end,
            max_impacts: 1_000_000,
            v_stick: self.v_stick,
        }
    }

    pub fn simulation(&self) -> Simulation {
        Simulation::new(self.system(), self.rules(), 0.0, self.start).expect("a legal start")
    }

    pub fn run(&self) -> Trajectory {
        Trajectory::record(self.simulation())
    }
}

pub fn oracle(file: &str) -> Vec<Value> {
    let path = format!("{}/tests/oracle/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    let whole: Value = serde_json::from_str(&text).expect("JSON");
    whole["cases"].as_array().expect("cases").clone()
}

/// A decimal string or a number of the oracle.
pub fn number(value: &Value) -> f64 {
    match value {
        Value::String(text) => text.parse().expect("a decimal number"),
        other => other.as_f64().expect("a number"),
    }
}

/// The oracle's order is x, y, θ, ẋ, ẏ, θ̇.
pub fn state(value: &Value) -> State {
    let c: Vec<f64> = value.as_array().expect("six").iter().map(number).collect();
    State {
        x: c[0],
        y: c[1],
        theta: c[2],
        vx: c[3],
        vy: c[4],
        vtheta: c[5],
    }
}

pub fn components(s: &State) -> [f64; 6] {
    [s.x, s.y, s.theta, s.vx, s.vy, s.vtheta]
}

/// The largest difference of two states, component by component.
pub fn distance(a: &State, b: &State) -> f64 {
    let (a, b) = (components(a), components(b));
    (0..6).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

/// The case of an oracle's `params`, `start` and `Ic`.
pub fn breakwater(case: &Value) -> Breakwater {
    let p = |key: &str| number(&case["params"][key]);
    let it = Breakwater {
        r: p("r"),
        e: case["params"].get("e").map_or(0.9, number),
        a: p("a"),
        b: p("b"),
        f_o: p("f0"),
        nu: p("nu"),
        omega: p("Om"),
        start: state(&case["start"]),
        ..STANDARD
    };
    assert!((it.inertia() - number(&case["Ic"])).abs() < 1e-15);
    it
}

pub const IDENTITY: Matrix = {
    let mut identity = [[0.0; 6]; 6];
    let mut i = 0;
    while i < 6 {
        identity[i][i] = 1.0;
        i += 1;
    }
    identity
};

/// The matrix of a step of the linearised motion, for deviations at one time.
pub fn matrix(map: &StepMap) -> Matrix {
    let mut matrix = [[0.0; 6]; 6];
    for (j, unit) in IDENTITY.iter().enumerate() {
        for (row, entry) in matrix.iter_mut().zip(map.fundamental(unit)) {
            row[j] = entry;
        }
    }
    matrix
}

/// a b.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| {
        let mut sum = [0.0; 6];
        for (factor, line) in row.iter().zip(b) {
            for (sum, entry) in sum.iter_mut().zip(line) {
                *sum += factor * entry;
            }
        }
        sum
    })
}

/// Rows and columns of one degree of freedom of a matrix: position and velocity.
pub type Square = [[f64; 2]; 2];

/// The block of one degree of freedom: 0 for x, 1 for y, 2 for θ.
pub fn block(matrix: &Matrix, i: usize) -> Square {
    [i, i + 3].map(|row| [i, i + 3].map(|column| matrix[row][column]))
}

pub fn trace(a: &Square) -> f64 {
    a[0][0] + a[1][1]
}

pub fn determinant(a: &Square) -> f64 {
    a[0][0] * a[1][1] - a[0][1] * a[1][0]
}

/// A motion that continues long after every test, in which no impact is slow enough to stick.
pub fn unending(system: System, t: f64, start: State) -> Simulation {
    Simulation::new(system, Rules::until(t + 1e6), t, start).expect("a legal start")
}
