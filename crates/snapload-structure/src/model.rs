//! From SI to the engine's units and back (docs/model.md section 10, docs/structures.md).
//!
//! The engine's picture is upside down: x_e = (x − x_0)/L, y_e = −(z − z_0)/L, and, a reflection being one, θ_e = −θ.
//! The centre (x_0, z_0) of the engine's picture is where the body rests in still water.

use crate::equilibrium::Equilibrium;
use crate::sea::components;
use crate::structure::{LineSi, Outline, Structure, Water};
use crate::wave::LinearWave;
use snapload::{Body, Cable, Drag, Forcing, Harmonic, Rules, Shape, State, System};
use std::f64::consts::FRAC_PI_2;

/// An impact slower than this lets its line stay taut, in the engine's units (docs/model.md section 6).
const V_STICK: f64 = 1e-6;
/// A body that is turned by less than this at rest is upright: its gaps are then off by rounding only \[rad\].
const UPRIGHT: f64 = 1e-12;

/// Anchors that stand closer together than this part of the longest line do not make a scale.
const LEAST_SPREAD: f64 = 0.02;

/// The units of the engine in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// L: half the horizontal distance between the outermost anchors; the longest line where they have none \[m\].
    pub length_m: f64,
    /// M: mass with added mass \[kg\].
    pub mass_kg: f64,
    /// F: net buoyancy \[N\].
    pub force_n: f64,
    /// T = sqrt(M L/F) \[s\].
    pub time_s: f64,
    /// The centre of the engine's picture \[m\].
    pub origin_m: [f64; 2],
}

impl Scales {
    /// Of a structure, about a place.
    pub fn new(structure: &Structure, origin_m: [f64; 2]) -> Self {
        let anchors = structure.lines.iter().map(|line| line.anchor_m[0]);
        let (low, high) = anchors.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let longest = structure
            .lines
            .iter()
            .fold(0.0_f64, |longest, line| longest.max(line.length_m));
        let length_m = if high - low > LEAST_SPREAD * longest {
            (high - low) / 2.0
        } else {
            longest
        };
        let (mass_kg, force_n) = (structure.moving_mass_kg(), structure.net_buoyancy_n());
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

    /// A place `[x, z]` in the engine's picture.
    pub fn to_engine(&self, place_m: [f64; 2]) -> [f64; 2] {
        [
            (place_m[0] - self.origin_m[0]) / self.length_m,
            -(place_m[1] - self.origin_m[1]) / self.length_m,
        ]
    }

    /// The place `[x, z]` of a point of the engine's picture \[m\].
    pub fn to_si(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.origin_m[0] + x * self.length_m,
            self.origin_m[1] - y * self.length_m,
        ]
    }
}

/// One sinusoidal wave with its phase: at the place of the body the surface is A sin(ωt + ε).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhasedWave {
    /// The wave.
    pub wave: LinearWave,
    /// ε \[rad\].
    pub phase_rad: f64,
}

/// The nondimensional groups of a structure; those of the wave where it is regular.
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
    pub waves: Vec<PhasedWave>,
    /// The groups.
    pub groups: Groups,
}

impl Model {
    /// Of a structure, about where it rests.
    pub fn resting(structure: &Structure, rest: &Equilibrium) -> Self {
        // A turned body's lines are as long as their gaps say; an upright one's are exactly taut.
        let upright = rest.theta_rad.abs() < UPRIGHT;
        let taut: &[usize] = if upright { &rest.taut } else { &[] };
        Self::about(structure, rest.place_m, taut)
    }

    /// Of a structure about the place `[x, z]` with which the engine's picture is centred. Lines of `taut` are taut
    /// by construction where the body's centre is there and the body is upright.
    pub fn about(structure: &Structure, origin_m: [f64; 2], taut: &[usize]) -> Self {
        let scales = Scales::new(structure, origin_m);
        let waves = waves(structure, origin_m[1]);
        let body = &structure.body;
        let l = scales.length_m;
        let (a, b) = (body.width_m / (2.0 * l), body.height_m / (2.0 * l));
        let shape = match body.outline {
            Outline::Circle => Shape::Circle { radius: a },
            Outline::Rectangle => Shape::Rectangle {
                half_width: a,
                half_height: b,
            },
        };
        let inertia = body.moment_of_inertia_kg_m2 / (scales.mass_kg * l * l);
        let harmonics: Vec<Harmonic> = waves
            .iter()
            .map(|wave| force(structure, &scales, wave))
            .collect();
        let groups = Groups {
            r: structure
                .lines
                .iter()
                .map(|line| line.length_m / l)
                .collect(),
            a,
            b: if body.outline == Outline::Circle {
                0.0
            } else {
                b
            },
            inertia,
            wave: match (structure.water, waves.first()) {
                (Water::Wave(_), Some(PhasedWave { wave, .. })) => Some([
                    force_per_acceleration(structure) * wave.a_x_m_s2 / scales.force_n,
                    (wave.wave_number_1_m * (origin_m[1] + structure.site.depth_m)).tanh(),
                    wave.omega_rad_s * scales.time_s,
                ]),
                _ => None,
            },
        };
        let system = System {
            body: Body::rigid(shape, inertia),
            cables: structure
                .lines
                .iter()
                .enumerate()
                .map(|(index, line)| cable(structure, &scales, line, taut.contains(&index)))
                .collect(),
            forcing: Forcing {
                constant: [0.0, -1.0],
                harmonics,
            },
            drag: drag(structure, &scales, &waves, inertia),
            restitution: structure.restitution,
        };
        let floor = (origin_m[1] + structure.site.depth_m) / l;
        let rules = Rules {
            rotation_limit: Some(FRAC_PI_2),
            upper_bound: Some(floor),
            max_impacts: structure.max_snaps,
            v_stick: V_STICK,
            ..Rules::until(structure.duration_s / scales.time_s)
        };
        Self {
            scales,
            system,
            rules,
            waves,
            groups,
        }
    }

    /// The state of a body at rest at a place, turned by θ counter-clockwise in the picture with z up.
    pub fn at_rest(&self, place_m: [f64; 2], theta_rad: f64) -> State {
        let [x, y] = self.scales.to_engine(place_m);
        State {
            x,
            y,
            theta: -theta_rad,
            ..State::default()
        }
    }

    /// The force of the waves at a time, `[x, z]` \[N\].
    pub fn wave_force_n(&self, t_s: f64) -> [f64; 2] {
        let [x, y] = self.system.forcing.at(t_s / self.scales.time_s);
        let buoyancy = self.system.forcing.constant;
        let f = self.scales.force_n;
        [f * (x - buoyancy[0]), -f * (y - buoyancy[1])]
    }
}

/// Froude-Krylov force with added mass over the water's acceleration, ρV(1 + C_a) \[kg\].
pub fn force_per_acceleration(structure: &Structure) -> f64 {
    structure.displaced_mass_kg() + structure.body.added_mass_kg
}

/// The waves of a structure as they are at the body's level.
fn waves(structure: &Structure, z_m: f64) -> Vec<PhasedWave> {
    let site = &structure.site;
    match structure.water {
        Water::Still => Vec::new(),
        Water::Wave(wave) => vec![PhasedWave {
            wave: LinearWave::new(site, wave.height_m / 2.0, wave.omega_rad_s(), z_m),
            phase_rad: 0.0,
        }],
        Water::Sea(sea) => components(&sea)
            .into_iter()
            .map(|part| PhasedWave {
                wave: LinearWave::new(site, part.amplitude_m, part.omega_rad_s, z_m),
                phase_rad: part.phase_rad,
            })
            .collect(),
    }
}

/// The force of one wave in the engine's units.
///
/// With the surface η = A sin(ωt + ε) above the body, of a wave that goes to +x, linear theory gives
///
/// ```text
/// u̇ = a_x cos(ωt + ε),    ẇ = −a_z sin(ωt + ε)
/// ```
///
/// so f_x = f_o cos(Ωt + ε), and f_y = ν f_o sin(Ωt + ε) as y points down: for ε = 0 the ellipse of
/// docs/model.md section 3, begun when the horizontal acceleration is greatest. A wave that goes to −x turns the
/// sign of u̇.
fn force(structure: &Structure, scales: &Scales, wave: &PhasedWave) -> Harmonic {
    let per = force_per_acceleration(structure) / scales.force_n;
    let x = structure.heading * per * wave.wave.a_x_m_s2;
    let y = per * wave.wave.a_z_m_s2;
    let (sine, cosine) = wave.phase_rad.sin_cos();
    Harmonic {
        omega: wave.wave.omega_rad_s * scales.time_s,
        cosine: [x * cosine, y * sine],
        sine: [-x * sine, y * cosine],
    }
}

/// Drag and damping of the body in the engine's units, per unit mass and inertia; none where all are zero.
///
/// With u̇ and ẇ as in [`force`] the water moves at u = (a_x/ω) sin(ωt + ε), w = (a_z/ω) cos(ωt + ε), and z points up.
fn drag(
    structure: &Structure,
    scales: &Scales,
    waves: &[PhasedWave],
    inertia: f64,
) -> Option<Drag> {
    let body = &structure.body;
    let (l, m, t) = (scales.length_m, scales.mass_kg, scales.time_s);
    let quadratic = 0.5 * structure.site.water_density_kg_m3 * body.drag_area_m2;
    let drag = Drag {
        linear: body.linear_damping_n_s_m * t / m,
        quadratic: quadratic * l / m,
        turning: body.turning_damping_n_m_s * t / (m * l * l) / inertia,
        water: Vec::new(),
    };
    let velocity = |wave: &PhasedWave| {
        let per = 1.0 / (wave.wave.omega_rad_s * scales.speed_m_s());
        let x = structure.heading * per * wave.wave.a_x_m_s2;
        let y = -per * wave.wave.a_z_m_s2;
        let (sine, cosine) = wave.phase_rad.sin_cos();
        Harmonic {
            omega: wave.wave.omega_rad_s * t,
            cosine: [x * sine, y * cosine],
            sine: [x * cosine, -y * sine],
        }
    };
    let resists = drag.linear + drag.quadratic + drag.turning > 0.0;
    resists.then(|| Drag {
        water: waves.iter().map(velocity).collect(),
        ..drag
    })
}

fn cable(structure: &Structure, scales: &Scales, line: &LineSi, taut: bool) -> Cable {
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
