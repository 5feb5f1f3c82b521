//! What certificates must hold, by the authority that each agrees with.
mod alterations;
mod borders;
mod common;
mod grazes;
mod oracle;
mod taut;
