//! Pictures of motions on cables, as SVG and PNG, in print quality.
//!
//! This crate draws axes, lines and letters, and computes no physics: its input is points, or a
//! finished run ([`RunPlots`]) from which it takes them. Five functions ([`trajectory`],
//! [`rotation`], [`snap_velocities`], [`tensions`], [`energy`]) turn them into a [`Plot`];
//! [`draw()`] puts one plot, or several below each other, on a [`Picture`], which is written as SVG
//! and, rendered from that SVG, as PNG. A [`Map`] shows a number or a class over two axes.
//!
//! ```
//! use snapload_figures::{Plot, Width, draw, rotation};
//!
//! let theta = [[0.0, 0.0], [1.0, 0.8], [2.0, -0.3]];
//! let plot = Plot { title: "case A1".to_string(), ..rotation(&theta, None) };
//! let picture = draw("theta", Width::Column, &[plot])?;
//! assert!(picture.svg().contains("π/2"));
//! let png = picture.png(300.0 / 72.0)?;
//! # assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), snapload_figures::FigureError>(())
//! ```
//!
//! # Guarantees
//!
//! Letters measure 7 to 8 points on paper, unless a text is too long for its place; lines 0.5 to
//! 1.3 points; colours are those of Okabe and Ito, and nothing is distinguished by colour alone.
//! The same points give the same bytes. Points that are not finite are skipped. Lines are thinned
//! by less than 0.2 points on paper, so that the file of a smooth line, or of any line over time,
//! of a hundred thousand points stays small; a line that covers the whole plane is kept as it is.
//!
//! # Why the SVG is written here
//!
//! The `plotters` crate was considered first. Its back ends take whole pixels (`BackendCoord` is a
//! pair of `i32`), so a smooth path is drawn in steps unless the whole page is scaled, and its SVG
//! back end does not support dashes, the halo that keeps a letter readable on a line, or italics
//! within a label. These plots need only paths and text of SVG, which is one small file here;
//! `resvg` does the difficult part, the pixels.

mod area;
mod axis;
mod draw;
mod error;
mod figures;
mod layers;
mod legend;
mod map;
mod picture;
mod place;
mod plot;
mod polyline;
mod run;
mod svg;
mod text;

pub use draw::draw;
pub use error::FigureError;
pub use figures::{Mode, PathPart, energy, rotation, snap_velocities, tensions, trajectory};
pub use map::{MOST_CLASSES, NOT_CERTAIN};
pub use picture::{PNG_SCALE, Picture};
pub use plot::{
    Axis, Cell, Colour, Dash, Inset, Layer, Map, Mark, Plot, Point, Range, Shape, Stroke,
    TickStyle, Width,
};
pub use run::{RunPlot, RunPlots};
