//! `snapload assess`: one structure in SI units, from its case to a verdict.
use crate::bar::Bar;
use crate::failure::{Failure, print};
use crate::json::JsonArgs;
use crate::option_values::whole_number;
use crate::outputs::Outputs;
use crate::structure_input::{ReadStructure, StructureArgs};
use snapload::analysis::Progress;
use snapload_structure::note::{self, Source};
use snapload_structure::{DEFAULT_NEIGHBOURS, NEIGHBOURS, STRUCTURE, assess};
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = include_str!("../help/assess.txt").trim_ascii_end();

/// Which structure, and where the answer goes.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    input: StructureArgs,
    /// List the keys of a structure's case and exit
    #[arg(long)]
    keys: bool,
    /// Write the design note as one self-contained HTML page
    #[arg(long, value_name = "NOTE.html")]
    out: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArgs,
    /// Number of neighbours of the run, 1e-6 of the wave height away, that
    /// show how far it can be trusted
    #[arg(long, value_name = "NUMBER", default_value_t = DEFAULT_NEIGHBOURS, value_parser = whole_number::<u32>(NEIGHBOURS))]
    neighbours: u32,
    /// Omit the scan over wave heights and periods from the page
    #[arg(long)]
    no_scan: bool,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.keys {
        return print(&STRUCTURE.listing());
    }
    let ReadStructure {
        name,
        structure,
        sha256,
    } = args.input.read()?;
    let mut outputs = Outputs::open(&args.json)?;
    let out = outputs.file("--out", args.out.as_deref(), &["html"])?;
    let bar = Bar::new();
    let on_progress = |progress: Progress| bar.show(progress);
    let assessment = assess(structure, args.neighbours, &on_progress)
        .map_err(|error| Failure::from(error).with_prefix(&name))?;
    if let Some(out) = out {
        let structure = &assessment.prepared.structure;
        let scan = match args.no_scan {
            true => None,
            false => note::scan(structure, &on_progress)?,
        };
        drop(bar);
        let mut command = args.input.command("assess");
        if args.neighbours != DEFAULT_NEIGHBOURS {
            let _ = write!(command, " --neighbours {}", args.neighbours);
        }
        let source = Source {
            name: &name,
            command: &command,
            sha256: Some(&sha256),
        };
        let page = note::page(source, &assessment, scan.as_ref())
            .map_err(|error| Failure::Failed(format!("can not draw the page: {error}")))?;
        outputs.write(out, |out| out.write_all(page.as_bytes()))?;
    }
    outputs.finish_with_text(&assessment.to_json(&name), assessment.summary(&name))
}
