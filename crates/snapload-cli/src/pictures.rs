//! The pictures of a run, as the files they become.
use crate::failure::Failure;
use snapload_figures::{FigureError, Plot, RunPlots, Width, draw};
use snapload_report::Trusted;

/// A picture, ready to be written.
pub(crate) struct Picture {
    /// File name with its ending, such as `trajectory.svg`.
    pub(crate) name: String,
    /// Contents.
    pub(crate) bytes: Vec<u8>,
}

/// Pixels per point of the PNGs: 300 dpi, what journals ask of a line drawing in a raster format.
const PNG_SCALE: f32 = 300.0 / 72.0;

/// Draws the pictures of a run; `title` is the code or the file name of the case.
pub(crate) fn pictures(title: &str, trusted: &Trusted) -> Result<Vec<Picture>, Failure> {
    let mut files = Vec::new();
    for (name, plot) in RunPlots::new(&trusted.run)
        .with_horizon(trusted.horizon())
        .all()
    {
        let plot = Plot {
            title: title.to_owned(),
            ..plot
        };
        let picture = draw(name, Width::Page, &[plot]).map_err(|error| broken(name, &error))?;
        let png = picture
            .png(PNG_SCALE)
            .map_err(|error| broken(name, &error))?;
        files.push(Picture {
            name: format!("{name}.svg"),
            bytes: picture.svg().as_bytes().to_vec(),
        });
        files.push(Picture {
            name: format!("{name}.png"),
            bytes: png,
        });
    }
    Ok(files)
}

fn broken(name: &str, error: &FigureError) -> Failure {
    Failure::Failed(format!("the picture {name} can not be drawn: {error}"))
}
