//! The objects of a MoorDyn file: types, the body, points; and whether they lie in one vertical
//! plane.

use super::sections::{Row, Section, Sections, number};
use snapload::CaseError;
use std::collections::BTreeMap;

/// The largest distance of a point from the plane \[m\].
const OFF_PLANE_M: f64 = 1e-6;
/// The number of columns from which on a row of POINTS has an applied force.
const COLUMNS_WITH_FORCE: usize = 12;
/// How MoorDyn calls a body or a point that another program moves.
const COUPLED: [&str; 5] = ["coupled", "cpld", "vessel", "ves", "coup"];

/// The object to which a point is attached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PointOf {
    Ground,
    Body,
}

/// A point, in earth-fixed coordinates.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) attached_to: PointOf,
    pub(super) place_m: [f64; 3],
}

/// The points of a file with their rows, by their numbers.
pub(super) type Points<'a> = BTreeMap<&'a str, (&'a Row<'a>, Point)>;

/// The body of a file.
#[derive(Debug)]
pub(super) struct Body<'a> {
    pub(super) row: &'a Row<'a>,
    pub(super) place_m: [f64; 3],
}

/// Sections that can not be represented as straight lines from anchors to one body: the section,
/// its name in errors, what is allowed and advice.
const UNSUPPORTED: [(Section, &str, &str, &str); 4] = [
    (
        Section::Rods,
        "RODS",
        "no rods: snapload's lines run from anchors to points of one body",
        "for a rod fixed to the body add its mass, inertia and volume to those of the body, and write \
         its ends as points of Body1",
    ),
    (
        Section::Failure,
        "FAILURE",
        "no failures: snapload reports whether a line would break, and keeps it",
        "remove the section; give the breaking load as line.1.breaking_load by --set",
    ),
    (
        Section::Control,
        "CONTROL",
        "no control of line lengths",
        "remove the section",
    ),
    (
        Section::Loads,
        "EXTERNAL LOADS",
        "no external loads",
        "remove the section; linear damping is body.linear_damping, given by --set",
    ),
];

/// Refuses sections that are not supported.
pub(super) fn refuse_unsupported(sections: &Sections<'_>) -> Result<(), CaseError> {
    for (section, name, allowed, hint) in UNSUPPORTED {
        if let Some(row) = sections.rows(section).next() {
            return Err(row.refuse(name, "(given)", allowed, hint));
        }
    }
    Ok(())
}

/// The only body; none if points are coupled to one that is not in the file.
pub(super) fn body<'a>(sections: &'a Sections<'a>) -> Result<Option<Body<'a>>, CaseError> {
    let mut rows = sections.rows(Section::Bodies);
    let Some(row) = rows.next() else {
        return Ok(None);
    };
    if let Some(second) = rows.next() {
        let hint = "snapload moors one body; write a file for each, with lines to the ground";
        return Err(second.refuse("ID", "(a further body)", "one body", hint));
    }
    let column = "Attachment";
    let attachment = row.word(1, column)?;
    let lower = attachment.to_lowercase();
    if lower != "free" && !COUPLED.contains(&lower.as_str()) {
        let hint = "snapload's body is free in x, z and rotation";
        return Err(row.refuse(column, attachment, "Free or Coupled", hint));
    }
    let place_m = row.place(2, ["X0", "Y0", "Z0"])?;
    for (index, column) in [(5, "r0"), (6, "p0"), (7, "y0")] {
        let hint = "its rotation at rest is computed";
        row.number(index, column)?;
        row.zero(index, column, "0: the body is drawn upright", hint)?;
    }
    row.zero(
        9,
        "CG",
        "0: one centre of mass, buoyancy and added mass",
        "if one centre is accurate enough, move the body's origin there: add CG to Z0, and subtract CG from the z of its \
         points",
    )?;
    Ok(Some(Body { row, place_m }))
}

/// The points by their numbers.
pub(super) fn points<'a>(
    sections: &'a Sections<'a>,
    body: Option<&Body<'_>>,
) -> Result<Points<'a>, CaseError> {
    let mut points = BTreeMap::new();
    for row in sections.rows(Section::Points) {
        let id = row.word(0, "ID")?;
        if points.contains_key(id) {
            return Err(row.refuse("ID", id, "a number that no other point has", ""));
        }
        let point = point(row, body)?;
        refuse_own_properties(row)?;
        points.insert(id, (row, point));
    }
    Ok(points)
}

/// Refuses mass, volume, drag and forces of a point. Rows that are too short are left to MoorDyn to
/// refuse.
fn refuse_own_properties(row: &Row<'_>) -> Result<(), CaseError> {
    // MoorDyn takes a longer row as one in which a force stands before CdA.
    let columns: &[&str] = match row.words.len() < COLUMNS_WITH_FORCE {
        true => &["Mass", "Volume", "CdA"],
        false => &["Mass", "Volume", "Fx", "Fy", "Fz", "CdA"],
    };
    let mut given = columns.iter().zip(row.words.iter().skip(5));
    if let Some((column, word)) = given.find(|(_, word)| number(word) != Some(0.0)) {
        let (allowed, hint) = match column.starts_with('F') {
            true => (
                "0: no force acts on a point; in a row of twelve columns and more Fx, Fy and Fz stand \
                 before CdA",
                "give a force on the centre of the body as body.constant_force by --set; a comment \
                 begins with !",
            ),
            false => (
                "0: points have no mass, volume or drag",
                "add mass and volume of a point on the body to those of the body",
            ),
        };
        return Err(row.refuse(column, word, allowed, hint));
    }
    Ok(())
}

fn point(row: &Row<'_>, body: Option<&Body<'_>>) -> Result<Point, CaseError> {
    let attachment = row.word(1, "Attachment")?;
    let own = row.place(2, ["X", "Y", "Z"])?;
    let lower = attachment.to_lowercase();
    let number = lower
        .strip_prefix("body")
        .or_else(|| lower.strip_prefix('b'));
    let refuse = |allowed: &str, hint| Err(row.refuse("Attachment", attachment, allowed, hint));
    let is_coupled = lower == "fairlead" || COUPLED.contains(&lower.as_str());
    let (attached_to, place_m) = match (lower.as_str(), number, body) {
        ("fixed" | "fix" | "anchor" | "body0", ..) => (PointOf::Ground, own),
        (_, _, None) if is_coupled => (PointOf::Body, own),
        (_, Some(number), Some(body)) if body.row.words.first() == Some(&number) => {
            (PointOf::Body, [0, 1, 2].map(|i| body.place_m[i] + own[i]))
        }
        (_, Some(_), Some(body)) => {
            let allowed = format!("Fixed or Body{}", body.row.words[0]);
            return refuse(&allowed, "each Body has a row in the section BODIES");
        }
        (_, Some(_), None) => {
            let allowed = "Fixed, or Coupled where the file has no section BODIES";
            return refuse(allowed, "each Body has a row in the section BODIES");
        }
        _ => {
            let hint = match is_coupled {
                true => "in a file with a section BODIES the body moves, and its points with it",
                false => {
                    "a free point, such as a joint or a clump, is not supported: lines run from the \
                     ground straight to the body"
                }
            };
            return refuse("Fixed (the ground) or Body1 (the body)", hint);
        }
    };
    Ok(Point {
        attached_to,
        place_m,
    })
}

/// Refuses objects outside the plane of the others, y = const.
pub(super) fn refuse_off_plane<'a>(
    body: Option<&Body<'_>>,
    used: impl Iterator<Item = &'a (&'a Row<'a>, Point)>,
) -> Result<(), CaseError> {
    let mut plane = body.map(|body| body.place_m[1]);
    for (row, point) in used {
        let y = point.place_m[1];
        let of = *plane.get_or_insert(y);
        if (y - of).abs() > OFF_PLANE_M {
            let allowed = format!("y = {of}, where the others are: one vertical plane y = const");
            let hint = "snapload computes motion in the x-z plane; keep the lines of one plane, or \
                        turn the file so that its plane is y = const";
            return Err(row.refuse("Y", y, &allowed, hint));
        }
    }
    Ok(())
}
