//! Draws every figure from made-up data into a folder: `cargo run --example gallery -- FOLDER`.
//!
//! The motion is a toy: a light point under two circles, thrown back by each with half its normal
//! velocity until the rebounds accumulate, then gliding along the circle to the corner.

use snapload_figures::{
    Axis, Leg, Mark, Mode, Picture, Plot, Point, Width, draw, energy, rotation, snap_velocities,
    tensions, trajectory,
};
use std::error::Error;
use std::path::Path;

const ANCHORS: [Point; 2] = [[-0.7, -0.9], [0.7, -0.9]];
const LENGTH: f64 = 1.4;
const STEP: f64 = 2e-5;
const RESTITUTION: f64 = 0.9;
const LIFT: f64 = 0.5;

/// All that the figures need of a motion.
#[derive(Default)]
struct Motion {
    legs: Vec<Leg>,
    marks: Vec<Mark>,
    theta: Vec<Point>,
    snaps: [Vec<Point>; 2],
    tensions: [Vec<Vec<Point>>; 2],
    energy: Vec<Point>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: gallery FOLDER")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let motion = motion();
    let empty = Motion::default();
    println!(
        "{} and {} snaps",
        motion.snaps[0].len(),
        motion.snaps[1].len()
    );
    for (tag, width, horizon) in [("", Width::Column, None), ("-wide", Width::Page, Some(6.2))] {
        for (name, plot) in plots(&motion, horizon) {
            save(folder, &draw(&format!("{name}{tag}"), width, &[plot])?)?;
        }
        let panels: Vec<Plot> = plots(&motion, horizon)
            .into_iter()
            .skip(1)
            .map(|(_, plot)| plot)
            .collect();
        save(folder, &draw(&format!("panels{tag}"), width, &panels)?)?;
    }
    for (name, plot) in plots(&empty, Some(3.0)) {
        save(
            folder,
            &draw(&format!("{name}-empty"), Width::Column, &[plot])?,
        )?;
    }
    for (name, plot) in odd_plots(&motion) {
        save(folder, &draw(name, Width::Column, &[plot])?)?;
    }
    Ok(())
}

fn plots(motion: &Motion, horizon: Option<f64>) -> Vec<(&'static str, Plot)> {
    let boundaries = [boundary(0), boundary(1)];
    let [snaps_1, snaps_2] = &motion.snaps;
    let [taut_1, taut_2] = &motion.tensions;
    let path = trajectory(
        &motion.legs,
        [&boundaries[0], &boundaries[1]],
        &motion.marks,
    );
    let named = [
        (
            "trajectory",
            Plot {
                title: "case A1-017".to_string(),
                ..path
            },
        ),
        ("rotation", rotation(&motion.theta, horizon)),
        ("snaps", snap_velocities([snaps_1, snaps_2], horizon)),
        ("tensions", tensions([taut_1, taut_2], horizon)),
        ("energy", energy(&motion.energy, horizon)),
    ];
    let labelled = |(name, plot): (&'static str, Plot)| {
        let axis = |axis: Axis| Axis {
            label: format!("{} (nondimensional)", axis.label),
            ..axis
        };
        (
            name,
            Plot {
                x: axis(plot.x.clone()),
                y: axis(plot.y.clone()),
                ..plot
            },
        )
    };
    named.into_iter().map(labelled).collect()
}

/// Plots that are harder to draw: tiny and huge numbers, many turns, noise.
fn odd_plots(motion: &Motion) -> Vec<(&'static str, Plot)> {
    let scaled = |points: &[Point], x: f64, y: f64| -> Vec<Point> {
        points.iter().map(|p| [p[0] * x, p[1] * y]).collect()
    };
    let turns: Vec<Point> = (0..2000)
        .map(|i| f64::from(i) / 100.0)
        .map(|t| [t, t * t / 12.0])
        .collect();
    let noise: Vec<Point> = (0..100_000_u32)
        .map(|i| {
            [
                f64::from(i) * 1e-4,
                f64::from(i.wrapping_mul(2_654_435_761) >> 8) / 1e7,
            ]
        })
        .collect();
    vec![
        ("tiny", energy(&scaled(&motion.energy, 1.0, 1e-12), None)),
        ("huge", energy(&scaled(&motion.energy, 1e6, 1e6), None)),
        ("turns", rotation(&turns, Some(18.0))),
        ("noise", energy(&noise, None)),
        ("constant", energy(&[[0.0, 1e6], [8.0, 1e6]], None)),
    ]
}

fn save(folder: &Path, picture: &Picture) -> Result<(), Box<dyn Error>> {
    let file = |ending: &str| folder.join(format!("{}.{ending}", picture.name));
    std::fs::write(file("svg"), picture.svg())?;
    std::fs::write(file("png"), picture.png(300.0 / 72.0)?)?;
    println!("{}: {} bytes of SVG", picture.name, picture.svg().len());
    Ok(())
}

fn boundary(cable: usize) -> Vec<Point> {
    let [x, y] = ANCHORS[cable];
    let angle = |i: u32| f64::from(i) * std::f64::consts::TAU / 400.0;
    (0..=400)
        .map(angle)
        .map(|a| [x + LENGTH * a.cos(), y + LENGTH * a.sin()])
        .collect()
}

/// How far a point is outside a circle, and the outward normal.
fn gap(cable: usize, p: Point) -> (f64, Point) {
    let r = [p[0] - ANCHORS[cable][0], p[1] - ANCHORS[cable][1]];
    let distance = f64::hypot(r[0], r[1]);
    (distance - LENGTH, [r[0] / distance, r[1] / distance])
}

fn energy_of(p: Point, v: Point) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) - LIFT * p[1]
}

/// Flies and rebounds until the rebounds are small, then glides.
fn motion() -> Motion {
    let mut motion = Motion::default();
    let (mut t, mut p, mut v, mut spin) = (0.0, [-0.1, -0.1], [0.25, 0.1], 0.9_f64);
    let mut theta = 0.1_f64;
    motion.marks.push(mark(p, "I"));
    let mut path = vec![p];
    let mut last = [0, 0];
    for step in 0_u32.. {
        v[1] += LIFT * STEP;
        p = [p[0] + v[0] * STEP, p[1] + v[1] * STEP];
        t += STEP;
        spin -= (2.2 * theta + 0.1 * spin) * STEP;
        theta += spin * STEP;
        if step % 500 == 0 {
            path.push(p);
            motion.theta.push([t, theta]);
            motion.energy.push([t, energy_of(p, v)]);
        }
        let hit = (0..2)
            .map(|cable| (cable, gap(cable, p)))
            .find(|&(_, (g, n))| g > 0.0 && v[0] * n[0] + v[1] * n[1] > 0.0);
        let Some((cable, (_, n))) = hit else { continue };
        let normal = v[0] * n[0] + v[1] * n[1];
        path.push(p);
        motion.snaps[cable].push([t, normal]);
        motion.energy.push([t, energy_of(p, v)]);
        v = [0, 1].map(|i| v[i] - (1.0 + RESTITUTION) * normal * n[i]);
        motion.energy.push([t, energy_of(p, v)]);
        spin += if cable == 0 {
            0.6 * normal
        } else {
            -0.5 * normal
        };
        last = [cable, last[0]];
        if normal < 0.02 || t > 40.0 {
            break;
        }
    }
    motion.legs.push(Leg {
        mode: Mode::Slack,
        points: path,
    });
    motion.marks.push(mark(p, "S"));
    let t = rebound(&mut motion, last[0], t, p, theta);
    glide(&mut motion, last[0], t, p, theta);
    motion
}

/// The last rebounds, by their geometric series.
fn rebound(motion: &mut Motion, cable: usize, mut t: f64, p: Point, theta: f64) -> f64 {
    let mut normal = 0.02;
    while normal > 1e-12 {
        normal *= RESTITUTION;
        t += 2.0 * normal / 0.4;
        motion.snaps[cable].push([t, normal]);
        motion.theta.push([t, theta]);
        motion.energy.push([t, energy_of(p, [normal, 0.0])]);
    }
    t
}

/// Along the circle of one cable to that of the other, then a little rocking.
fn glide(motion: &mut Motion, cable: usize, start: f64, p: Point, theta: f64) {
    let [x, y] = ANCHORS[cable];
    let from = f64::atan2(p[1] - y, p[0] - x);
    let mut points = Vec::new();
    let mut pull = Vec::new();
    let mut t = start;
    let mut end = p;
    let turn = if gap(
        1 - cable,
        [
            x + LENGTH * (from + 0.01).cos(),
            y + LENGTH * (from + 0.01).sin(),
        ],
    )
    .0 > gap(1 - cable, p).0
    {
        1.0
    } else {
        -1.0
    };
    for i in 0..4000 {
        let s = f64::from(i) / 4000.0;
        let angle = from + turn * s * s * 1.2;
        let at = [x + LENGTH * angle.cos(), y + LENGTH * angle.sin()];
        if gap(1 - cable, at).0 > 0.0 {
            break;
        }
        (end, t) = (at, start + 1.6 * s);
        points.push(end);
        pull.push([t, 0.3 + 0.2 * s]);
        motion.theta.push([t, theta * (1.0 - s)]);
        motion.energy.push([t, energy_of(end, [0.0, 0.0]) + 0.02]);
    }
    motion.legs.push(Leg {
        mode: Mode::Sliding,
        points,
    });
    motion.marks.extend([mark(end, "G"), mark(end, "R")]);
    motion.tensions[cable].push(pull);
    let rock = |i: u32| f64::from(i) / 200.0;
    let sway = |s: f64| 0.08 * s;
    motion.legs.push(Leg {
        mode: Mode::Rocking,
        points: (0..=200)
            .map(rock)
            .map(|s| [end[0] - sway(s), end[1] - 2.0 * sway(s)])
            .collect(),
    });
    for (i, base) in [(cable, 0.42), (1 - cable, 0.2)] {
        let pull = |s: f64| [t + s, base + 0.08 * (4.0 * s).sin()];
        motion.tensions[i].push((0..=200).map(rock).map(pull).collect());
    }
    motion
        .marks
        .push(mark([end[0] - sway(1.0), end[1] - 2.0 * sway(1.0)], "E"));
}

fn mark(at: Point, letter: &str) -> Mark {
    Mark {
        at,
        letter: letter.to_string(),
    }
}
