//! `--plot` and `--show`: which picture of a study, and where it goes.
use crate::failure::Failure;
use crate::pending_outputs::PendingOutputs;
use crate::study_input::axes_of;
use snapload_figures::PNG_SCALE;
use snapload_study::{StudyError, StudyPicture, folder_of, identity_of};
use std::fs;
use std::path::{Path, PathBuf};

/// Which picture.
#[derive(clap::Args)]
pub(crate) struct PictureArgs {
    /// Draw a picture: a line plot if one key varies, a map if two keys vary
    #[arg(long, value_name = "FILE.svg|png")]
    plot: Option<PathBuf>,
    /// Column to draw; by default rho1 in a line plot and the end in a map
    #[arg(long, value_name = "COLUMN", requires = "plot")]
    show: Option<String>,
}

impl PictureArgs {
    /// Refuses what can not be drawn, before anything is computed. Whoever resumes may have drawn
    /// the picture already, so then it may be there.
    pub(crate) fn check(&self, study: &str, resume: bool) -> Result<(), Failure> {
        match self.requested(study)? {
            Some((path, _)) if !resume && is_there(path) => Err(occupied(path)),
            _ => Ok(()),
        }
    }

    fn requested(&self, study: &str) -> Result<Option<(&Path, StudyPicture)>, Failure> {
        let Some(path) = &self.plot else {
            return Ok(None);
        };
        let wrong = |error: StudyError| Failure::BadInput(format!("--plot: {error}"));
        if !["svg", "png"].map(Some).contains(&ending(path)) {
            let words = format!("{} ends neither in .svg nor in .png", path.display());
            return Err(wrong(StudyError::Input(words)));
        }
        folder_of(path).map_err(wrong)?;
        let picture = StudyPicture::over(axes_of(study).unwrap_or_default()).map_err(wrong)?;
        let picture = match &self.show {
            Some(name) => (picture.showing(name))
                .map_err(|error| Failure::from(error).with_prefix("--show"))?,
            None => picture,
        };
        Ok(Some((path, picture)))
    }

    /// Draws the picture of a complete file, if one is wanted, and returns its path.
    pub(crate) fn draw(&self, file: &Path) -> Result<Option<PathBuf>, Failure> {
        let Some(identity) = identity_of(file) else {
            return Ok(None);
        };
        let Some((path, picture)) = self.requested(&identity.study)? else {
            return Ok(None);
        };
        let picture = picture.draw(file)?;
        let bytes = match ending(path) {
            Some("png") => picture.png(PNG_SCALE).map_err(|error| {
                Failure::Failed(format!("the picture can not be drawn: {error}"))
            })?,
            _ => picture.svg().as_bytes().to_vec(),
        };
        if is_there(path) {
            return match fs::read(path) {
                Ok(there) if there == bytes => Ok(Some(path.to_owned())),
                _ => Err(occupied(path)),
            };
        }
        let mut pending = PendingOutputs::default();
        let folder = pending.open(folder_of(path)?)?;
        pending.write(folder, path.to_owned(), |out| out.write_all(&bytes))?;
        pending.commit()?;
        Ok(Some(path.to_owned()))
    }
}

fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// An existing picture is not overwritten, as rows are not.
fn occupied(path: &Path) -> Failure {
    Failure::BadInput(format!(
        "--plot: {} exists already; choose another name, or remove it",
        path.display()
    ))
}

fn ending(path: &Path) -> Option<&str> {
    path.extension()?.to_str()
}
