//! scratch stress
use snapload::*;
struct Rng(u64);
impl Rng {
    fn u(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn r(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.u()
    }
}
fn main() {
    let n: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let mut g = Rng(0x9E3779B97F4A7C15);
    let mut ends = std::collections::BTreeMap::<String, usize>::new();
    let mut slow = vec![];
    let mut k = 0;
    let mut worst_gap: f64 = -1.0;
    let mut worst_e: f64 = -1.0;
    let mut worst_b: f64 = 0.0;
    let (mut total_imp, mut done) = (0usize, 0);
    while done < n {
        k += 1;
        let mut p = Parameters::STANDARD;
        let a = if g.u() < 0.1 {
            1.0
        } else if g.u() < 0.1 {
            g.r(1.0, 2.0)
        } else {
            g.r(0.0, 0.5)
        };
        let b = if g.u() < 0.4 { 0.0 } else { g.r(0.0, 0.5) };
        p.a = a;
        p.b = b;
        p.r = (1.0 - a).abs() + g.r(0.01, 2.0);
        p.inertia = natural_inertia(a, b);
        if g.u() < 0.1 {
            p.inertia = Some(10f64.powf(g.r(-6.0, 2.0)));
        }
        if p.inertia.unwrap_or(0.0) < 1e-12 {
            continue;
        }
        p.e = match (g.u() * 6.0) as i32 {
            0 => 0.0,
            1 => 1.0,
            2 => 0.9,
            3 => 0.5,
            4 => 0.99,
            _ => g.u(),
        };
        p.f_o = match (g.u() * 4.0) as i32 {
            0 => 0.0,
            1 => g.r(0.0, 0.3),
            _ => g.r(-1.5, 1.5),
        };
        p.nu = g.r(-1.0, 1.0);
        p.omega = match (g.u() * 5.0) as i32 {
            0 => 0.0,
            1 => g.r(-30.0, 30.0),
            _ => g.r(0.1, 3.0),
        };
        p.stop_when_settled = g.u() < 0.3;
        p.stop_when_sliding = g.u() < 0.1;
        p.v_stick = if g.u() < 0.5 {
            1e-6
        } else {
            10f64.powf(g.r(-9.0, -2.0))
        };
        p.t_end = 20.0;
        p.x = g.r(-0.3, 0.3);
        p.y = g.r(0.0, 0.6);
        p.theta = g.r(-1.0, 1.0);
        if g.u() < 0.2 {
            p.x = 0.0;
            p.theta = 0.0;
            p.y = g.r(0.0, 0.5);
        }
        let v = if g.u() < 0.3 { 0.0 } else { 1.0 };
        p.vx = v * g.r(-1.0, 1.0);
        p.vy = v * g.r(-1.0, 1.0);
        p.vtheta = v * g.r(-3.0, 3.0);
        if p.x == 0.0 && v == 1.0 && g.u() < 0.5 {
            p.vx = 0.0;
            p.vtheta = 0.0;
        }
        p.max_impacts = 200_000;
        let Ok(c) = Case::new(p) else { continue };
        done += 1;
        let t0 = std::time::Instant::now();
        {
            let mut sim = c.simulation();
            let mut n = 0u64;
            while let Some(st) = sim.step() {
                n += 1;
                if t0.elapsed().as_secs() > 4 {
                    println!(
                        "HANG n={n} t={} taut {:?} len {:e} {:?} {p:?}",
                        sim.time(),
                        st.taut,
                        st.t_end - st.t_start,
                        sim.state()
                    );
                    if t0.elapsed().as_millis() > 4010 {
                        break;
                    }
                }
            }
            if t0.elapsed().as_secs() >= 4 {
                continue;
            }
        }
        let run = c.run();
        let el = t0.elapsed().as_secs_f64();
        total_imp += run.impacts().len();
        *ends.entry(format!("{:?}", run.end().reason)).or_default() += 1;
        if el > 0.05 {
            slow.push((el, run.impacts().len(), run.modes().len(), p));
        }
        // gaps
        let sys = run.system();
        let mut e_prev = f64::NAN;
        for i in 0..=200 {
            let t = run.end().t * i as f64 / 200.0;
            let m = run.at(t);
            for c in &sys.cables {
                let gp = c.gap(&m.state);
                if !(gp <= worst_gap) {
                    worst_gap = gp;
                    if gp > 1e-12 {
                        println!("gap {gp:e} at {t} case {p:?}");
                    }
                }
            }
            if p.f_o == 0.0 {
                if m.energy - e_prev > worst_e {
                    worst_e = m.energy - e_prev;
                    if worst_e > 1e-13 {
                        println!("energy rise {worst_e:e} t={t} {p:?}");
                    }
                }
                e_prev = m.energy;
            }
        }
        let _ = &mut worst_b;
        let mut last = 0.0;
        for m in run.modes() {
            assert!(m.t_start == last && m.t_end > m.t_start);
            last = m.t_end;
        }
        assert!(last == run.end().t || run.end().t == 0.0);
    }
    println!(
        "{k} tried {done} done {total_imp} impacts {ends:?} worst gap {worst_gap:e} energy {worst_e:e}"
    );
    slow.sort_by(|a, b| b.0.total_cmp(&a.0));
    for s in slow.iter().take(6) {
        println!("{s:?}");
    }
    println!("slow {}", slow.len());
}
