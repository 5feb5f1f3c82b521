//! Certificates as JSON, read strictly.

use crate::arithmetic::decimal::Decimal;
use crate::case::{ExactCase, NUMBERS};
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;
use std::marker::PhantomData;

/// The format of certificates of slack flight.
pub(crate) const FORMAT: &str = "snapload-certificate-1";
/// The format of certificates that continue where a cable stays taut.
pub(crate) const TAUT_FORMAT: &str = "snapload-certificate-2";
/// The model that certificates refer to.
pub(crate) const MODEL: &str = "snapload model 1";
/// The reason at the end of a certificate that proves only the beginning of a run.
pub(crate) const UNDECIDED: &str = "undecided";
/// A claim is that a number is true to half a unit of its last place, which of 0e10 says nothing.
/// Times and states have at least so many places after the point; a writer has three to five more.
const LEAST_PLACES: i64 = 20;
/// Normal velocities have at least so many digits; a writer has one to three more.
const LEAST_DIGITS: i64 = 14;
/// How much of a text a message repeats, in characters.
const LONGEST_ECHO: usize = 60;

/// A certificate as it is written: the case, and what is claimed of its run.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CertificateText {
    pub(crate) format: String,
    pub(crate) model: String,
    pub(crate) bits: u64,
    #[serde(deserialize_with = "keyed")]
    pub(crate) case: CaseText,
    pub(crate) impacts: Vec<Line>,
    #[serde(deserialize_with = "keyed")]
    pub(crate) end: EndText,
}

impl CertificateText {
    /// A certificate out of its text.
    pub(crate) fn read(text: &str) -> Result<Self, serde_json::Error> {
        let mut json = serde_json::Deserializer::from_str(text);
        let certificate = keyed(&mut json)?;
        json.end()?;
        Ok(certificate)
    }
}

/// The events of a run in order.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum Line {
    /// Cable from 1, time, normal velocity.
    Impact(u8, String, String),
    TautSegment(#[serde(deserialize_with = "keyed")] TautSegment),
}

impl Line {
    /// The time of the event, or the end of the segment.
    pub(crate) fn time(&self) -> &str {
        match self {
            Self::Impact(_, t, _) => t,
            Self::TautSegment(segment) => &segment.until,
        }
    }
}

/// A segment of motion with one taut cable.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TautSegment {
    /// The taut cables, from 1.
    pub(crate) mode: Vec<u8>,
    pub(crate) from: String,
    pub(crate) until: String,
    pub(crate) event: String,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EndText {
    pub(crate) reason: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) t: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) state: Option<[String; 6]>,
}

/// Every key of the case, none of them left to a default.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CaseText {
    r: String,
    e: String,
    a: String,
    b: String,
    #[serde(deserialize_with = "present")]
    inertia: Option<String>,
    f_o: String,
    nu: String,
    omega: String,
    x: String,
    y: String,
    theta: String,
    vx: String,
    vy: String,
    vtheta: String,
    t_end: String,
    v_stick: String,
    stop_when_settled: bool,
    stop_when_sliding: bool,
    max_impacts: u64,
    body: String,
}

/// A struct given with its keys. Without this, serde would also accept a list of the values in the
/// order of the keys.
fn keyed<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<T, D::Error> {
    struct Keys<T>(PhantomData<T>);
    impl<'de, T: Deserialize<'de>> Visitor<'de> for Keys<T> {
        type Value = T;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("an object with keys")
        }
        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
            T::deserialize(MapAccessDeserializer::new(map))
        }
    }
    deserializer.deserialize_map(Keys(PhantomData))
}

/// A key that may be null and must be there.
fn present<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<String>, D::Error> {
    Option::deserialize(deserializer)
}

impl CaseText {
    pub(crate) fn of(case: &ExactCase) -> Self {
        let text = |key: &str| case.number(key).text().to_owned();
        Self {
            r: text("r"),
            e: text("e"),
            a: text("a"),
            b: text("b"),
            inertia: case.inertia.as_ref().map(|d| d.text().to_owned()),
            f_o: text("f_o"),
            nu: text("nu"),
            omega: text("omega"),
            x: text("x"),
            y: text("y"),
            theta: text("theta"),
            vx: text("vx"),
            vy: text("vy"),
            vtheta: text("vtheta"),
            t_end: text("t_end"),
            v_stick: text("v_stick"),
            stop_when_settled: case.stop_when_settled,
            stop_when_sliding: case.stop_when_sliding,
            max_impacts: case.max_impacts,
            body: case.body().to_owned(),
        }
    }

    pub(crate) fn exact(&self) -> Result<ExactCase, String> {
        let is_point = match self.body.as_str() {
            "rigid" => false,
            "point" => true,
            other => return Err(format!("body {} is neither rigid nor point", quoted(other))),
        };
        let texts: [&String; NUMBERS.len()] = [
            &self.r,
            &self.e,
            &self.a,
            &self.b,
            &self.f_o,
            &self.nu,
            &self.omega,
            &self.x,
            &self.y,
            &self.theta,
            &self.vx,
            &self.vy,
            &self.vtheta,
            &self.t_end,
            &self.v_stick,
        ];
        let mut numbers = Vec::new();
        for (key, text) in NUMBERS.iter().zip(texts) {
            numbers.push(decimal(key, text)?);
        }
        let inertia = self.inertia.as_deref().map(|text| decimal("inertia", text));
        ExactCase::new(
            numbers.try_into().map_err(|_| "a key is missing")?,
            inertia.transpose()?,
            is_point,
            [self.stop_when_settled, self.stop_when_sliding],
            self.max_impacts,
        )
    }
}

/// A decimal of a certificate.
pub(crate) fn decimal(what: &str, text: &str) -> Result<Decimal, String> {
    let refuse = || {
        format!(
            "{what} {} is not a decimal of at most 399 characters",
            quoted(text)
        )
    };
    Decimal::parse(text).ok_or_else(refuse)
}

/// A time or a component of a state, with the places that a statement of it needs.
pub(crate) fn placed(what: &str, text: &str) -> Result<(), String> {
    let known = decimal(what, text)?.has_places(LEAST_PLACES);
    claimed(known, what, text, format!("{LEAST_PLACES} decimals"))
}

/// A normal velocity, with the digits that a statement of it needs.
pub(crate) fn velocity(what: &str, text: &str) -> Result<(), String> {
    let known = decimal(what, text)?.has_digits(LEAST_DIGITS);
    claimed(known, what, text, format!("{LEAST_DIGITS} digits"))
}

fn claimed(known: bool, what: &str, text: &str, least: String) -> Result<(), String> {
    let refuse = || format!("{what} {} has fewer than {least}", quoted(text));
    known.then_some(()).ok_or_else(refuse)
}

/// A text of a certificate as a message repeats it: in quotation marks, and cut where it is long.
pub(crate) fn quoted(text: &str) -> String {
    format!("{:?}", cut(text, LONGEST_ECHO))
}

/// At most so many characters of a text.
pub(crate) fn cut(text: &str, most: usize) -> String {
    let mut shown: String = text.chars().take(most).collect();
    if shown.len() < text.len() {
        shown += "...";
    }
    shown
}
