//! All tests of structures from outside, as one program: it is linked once, and the tests of all
//! files run side by side.
#![allow(clippy::unwrap_used, clippy::panic)]

mod added_mass;
mod adrift;
mod afloat;
mod afloat_lines;
mod conversion;
mod current;
mod cut_short;
mod design;
mod elastic;
mod elastic_comparison;
mod elastic_peaks;
mod elastic_strands;
mod emergence;
mod equilibrium;
mod firm_verdicts;
mod hydrostatics;
mod judged;
mod judged_step;
mod manual;
mod moordyn;
mod moordyn_columns;
mod moordyn_edits;
mod moordyn_keys;
mod other_waves;
mod physics;
mod progress;
mod rates;
mod scale;
mod sea_verdicts;
mod short_run;
mod softness;
mod still_water;
mod verdicts;
mod waves;
