//! `snapload moordyn`: a structure's case from a MoorDyn file, and for MoorDyn.
use crate::case_input::read_text;
use crate::failure::{Failure, print};
use crate::json::{folder_for, refuse_directory};
use crate::option_values::whole_number;
use crate::pending_outputs::PendingOutputs;
use crate::structure_input::{ReadStructure, StructureArgs};
use clap::Subcommand;
use snapload_structure::{SEGMENTS, Structure, labelled_row, moordyn};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = include_str!("../help/moordyn.txt").trim_ascii_end();

/// From MoorDyn or for it.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    direction: Direction,
}

#[derive(Subcommand)]
enum Direction {
    /// Read a MoorDyn v2 input file whose body and lines lie in one vertical plane
    #[command(after_help = EXAMPLES)]
    Read(Read),
    /// Write a structure's case as an input file of MoorDyn v2
    #[command(after_help = EXAMPLES)]
    Write(Write),
}

#[derive(clap::Args)]
struct Read {
    /// Input file of MoorDyn v2
    #[arg(value_name = "FILE.txt")]
    file: PathBuf,
    /// Add or change a key, such as wave.height=2 or body.width=3; may be repeated
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    set: Vec<String>,
    /// Write the case to this file instead of standard output
    #[arg(long, value_name = "CASE.toml")]
    out: Option<PathBuf>,
}

#[derive(clap::Args)]
struct Write {
    #[command(flatten)]
    input: StructureArgs,
    /// Number of segments of each line: one is a spring with a damper, more have mass along the
    /// length of the line
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = whole_number::<u32>(SEGMENTS))]
    segments: u32,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "LINES.txt")]
    out: Option<PathBuf>,
}

/// Does it.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.direction {
        Direction::Read(args) => read(args),
        Direction::Write(args) => write(args),
    }
}

fn read(args: &Read) -> Result<(), Failure> {
    let name = args.file.display().to_string();
    let reading = moordyn::read(&name, &read_text(&args.file)?)?;
    let moordyn::Reading { mut entries, notes } = reading;
    args.set.iter().try_for_each(|set| entries.set(set))?;
    let missing = entries.missing();
    if missing.is_empty() {
        Structure::from_entries_beside(&entries, Path::new(""))?;
    }
    let mut text = format!("# From {}, an input file of MoorDyn.\n", one_line(&name));
    for note in &notes {
        let _ = writeln!(text, "# {}", one_line(note));
    }
    if !missing.is_empty() {
        let _ = writeln!(text, "# Still missing: {}.", missing.join(", "));
    }
    let _ = write!(text, "\n{}", entries.to_toml());
    let Some(path) = &args.out else {
        return print(&text);
    };
    let mut message = labelled_row("written", &put(path, &text)?);
    for note in &notes {
        message += &labelled_row("note", note);
    }
    if !missing.is_empty() {
        let words = format!(
            "{}: MoorDyn files do not contain them; add them to the case, or set them with --set",
            missing.join(", ")
        );
        message += &labelled_row("missing", &words);
    }
    print(&message)
}

fn write(args: &Write) -> Result<(), Failure> {
    let ReadStructure {
        name, structure, ..
    } = args.input.read()?;
    let text = moordyn::write(&name, &structure, args.segments)
        .map_err(|error| Failure::BadInput(format!("{name}: {error}")))?;
    match &args.out {
        None => print(&text),
        Some(path) => print(&labelled_row("written", &put(path, &text)?)),
    }
}

/// Writes a text to a file, completely or not at all, and returns a message with its path.
fn put(path: &Path, text: &str) -> Result<String, Failure> {
    let mut pending = PendingOutputs::default();
    refuse_directory(path)?;
    let folder = pending.create_and_open(&folder_for(path))?;
    pending.write(folder, path.to_owned(), |out| {
        out.write_all(text.as_bytes())
    })?;
    pending.commit()?;
    Ok(path.display().to_string())
}

fn one_line(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect()
}
