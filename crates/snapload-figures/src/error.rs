//! The errors in making a picture.

use std::fmt;

/// Why no picture could be made.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum FigureError {
    /// There was no panel to draw.
    NoPanel,
    /// A panel with equal scale on both axes cannot share its x axis with other panels.
    EqualScaleInStack,
    /// The scale of a PNG is not positive, or gives more than a hundred million pixels.
    Scale,
    /// The SVG could not be turned into pixels; the text is the reason that the rasteriser gave.
    Raster(String),
}

impl fmt::Display for FigureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPanel => write!(f, "a picture needs at least one panel"),
            Self::EqualScaleInStack => {
                write!(
                    f,
                    "a panel with equal scale on both axes must be the only panel"
                )
            }
            Self::Scale => {
                write!(
                    f,
                    "the scale of a PNG must be positive and give at most 100 million pixels"
                )
            }
            Self::Raster(reason) => write!(f, "the picture could not be rasterised: {reason}"),
        }
    }
}

impl std::error::Error for FigureError {}
