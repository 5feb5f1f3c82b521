//! The texts of the claims, which are in `claims/*.toml`. Each claim has a table there:
//!
//! ```toml
//! ["6.4.1-27"]
//! claim = "The rotations get larger with the frequency."
//! evidence = "largest rotation {rotations:.3}"
//! not_reproduced.ends = "It holds only for the ends of the range; {back} of 4 steps go the other way."
//! ```
//!
//! A key `judged` gives the measure, threshold and range of the judgement, where these are a
//! choice.
//!
//! `{rotations:.3}` shows the value that the check of the claim gives under that name, with three
//! decimals. The last line is a remark: it is shown with the verdict "not reproduced", and only if
//! the check found that the condition `ends` holds. So no remark remains if the numbers change from
//! which it was written. A remark called `always` depends on the verdict alone.

use super::numbers::{between, residual};
use super::verdict::{Claim, Finding, Verdict};
use crate::ReportError;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The texts of all claims, section by section.
const FILES: [&str; 8] = [
    include_str!("../../claims/6.3.toml"),
    include_str!("../../claims/6.4.1.toml"),
    include_str!("../../claims/6.4.2.toml"),
    include_str!("../../claims/6.4.3.toml"),
    include_str!("../../claims/6.5.toml"),
    include_str!("../../claims/6.5.1.1.toml"),
    include_str!("../../claims/6.5.1.2.toml"),
    include_str!("../../claims/6.5.2.1.toml"),
];

/// The name of a remark that depends on the verdict alone.
const ALWAYS: &str = "always";

/// The texts of one claim.
#[derive(Debug, Deserialize)]
struct Entry {
    /// The claim in our words.
    claim: String,
    /// The evidence, with a place for each value.
    evidence: String,
    /// The measure, threshold and range of the judgement, where these are a choice.
    #[serde(default)]
    judged: String,
    /// Remarks for each verdict, by the name of their condition.
    #[serde(flatten)]
    remarks: BTreeMap<Verdict, BTreeMap<String, String>>,
}

type Entries = BTreeMap<String, Entry>;

static ENTRIES: LazyLock<Result<Entries, toml::de::Error>> =
    LazyLock::new(|| toml::from_str(&FILES.join("\n")));

/// A value that a check gives.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Text(String),
    Numbers(Vec<f64>),
    /// One list for each start.
    ByStart(Vec<Vec<f64>>),
}

impl Value {
    /// The value in the format of its place: `.2` and `.2e` numbers with this many decimals, as a
    /// list if there are several; `span.2` the least and the greatest of them, or one number if
    /// both read the same; `residual` the size of a rounding error. None if there is no such
    /// format.
    fn show(&self, format: &str) -> Option<String> {
        let numbers = match self {
            Self::Text(text) => return format.is_empty().then(|| text.clone()),
            Self::Numbers(numbers) => numbers,
            Self::ByStart(starts) => {
                let length = starts.iter().map(Vec::len).min().unwrap_or(0);
                let column = |k: usize| starts.iter().map(|list| list[k]).collect();
                let columns = (0..length).map(|k| Self::Numbers(column(k)));
                let span = format!("span{format}");
                let shown: Option<Vec<String>> = columns.map(|list| list.show(&span)).collect();
                return shown.map(|shown| shown.join(", "));
            }
        };
        let (kind, digits) = format.split_once('.').unwrap_or((format, ""));
        let decimals = digits.trim_end_matches('e').parse();
        let number = |v: f64| match decimals {
            Ok(decimals) if digits.ends_with('e') => format!("{v:.decimals$e}"),
            Ok(decimals) => format!("{v:.decimals$}"),
            Err(_) => v.to_string(),
        };
        let list = || numbers.iter().map(|v| number(*v)).collect::<Vec<_>>();
        match kind {
            _ if decimals.is_err() && !digits.is_empty() => None,
            "" => Some(list().join(", ")),
            "span" => Some(between(numbers.iter().copied(), number)),
            "residual" => numbers.first().map(|v| residual(*v)),
            _ => None,
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Numbers(vec![number])
    }
}

impl From<usize> for Value {
    fn from(count: usize) -> Self {
        Self::from(count as f64)
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// The claim of this name with its finding.
///
/// # Errors
/// [`ReportError::Claim`] if texts and finding do not match.
pub(super) fn with_texts(id: &str, finding: &Finding) -> Result<Claim, ReportError> {
    let fault = |what: String| ReportError::Claim(format!("claim {id}: {what}"));
    let entries = ENTRIES.as_ref().map_err(|error| fault(error.to_string()))?;
    let (id, entry) = entries
        .get_key_value(id)
        .ok_or_else(|| fault("it has no text".to_owned()))?;
    let [evidence, judged, remark] = entry.fill_texts(finding).map_err(fault)?;
    Ok(Claim {
        id,
        section: id.rsplit_once('-').map_or(id, |(section, _)| section),
        claim: &entry.claim,
        verdict: finding.verdict,
        evidence,
        judged,
        remark,
    })
}

/// Checks that exactly the claims that have texts have been judged.
///
/// # Errors
/// [`ReportError::Claim`] with the first claim that has not, or that was judged twice.
pub(super) fn check_all(judged: &[&str]) -> Result<(), ReportError> {
    let fault = |id: &str, what: &str| Err(ReportError::Claim(format!("claim {id}: {what}")));
    let mut ids = ENTRIES.iter().flatten().map(|(id, _)| id.as_str());
    if let Some(id) = ids.find(|id| !judged.contains(id)) {
        return fault(id, "it has a text, but is not judged");
    }
    match judged.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => fault(pair[0], "it is judged twice"),
        None => Ok(()),
    }
}

impl Entry {
    /// The evidence of a finding, how it was judged, and the remarks.
    fn fill_texts(&self, finding: &Finding) -> Result<[String; 3], String> {
        self.check(finding)?;
        let is_so = |name: &str| name == ALWAYS || finding.conditions.get(name) == Some(&true);
        let remarks = self.remarks.get(&finding.verdict).into_iter().flatten();
        let remarks = remarks.filter(|(name, _)| is_so(name));
        let remarks = remarks.map(|(_, remark)| fill(remark, &finding.values));
        let remarks: Vec<String> = remarks.collect::<Result<_, _>>()?;
        let [evidence, judged] = [&self.evidence, &self.judged].map(|t| fill(t, &finding.values));
        Ok([evidence?, judged?, remarks.join(" ")])
    }

    /// Checks that every value of the check is used in the texts, and that the condition of every
    /// remark, except those that always apply, is decided.
    fn check(&self, finding: &Finding) -> Result<(), String> {
        let remarks = || self.remarks.values().flatten();
        let text = remarks().map(|(_, text)| &**text).collect::<String>();
        let text = text + &self.evidence + &self.judged;
        let place = |name: &str, end: &str| text.contains(&format!("{{{name}{end}"));
        let used = |name: &str| place(name, "}") || place(name, ":");
        if let Some(name) = finding.values.keys().find(|name| !used(name)) {
            return Err(format!(
                "its check gives `{name}`, which its text does not use"
            ));
        }
        let mut named: Vec<&str> = remarks().map(|(name, _)| &**name).collect();
        named.retain(|name| *name != ALWAYS);
        let undecided = |name: &&&str| !finding.conditions.contains_key(**name);
        if let Some(name) = named.iter().find(undecided) {
            return Err(format!(
                "a remark depends on `{name}`, which its check does not decide"
            ));
        }
        match finding.conditions.keys().find(|name| !named.contains(name)) {
            Some(name) => Err(format!(
                "its check decides `{name}`, on which no remark depends"
            )),
            None => Ok(()),
        }
    }
}

/// A text with the values in their places.
fn fill(template: &str, values: &BTreeMap<&str, Value>) -> Result<String, String> {
    let mut text = String::new();
    let mut rest = template;
    while let Some((before, place)) = rest.split_once('{') {
        let (place, after) = place
            .split_once('}')
            .ok_or("a place is not closed with }")?;
        let (name, format) = place.split_once(':').unwrap_or((place, ""));
        let value = values
            .get(name)
            .ok_or_else(|| format!("its check gives no `{name}`"))?;
        let shown = value
            .show(format)
            .ok_or_else(|| format!("`{name}` can not be shown as `{format}`"))?;
        text.push_str(before);
        text.push_str(&shown);
        rest = after;
    }
    text.push_str(rest);
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Verdict::{NotDecidable, NotReproduced, Reproduced};

    fn entry() -> Result<Entry, String> {
        let text = "
            claim = 'both hold'
            evidence = '{holding} of {all:.1}'
            judged = 'by one'
            not_reproduced = { fails = '{one} fails', rains = 'it rains' }
            not_decidable.always = 'by chance'
        ";
        toml::from_str(text).map_err(|error| error.to_string())
    }

    fn finding(verdict: Verdict) -> Finding {
        Finding::new(verdict)
            .value("holding", 1_usize)
            .list("all", [2.0, 3.0])
            .value("one", "one".to_owned())
            .condition("fails", true)
            .condition("rains", false)
    }

    #[test]
    fn a_remark_stands_only_beside_the_verdict_that_it_explains() -> Result<(), String> {
        for (verdict, remark) in [
            (Reproduced, ""),
            (NotReproduced, "one fails"),
            (NotDecidable, "by chance"),
        ] {
            let texts = entry()?.fill_texts(&finding(verdict))?;
            assert_eq!(
                texts,
                ["1 of 2.0, 3.0", "by one", remark].map(str::to_owned)
            );
        }
        Ok(())
    }

    #[test]
    fn texts_and_findings_that_do_not_fit_are_refused() -> Result<(), String> {
        let entry = entry()?;
        let refused = |finding: Finding| entry.fill_texts(&finding).unwrap_err();
        let more = finding(Reproduced).value("two", 2_usize);
        assert_eq!(
            refused(more),
            "its check gives `two`, which its text does not use"
        );
        let more = finding(Reproduced).condition("snows", true);
        assert_eq!(
            refused(more),
            "its check decides `snows`, on which no remark depends"
        );
        let mut less = finding(Reproduced);
        less.conditions.remove("rains");
        assert_eq!(
            refused(less),
            "a remark depends on `rains`, which its check does not decide"
        );
        let mut less = finding(Reproduced);
        less.values.remove("holding");
        assert_eq!(refused(less), "its check gives no `holding`");
        let text = finding(Reproduced).value("all", "two".to_owned());
        assert_eq!(refused(text), "`all` can not be shown as `.1`");
        Ok(())
    }

    #[test]
    fn a_claim_without_a_check_or_with_two_is_noticed() -> Result<(), ReportError> {
        let all: Vec<&str> = ENTRIES
            .iter()
            .flatten()
            .map(|(id, _)| id.as_str())
            .collect();
        assert!(all.len() >= 150);
        check_all(&all)?;
        let twice = [&all[..1], &all].concat();
        for wrong in [&all[1..], &twice] {
            assert!(check_all(wrong).is_err_and(|error| error.to_string().contains(all[0])));
        }
        Ok(())
    }

    #[test]
    fn numbers_are_shown_in_the_format_of_their_place() {
        let numbers = Value::Numbers(vec![0.25, 0.5]);
        let shown = ["", ".2", ".0e", "span.1", "span", ".x", "wide.2"].map(|f| numbers.show(f));
        let [plain, two, powers, span, bare, odd, unknown] = shown.map(Option::unwrap_or_default);
        let starts = Value::ByStart(vec![vec![0.251, 0.5], vec![0.254, 0.75]]);
        let shown = starts.show(".2").unwrap_or_default();
        assert_eq!(shown, "0.25, 0.50 to 0.75");
        assert_eq!(
            [plain, two, powers].join("; "),
            "0.25, 0.5; 0.25, 0.50; 2e-1, 5e-1"
        );
        assert_eq!([span, bare].join("; "), "0.2 to 0.5; 0.25 to 0.5");
        assert_eq!(odd + &unknown, "");
    }
}
