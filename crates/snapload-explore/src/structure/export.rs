//! `/api/structure/export/NAME`: the case, its results and the page for a design note.
use super::Latest;
use super::opened::{CaseRequest, Opened};
use super::run::{RunRequest, assessed, too_long};
use crate::refusal::Refusal;
use crate::work::Allowance;
use serde::Deserialize;
use snapload::analysis::Unfinished;
use snapload_structure::note::{self, Source};
use std::time::Duration;

/// The time budget of a file: a run, its neighbours and other waves.
const BUDGET: Duration = Duration::from_secs(120);

/// A file that can be requested.
#[derive(Clone, Copy)]
pub(crate) enum File {
    Case,
    Assessment,
    Note,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Request {
    case: CaseRequest,
    /// Whether to report the progress, line by line.
    #[serde(default)]
    pub(crate) progress: bool,
}

impl File {
    /// The file of a name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        match name {
            "case.toml" => Some(Self::Case),
            "assess.json" => Some(Self::Assessment),
            "note.html" => Some(Self::Note),
            _ => None,
        }
    }

    /// Its media type.
    pub(crate) fn content_type(self) -> &'static str {
        match self {
            Self::Case => "application/toml",
            Self::Assessment => "application/json",
            Self::Note => "text/html; charset=utf-8",
        }
    }

    /// Its contents.
    pub(crate) fn write(
        self,
        request: &Request,
        start: Option<&Opened>,
        latest: &Latest,
        allowance: &Allowance,
    ) -> Result<Vec<u8>, Refusal> {
        let case = request.case.read(start)?;
        if matches!(self, Self::Case) {
            return Ok(case.opened.to_file().into_bytes());
        }
        let allowance = allowance.within(BUDGET);
        // What was already computed for the page is not run again.
        let wanted_run = RunRequest {
            preview: false,
            neighbours: true,
            time: BUDGET,
        };
        let assessment = assessed(&request.case, &case, wanted_run, latest, &allowance)?;
        let name = &case.opened.name;
        if matches!(self, Self::Assessment) {
            let answer = assessment.to_json(name);
            return serde_json::to_vec_pretty(&answer).map_err(Refusal::failed);
        }
        let scan = note::scan(&case.structure, &|progress| allowance.check(progress));
        let scan = scan.map_err(|cancelled| {
            too_long(&case, "assess", BUDGET, Unfinished::Cancelled(cancelled))
        })?;
        let command = case.command("assess");
        let source = Source {
            name,
            command: &command,
            sha256: None,
        };
        let page = note::page(source, &assessment, scan.as_ref());
        page.map(String::into_bytes).map_err(Refusal::failed)
    }
}
