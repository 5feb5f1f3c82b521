//! Body, cables, forces and restitution together.

use crate::arithmetic::plane::Vector2;
use crate::arithmetic::real::Real;
use crate::model::body::{Body, Shape};
use crate::model::cable::{Cable, Normal};
use crate::model::contact_law::ContactLaw;
use crate::model::drag::Drag;
use crate::model::floating::{Complex, Floating};
use crate::model::forcing::{Forcing, Harmonic};
use crate::model::state::State;
use crate::model::surroundings::Surroundings;
use crate::model::taut_set::{MAX_CABLES, TautSet};

/// Up to this number of sinusoids are summed up directly at each instant.
pub(crate) const FEW_SINUSOIDS: usize = 8;

/// A body on inextensible cables, under forces that depend on time alone, possibly with drag or
/// afloat.
#[derive(Clone, Debug, PartialEq)]
pub struct System<T = f64> {
    /// The body.
    pub body: Body<T>,
    /// The cables, at most [`MAX_CABLES`].
    pub cables: Vec<Cable<T>>,
    /// All forces except those of the cables, including the weight.
    pub forcing: Forcing<T>,
    /// Drag of the water, if there is any.
    pub drag: Option<Drag<T>>,
    /// The forces of linear water, if the body floats.
    pub floating: Option<Floating<T>>,
    /// Coefficient of restitution e, 0 ≤ e ≤ 1.
    pub restitution: T,
}

impl<T: Real> System<T> {
    /// The breakwater of docs/model.md section 2: weight 1, anchors at (±1, h + b), fairleads at
    /// (±a, b) on the body, cables of length r, forced along an ellipse.
    ///
    /// h = sqrt(r² − (1 − a)²), so that both cables are taut at x = y = θ = 0; r > |1 − a|.
    pub fn moored_breakwater(
        body: Body<T>,
        [a, b]: [T; 2],
        r: T,
        restitution: T,
        wave: Harmonic<T>,
    ) -> Self {
        let h = anchor_height(r, a);
        let half_gap = a - 1.0;
        let cable = |side: T| Cable::taut_at_rest([side * half_gap, -h], [side * a, b], r);
        Self {
            body,
            cables: vec![cable(T::ONE), cable(-T::ONE)],
            forcing: Forcing {
                constant: [T::ZERO, -T::ONE].into(),
                harmonics: vec![wave],
            },
            drag: None,
            floating: None,
            restitution,
        }
    }

    /// The same system in another arithmetic.
    pub fn map<U: Real>(&self, number: impl Fn(T) -> U + Copy) -> System<U> {
        System {
            body: self.body.map(number),
            cables: self.cables.iter().map(|cable| cable.map(number)).collect(),
            forcing: self.forcing.map(number),
            drag: self.drag.as_ref().map(|drag| drag.map(number)),
            floating: self.floating.as_ref().map(|water| water.map(number)),
            restitution: number(self.restitution),
        }
    }

    /// The part of an impulse that stops the closing velocity of its cable; the rest is the
    /// rebound.
    pub fn without_rebound(&self, impulse: T) -> T {
        self.contact_law().without_rebound(impulse)
    }

    /// The law of contact of its cables.
    #[inline(always)]
    pub(crate) fn contact_law(&self) -> ContactLaw<T> {
        ContactLaw {
            restitution: self.restitution,
        }
    }

    /// Whether motion with these taut cables is computed in closed form. With many sinusoids that
    /// takes longer than a series: each has to be evaluated at every evaluation of the motion,
    /// while their series is summed up once for many steps ([`crate::motion::waves`]). Numbers of
    /// many digits, which take many short steps, use the closed form; numbers with derivatives use
    /// whatever the doubles use.
    pub(crate) fn has_closed_form(&self, taut: TautSet) -> bool {
        let summed_up = T::FUSES || T::CARRIES_SLOPES;
        let many = self.forcing.harmonics.len() > FEW_SINUSOIDS;
        self.flies_freely(taut) && !(summed_up && many)
    }

    /// Whether the acceleration with these taut cables is the force alone and depends on no state:
    /// slack, of unit mass, without drag and not afloat.
    pub(crate) fn flies_freely(&self, taut: TautSet) -> bool {
        taut.is_empty()
            && self.drag.is_none()
            && self.floating.is_none()
            && self.body.mass.is_unit()
    }

    /// The memory of water that has been at rest; empty where the body does not float.
    pub fn memory_at_rest(&self) -> Vec<Complex<T>> {
        self.floating
            .as_ref()
            .map_or_else(Vec::new, Floating::at_rest)
    }

    /// The force of the water's memory on the body.
    #[inline(always)]
    pub fn memory_force(&self, memory: &[Complex<T>]) -> [T; 3] {
        match &self.floating {
            Some(water) => water.memory_force(memory),
            None => [T::ZERO; 3],
        }
    }

    /// Whether some taut cables of which none depends on the others leave the body no freedom:
    /// three, or two if no cable has a lever arm, so that the rotation changes no gap.
    #[inline(always)]
    pub(crate) fn is_held_by(&self, taut: TautSet) -> bool {
        let centred = |cable: &Cable<T>| cable.fairlead().length() == T::ZERO;
        taut.len() >= 3 || taut.len() == 2 && self.cables.iter().all(centred)
    }

    /// The set of all cables.
    pub fn all_cables(&self) -> TautSet {
        (0..self.cables.len().min(MAX_CABLES)).collect()
    }

    /// Energy: kinetic, and potential in the constant force and in the hydrostatic stiffness
    /// (docs/model.md section 1: unit F L).
    pub fn energy(&self, state: &State<T>) -> T {
        let kinetic = self.body.mass.kinetic_energy(state);
        let energy = kinetic - self.forcing.constant.dot(state.centre());
        match &self.floating {
            Some(water) => energy + water.potential_energy(state),
            None => energy,
        }
    }

    /// y of the highest point of the body.
    #[inline(always)]
    pub fn top(&self, state: &State<T>) -> T {
        let (sine, cosine) = state.theta.sin_cos();
        state.y + self.body.top(sine, cosine)
    }

    /// The normals of the cables of a set; the others' entries are zero.
    ///
    /// # Panics
    /// If the set has a cable that the system does not have.
    #[inline(always)]
    pub fn normals(&self, state: &State<T>, set: TautSet) -> [Normal<T>; MAX_CABLES] {
        let mut normals = [Normal::default(); MAX_CABLES];
        for cable in set.iter() {
            normals[cable] = self.cables[cable].normal(state);
        }
        normals
    }

    /// The external forces at a time, with each sinusoid evaluated.
    #[inline(always)]
    pub fn surroundings(&self, t: T) -> Surroundings<T> {
        Surroundings {
            force: self.forcing.at(t),
            water: match &self.drag {
                Some(drag) => drag.velocity_of_water(t),
                None => Vector2::ZERO,
            },
            excitation: match &self.floating {
                Some(water) => water.excitation_at(t),
                None => [T::ZERO; 3],
            },
        }
    }

    /// (ẍ, ÿ, θ̈) without any cable force: M⁻¹ times the forces, the drag and the forces of the
    /// water, of which that of its memory is given; it is zero where the body does not float.
    #[inline(always)]
    pub fn free_acceleration(
        &self,
        around: &Surroundings<T>,
        state: &State<T>,
        memory_force: [T; 3],
    ) -> [T; 3] {
        let mass = &self.body.mass;
        let Vector2 { x, y } = around.force;
        let mut load = match &self.drag {
            None => [x, y, T::ZERO],
            Some(drag) => {
                let [u, v, turning] = drag.at(around.water, state);
                [x + u, y + v, mass.load_of_turning(turning)]
            }
        };
        if let Some(water) = &self.floating {
            let [x, y, moment] = water.force(around.excitation, state, memory_force);
            load = [
                load[0] + x,
                load[1] + y,
                load[2] + mass.load_of_moment(moment),
            ];
        }
        mass.accelerated_by(load)
    }

    /// Normal acceleration g̈/(2r) of a cable of zero gap without any cable force, with (f, θ̈) the
    /// free acceleration: n·f + s θ̈ + |Ṗ|²/r − θ̇² n·ρ (docs/model.md section 6).
    #[inline(always)]
    pub fn free_normal_acceleration(
        &self,
        cable: usize,
        state: &State<T>,
        [x, y, turning]: [T; 3],
    ) -> T {
        let tether = &self.cables[cable];
        let (sine, cosine) = state.theta.sin_cos();
        let lever = tether.lever(sine, cosine);
        let normal = tether.normal(state);
        let velocity = Vector2 {
            x: state.vx - state.vtheta * lever.y,
            y: state.vy + state.vtheta * lever.x,
        };
        normal.n.dot([x, y].into())
            + normal.arm * turning
            + velocity.dot(velocity) / tether.length()
            - state.vtheta.squared() * normal.n.dot(lever)
    }
}

/// h = sqrt(r² − (1 − a)²), written without cancellation.
pub fn anchor_height<T: Real>(r: T, a: T) -> T {
    let half_gap = T::ONE - a;
    ((r - half_gap) * (r + half_gap)).sqrt()
}

impl<T: Real> Shape<T> {
    /// The outline that docs/model.md section 2 gives half-sizes a and b: a circle of radius a
    /// where b = 0, else a rectangle.
    pub fn of_half_sizes(a: T, b: T) -> Self {
        if b > T::ZERO {
            Shape::Rectangle {
                half_width: a,
                half_height: b,
            }
        } else {
            Shape::Circle { radius: a }
        }
    }
}
