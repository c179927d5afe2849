//! The formulas of reflectance, held to an oracle in f64 that shares no code with them, to
//! reciprocity, and to their energy.

#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

mod agreement;
mod albedo;
mod dialects;
mod directions;
mod energy;
mod oracle;
mod written;
