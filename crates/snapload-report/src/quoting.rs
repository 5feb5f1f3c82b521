//! Words in the notations of a shell and of Python, for lines that are copied.
use shlex::Quoter;

/// The command of these words, for a POSIX shell. A word is quoted if the shell would read it as
/// anything but itself, such as the name of a file with a blank, a quote or a semicolon.
pub fn shell_command<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    // Only a NUL could be refused, which no argument of a program can contain.
    let joined = Quoter::new().allow_nul(true).join(words);
    joined.unwrap_or_default()
}

/// A text as a literal of Python, where every escape of JSON has the same meaning.
pub fn python_text(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of files and values that a shell or Python would read as something else.
    const WORDS: [&str; 11] = [
        "plain.toml",
        "my pier's.toml",
        "a;echo b.toml",
        "$(echo x)`echo y`.toml",
        "both \" and ' and \\",
        "line.1.anchor=[3.593, -10]",
        "~/*.toml",
        "two\nlines",
        "",
        "!! ^ # & | < > {a,b}",
        "Brücke e\u{301} \u{7f} \u{200b}.toml",
    ];

    #[cfg(unix)]
    #[test]
    fn a_shell_reads_the_words_of_a_command() {
        // The first word is the shell's own command.
        let command = shell_command(["printf", "%s\\0"].into_iter().chain(WORDS));
        let mut shell = std::process::Command::new("sh");
        let printed = shell.args(["-c", &command]).output().unwrap();
        let printed = String::from_utf8(printed.stdout).unwrap();
        let read: Vec<&str> = printed.strip_suffix('\0').unwrap().split('\0').collect();
        assert_eq!(read, WORDS);
    }

    #[test]
    fn words_that_need_no_quotes_have_none() {
        let plain = "snapload assess docs/examples/cylinder.toml --neighbours 4";
        assert_eq!(shell_command(plain.split(' ')), plain);
    }

    #[test]
    fn a_text_of_python_has_escapes_that_python_knows() {
        assert_eq!(python_text("my pier's.toml"), "\"my pier's.toml\"");
        assert_eq!(python_text("C:\\\"a\"\n"), r#""C:\\\"a\"\n""#);
        // Python has no `\u{1b}`; a combining accent needs no escape.
        assert_eq!(python_text("\u{1b}e\u{301}"), "\"\\u001be\u{301}\"");
    }
}
