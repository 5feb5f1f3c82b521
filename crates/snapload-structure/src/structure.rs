//! A moored structure in SI units, checked once when it is read.

mod added_mass;
mod afloat;
mod check;
mod design;
mod read;

pub use added_mass::{AddedMass, AddedMassDefaults};
pub use afloat::{Afloat, NO_FILES_HERE, files_beside};

use crate::text_layout::kilo;
use std::f64::consts::PI;
use std::sync::Arc;

/// The outline of the body in the x-z plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// A circle whose diameter is the width.
    Circle,
    /// A rectangle.
    Rectangle,
}

impl Outline {
    /// Its area \[m²\].
    fn area_m2(self, [width_m, height_m]: [f64; 2]) -> f64 {
        match self {
            Self::Circle => PI * width_m * width_m / 4.0,
            Self::Rectangle => width_m * height_m,
        }
    }
}

/// The body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodySi {
    /// Mass m \[kg\].
    pub mass_kg: f64,
    /// The added mass of the water.
    pub added_mass: AddedMass,
    /// Outline.
    pub outline: Outline,
    /// Size in x \[m\].
    pub width_m: f64,
    /// Size in z \[m\].
    pub height_m: f64,
    /// Displaced volume V \[m³\].
    pub displaced_volume_m3: f64,
    /// Moment of inertia about the centre, besides that of `added_mass` \[kg m²\].
    pub moment_of_inertia_kg_m2: f64,
    /// C_d A of the quadratic drag \[m²\].
    pub drag_area_m2: f64,
    /// Force per relative velocity of the water \[N s/m\].
    pub linear_damping_n_s_m: f64,
    /// Moment per angular velocity \[N m s\].
    pub turning_damping_n_m_s: f64,
    /// A constant load `[x, z]` \[N\].
    pub constant_force_n: [f64; 2],
    /// Position of the centre `[x, z]` for which the fairleads are given \[m\].
    pub position_m: [f64; 2],
}

/// A mooring line.
#[derive(Clone, Debug, PartialEq)]
pub struct LineSi {
    /// Anchor `[x, z]` \[m\].
    pub anchor_m: [f64; 2],
    /// Fairlead `[x, z]` with the body at its position, unturned \[m\].
    pub fairlead_m: [f64; 2],
    /// Unstretched length \[m\].
    pub length_m: f64,
    /// Its name, from its type and diameter; empty if they are not given.
    pub name: String,
    /// Axial stiffness EA \[N\].
    pub stiffness_n: Option<f64>,
    /// Mass per length μ \[kg/m\].
    pub mass_per_length_kg_m: Option<f64>,
    /// Minimum breaking load \[N\].
    pub breaking_load_n: Option<f64>,
}

impl BodySi {
    /// Its length across the plane: the displaced volume divided by the area of the section \[m\].
    pub fn length_m(&self) -> f64 {
        self.displaced_volume_m3 / self.outline.area_m2([self.width_m, self.height_m])
    }

    /// The part of the outline's area that is under the still water with the body at its position.
    pub(crate) fn part_under_still_water(&self) -> f64 {
        let [half, z] = [0.5 * self.height_m, self.position_m[1]];
        // The depth of the water over the centre, within the outline.
        let deep = (-z).clamp(-half, half);
        match self.outline {
            Outline::Rectangle => (half + deep) / self.height_m,
            Outline::Circle => {
                let segment =
                    half * half * (-deep / half).acos() + deep * (half * half - deep * deep).sqrt();
                segment / (PI * half * half)
            }
        }
    }

    /// Takes mass and inertia from the coefficients of a floating body, at infinite frequency.
    fn weigh(&mut self, afloat: &Afloat) {
        let added = &afloat.report.fit.added_mass_inf;
        self.added_mass = AddedMass::given([0, 1, 2].map(|i| added[(i, i)]));
        self.moment_of_inertia_kg_m2 = afloat.body.mass[(2, 2)];
    }

    /// Mass along x and along z, with the added mass \[kg\].
    pub fn moving_mass_kg(&self) -> [f64; 2] {
        let added = &self.added_mass;
        [added.surge_kg, added.heave_kg].map(|added| self.mass_kg + added)
    }

    /// Moment of inertia about the centre, with the added one \[kg m²\].
    pub fn turning_inertia_kg_m2(&self) -> f64 {
        self.moment_of_inertia_kg_m2 + self.added_mass.pitch_kg_m2
    }

    /// Whether a point of the plane is on or within the body at its position, to a thousandth.
    pub fn reaches(&self, [x, z]: [f64; 2]) -> bool {
        let [right, up] = [x - self.position_m[0], z - self.position_m[1]];
        let most = 0.501;
        match self.outline {
            Outline::Circle => right.hypot(up) <= most * self.width_m,
            Outline::Rectangle => {
                right.abs() <= most * self.width_m && up.abs() <= most * self.height_m
            }
        }
    }

    /// Half of its size in z, turned by θ \[m\].
    pub fn half_height_m(&self, theta_rad: f64) -> f64 {
        let (sine, cosine) = theta_rad.sin_cos();
        match self.outline {
            Outline::Circle => self.width_m / 2.0,
            Outline::Rectangle => (self.width_m * sine.abs() + self.height_m * cosine.abs()) / 2.0,
        }
    }
}

impl LineSi {
    /// Spring rate k = EA/length \[N/m\].
    pub fn spring_rate_n_m(&self) -> Option<f64> {
        self.stiffness_n.map(|stiffness| stiffness / self.length_m)
    }

    /// Whether two lines are strands of one, which always pull together: their ends and lengths are
    /// the same, up to the rounding of given numbers.
    pub(crate) fn is_strand_with(&self, other: &Self) -> bool {
        let near = 1e-6 * self.length_m.min(other.length_m);
        let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        apart(self.anchor_m, other.anchor_m) <= near
            && apart(self.fairlead_m, other.fairlead_m) <= near
            && (self.length_m - other.length_m).abs() <= near
    }
}

/// The site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Depth d \[m\].
    pub depth_m: f64,
    /// Density of the water ρ \[kg/m³\].
    pub water_density_kg_m3: f64,
    /// Velocity of the water to +x besides that of waves \[m/s\].
    pub current_m_s: f64,
    /// Gravity g \[m/s²\].
    pub gravity_m_s2: f64,
}

/// A regular wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Height H from trough to crest \[m\].
    pub height_m: f64,
    /// Period \[s\].
    pub period_s: f64,
}

/// The shape of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectrumShape {
    /// JONSWAP with this peak enhancement γ.
    Jonswap(f64),
    /// Pierson-Moskowitz.
    PiersonMoskowitz,
}

/// An irregular sea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrregularSea {
    /// Shape of its spectrum.
    pub shape: SpectrumShape,
    /// Significant wave height Hs = 4 sqrt(m0) \[m\].
    pub significant_height_m: f64,
    /// Peak period Tp \[s\].
    pub peak_period_s: f64,
    /// Seed of its phases.
    pub seed: u64,
    /// The number of its sinusoids.
    pub components: usize,
}

/// The motion of the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Water {
    /// Nothing.
    Still,
    /// A regular wave.
    Wave(Wave),
    /// An irregular sea.
    Sea(IrregularSea),
}

/// The head of a note; texts that are not given are empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Project {
    /// The name of the project.
    pub name: String,
    /// The client of the note.
    pub client: String,
    /// The author.
    pub author: String,
    /// The date of the note.
    pub date: String,
}

impl Project {
    /// The texts that are given: key, name on a page, and text.
    pub(crate) fn rows(&self) -> Vec<[&str; 3]> {
        let all = [
            ["name", "Project", &self.name],
            ["client", "Client", &self.client],
            ["author", "Author", &self.author],
            ["date", "Date", &self.date],
        ];
        all.into_iter()
            .filter(|[_, _, text]| !text.is_empty())
            .collect()
    }
}

/// The user's design rule; each check is made if its factors are given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DesignRule {
    /// Partial factors γ_pret and γ_env, and the ratio of characteristic strength to breaking load.
    pub strength: Option<[f64; 3]>,
    /// The ratio of the least tension to that at rest has to be above this.
    pub least_share: Option<f64>,
    /// γ₁ and γ₂ of γ₁ T_0 + γ₂ (T_min − T_0) > 0.
    pub least_factors: Option<[f64; 2]>,
    /// The ratio of the waves' vertical force to the net buoyancy is at most this.
    pub force_share: Option<f64>,
}

impl DesignRule {
    /// The keys that are given, with their values.
    pub(crate) fn rows(&self) -> Vec<(&'static str, f64)> {
        let Self {
            strength,
            least_share,
            least_factors,
            force_share,
        } = *self;
        let named = |keys: &[&'static str], values: &[f64]| -> Vec<(&'static str, f64)> {
            keys.iter().copied().zip(values.iter().copied()).collect()
        };
        let groups = [
            strength.map(|values| named(&Self::STRENGTH, &values)),
            least_share.map(|value| named(&["least_share"], &[value])),
            least_factors.map(|values| named(&Self::LEAST, &values)),
            force_share.map(|value| named(&["force_share"], &[value])),
        ];
        groups.into_iter().flatten().flatten().collect()
    }

    /// The keys of `strength`, which are given together.
    pub(crate) const STRENGTH: [&'static str; 3] =
        ["pretension_factor", "environment_factor", "strength_factor"];
    /// The keys of `least_factors`, which are given together.
    pub(crate) const LEAST: [&'static str; 2] = ["rest_factor", "dynamic_factor"];
}

/// A structure and the conditions of its run.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// The head of a note on it.
    pub project: Project,
    /// The body.
    pub body: BodySi,
    /// The lines.
    pub lines: Vec<LineSi>,
    /// The site.
    pub site: Site,
    /// The forces of the water on it, if it floats.
    pub afloat: Option<Arc<Afloat>>,
    /// The waves.
    pub water: Water,
    /// The direction of the waves: 1 to +x, −1 to −x.
    pub heading: f64,
    /// Coefficient of restitution e.
    pub restitution: f64,
    /// Time that is computed \[s\].
    pub duration_s: f64,
    /// Snaps before this are not judged \[s\].
    pub transient_s: f64,
    /// Whether the case gives it; otherwise it is the usual one of its waves.
    pub transient_is_given: bool,
    /// Centre at the start `[x, z]`; none for the position of rest \[m\].
    pub start_m: Option<[f64; 2]>,
    /// The run ends at more snaps than this.
    pub max_snaps: u64,
    /// The user's design rule.
    pub design: DesignRule,
}

/// Three hours, during which a sea is assumed to be stationary \[s\].
pub const THREE_HOURS_S: f64 = 10_800.0;
impl Structure {
    /// Net buoyancy F = (ρV − m) g \[N\]; positive for every checked structure that does not float.
    pub fn net_buoyancy_n(&self) -> f64 {
        if let Some(afloat) = &self.afloat {
            return afloat.body.constant_force[1];
        }
        self.site.gravity_m_s2 * (self.displaced_mass_kg() - self.body.mass_kg)
    }

    /// The weight of the displaced water \[N\].
    pub(crate) fn weight_of_displaced_n(&self) -> f64 {
        self.site.gravity_m_s2 * self.displaced_mass_kg()
    }

    /// Mass of the displaced water ρV \[kg\].
    pub fn displaced_mass_kg(&self) -> f64 {
        self.site.water_density_kg_m3 * self.body.displaced_volume_m3
    }

    /// Coefficients of added mass in x and z, C_a = m_a/(ρV).
    pub fn added_mass_coefficients(&self) -> [f64; 2] {
        let added = &self.body.added_mass;
        [added.surge_kg, added.heave_kg].map(|added| added / self.displaced_mass_kg())
    }

    /// The source of added mass that the case does not give; none if it gives all of it.
    pub fn added_mass_source(&self) -> Option<&'static str> {
        self.body.added_mass.source(self.body.outline)
    }

    /// The added mass in words, if the case leaves some of it to the textbook.
    pub fn default_text(&self) -> Option<String> {
        let (body, added) = (&self.body, &self.body.added_mass);
        let source = self.added_mass_source()?;
        let tonnes = |kilograms: f64| kilo(&kilograms, 1);
        Some(format!(
            "{} t, added mass {} t in x and {} t in z; moment of inertia {} t m^2 of the body and \
             {} t m^2 of the added mass: {source}",
            tonnes(body.mass_kg),
            tonnes(added.surge_kg),
            tonnes(added.heave_kg),
            tonnes(body.moment_of_inertia_kg_m2),
            tonnes(added.pitch_kg_m2),
        ))
    }

    /// The drag of the current, ½ ρ C_d A |U| U + b U \[N\].
    pub fn drag_of_current_n(&self) -> f64 {
        let (body, current) = (&self.body, self.site.current_m_s);
        let quadratic = 0.5 * self.site.water_density_kg_m3 * body.drag_area_m2;
        (quadratic * current.abs() + body.linear_damping_n_s_m) * current
    }

    /// The constant loads besides weight and buoyancy, in words; none if there are none.
    pub fn steady_text(&self) -> Option<String> {
        let (current, [x, z]) = (self.site.current_m_s, self.body.constant_force_n);
        let mut parts = Vec::new();
        if current != 0.0 {
            let drag = kilo(&self.drag_of_current_n(), 1);
            parts.push(format!(
                "a current of {current} m/s with a drag of {drag} kN"
            ));
        }
        if [x, z] != [0.0; 2] {
            let [x, z] = [x, z].map(|newtons| kilo(&newtons, 1));
            parts.push(format!("a constant force of {x} kN in x and {z} kN in z"));
        }
        let moment = self.afloat.iter().map(|afloat| afloat.constant_moment_n_m);
        for moment in moment.filter(|moment| *moment != 0.0) {
            let moment = kilo(&moment, 1);
            parts.push(format!(
                "a constant moment of {moment} kN m, counter-clockwise"
            ));
        }
        (!parts.is_empty()).then(|| parts.join("; "))
    }

    /// Whether there are waves.
    pub(crate) fn has_waves(&self) -> bool {
        self.water.has_waves()
    }

    /// The direction of the waves: the value of their key.
    pub fn direction(&self) -> &'static str {
        if self.heading < 0.0 { "-x" } else { "+x" }
    }

    /// Whether every line has a stiffness, without which the tension in a snap is not known.
    pub fn tensions_known(&self) -> bool {
        self.lines.iter().all(|line| line.stiffness_n.is_some())
    }

    /// Whether the tension over the breaking load is known of every line, however it snaps.
    pub fn utilisations_known(&self) -> bool {
        let breaks = self.lines.iter().all(|line| line.breaking_load_n.is_some());
        breaks && self.tensions_known()
    }
}

impl SpectrumShape {
    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::Jonswap(gamma) => format!("JONSWAP, γ = {gamma}"),
            Self::PiersonMoskowitz => "Pierson-Moskowitz".to_owned(),
        }
    }
}

impl Wave {
    /// Angular frequency ω = 2π/T \[rad/s\].
    pub fn omega_rad_s(&self) -> f64 {
        2.0 * PI / self.period_s
    }
}
