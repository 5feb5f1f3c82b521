//! The answers in the form of their JSON.

use crate::attraction::{Attraction, CellOutcome};
use crate::basin::Basin;
use crate::diagram::DiagramPoint;
use crate::erosion::Erosion;
use crate::hybrid::Point;
use crate::impact_map::ImpactPoint;
use crate::orbit_row::OrbitRow;
use crate::section::Section;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// Section points of one motion.
#[derive(Serialize)]
pub struct SectionRow {
    phase: f64,
    period: Option<usize>,
    snaps: Option<f64>,
    exponents: Vec<ExponentRow>,
    y_max: f64,
    theta_max: f64,
    stop: Option<StopRow>,
    points: Vec<PointRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    impacts: Option<Vec<ImpactPoint>>,
}

#[derive(Serialize)]
struct ExponentRow {
    /// None stands for −∞.
    value: Option<f64>,
    /// Written as null if there are too few periods to estimate it, or the exponent has no limit.
    se: f64,
}

#[derive(Serialize)]
struct StopRow {
    reason: &'static str,
    t: f64,
    /// False if rounding may decide the time, as deviations had grown too much.
    certain: Option<bool>,
}

impl StopRow {
    fn of(section: &Section, certain: Option<bool>) -> Option<Self> {
        section.stop.map(|stop| Self {
            reason: stop.name(),
            t: section.end.1,
            certain,
        })
    }
}

#[derive(Serialize)]
struct PointRow {
    k: u64,
    state: Point,
}

fn exponents(section: &Section) -> Vec<ExponentRow> {
    let row = |[value, se]: &[f64; 2]| ExponentRow {
        value: value.is_finite().then_some(*value),
        se: *se,
    };
    section.exponents.iter().map(row).collect()
}

impl SectionRow {
    /// Of a section.
    pub fn new(section: &Section, phase: f64) -> Self {
        let period = section.stop.is_none().then(|| section.period()).flatten();
        let points = section.points.iter().zip(section.first..);
        Self {
            phase,
            period,
            snaps: section.snaps_per_period(period),
            exponents: exponents(section),
            y_max: section.y_max,
            theta_max: section.theta_max,
            stop: StopRow::of(section, section.stop_is_certain()),
            points: points
                .map(|(state, k)| PointRow { k, state: *state })
                .collect(),
            impacts: section.impacts.as_ref().map(|kept| kept.points.clone()),
        }
    }
}

/// One value of a diagram.
#[derive(Serialize)]
pub struct DiagramRow {
    value: f64,
    period: Option<usize>,
    snaps: Option<f64>,
    exponent: Option<f64>,
    exponent_se: Option<f64>,
    stop: Option<StopRow>,
    seed: Point,
    restarted: bool,
    x_min: Option<f64>,
    x_max: Option<f64>,
    y_max: f64,
}

impl DiagramRow {
    /// Of what there is at one value.
    pub fn new(at: &DiagramPoint) -> Self {
        let xs = || at.section.points.iter().map(|point| point[0]);
        let exponent = at.section.exponents.first().filter(|_| at.stop().is_none());
        Self {
            value: at.value,
            period: at.period,
            snaps: at.snaps(),
            exponent: exponent
                .map(|[mean, _]| *mean)
                .filter(|mean| mean.is_finite()),
            exponent_se: exponent.map(|[_, error]| *error),
            stop: StopRow::of(&at.section, at.stop_is_certain()),
            seed: at.seed,
            restarted: at.restarted,
            x_min: xs().min_by(f64::total_cmp),
            x_max: xs().max_by(f64::total_cmp),
            y_max: at.section.y_max,
        }
    }
}

/// A safe basin.
#[derive(Serialize)]
pub struct BasinRow {
    keys: [&'static str; 2],
    legal: usize,
    safe: usize,
    fraction: f64,
    interval95: [f64; 2],
    undecided: Option<usize>,
    cut_short: usize,
    past_horizon: Option<usize>,
    by_outcome: ByOutcome,
    gim: f64,
    lim: Option<f64>,
    r#if: Option<f64>,
    iim: Option<f64>,
    lim_at_least: Option<f64>,
    if_at_least: Option<f64>,
    iim_at_least: Option<f64>,
    cell: Widths,
}

struct ByOutcome(Vec<(&'static str, usize)>);

impl Serialize for ByOutcome {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

struct Widths([(&'static str, f64); 2]);

impl Serialize for Widths {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(2))?;
        for (key, width) in self.0 {
            map.serialize_entry(key, &width)?;
        }
        map.end()
    }
}

impl BasinRow {
    /// Of a basin.
    pub fn new(basin: &Basin) -> Self {
        let measures = &basin.measures;
        let [first, second] = basin.window.keys;
        let [height, width] = basin.window.cell();
        let ended = basin.by_outcome();
        Self {
            keys: basin.window.keys,
            legal: measures.legal,
            safe: measures.safe,
            fraction: measures.gim,
            interval95: measures.interval,
            undecided: basin.neighbours_run.then_some(measures.undecided),
            cut_short: measures.cut_short,
            past_horizon: basin.neighbours_run.then_some(measures.past_horizon),
            by_outcome: ByOutcome(ended.iter().map(|(stop, n)| (stop.name(), *n)).collect()),
            gim: measures.gim,
            lim: measures.lim,
            r#if: measures.integrity_factor,
            iim: basin.iim(),
            lim_at_least: measures.at_least.lim,
            if_at_least: measures.at_least.integrity_factor,
            iim_at_least: basin.iim_at_least(),
            cell: Widths([(first, height), (second, width)]),
        }
    }
}

/// Erosion.
#[derive(Serialize)]
pub struct ErosionRow {
    over: &'static str,
    knee: Option<f64>,
    /// The range of the knee for all possible ends of the undecided cells; none if neighbours were
    /// not computed and no run is cut short.
    knee_between: Option<[Option<f64>; 2]>,
    points: Vec<ErosionPoint>,
}

#[derive(Serialize)]
struct ErosionPoint {
    value: f64,
    /// The safe part of the decided cells, from which the knee is found; none without such cells.
    decided_fraction: Option<f64>,
    #[serde(flatten)]
    basin: BasinRow,
}

impl ErosionRow {
    /// Of an erosion.
    pub fn new(erosion: &Erosion) -> Self {
        let point = |(value, basin): &(f64, Basin)| ErosionPoint {
            value: *value,
            decided_fraction: basin.measures.decided_part(),
            basin: BasinRow::new(basin),
        };
        Self {
            over: erosion.key,
            knee: erosion.knee(),
            knee_between: erosion.knee_between(),
            points: erosion.points.iter().map(point).collect(),
        }
    }
}

/// Basins of attraction.
#[derive(Serialize)]
pub struct AttractionRow {
    keys: [&'static str; 2],
    legal: usize,
    undecided: Option<usize>,
    by_outcome: ByOutcome,
    cell: Widths,
    attractors: Vec<AttractorRow>,
}

#[derive(Serialize)]
struct AttractorRow {
    attractor: usize,
    cells: usize,
    fraction: f64,
    period: usize,
    state: Point,
    orbit: Option<OrbitRow>,
}

impl AttractionRow {
    /// Of basins of attraction; attractors count from 1.
    pub fn new(found: &Attraction) -> Self {
        let [first, second] = found.window.keys;
        let [height, width] = found.window.cell();
        let legal = found.count(|outcome| *outcome != CellOutcome::Illegal);
        let mut by_outcome: Vec<(&'static str, usize)> = snapload::Stop::ALL
            .iter()
            .map(|stop| {
                let is = |outcome: &CellOutcome| matches!(outcome, CellOutcome::Stopped(s, _) if s == stop);
                (stop.name(), found.count(is))
            })
            .filter(|(_, cells)| *cells > 0)
            .collect();
        by_outcome.push((
            "attracted",
            found.count(|outcome| matches!(outcome, CellOutcome::Attracted(_))),
        ));
        by_outcome.push((
            "aperiodic",
            found.count(|outcome| *outcome == CellOutcome::Aperiodic),
        ));
        let attractors = found.attractors.iter().zip(1..);
        let attractors = attractors.map(|(attractor, number)| AttractorRow {
            attractor: number,
            cells: attractor.cells,
            fraction: attractor.cells as f64 / legal as f64,
            period: attractor.period,
            state: attractor.z,
            orbit: attractor.orbit.as_ref().map(OrbitRow::new),
        });
        Self {
            keys: found.window.keys,
            legal,
            undecided: found.undecided(),
            by_outcome: ByOutcome(by_outcome),
            cell: Widths([(first, height), (second, width)]),
            attractors: attractors.collect(),
        }
    }
}
