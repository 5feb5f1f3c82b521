//! A case in its notations: as a file, as a command, as lines of Python.
use snapload::{Parameters, Value};
use std::fmt::Write;

/// A case file for this case: the keys that differ from the standard one, one in each line.
pub fn case_file(parameters: &Parameters) -> String {
    let mut text =
        String::from("# A case of snapload; keys left out take their defaults (snapload keys).\n");
    for (key, value) in parameters.differing() {
        let _ = writeln!(text, "{key} = {value}");
    }
    text
}

/// The command that runs this case. Its values are numbers, flags and words of the schema, none of
/// which needs quotes in a shell.
pub fn shell_line(parameters: &Parameters) -> String {
    let mut line = "snapload run".to_owned();
    for (key, value) in parameters.differing() {
        let _ = match value {
            Value::Text(word) => write!(line, " --set {key}={word}"),
            value => write!(line, " --set {key}={value}"),
        };
    }
    line
}

/// The lines of Python that run this case.
pub fn python_lines(parameters: &Parameters) -> String {
    let differing = parameters.differing();
    let keywords: Vec<String> = differing
        .iter()
        .map(|(key, value)| match value {
            Value::Bool(true) => format!("{key}=True"),
            Value::Bool(false) => format!("{key}=False"),
            value => format!("{key}={value}"),
        })
        .collect();
    let case = keywords.join(", ");
    format!("import snapload\n\nrun = snapload.Case({case}).run()\nprint(run)\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_written_as_its_author_would() {
        let point = Parameters {
            a: 0.0,
            inertia: None,
            y: 0.2,
            v_stick: 1e-7,
            stop_when_settled: false,
            ..Parameters::STANDARD
        };
        assert!(
            case_file(&point).ends_with(
                "\ny = 0.2\nv_stick = 1e-7\nstop_when_settled = false\nbody = \"point\"\n"
            )
        );
        assert_eq!(
            shell_line(&point),
            "snapload run --set y=0.2 --set v_stick=1e-7 --set stop_when_settled=false --set body=point"
        );
        assert!(python_lines(&point).contains(
            "snapload.Case(y=0.2, v_stick=1e-7, stop_when_settled=False, body=\"point\").run()"
        ));
        assert_eq!(shell_line(&Parameters::STANDARD), "snapload run");
    }
}
