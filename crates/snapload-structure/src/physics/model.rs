//! From SI to the engine's units and back (docs/structures.md).
//!
//! The engine's y points down: x_e = (x − x_0)/L, y_e = −(z − z_0)/L, and, as this is a reflection,
//! θ_e = −θ. The origin (x_0, z_0) of the engine's axes is the position of rest in still water.

use super::sea::components;
use super::wave::LinearWave;
use crate::structure::{Outline, Structure, Water};
use serde::Serialize;
use snapload::{
    Body, Cable, Drag, Forcing, Harmonic, Limit, LimitBounds, Rules, Shape, State, System,
};
use std::f64::consts::FRAC_PI_2;

/// An impact slower than this lets its line stay taut, in the engine's units
/// (docs/model.md section 6).
const V_STICK: f64 = 1e-6;

/// The frequency that stands for the constant part of the water's velocity.
pub(super) const CURRENT: f64 = 0.0;

/// Anchors that are closer together than this part of the longest line do not define the length
/// scale.
const LEAST_SPREAD: f64 = 0.02;

/// The units of the engine in SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Scales {
    /// L: half the horizontal distance between the outermost anchors; the longest line if that is
    /// too small \[m\].
    pub length_m: f64,
    /// M: mass with the added mass of heave \[kg\].
    pub mass_kg: f64,
    /// F: net buoyancy \[N\].
    pub force_n: f64,
    /// T = sqrt(M L/F) \[s\].
    pub time_s: f64,
    /// The origin of the engine's axes \[m\].
    #[serde(skip)]
    pub origin_m: [f64; 2],
}

impl Scales {
    /// The scales of a structure, about a position.
    pub fn new(structure: &Structure, origin_m: [f64; 2]) -> Self {
        let anchors = || structure.lines.iter().map(|line| line.anchor_m[0]);
        let wide =
            anchors().fold(f64::NEG_INFINITY, f64::max) - anchors().fold(f64::INFINITY, f64::min);
        let lengths = structure.lines.iter().map(|line| line.length_m);
        let longest = lengths.fold(0.0, f64::max);
        let has_scale = wide > LEAST_SPREAD * longest;
        let length_m = if has_scale { wide / 2.0 } else { longest };
        let [_, mass_kg] = structure.body.moving_mass_kg();
        let force_n = structure.net_buoyancy_n();
        Self {
            length_m,
            mass_kg,
            force_n,
            time_s: (mass_kg * length_m / force_n).sqrt(),
            origin_m,
        }
    }

    /// Unit of velocity L/T \[m/s\].
    pub fn speed_m_s(&self) -> f64 {
        self.length_m / self.time_s
    }

    /// Unit of impulse M L/T \[N s\].
    pub fn impulse_n_s(&self) -> f64 {
        self.mass_kg * self.speed_m_s()
    }

    /// Unit of energy F L \[J\].
    pub fn energy_j(&self) -> f64 {
        self.force_n * self.length_m
    }

    /// A position `[x, z]` in the engine's coordinates.
    pub fn to_engine(&self, place_m: [f64; 2]) -> [f64; 2] {
        [
            (place_m[0] - self.origin_m[0]) / self.length_m,
            -(place_m[1] - self.origin_m[1]) / self.length_m,
        ]
    }

    /// The position `[x, z]` of a point in the engine's coordinates \[m\].
    pub fn to_si(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.origin_m[0] + x * self.length_m,
            self.origin_m[1] - y * self.length_m,
        ]
    }
}

/// The nondimensional groups of a structure, with those of the wave if it is regular.
#[derive(Clone, Debug, PartialEq)]
pub struct Groups {
    /// r/L of each line.
    pub r: Vec<f64>,
    /// Half the width over L.
    pub a: f64,
    /// Half the height over L.
    pub b: f64,
    /// I/(M L²).
    pub inertia: f64,
    /// f_o, ν and Ω of a regular wave.
    pub wave: Option<[f64; 3]>,
}

/// A structure in the engine's units.
#[derive(Clone, Debug)]
pub struct Model {
    /// The units.
    pub scales: Scales,
    /// The system.
    pub system: System,
    /// When a run ends.
    pub rules: Rules,
    /// The waves, in SI.
    pub waves: Vec<LinearWave>,
    /// The groups.
    pub groups: Groups,
}

impl Model {
    /// The model of a structure about the position `[x, z]` at the origin of the engine's axes.
    /// Lines of `taut` are taut by construction when the upright body's centre is there.
    pub fn about(structure: &Structure, origin_m: [f64; 2], taut: &[usize]) -> Self {
        let scales = Scales::new(structure, origin_m);
        let waves = waves(structure, origin_m[1]);
        let groups = groups(structure, &scales, &waves);
        let shape = shape(structure, &groups);
        let froude_krylov = force_per_acceleration(structure).map(|per| per / scales.force_n);
        let lines = 0..structure.lines.len();
        let cables = lines.map(|line| cable(structure, &scales, line, taut.contains(&line)));
        let force = |wave: &LinearWave| {
            let (sine, cosine) = wave.phase_rad.sin_cos();
            sinusoid(structure, &scales, wave, froude_krylov, [sine, cosine])
        };
        let [pushed, lifted] = structure.body.constant_force_n;
        let system = System {
            body: body(structure, shape, groups.inertia),
            cables: cables.collect(),
            forcing: Forcing {
                constant: [pushed / scales.force_n, -(1.0 + lifted / scales.force_n)].into(),
                harmonics: waves.iter().map(force).collect(),
            },
            drag: drag(structure, &scales, &waves, groups.inertia),
            floating: None,
            restitution: structure.restitution,
        };
        let rules = rules(structure, &scales);
        Self {
            scales,
            system,
            rules,
            waves,
            groups,
        }
    }

    /// The state of a body at rest at a position, turned by θ counter-clockwise in axes with z up.
    pub fn at_rest(&self, place_m: [f64; 2], theta_rad: f64) -> State {
        let [x, y] = self.scales.to_engine(place_m);
        State {
            x,
            y,
            theta: -theta_rad,
            ..State::default()
        }
    }

    /// The system in still water, with the drag of the current among the constant forces, so that
    /// the body rests where they and the cables are in balance.
    pub(super) fn still(&self) -> System {
        let mut still = self.system.clone();
        still.forcing.harmonics.clear();
        if let Some(mut drag) = still.drag.take() {
            drag.water.retain(|water| water.omega == CURRENT);
            let [x, y, _] = drag.at(drag.velocity_of_water(0.0), &State::default());
            let constant = still.forcing.constant;
            still.forcing.constant = [constant.x + x, constant.y + y].into();
        }
        still
    }

    /// The wave and its groups f_o, ν and Ω, where it is regular.
    pub(crate) fn regular_wave(&self) -> Option<(&LinearWave, [f64; 3])> {
        self.waves.first().zip(self.groups.wave)
    }

    /// The level of the surface over the place of rest at a time \[m\].
    pub(crate) fn surface_m(&self, t_s: f64) -> f64 {
        let waves = self.waves.iter();
        let level =
            |wave: &LinearWave| wave.amplitude_m * (wave.omega_rad_s * t_s + wave.phase_rad).sin();
        waves.map(level).sum()
    }

    /// The force of the waves at a time, `[x, z]` \[N\].
    pub fn wave_force_n(&self, t_s: f64) -> [f64; 2] {
        let forcing = &self.system.forcing;
        let force = forcing.at(t_s / self.scales.time_s) - forcing.constant;
        let unit = self.scales.force_n;
        [unit * force.x, -unit * force.y]
    }
}

/// The outline in the engine's units.
pub(super) fn shape(structure: &Structure, groups: &Groups) -> Shape {
    match structure.body.outline {
        Outline::Circle => Shape::Circle { radius: groups.a },
        Outline::Rectangle => Shape::Rectangle {
            half_width: groups.a,
            half_height: groups.b,
        },
    }
}

/// When a run ends.
pub(super) fn rules(structure: &Structure, scales: &Scales) -> Rules {
    Rules {
        limits: LimitBounds::none().with(Limit::Rotation, FRAC_PI_2).with(
            Limit::UpperBound,
            (scales.origin_m[1] + structure.site.depth_m) / scales.length_m,
        ),
        max_impacts: structure.max_snaps,
        v_stick: V_STICK,
        ..Rules::until(structure.duration_s / scales.time_s)
    }
}

impl Groups {
    /// The groups of body and lines.
    pub(super) fn of_body(structure: &Structure, scales: &Scales, inertia: f64) -> Self {
        let (body, l) = (&structure.body, scales.length_m);
        let lines = structure.lines.iter();
        Self {
            r: lines.map(|line| line.length_m / l).collect(),
            a: body.width_m / (2.0 * l),
            b: match body.outline {
                Outline::Circle => 0.0,
                Outline::Rectangle => body.height_m / (2.0 * l),
            },
            inertia,
            wave: None,
        }
    }
}

fn groups(structure: &Structure, scales: &Scales, waves: &[LinearWave]) -> Groups {
    let l = scales.length_m;
    let above_floor = scales.origin_m[1] + structure.site.depth_m;
    let inertia = structure.body.turning_inertia_kg_m2() / (scales.mass_kg * l * l);
    Groups {
        wave: match (structure.water, waves.first()) {
            (Water::Wave(_), Some(wave)) => {
                let [along, up] = force_per_acceleration(structure);
                Some([
                    along * wave.a_x_m_s2 / scales.force_n,
                    up / along * (wave.wave_number_1_m * above_floor).tanh(),
                    wave.omega_rad_s * scales.time_s,
                ])
            }
            _ => None,
        },
        ..Groups::of_body(structure, scales, inertia)
    }
}

/// The body with its mass matrix, diag(m + A11, m + A33, I + A55) in units of m + A33; it does not
/// turn with the body. If the masses in x and z are equal it is the unit mass, for which flight has
/// a closed form.
fn body(structure: &Structure, shape: Shape, inertia: f64) -> Body {
    let [surge, heave] = structure.body.moving_mass_kg();
    let matrix = [
        [surge / heave, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, inertia],
    ];
    let of_matrix = || Body::with_mass_matrix(shape, matrix);
    let unlike = (surge != heave).then(of_matrix).flatten();
    unlike.unwrap_or_else(|| Body::rigid(shape, inertia))
}

/// Froude-Krylov force plus that of added mass, divided by the water's acceleration in x and in z:
/// ρV + m_a \[kg\].
pub fn force_per_acceleration(structure: &Structure) -> [f64; 2] {
    let added = &structure.body.added_mass;
    [added.surge_kg, added.heave_kg].map(|added| structure.displaced_mass_kg() + added)
}

/// The waves of a structure at the body's level.
pub(super) fn waves(structure: &Structure, z_m: f64) -> Vec<LinearWave> {
    let of = |amplitude_m: f64, omega_rad_s: f64, phase_rad: f64| LinearWave {
        phase_rad,
        ..LinearWave::new(&structure.site, amplitude_m, omega_rad_s, z_m)
    };
    match structure.water {
        Water::Still => Vec::new(),
        Water::Wave(wave) => vec![of(wave.height_m / 2.0, wave.omega_rad_s(), 0.0)],
        Water::Sea(sea) => {
            let parts = components(&sea).into_iter();
            parts
                .map(|part| of(part.amplitude_m, part.omega_rad_s, part.phase_rad))
                .collect()
        }
    }
}

/// A vector that is `per` times the water's acceleration in a wave, along x and along z, in the
/// engine's axes.
///
/// With the surface η = A sin(ωt + ε) above the body, of a wave that goes to +x, linear theory
/// gives
///
/// ```text
/// u̇ = a_x cos(ωt + ε),    ẇ = −a_z sin(ωt + ε)
/// ```
///
/// so the force is f_x = f_o cos(Ωt + ε), and f_y = ν f_o sin(Ωt + ε) as y points down: for ε = 0
/// the ellipse of docs/model.md section 3, beginning at the largest horizontal acceleration. For a
/// wave that goes to −x the sign of u̇ is reversed. The phase is given as \[sin ε, cos ε\].
fn sinusoid(
    structure: &Structure,
    scales: &Scales,
    wave: &LinearWave,
    [along, up]: [f64; 2],
    [sine, cosine]: [f64; 2],
) -> Harmonic {
    let x = structure.heading * along * wave.a_x_m_s2;
    let y = up * wave.a_z_m_s2;
    Harmonic {
        omega: wave.omega_rad_s * scales.time_s,
        cosine: [x * cosine, y * sine].into(),
        sine: [-x * sine, y * cosine].into(),
    }
}

/// Drag and damping of the body in the engine's units, per unit mass and inertia; none where all
/// are zero. The water's velocity is its acceleration over ω, a quarter of a period later.
pub(super) fn drag(
    structure: &Structure,
    scales: &Scales,
    waves: &[LinearWave],
    inertia: f64,
) -> Option<Drag> {
    let body = &structure.body;
    let (l, m, t) = (scales.length_m, scales.mass_kg, scales.time_s);
    let velocity = |wave: &LinearWave| {
        let per = 1.0 / (wave.omega_rad_s * scales.speed_m_s());
        let (sine, cosine) = wave.phase_rad.sin_cos();
        sinusoid(structure, scales, wave, [per; 2], [-cosine, sine])
    };
    let quadratic = 0.5 * structure.site.water_density_kg_m3 * body.drag_area_m2;
    let mut drag = Drag {
        linear: body.linear_damping_n_s_m * t / m,
        quadratic: quadratic * l / m,
        turning: body.turning_damping_n_m_s * t / (m * l * l) / inertia,
        water: Vec::new(),
    };
    let resists = drag.linear + drag.quadratic + drag.turning > 0.0;
    resists.then(|| {
        drag.water = waves.iter().map(velocity).collect();
        if structure.site.current_m_s != 0.0 {
            drag.water.push(Harmonic {
                omega: CURRENT,
                cosine: [structure.site.current_m_s / scales.speed_m_s(), 0.0].into(),
                ..Harmonic::default()
            });
        }
        drag
    })
}

pub(super) fn cable(structure: &Structure, scales: &Scales, line: usize, taut: bool) -> Cable {
    let line = &structure.lines[line];
    let l = scales.length_m;
    let position = structure.body.position_m;
    let arm = [0, 1].map(|i| line.fairlead_m[i] - position[i]);
    let fairlead = [arm[0] / l, -arm[1] / l];
    let span = [0, 1].map(|i| scales.origin_m[i] + arm[i] - line.anchor_m[i]);
    let length = line.length_m / l;
    if taut {
        Cable::taut_at_rest([span[0] / l, -span[1] / l], fairlead, length)
    } else {
        Cable::new(scales.to_engine(line.anchor_m), fairlead, length)
    }
}
