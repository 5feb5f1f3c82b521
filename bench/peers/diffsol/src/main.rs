//! The standard case in diffsol: `tsit45` with root functions, restarted after every impact.

mod standard;

use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use standard::{A, Cable, F_O, HEIGHT, MAX_IMPACTS, NU, OMEGA, ROTATION_LIMIT, Run, START, T_END};
use std::error::Error;
use std::time::Instant;

const ROOTS: usize = 4;
const REPEATS: usize = 50;

fn rates(u: &[f64], t: f64, du: &mut [f64]) {
    let (sin, cos) = (OMEGA * t).sin_cos();
    du.copy_from_slice(&[u[3], u[4], u[5], F_O * cos, NU * F_O * sin - 1.0, 0.0]);
}

fn roots(u: &[f64], g: &mut [f64]) {
    g[0] = Cable::RIGHT.gap(u);
    g[1] = Cable::LEFT.gap(u);
    g[2] = u[2].abs() - ROTATION_LIMIT;
    g[3] = u[1] + A - HEIGHT;
}

fn solve(inside: f64, tolerance: f64) -> Result<Run, Box<dyn Error>> {
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs(|u, _p, t, du| rates(u, t, du))
        .init(|_p, _t, u| u.copy_from_slice(&START), START.len())
        .root(|u, _p, _t, g| roots(u, g), ROOTS)
        .build()?;
    let mut solver = problem.tsit45()?;
    solver.set_stop_time(T_END)?;
    let mut run = Run::default();
    while run.impacts.len() < MAX_IMPACTS {
        let (t, root) = match solver.step()? {
            OdeSolverStopReason::RootFound(t, root) => (t, root),
            OdeSolverStopReason::TstopReached => return Ok(run.ended("end_time", T_END)),
            _ => continue,
        };
        solver.state_mut_back(t)?;
        if root >= 2 {
            return Ok(run.ended(["rotation_limit", "upper_bound"][root - 2], t));
        }
        let cable = [Cable::RIGHT, Cable::LEFT][root];
        let state = solver.state_mut();
        let u = state.y.batch_as_mut_slice(0);
        let v_n = cable.strike(u);
        // A change of sign to the slack side is the restart itself, seen again.
        if v_n > 0.0 {
            run.impacts.push((t, root + 1, v_n));
            if let Some(kind) = cable.sticks(t, u, v_n) {
                return Ok(run.ended(kind, t));
            }
            cable.place_inside(u, inside);
        }
        rates(u, t, state.dy.batch_as_mut_slice(0));
    }
    Ok(run.ended("impact_limit", T_END))
}

fn main() -> Result<(), Box<dyn Error>> {
    let numbers = std::env::args().skip(1).map(|number| number.parse());
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
    let [inside, tolerance] = numbers[..] else {
        return Err("how far inside to restart, and to which tolerance?".into());
    };
    let run = solve(inside, tolerance)?;
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let begin = Instant::now();
        std::hint::black_box(solve(inside, tolerance)?);
        best = best.min(begin.elapsed().as_secs_f64());
    }
    println!("{}", run.report("0.18.0", best));
    Ok(())
}
