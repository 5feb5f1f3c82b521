//! The pictures of a run, as files.
use crate::failure::Failure;
use snapload_figures::{FigureError, PNG_SCALE, RunPlot, RunPlots};
use snapload_report::RunWithTrust;

/// A picture, ready to be written.
pub(crate) struct Picture {
    /// File name with its ending, such as `trajectory.svg`.
    pub(crate) name: String,
    /// Contents.
    pub(crate) bytes: Vec<u8>,
}

/// Draws the pictures of a run; `title` is the code or the file name of the case.
pub(crate) fn pictures(title: &str, trusted: &RunWithTrust) -> Result<Vec<Picture>, Failure> {
    let mut files = Vec::new();
    let plots = RunPlots::new(&trusted.run).with_horizon(trusted.horizon());
    for plot in RunPlot::ALL {
        let name = plot.name();
        let broken = |error: FigureError| broken(name, &error);
        let picture = plots.picture(plot, title).map_err(broken)?;
        let png = picture.png(PNG_SCALE).map_err(broken)?;
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
