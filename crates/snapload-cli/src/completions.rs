//! `snapload completions`: completion scripts for shells.
use crate::failure::{Failure, print};
use clap::CommandFactory;
use clap_complete::Shell;

/// Which shell.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  snapload completions bash > ~/.local/share/bash-completion/completions/snapload
  snapload completions fish > ~/.config/fish/completions/snapload.fish")]
pub(crate) struct Args {
    /// The shell
    shell: Shell,
}

/// Prints the script.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(
        args.shell,
        &mut crate::Cli::command(),
        "snapload",
        &mut script,
    );
    print(&String::from_utf8_lossy(&script))
}
