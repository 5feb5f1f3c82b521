//! Conversion between SI and the engine's units.

use snapload::{Case, Parameters, Simulation, Trajectory};
use snapload_structure::{LinearWave, Model, Structure, wave_number};
use std::f64::consts::PI;

const RHO: f64 = 1025.0;
const G: f64 = 9.806_65;

/// The thesis's standard case as a structure: half the anchors' distance L, a net buoyancy and a
/// mass are chosen, and all other values follow from r, a, f_o, ν and Ω (docs/structures.md).
fn disguised(p: &Parameters) -> String {
    let (l, volume, mass, depth) = (15.0, 10.0, 4000.0, 40.0);
    let force = (RHO * volume - mass) * G;
    let moving = mass + RHO * volume;
    let time = (moving * l / force).sqrt();
    let omega = p.omega / time;
    let k = wave_number(omega, depth, G);
    let z = p.nu.atanh() / k - depth;
    let acceleration = p.f_o * force / (2.0 * RHO * volume);
    let height = 2.0 * acceleration / omega.powi(2) * (k * depth).sinh() / (k * (z + depth)).cosh();
    let h = (p.r * p.r - (1.0 - p.a).powi(2)).sqrt();
    let (width, arm, anchor) = (2.0 * p.a * l, p.a * l, z - h * l);
    format!(
        "[body]\nmass = {mass}\ndisplaced_volume = {volume}\nwidth = {width}\nposition = [0, {z}]\n\
         moment_of_inertia = {inertia}\n\
         [[line]]\nanchor = [{l}, {anchor}]\nfairlead = [{arm}, {z}]\nlength = {r}\n\
         [[line]]\nanchor = [-{l}, {anchor}]\nfairlead = [-{arm}, {z}]\nlength = {r}\n\
         [site]\ndepth = {depth}\n[wave]\nheight = {height}\nperiod = {period}\n\
         [run]\nrestitution = {e}\nduration = {duration}\nstart = [0, {start}]\n",
        inertia = p.a * p.a * moving * l * l,
        r = p.r * l,
        period = 2.0 * PI / omega,
        e = p.e,
        duration = p.t_end * time,
        start = z - p.y * l,
    )
}

/// The same groups, and the same impacts until rounding has grown too far, as it grows tenfold in a
/// few impacts.
#[test]
fn thesis_in_disguise_is_the_thesis() {
    let p = Parameters::STANDARD;
    let structure = Structure::parse("disguise", &disguised(&p)).unwrap();
    let model = Model::about(&structure, structure.body.position_m, &[0, 1]);
    let [f_o, nu, omega] = model.groups.wave.unwrap();
    for (ours, theirs) in [
        (f_o, p.f_o),
        (nu, p.nu),
        (omega, p.omega),
        (model.groups.r[1], p.r),
        (model.groups.a, p.a),
    ] {
        assert!((ours - theirs).abs() < 1e-14, "{ours} {theirs}");
    }
    let start = model.at_rest(structure.start_m.unwrap(), 0.0);
    let mut rules = model.rules;
    rules.settled_below = Some(snapload::SETTLING_HEIGHT);
    let ours =
        Trajectory::record(Simulation::new(model.system.clone(), rules, 0.0, start).unwrap());
    let theirs = Case::new(p).unwrap().run();
    let mut compared = 0;
    for (ours, theirs) in ours.impacts().iter().zip(theirs.impacts()) {
        // Rounding of 1e-15 that grows by less than ten an impact.
        let allowed = 1e-14 * 10f64.powi(compared);
        if allowed > 1e-6 {
            break;
        }
        assert_eq!(ours.cable, theirs.cable);
        assert!(
            (ours.t - theirs.t).abs() < allowed && (ours.v_n - theirs.v_n).abs() < allowed,
            "{ours:?}\n{theirs:?}"
        );
        compared += 1;
    }
    assert!(compared >= 8);
    assert_eq!(ours.end().reason, theirs.end().reason);
}

/// A cylinder of 3 m in 10 m of water, its axis 3.5 m down, under waves of 2 m and 6 s: values
/// computed independently from linear theory.
#[test]
fn cylinder_feels_what_linear_theory_predicts() {
    let text = include_str!("../../../../docs/examples/cylinder.toml");
    let structure = Structure::parse("cylinder.toml", text).unwrap();
    let wave = LinearWave::new(&structure.site, 1.0, 2.0 * PI / 6.0, -3.5);
    assert!((wave.a_x_m_s2 - 0.891_312).abs() < 1e-6 && (wave.a_z_m_s2 - 0.613_113).abs() < 1e-6);
    let [along, up] = snapload_structure::force_per_acceleration(&structure);
    assert_eq!(along, up);
    let force = along / structure.net_buoyancy_n();
    assert!(
        (force * wave.a_x_m_s2 - 0.364).abs() < 5e-4,
        "{}",
        force * wave.a_x_m_s2
    );
    assert!(
        (force * wave.a_z_m_s2 - 0.250).abs() < 5e-4,
        "{}",
        force * wave.a_z_m_s2
    );
}
