//! The tables `[project]` and `[design]`.

use crate::structure::{DesignRule, Project};
use snapload::{CaseError, Entries, Fields};

/// The head of a note.
pub(super) fn read_project(entries: &Entries) -> Result<Project, CaseError> {
    if entries.count("project") == 0 {
        return Ok(Project::default());
    }
    let fields = entries.table("project", 0);
    let text = |key| Ok(fields.get::<String>(key)?.unwrap_or_default());
    Ok(Project {
        name: text("name")?,
        client: text("client")?,
        author: text("author")?,
        date: text("date")?,
    })
}

/// The checks whose factors are given; factors that belong together have to be given together.
pub(super) fn read_design(entries: &Entries) -> Result<DesignRule, CaseError> {
    if entries.count("design") == 0 {
        return Ok(DesignRule::default());
    }
    let fields = entries.table("design", 0);
    let given = |key| fields.get::<f64>(key);
    if let Some(value) = fields
        .given("force_share")
        .filter(|_| entries.count("float") > 0)
    {
        let allowed =
            "nothing beside [float], as waves act on a floating body through its waterplane";
        return Err(fields
            .refuse("force_share", value, allowed)
            .with_hint("leave it out; least_share and the factors check the lines' tensions"));
    }
    Ok(DesignRule {
        strength: together(fields, DesignRule::STRENGTH)?,
        least_share: given("least_share")?,
        least_factors: together(fields, DesignRule::LEAST)?,
        force_share: given("force_share")?,
    })
}

/// Values that are either all given or none.
fn together<const N: usize>(
    fields: Fields<'_>,
    keys: [&'static str; N],
) -> Result<Option<[f64; N]>, CaseError> {
    let mut values = [None; N];
    for (value, key) in values.iter_mut().zip(keys) {
        *value = fields.get::<f64>(key)?;
    }
    let missing = (0..N).find(|&k| values[k].is_none());
    match missing {
        Some(k) if values.iter().any(Option::is_some) => {
            let allowed = format!("a value, as {} must be given together", keys.join(", "));
            Err(fields.refuse(keys[k], "(left out)", allowed))
        }
        Some(_) => Ok(None),
        None => Ok(Some(values.map(Option::unwrap_or_default))),
    }
}
