//! A body at another x is the same body: its wave forces refer to the crest over it, whereas those
//! of files refer to a crest at x = 0.

use crate::common::{Spoilt, dataset, reading};
use nalgebra::Complex;
use snapload_hydro::{Format, Given, Reading, SectionBody, Shape, Values, Water, from_dataset};

/// The file as the panel code writes it if the same hull is at another x: points have that x, and
/// the wave has gone through the phase kx more when its crest arrives there. The file says how long
/// its waves are.
fn moved(name: &str, x: f64) -> Spoilt {
    let mut file = dataset(name);
    let (_, wave_number) = file
        .all()
        .into_iter()
        .find(|(name, _)| name == "wavenumber")
        .expect("wave numbers");
    let Values::Numbers(k) = wave_number.values else {
        unreachable!("no numbers");
    };
    for point in ["rotation_center", "center_of_mass", "center_of_buoyancy"] {
        file = file.numbers(
            point,
            |axis, value| if axis == 0 { value + x } else { value },
        );
    }
    for force in [
        "diffraction_force",
        "Froude_Krylov_force",
        "excitation_force",
    ] {
        file = file.with(force, |variable| {
            let dims = ["complex", "omega", "wave_direction", "influenced_dof"];
            assert_eq!(variable.dims, dims);
            let Values::Numbers(numbers) = &mut variable.values else {
                unreachable!("no numbers");
            };
            let half = numbers.len() / 2;
            for at in 0..half {
                let direction = if at / 3 % 2 == 0 { 1.0 } else { -1.0 };
                let phase = Complex::from_polar(1.0, direction * k[at / 6] * x);
                let turned = Complex::new(numbers[at], numbers[half + at]) * phase;
                [numbers[at], numbers[half + at]] = [turned.re, turned.im];
            }
        });
    }
    file
}

/// The force is that of the hull at x = 0, also between the frequencies of the file, for waves in
/// both directions and about another point; and so are the checks of the phases.
#[test]
fn a_hull_elsewhere_has_the_same_forces() {
    for name in ["pontoon-deep.nc", "pontoon.nc"] {
        let here = reading(name);
        let omega = &here.hydro.omega_rad_s;
        let between = omega.windows(2).map(|two| 0.5 * (two[0] + two[1]));
        let all: Vec<f64> = omega.iter().copied().chain(between).collect();
        for x in [6.0, -100.0] {
            let file = moved(name, x);
            let hydro = from_dataset(&file.0, &Given::default()).expect("coefficients");
            let there = Reading::new(Format::Capytaine, hydro).expect("a reading");
            assert_eq!(there.hydro.reference_m, [x, 0.0]);
            assert_eq!(there.warnings, here.warnings);
            for (direction, z) in [(1.0, 0.0), (-1.0, 0.0), (1.0, -0.7)] {
                let [own, other] = [(&here, 0.0), (&there, x)].map(|(reading, x)| {
                    let hydro = reading.hydro.about([x, z]);
                    hydro.excitation_curve(direction).expect("a direction")
                });
                for omega in &all {
                    let [own, other] = [&own, &other].map(|x| x.at(*omega).expect("a force"));
                    let part = 1e-9 * own.norm();
                    assert!((own - other).norm() < part, "{name}, x = {x}: ω = {omega}");
                }
            }
        }
    }
}

/// The force on a textbook's section about another point is that of a crest over it, in its table
/// and in closed form.
#[test]
fn a_section_is_seen_from_any_place() {
    let section = SectionBody {
        shape: Shape::Rectangle,
        half_width_m: 2.0,
        draft_m: 1.2,
        length_m: 20.0,
        x_m: 0.0,
        centre_of_gravity_m: [0.0, -0.2],
    };
    let water = Water {
        density_kg_m3: 1025.0,
        gravity_m_s2: 9.81,
        depth_m: f64::INFINITY,
    };
    let hydro = section.reading(water).expect("a body").hydro;
    let there = hydro.about([30.0, -0.5]);
    for direction in [1.0, -1.0] {
        let curve = |hydro: &snapload_hydro::Hydrodynamics| {
            hydro.excitation_curve(direction).expect("a direction")
        };
        let table = &there.excitation_to(direction).expect("a direction").force;
        for (k, omega) in hydro.omega_rad_s.iter().enumerate() {
            let (own, far) = (curve(&hydro).at(*omega), curve(&there).at(*omega));
            let (own, far) = (own.expect("X"), far.expect("X"));
            // In deep water k = ω²/g; the crest reaches the point later by kx.
            let phase = Complex::from_polar(1.0, -direction * omega * omega / 9.81 * 30.0);
            let moment = own[2] + own[0] * 0.5 + own[1] * 30.0;
            for (found, right) in [(far[0], own[0]), (far[1], own[1]), (far[2], moment)] {
                assert!((found - right * phase).norm() < 1e-9 * far.norm());
            }
            assert!((far - table[k]).norm() < 1e-9 * far.norm());
        }
    }
}
