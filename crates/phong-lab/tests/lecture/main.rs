//! The lecture, claim by claim: "Ray Tracing, Part II", Geoffrey Matthews, Western Washington
//! University, 2015. One test an equation or a figure's claim, in the order of the slides:
//! `equations` holds what needs no picture, `pictures` what does.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

mod equations;
mod pictures;
