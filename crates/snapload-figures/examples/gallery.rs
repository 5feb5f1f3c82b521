//! Draws every kind of picture into a folder: `cargo run --example gallery -- FOLDER`.

use snapload::{Case, named_case};
use snapload_figures::{
    Axis, Cell, Layer, Map, Plot, Point, Range, RunPlot, RunPlots, Stroke, Width, draw, energy,
    rotation, snap_velocities, tensions, trajectory,
};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: gallery FOLDER")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let case = named_case("sliding-example")?;
    let run = Case::new(case.parameters)?.run();
    let plots = RunPlots::new(&run);
    let untrusted = plots.clone().with_horizon(Some(0.6 * run.end().t));
    for (tag, width, plots) in [
        ("", Width::Column, plots),
        ("-wide", Width::Page, untrusted),
    ] {
        let titled = |which: RunPlot| {
            let title = case.code.to_string();
            Plot {
                title,
                ..plots.plot(which)
            }
        };
        let drawn = RunPlot::ALL.map(titled);
        for (which, plot) in RunPlot::ALL.iter().zip(&drawn) {
            let name = format!("{}{tag}", which.name());
            save(folder, &name, width, std::slice::from_ref(plot))?;
        }
        // All but the first share the axis of time.
        save(folder, &format!("panels{tag}"), width, &drawn[1..])?;
    }
    for (name, plot) in empty_plots().into_iter().chain(odd_plots()) {
        save(folder, name, Width::Column, &[plot])?;
    }
    Ok(())
}

fn save(folder: &Path, name: &str, width: Width, panels: &[Plot]) -> Result<(), Box<dyn Error>> {
    let picture = draw(name, width, panels)?;
    std::fs::write(folder.join(format!("{name}.svg")), picture.svg())?;
    std::fs::write(
        folder.join(format!("{name}.png")),
        picture.png(300.0 / 72.0)?,
    )?;
    println!("{name}: {} bytes of SVG", picture.svg().len());
    Ok(())
}

fn empty_plots() -> Vec<(&'static str, Plot)> {
    let horizon = Some(3.0);
    vec![
        ("trajectory-empty", trajectory(&[], [&[], &[]], &[])),
        ("rotation-empty", rotation(&[], horizon)),
        ("snaps-empty", snap_velocities([&[], &[]], horizon)),
        ("tensions-empty", tensions([&[], &[]], horizon)),
        ("energy-empty", energy(&[], horizon)),
    ]
}

/// Plots that are harder to draw: tiny and huge numbers, many turns, noise; and maps.
fn odd_plots() -> Vec<(&'static str, Plot)> {
    let line = |n: u32, of: &dyn Fn(u32) -> Point| (0..n).map(of).collect::<Vec<Point>>();
    let wave = |x: f64, y: f64| {
        line(400, &move |i| {
            [x * f64::from(i), y * (1.0 + (f64::from(i) / 30.0).sin())]
        })
    };
    let turns = line(2_000, &|i| {
        [f64::from(i) / 100.0, f64::from(i).powi(2) / 1.2e5]
    });
    let noise = line(100_000, &|i| {
        let hash = i.wrapping_mul(2_654_435_761) >> 8;
        [f64::from(i) * 1e-4, f64::from(hash) / 1e7]
    });
    let cell = |value: f64, class: bool| match value {
        ..-0.95 => Cell::Illegal,
        -0.95..-0.8 => Cell::Empty,
        value if class => Cell::Class((3.0 * value.abs()) as usize),
        value => Cell::Value(value),
    };
    let side: Vec<f64> = (0..60).map(|i| f64::from(i) / 10.0).collect();
    let map = |class: bool| {
        let at = |x: &f64| {
            side.iter()
                .map(|y| cell((x * y).sin(), class))
                .collect::<Vec<_>>()
        };
        let map = Map {
            x: side.clone(),
            y: side.clone(),
            cells: side.iter().flat_map(at).collect(),
            value_label: "sin *xy*".to_string(),
            classes: ["first", "second", "third"].map(String::from).to_vec(),
            ..Map::default()
        };
        Plot {
            x: Axis::new("*x*", Range::Auto),
            y: Axis::new("*y*", Range::Auto),
            layers: vec![Layer::Map(map)],
            ..Plot::default()
        }
    };
    let mut curve_on_map = map(false);
    let curve = line(59, &|i| [f64::from(i + 1) / 10.0, 10.0 / f64::from(i + 1)]);
    curve_on_map.layers.push(Layer::Line(
        vec![curve],
        Stroke::default(),
        "*xy* = 1".to_string(),
    ));
    vec![
        ("tiny", energy(&wave(0.02, 1e-12), None)),
        ("huge", energy(&wave(2e4, 1e6), None)),
        ("turns", rotation(&turns, Some(18.0))),
        ("noise", energy(&noise, None)),
        ("constant", energy(&[[0.0, 1e6], [8.0, 1e6]], None)),
        ("map", curve_on_map),
        ("classes", map(true)),
    ]
}
