//! `snapload explore`: a run on a page in the browser, which this program serves itself.
use crate::case_input::{CaseArgs, read_text};
use crate::failure::{Failure, print, without_number};
use crate::interrupt::{Graceful, end_gracefully, print_error_line};
use crate::option_values::whole_number;
use crate::structure_input::{entries_of, structure_of};
use snapload::{Key, Kind, Parameters};
use snapload_explore::{Opened, Server, Start};
use snapload_report::case_in_words;
use std::io;
use std::path::Path;

/// Ports; 0 is any that is free.
const PORT: Key = Key::option("port", Kind::Count(0, 65_535));
/// The port where none is asked for.
const USUAL_PORT: u16 = 7627;

const EXAMPLES: &str = "\
This program serves the page, and only to this machine; no network is needed. The page shows the
motion, its plots and how far they can be trusted. Every key can be changed on the page, and the
case can be saved as a file.

Examples:
  snapload explore
      start with the standard case
  snapload explore --case 1922001000-359 --set f_o=0.4
      start with a built-in case and change one key
  snapload explore mooring.toml
      start with your own case
  snapload explore docs/examples/cylinder.toml
      a structure in metres, kilonewtons and seconds
  snapload explore --port 8000 --no-browser
      serve http://127.0.0.1:8000/, to be opened in a browser by hand

Press Ctrl-C to stop the program.";

/// What to begin with, and where.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// Port to serve the page on; 0 means any free port [default: 7627, or
    /// any free port if that is taken]
    #[arg(long, value_name = "N", value_parser = whole_number::<u16>(PORT))]
    port: Option<u16>,
    /// Print the address without opening a browser
    #[arg(long)]
    no_browser: bool,
}

/// Serves it until it is interrupted.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let opened = opened(&args.case)?;
    let start = match opened {
        Some(_) => Start {
            name: "the standard case".to_owned(),
            parameters: Parameters::STANDARD,
        },
        None => start(&args.case)?,
    };
    let server = bind(args.port, &start)?;
    let server = match opened {
        Some(opened) => server.opening(opened),
        None => server,
    };
    let (address, stop) = (server.address(), server.stop());
    end_gracefully(Graceful {
        on_first: Box::new(move || stop.now()),
        after_second: "the page is no longer served",
    });
    print(&format!("{address}\n"))?;
    // A program that reads the address may have closed the output by now.
    print_error_line("press Ctrl-C to stop");
    if !args.no_browser && open::that_detached(&address).is_err() {
        print_error_line("no browser could be opened; open the address above by hand");
    }
    let served = server.serve();
    served.map_err(|error| {
        Failure::Failed(format!(
            "the page can not be served: {}",
            without_number(&error)
        ))
    })
}

/// The first case of the thesis's model.
fn start(case: &CaseArgs) -> Result<Start, Failure> {
    let input = case.read()?;
    let parameters = *input.case.parameters();
    let name = match input.name.as_str() {
        // A changed case may not have the name of the one that it was.
        name if !case.changes().is_empty() => case_in_words(name, &parameters),
        "standard case" => "the standard case".to_owned(),
        name => name.to_owned(),
    };
    Ok(Start { name, parameters })
}

/// The first structure, if the file is the case of one.
fn opened(case: &CaseArgs) -> Result<Option<Opened>, Failure> {
    let Some(path) = case.file() else {
        return Ok(None);
    };
    let text = read_text(path)?;
    if !snapload_structure::is_structure(&text) {
        return Ok(None);
    }
    let (name, entries) = entries_of(path, &text, case.changes())?;
    structure_of(path, &name, &entries)?;
    let folder = Some(path.parent().unwrap_or(Path::new("")).to_owned());
    Ok(Some(Opened {
        name,
        entries,
        changes: case.changes().to_vec(),
        folder,
    }))
}

/// Links contain the port, so that it is the same every time unless another is asked for; a second
/// page at the same time has another.
fn bind(port: Option<u16>, start: &Start) -> Result<Server, Failure> {
    match port {
        Some(port) => Server::bind(port, start.clone()).map_err(|error| no_port(port, &error)),
        None => Server::bind(USUAL_PORT, start.clone())
            .or_else(|_| Server::bind(0, start.clone()))
            .map_err(|error| no_port(0, &error)),
    }
}

fn no_port(port: u16, error: &io::Error) -> Failure {
    Failure::BadInput(format!(
        "--port {port}: {}\nhint: choose another port, or leave --port out for any free one",
        without_number(error)
    ))
}
