//! Every sentence of the chapter: which claims it makes, or why it makes none that can be checked.

use crate::ReportError;
use crate::claims::Claim;
use serde::Deserialize;
use std::collections::BTreeMap;

/// The sentences, section by section.
pub(crate) struct Chapter {
    pub(crate) sections: Vec<Section>,
}

pub(crate) struct Section {
    /// Such as `6.4.1`.
    pub(crate) name: String,
    pub(crate) sentences: Vec<Sentence>,
}

/// A sentence of the chapter.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "[String; 2]")]
pub(crate) struct Sentence {
    /// Its first words, by which it is found.
    pub(crate) begins: String,
    pub(crate) kind: Kind,
}

/// The kind of a sentence.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    /// It makes the claims of these names.
    Claims(Vec<String>),
    /// It sets a convention, reports what was done, or refers to another place.
    Definition,
    /// It can not be checked by computation, and why.
    NotCheckable(String),
}

impl From<[String; 2]> for Sentence {
    fn from([begins, kind]: [String; 2]) -> Self {
        let kind = match kind.as_str() {
            "definition" => Kind::Definition,
            text => match text.strip_prefix("not checkable: ") {
                Some(why) => Kind::NotCheckable(why.to_owned()),
                None => Kind::Claims(text.split(", ").map(str::to_owned).collect()),
            },
        };
        Self { begins, kind }
    }
}

impl Chapter {
    /// The stored table, checked against the claims.
    pub(crate) fn read(claims: &[Claim]) -> Result<Self, ReportError> {
        let sections: BTreeMap<String, Vec<Sentence>> =
            toml::from_str(include_str!("../claims/sentences.toml"))?;
        let sections = sections.into_iter();
        let chapter = Self {
            sections: sections
                .map(|(name, sentences)| Section { name, sentences })
                .collect(),
        };
        let ids: Vec<&str> = claims.iter().map(|claim| claim.id).collect();
        chapter.check(&ids)?;
        Ok(chapter)
    }

    /// Checks that every claim stems from a sentence, and that the claims of every sentence are
    /// judged.
    fn check(&self, ids: &[&str]) -> Result<(), ReportError> {
        let fault = |id: &str, what: &str| Err(ReportError::Claim(format!("claim {id}: {what}")));
        let claimed_ids: Vec<&str> = self.claimed().collect();
        if let Some(id) = claimed_ids.iter().find(|id| !ids.contains(*id)) {
            return fault(id, "a sentence names it, but it is not judged");
        }
        match ids.iter().find(|id| !claimed_ids.contains(*id)) {
            Some(id) => fault(id, "no sentence makes it"),
            None => Ok(()),
        }
    }

    fn sentences(&self) -> impl Iterator<Item = &Sentence> {
        self.sections.iter().flat_map(|section| &section.sentences)
    }

    /// The claims that sentences make.
    fn claimed(&self) -> impl Iterator<Item = &str> {
        self.sentences().flat_map(|sentence| match &sentence.kind {
            Kind::Claims(ids) => ids.iter().map(String::as_str).collect(),
            _ => Vec::new(),
        })
    }

    /// The number of sentences of a kind.
    pub(crate) fn count(&self, such: impl Fn(&Kind) -> bool) -> usize {
        self.sentences()
            .filter(|sentence| such(&sentence.kind))
            .count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Chapter {
        let sections: BTreeMap<String, Vec<Sentence>> = toml::from_str(text).expect("a table");
        let sections = sections.into_iter();
        Chapter {
            sections: sections
                .map(|(name, sentences)| Section { name, sentences })
                .collect(),
        }
    }

    /// The number of sentences in each section of the chapter, counted in its text.
    const SENTENCES: [(&str, usize); 16] = [
        ("6.1", 5),
        ("6.2", 2),
        ("6.3", 12),
        ("6.3.1", 28),
        ("6.3.2", 10),
        ("6.4", 4),
        ("6.4.1", 67),
        ("6.4.2", 33),
        ("6.4.3", 41),
        ("6.5", 11),
        ("6.5.1", 6),
        ("6.5.1.1", 50),
        ("6.5.1.2", 39),
        ("6.5.2", 9),
        ("6.5.2.1", 32),
        ("6.5.2.2", 38),
    ];

    #[test]
    fn every_sentence_is_there_and_has_a_kind() {
        let chapter = read(include_str!("../claims/sentences.toml"));
        let lengths = chapter
            .sections
            .iter()
            .map(|s| (s.name.as_str(), s.sentences.len()));
        assert_eq!(lengths.collect::<Vec<_>>(), SENTENCES);
        for sentence in chapter.sentences() {
            assert!(!sentence.begins.is_empty(), "{sentence:?}");
            match &sentence.kind {
                Kind::Claims(ids) => assert!(ids.iter().all(|id| id.starts_with("6.")), "{ids:?}"),
                Kind::NotCheckable(why) => assert!(why.len() > 5, "{sentence:?}"),
                Kind::Definition => {}
            }
        }
    }

    #[test]
    fn a_claim_without_a_sentence_and_a_sentence_without_its_claim_are_seen() {
        let chapter = read("'6.1' = [['It is', '6.1-01, 6.1-02'], ['We', 'definition']]");
        assert!(chapter.check(&["6.1-01", "6.1-02"]).is_ok());
        assert!(chapter.check(&["6.1-01"]).is_err());
        assert!(chapter.check(&["6.1-01", "6.1-02", "6.1-03"]).is_err());
    }
}
