//! The commands of the page, each listed once, and the links from numbers to them.

use crate::source::Number;
use maud::{Markup, html};

/// The commands in the order of their first mention.
#[derive(Default)]
pub(super) struct Commands {
    texts: Vec<String>,
}

impl Commands {
    fn place(&mut self, command: &str) -> usize {
        let known = self.texts.iter().position(|text| text == command);
        1 + known.unwrap_or_else(|| {
            self.texts.push(command.to_owned());
            self.texts.len() - 1
        })
    }

    /// A number as a link to the command that makes it again; `key` is its place in what that prints.
    pub(super) fn link(&mut self, shown: &str, command: &str, key: &str) -> Markup {
        let place = self.place(command);
        html! {
            a.number href={ "#command-" (place) } title={ (command) " → " (key) } data-key=(key) { (shown) }
        }
    }

    /// A [`Number`] with its name.
    pub(super) fn number(&mut self, number: &Number) -> Markup {
        html! { (number.name) (self.link(&number.shown, &number.command, &number.key)) }
    }

    /// A reference such as \[12\], which paper shows too.
    pub(super) fn cite(&mut self, command: &str) -> Markup {
        let place = self.place(command);
        html! { a.cite href={ "#command-" (place) } title=(command) { "[" (place) "]" } }
    }

    /// The list to which the links lead.
    pub(super) fn list(&self) -> Markup {
        html! {
            section id="commands" {
                h2 { "The commands" }
                p {
                    "Every number above is a link to its command here (on a screen the pointer shows it at once, \
                     with the number's place in the output, written in the language of " code { "jq" }
                    "). The commands print JSON in full precision; "
                    code { "jq" } " is not needed to read it. The loops are for a POSIX shell."
                }
                ol.commands {
                    @for (k, text) in self.texts.iter().enumerate() {
                        li id={ "command-" (k + 1) } { (command(text)) }
                    }
                }
            }
        }
    }
}

/// A command that is broken into lines between its words only, never after a hyphen.
pub(super) fn command(text: &str) -> Markup {
    html! {
        code.command {
            @for (k, word) in text.split(' ').enumerate() {
                @if k > 0 { " " }
                span { (word) }
            }
        }
    }
}
