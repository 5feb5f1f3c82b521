//! Help texts that are wrapped at the width of the terminal and not at fixed places.

use clap::Command;

/// The same command and all its subcommands with each paragraph in one line, which clap wraps.
pub(crate) fn flowing(command: Command) -> Command {
    let text = command.get_after_help().map(ToString::to_string);
    let command = match text {
        Some(text) => command.after_help(paragraphs(&text)),
        None => command,
    };
    command.mut_subcommands(flowing)
}

/// Joins the lines of each paragraph. Indented lines, such as commands, are kept as they are.
fn paragraphs(text: &str) -> String {
    let is_prose = |line: &str| !line.is_empty() && !line.starts_with(' ');
    let mut joined = String::new();
    let mut goes_on = false;
    for line in text.lines() {
        let prose = is_prose(line);
        if !joined.is_empty() {
            joined.push(if goes_on && prose { ' ' } else { '\n' });
        }
        joined.push_str(line);
        goes_on = prose;
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::paragraphs;
    use clap::{Command, CommandFactory};

    #[test]
    fn paragraphs_are_joined_and_commands_left() {
        let text = "One\ntwo.\n\nExamples:\n  run\n      a run\n\nThree\nfour.";
        let flowing = "One two.\n\nExamples:\n  run\n      a run\n\nThree four.";
        assert_eq!(paragraphs(text), flowing);
    }

    /// clap would break a longer line, and a command that is broken can not be copied.
    #[test]
    fn examples_fit_into_100_columns() {
        let mut commands: Vec<Command> = vec![crate::Cli::command()];
        while let Some(command) = commands.pop() {
            let text = command.get_after_help().map(ToString::to_string);
            for line in text.iter().flat_map(|text| text.lines()) {
                let columns = line.chars().count();
                let fits = columns <= 100 || !line.starts_with(' ');
                assert!(fits, "{columns} columns: {line}");
            }
            commands.extend(command.get_subcommands().cloned());
        }
    }
}
