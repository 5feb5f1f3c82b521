//! A run followed event by event, with an account of its energy: what the snaps take away and what
//! the wave brings.

use snapload::{Case, CaseError, Parameters};

fn main() -> Result<(), CaseError> {
    let case = Case::new(Parameters {
        f_o: 0.31,
        ..Parameters::STANDARD
    })?;
    let mut simulation = case.simulation();
    let energy = |simulation: &snapload::Simulation| simulation.system().energy(simulation.state());
    let begun = energy(&simulation);
    let (mut lost, mut brought) = (0.0, 0.0);
    while let Some(step) = simulation.step() {
        let system = simulation.system();
        brought += system.energy(&step.before) - system.energy(&step.start);
        for impact in step.impacts() {
            lost += impact.energy_lost;
            println!(
                "t = {:8.5}  cable {}  v_n = {:.5}  energy lost {:.5}",
                impact.t,
                impact.cable + 1,
                impact.v_n,
                impact.energy_lost
            );
        }
        if step.taut != step.taut_after {
            println!(
                "t = {:8.5}  now {}",
                step.t_end,
                step.taut_after.mode().name()
            );
        }
        if let Some(stop) = step.stop {
            println!("t = {:8.5}  the end: {}", step.t_end, stop.reason_text());
        }
    }
    println!("the wave brought {brought:.5}, the snaps took {lost:.5}");
    assert!((energy(&simulation) - begun - brought + lost).abs() < 1e-12);
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
