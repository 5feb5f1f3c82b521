//! The rigid body: its mass matrix, its hydrostatic stiffness, and the constant forces.

use crate::coefficients::{FREEDOMS, Hydrodynamics};
use crate::digits::rounded_down;
use crate::error::HydroError;
use nalgebra::{Matrix3, Vector2, Vector3};

/// A body floats upright if it pitches by less than this, in rad.
pub(crate) const BALANCED_ANGLE: f64 = 0.01;

/// A body that is so many times as heavy as the water it displaces, or whose radius of gyration is
/// so many times the side of a cube of that water, is a mistake of units. Within these bounds the
/// frequencies of its motions are close enough for all of them to be found.
const MOST_MASSES: f64 = 100.0;
const MOST_SIDES: f64 = 1000.0;
/// So is damping of so many times m √(g/side), about the critical one of heave.
const MOST_DAMPING: f64 = 1e6;

/// The body's weight. Values that are not given are taken from the file: the displaced mass, and
/// the centre of gravity and inertia for which it was computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weight {
    /// m \[kg\].
    pub mass_kg: Option<f64>,
    /// The centre of gravity (x, z) \[m\].
    pub centre_m: Option<[f64; 2]>,
    /// The moment of inertia about the centre of gravity \[kg m²\].
    pub inertia_kg_m2: Option<f64>,
}

/// A floating body about its reference point, ready for linear answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// m \[kg\].
    pub mass_kg: f64,
    /// The centre of gravity \[m\].
    pub centre_m: [f64; 2],
    /// M of the rigid body.
    pub mass: Matrix3<f64>,
    /// C.
    pub stiffness: Matrix3<f64>,
    /// Linear damping in addition to that of waves.
    pub damping: Matrix3<f64>,
    /// Weight and buoyancy at the mean position, and other constant forces.
    pub constant_force: Vector3<f64>,
    /// The reference point's height above the still water \[m\].
    pub level_m: f64,
}

impl Body {
    /// The body of a file with a weight.
    ///
    /// # Errors
    /// [`HydroError::Missing`] if a required value is neither in the file nor in the weight, or
    /// [`HydroError::Value`] if a number is not possible.
    pub fn new(hydro: &Hydrodynamics, weight: &Weight) -> Result<Self, HydroError> {
        let statics = &hydro.hydrostatics;
        // First, as no given mass makes up for it.
        let file_stiffness = statics.stiffness.ok_or_else(|| {
            let advice = "the file does not have it (hydrostatic_stiffness of Capytaine, a .hst file of \
                          WAMIT; Nemoh writes none with its results), and it can not be given otherwise";
            HydroError::missing("the hydrostatic stiffness", advice)
        })?;
        let need = |what: &str, value: Option<f64>| {
            let advice = "neither the file nor the case has it; give it";
            value.ok_or_else(|| HydroError::missing(what, advice))
        };
        let mass_kg = need("the mass", weight.mass_kg.or(statics.displaced_mass_kg))?;
        let size = Size::new(hydro, mass_kg);
        let key = "--mass; body.mass in a case";
        up_to(MOST_MASSES * size.mass_kg, "the mass in kg", mass_kg, key)?;
        let centre = weight.centre_m.or(statics.centre_of_mass_m);
        let centre_m = [0, 1].map(|axis| centre.map(|centre| centre[axis]));
        let what = "the centre of gravity";
        let centre_m = [need(what, centre_m[0])?, need(what, centre_m[1])?];
        let [x, z] = [0, 1].map(|axis| centre_m[axis] - hydro.reference_m[axis]);
        let about_o = match (weight.inertia_kg_m2, statics.inertia) {
            (Some(inertia), _) => {
                let radius_m = MOST_SIDES * size.side_m;
                let most = mass_kg.max(size.mass_kg) * radius_m * radius_m;
                let key = "--inertia; body.moment_of_inertia in a case";
                up_to(most, "the moment of inertia in kg m²", inertia, key)?;
                inertia + mass_kg * (x * x + z * z)
            }
            (None, Some(file)) => {
                let own = statics.centre_of_mass_m.unwrap_or(centre_m);
                let own = [0, 1].map(|axis| own[axis] - hydro.reference_m[axis]);
                of_the_file(&file, own, mass_kg, [x, z])?
            }
            (None, None) => need("the moment of inertia", None)?,
        };
        Ok(Self {
            mass_kg,
            centre_m,
            mass: mass_matrix(mass_kg, [x, z], about_o),
            stiffness: stiffness(hydro, &file_stiffness, mass_kg, centre_m)?,
            damping: Matrix3::zeros(),
            constant_force: weight_and_buoyancy(hydro, mass_kg, x),
            level_m: hydro.reference_m[1],
        })
    }

    /// The body with linear damping in addition to that of waves, and with a constant force.
    ///
    /// # Errors
    /// [`HydroError::Value`] if one of them is not possible for a body of its size.
    pub(crate) fn loaded(
        mut self,
        hydro: &Hydrodynamics,
        damping: [f64; 3],
        force: [f64; 3],
    ) -> Result<Self, HydroError> {
        let Size { mass_kg, side_m } = Size::new(hydro, self.mass_kg);
        let mass_kg = mass_kg.max(self.mass_kg);
        let gravity = hydro.water.gravity_m_s2;
        let of_damping = MOST_DAMPING * mass_kg * (gravity / side_m).sqrt();
        let of_force = MOST_MASSES * mass_kg * gravity;
        for (i, freedom) in FREEDOMS.into_iter().enumerate() {
            let arm_m = if i == 2 { side_m } else { 1.0 };
            let most = of_damping * arm_m * arm_m;
            if !(0.0..=most).contains(&damping[i]) {
                let what = format!("the damping of {freedom} in addition to that of waves");
                let expected = format!(
                    "it must be 0 or above, and at most {:e} (--damping; float.damping in a case)",
                    rounded_down(most)
                );
                return Err(HydroError::value(what, damping[i], expected));
            }
            let most = of_force * arm_m;
            if !(-most..=most).contains(&force[i]) {
                let what = format!("the constant load on {freedom}");
                let most = rounded_down(most);
                let expected = format!("it must be from -{most:e} to {most:e} (--force)");
                return Err(HydroError::value(what, force[i], expected));
            }
        }
        self.damping += Matrix3::from_diagonal(&damping.into());
        self.constant_force += Vector3::from(force);
        Ok(self)
    }

    /// The moment of inertia about the centre of gravity, I_O − m (x_G² + z_G²) \[kg m²\].
    pub fn inertia_about_centre_kg_m2(&self) -> f64 {
        let [mz, mx] = [self.mass[(0, 2)], self.mass[(1, 2)]];
        self.mass[(2, 2)] - (mz * mz + mx * mx) / self.mass_kg
    }

    /// The body about where it floats without lines. Free of lines a lift F raises it
    /// by F/C33, which moves its weight and what is left of its buoyancy up. With
    /// vertical sides at the waterline,
    ///
    /// ```text
    /// C55 + z_O F + F²/(2 C33)
    /// ```
    ///
    /// with z_O the reference point's height above the still water, on which the sum
    /// does not depend: weight and buoyancy are equal there. C itself is that of a
    /// body held at the reference point.
    pub fn afloat(&self) -> Self {
        let mut body = self.clone();
        let (lift, heave) = (self.constant_force[1], self.stiffness[(1, 1)]);
        if heave > 0.0 {
            body.stiffness[(2, 2)] += self.level_m * lift + 0.5 * lift * lift / heave;
        }
        body
    }

    /// Heave and pitch that balance its constant forces by C \[m, rad\]; none if water
    /// does not hold it up and upright.
    pub(crate) fn balance(&self) -> Option<Vector2<f64>> {
        let stiffness = self.stiffness.fixed_view::<2, 2>(1, 1).into_owned();
        let force = self.constant_force.fixed_rows::<2>(1).into_owned();
        Some(stiffness.cholesky()?.solve(&force))
    }

    /// The pitch in which it floats without lines, if it is not upright \[rad\].
    pub fn unbalanced_pitch(&self) -> Option<f64> {
        let pitch = self.afloat().balance()?[1];
        (pitch.abs() > BALANCED_ANGLE).then_some(pitch)
    }

    /// The stiffness in pitch without lines if heave is free to follow, C55 − C35²/C33 \[N m\].
    pub(crate) fn righting_n_m(&self) -> f64 {
        let stiffness = self.afloat().stiffness;
        let [heave, coupled] = [stiffness[(1, 1)], stiffness[(1, 2)]];
        let followed = if coupled == 0.0 {
            0.0
        } else {
            coupled * coupled / heave
        };
        stiffness[(2, 2)] - followed
    }

    /// 𝓜 = M + A.
    ///
    /// # Errors
    /// [`HydroError::Impossible`] if it is not positive definite.
    pub fn with_added_mass(&self, added: &Matrix3<f64>) -> Result<Matrix3<f64>, HydroError> {
        let sum = self.mass + added;
        match sum.cholesky() {
            Some(_) => Ok(sum),
            None => Err(HydroError::Impossible(format!(
                "mass and added mass together are not positive definite: {:.4e} in surge, {:.4e} in \
                 heave, {:.4e} in pitch; correct the mass, the centre of gravity or the moment of inertia",
                sum[(0, 0)],
                sum[(1, 1)],
                sum[(2, 2)]
            ))),
        }
    }
}

/// I_O of a body that has the file's moment of inertia about its centre of gravity, for any
/// position of that and any mass: I_O(file) − m(file) |G(file)|² + m |G|², from the reference
/// point.
fn of_the_file(
    file: &Matrix3<f64>,
    own: [f64; 2],
    mass_kg: f64,
    centre: [f64; 2],
) -> Result<f64, HydroError> {
    let square = |[x, z]: [f64; 2]| x * x + z * z;
    let own_mass = if file[(0, 0)] > 0.0 {
        file[(0, 0)]
    } else {
        mass_kg
    };
    let inertia = file[(2, 2)] - own_mass * square(own);
    if inertia <= 0.0 {
        let what = "the file's moment of inertia about its centre of gravity in kg m²";
        let advice = "it must be above 0; give the body's own (--inertia; body.moment_of_inertia \
                      in a case)";
        return Err(HydroError::value(what, inertia, advice));
    }
    // If nothing differs this is the file's value to the bit.
    Ok(file[(2, 2)] + (mass_kg * square(centre) - own_mass * square(own)))
}

/// The water that a body displaces: its mass, and the side of a cube of it.
struct Size {
    mass_kg: f64,
    side_m: f64,
}

impl Size {
    /// A body whose file has no volume is taken to displace its own mass.
    fn new(hydro: &Hydrodynamics, mass_kg: f64) -> Self {
        let displaced = hydro.hydrostatics.displaced_mass_kg;
        let mass_kg = displaced.filter(|mass| *mass > 0.0).unwrap_or(mass_kg);
        let side_m = (mass_kg / hydro.water.density_kg_m3).cbrt();
        Self { mass_kg, side_m }
    }
}

/// Refuses a number that is not above 0, or above the most that a body of this size may have.
fn up_to(most: f64, what: &str, value: f64, key: &str) -> Result<(), HydroError> {
    if value > 0.0 && value <= most {
        return Ok(());
    }
    let expected = format!(
        "it must be above 0 and, for the water that the body displaces, at most {:e} ({key})",
        rounded_down(most)
    );
    Err(HydroError::value(what, value, expected))
}

/// M = [[m, 0, m z_G], [0, m, −m x_G], [m z_G, −m x_G, I_O]], (x_G, z_G) from the reference point.
fn mass_matrix(m: f64, [x, z]: [f64; 2], inertia: f64) -> Matrix3<f64> {
    Matrix3::new(m, 0.0, m * z, 0.0, m, -m * x, m * z, -m * x, inertia)
}

/// C for this weight. The file's includes m g z_G of a body whose mass is the displaced mass; surge
/// has none.
///
/// ```text
/// C55 = C55(file) + (ρV z_G(file) − m z_G) g,    z_G from the reference point
/// ```
fn stiffness(
    hydro: &Hydrodynamics,
    file: &Matrix3<f64>,
    mass_kg: f64,
    centre_m: [f64; 2],
) -> Result<Matrix3<f64>, HydroError> {
    let statics = &hydro.hydrostatics;
    let mut stiffness = Matrix3::zeros();
    for (i, j) in [(1, 1), (1, 2), (2, 1), (2, 2)] {
        stiffness[(i, j)] = 0.5 * (file[(i, j)] + file[(j, i)]);
    }
    let other = statics.displaced_mass_kg.is_none_or(|mass| mass != mass_kg)
        || statics
            .centre_of_mass_m
            .is_none_or(|centre| centre != centre_m);
    if other {
        let advice = "the file's pitch stiffness was computed for its own centre of gravity and the \
                      displaced mass; give both";
        let missing = |what: &str| HydroError::missing(what, advice);
        let displaced = statics.displaced_mass_kg;
        let displaced = displaced.ok_or_else(|| missing("the displaced mass"))?;
        let made = statics.centre_of_mass_m;
        let made = made.ok_or_else(|| missing("the file's centre of gravity"))?;
        let level = hydro.reference_m[1];
        let moment = displaced * (made[1] - level) - mass_kg * (centre_m[1] - level);
        stiffness[(2, 2)] += moment * hydro.water.gravity_m_s2;
    }
    Ok(stiffness)
}

/// F_c = (0, (ρV − m) g, m g x_G − ρgV x_B); a body whose file has no volume is taken to float in
/// balance.
fn weight_and_buoyancy(hydro: &Hydrodynamics, mass_kg: f64, x: f64) -> Vector3<f64> {
    let statics = &hydro.hydrostatics;
    let g = hydro.water.gravity_m_s2;
    let Some(displaced) = statics.displaced_mass_kg else {
        return Vector3::zeros();
    };
    // Without a centre of buoyancy the body is taken to float upright with the file's centre of
    // gravity.
    let made = statics.centre_of_mass_m.map(|centre| centre[0]);
    let x_b = statics.centre_of_buoyancy_x_m.or(made);
    let x_b = x_b.map_or(0.0, |x_b| x_b - hydro.reference_m[0]);
    let lift = (displaced - mass_kg) * g;
    Vector3::new(0.0, lift, g * (mass_kg * x - displaced * x_b))
}
