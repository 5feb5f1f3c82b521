//! The files of a command's answer, and its JSON.
use crate::failure::{Failure, print};
use crate::json::{Json, JsonArgs, folder_for, refuse_directory};
use crate::pending_outputs::{PendingOutputs, TargetFolder, is_same};
use serde::Serialize;
use snapload::Parameters;
use snapload_report::CaseEcho;
use snapload_study::{Values, write_csv, write_table};
use std::io;
use std::path::{Path, PathBuf};

/// The endings of a table's name.
pub(crate) const TABLE: [&str; 2] = ["parquet", "csv"];

/// The places of a command's answer. They are opened before anything is computed, so that an error
/// is known at once, and filled when all of it is.
pub(crate) struct Outputs {
    pending: PendingOutputs,
    json: Json,
    /// The files by the options that name them.
    named: Vec<(&'static str, PathBuf)>,
}

/// A file that an option names.
pub(crate) struct OutFile {
    folder: TargetFolder,
    path: PathBuf,
    /// The ending of its name, which is one of those allowed.
    pub(crate) ending: &'static str,
}

impl Outputs {
    /// With the place of the JSON.
    pub(crate) fn open(json: &JsonArgs) -> Result<Self, Failure> {
        let mut pending = PendingOutputs::default();
        let json = json.open(&mut pending)?;
        let named = match &json {
            Json::File(_, path) => vec![("--json", path.clone())],
            Json::None | Json::Stdout => Vec::new(),
        };
        Ok(Self {
            pending,
            json,
            named,
        })
    }

    /// Opens the place of a file, if an option names one. Its folder is created if necessary.
    pub(crate) fn file(
        &mut self,
        option: &'static str,
        path: Option<&Path>,
        endings: &[&'static str],
    ) -> Result<Option<OutFile>, Failure> {
        let Some(path) = path else {
            return Ok(None);
        };
        let shown = path.display();
        let given = path.extension().and_then(|ending| ending.to_str());
        let Some(ending) = endings.iter().find(|ending| given == Some(**ending)) else {
            let endings = endings.join(" or .");
            let message = format!("{option} {shown}: write a name that ends in .{endings}");
            return Err(Failure::BadInput(message));
        };
        refuse_directory(path)?;
        if let Some((other, _)) = self.named.iter().find(|(_, file)| is_same(file, path)) {
            let message = format!("{option} and {other}: both name {shown}; allowed are two files");
            return Err(Failure::BadInput(message));
        }
        let folder = self.pending.create_and_open(&folder_for(path))?;
        self.named.push((option, path.to_owned()));
        Ok(Some(OutFile {
            folder,
            path: path.to_owned(),
            ending,
        }))
    }

    /// Adds the contents of a file.
    pub(crate) fn write(
        &mut self,
        file: OutFile,
        fill: impl FnOnce(&mut dyn io::Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.pending.write(file.folder, file.path, fill)
    }

    /// Adds a table of results of a case, if one is wanted.
    pub(crate) fn table(
        &mut self,
        file: Option<OutFile>,
        case: &Parameters,
        columns: &[(&'static str, Values)],
    ) -> Result<(), Failure> {
        let Some(file) = file else {
            return Ok(());
        };
        let plain = file.ending == "csv";
        self.write(file, |out| match plain {
            true => write_csv(columns, out),
            false => {
                let case = serde_json::to_string(&CaseEcho(case))?;
                write_table(columns, case, out)
            }
        })
    }

    /// Moves all files to their places, and prints the answer in words with their paths, unless its
    /// JSON goes to standard output.
    pub(crate) fn finish(self, json: &impl Serialize, words: String) -> Result<(), Failure> {
        self.finish_with(json, words, |path| format!("Written   {path}\n"))
    }

    /// The same with each path under a label of its own, as answers about structures have them.
    #[cfg(feature = "structure")]
    pub(crate) fn finish_with_text(
        self,
        json: &impl Serialize,
        words: String,
    ) -> Result<(), Failure> {
        self.finish_with(json, words, |path| {
            snapload_structure::labelled_row("written", path)
        })
    }

    fn finish_with(
        self,
        json: &impl Serialize,
        mut words: String,
        line: impl Fn(&str) -> String,
    ) -> Result<(), Failure> {
        let Some(written) = self.json.write(self.pending, json)? else {
            return Ok(());
        };
        for path in written {
            words += &line(&path.display().to_string());
        }
        print(&words)
    }
}
