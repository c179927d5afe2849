//! One model matched to another: which exponent or roughness of B looks most like A.
//!
//! Two answers stand side by side. The *fitted* number makes the two lobes differ least (least
//! squares over all eyes, each lobe 1 at its peak) where light comes in along the normal; the
//! *formula* is what one would work out on paper. Neither is right for all angles: away from the
//! normal the lobes differ in shape, in the plane of incidence otherwise than across it. So the
//! answer comes with what is left, angle by angle.
//!
//! ```
//! use phong_lab::fit::{Lobe, Model, fit};
//! let fit = fit(Lobe::new(Model::Phong, 32.0)?, Model::BlinnPhong)?;
//! assert!((fit.to.number - 129.3).abs() < 0.1); // about four times
//! assert!(fit.residual.in_plane < 0.01 && fit.residual.across > 0.3);
//! # Ok::<(), phong_lab::fit::FitError>(())
//! ```

mod formula;
mod json;
mod lobe;
pub mod plot;
mod search;
mod surface;
#[cfg(test)]
mod tests;

use thiserror::Error;

pub use formula::{Formula, InUse};
pub use json::json;
pub use lobe::{Lobe, Model, Slice};
pub use surface::{Remodelled, Target, remodel};

/// Angles of incidence that the residual is told at, degrees.
pub const ANGLES: [f64; 4] = [0.0, 30.0, 60.0, 75.0];

/// The best match, and what is left.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// A, as given.
    pub from: Lobe,
    /// B, with the fitted number.
    pub to: Lobe,
    /// Whether the fit ran into an end of B's range, so that something beyond it may be better.
    pub at_the_end: bool,
    /// What one would work out on paper; `None` where nobody has.
    pub formula: Option<Formula>,
    /// What is left, over all of [`ANGLES`].
    pub residual: Residual,
    /// The same, angle by angle.
    pub angles: Vec<AtAngle>,
    /// What programs make of A's exponent where they want a roughness; empty where it is none.
    pub in_use: Vec<InUse>,
}

/// What is left of A when B is taken off, as a share of A: the root of the mean square, over eyes
/// in a plane, each lobe 1 at its peak there. 0: the same; 1: as much as A itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Over eyes in the plane of incidence.
    pub in_plane: f64,
    /// Over eyes across it.
    pub across: f64,
}

/// How alike A and B are for light at one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtAngle {
    /// The angle of incidence, degrees.
    pub theta: f64,
    /// What is left.
    pub residual: Residual,
    /// Half the width at half the peak, degrees, of A; in the plane of incidence, and across.
    /// `None` where the lobe is not at half its peak on both sides above the horizon.
    pub half_width_from: [Option<f64>; 2],
    /// The same of B.
    pub half_width_to: [Option<f64>; 2],
    /// B's number that would be best here alone, in the plane of incidence, and across.
    pub best_alone: [f64; 2],
}

/// Why there is no fit: the caller's fault.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FitError {
    /// A name that is no model's.
    #[error("no model `{name}`; there are {}", Model::names())]
    UnknownModel {
        /// What was asked for.
        name: String,
    },
    /// A model without its number.
    #[error("`{model}` needs its {}: `{model}:{}`", model.quantity(), model.example())]
    NoNumber {
        /// The model.
        model: Model,
    },
    /// A number that is none.
    #[error("`{text}` is not a number")]
    NotANumber {
        /// What was given.
        text: String,
    },
    /// A σ of Oren–Nayar that is no angle of a slope.
    #[error("sigma of `oren-nayar` is in degrees, from 0 to 90, not {sigma}")]
    Sigma {
        /// What was given.
        sigma: f64,
    },
    /// A number outside what f32 pictures can show.
    #[error("{} {number} of `{model}` is not between {} and {}", model.quantity(), model.range()[0], model.range()[1])]
    OutOfRange {
        /// The model.
        model: Model,
        /// What was given.
        number: f64,
    },
}

/// Finds the number with which `to` looks most like `from`.
///
/// Deterministic; takes a few hundredths of a second.
///
/// # Errors
/// [`FitError::OutOfRange`], where `from`'s number was changed after [`Lobe::new`] had checked it.
pub fn fit(from: Lobe, to: Model) -> Result<Fit, FitError> {
    let from = Lobe::new(from.model, from.number)?;
    let best = search::best(from, to, 0.0, Slice::InPlane);
    Ok(told(from, Lobe { model: to, number: best.number }, best.at_the_end))
}

/// Holds two lobes against each other as they are, without fitting anything.
///
/// # Errors
/// [`FitError::OutOfRange`], where a number was changed after [`Lobe::new`] had checked it.
pub fn hold(from: Lobe, to: Lobe) -> Result<Fit, FitError> {
    let [from, to] = [Lobe::new(from.model, from.number)?, Lobe::new(to.model, to.number)?];
    Ok(told(from, to, false))
}

fn told(from: Lobe, to: Lobe, at_the_end: bool) -> Fit {
    let angles = ANGLES.map(|theta| at_angle(from, to, theta)).to_vec();
    Fit {
        from,
        to,
        at_the_end,
        formula: formula::formula(from, to.model),
        residual: overall(&angles),
        angles,
        in_use: formula::in_use(from, to.model),
    }
}

fn at_angle(from: Lobe, to: Lobe, theta: f64) -> AtAngle {
    let slices = [Slice::InPlane, Slice::Across];
    let [in_plane, across] = slices.map(|slice| search::residual(from, to, theta, slice));
    AtAngle {
        theta,
        residual: Residual { in_plane, across },
        half_width_from: slices.map(|slice| from.half_width(theta, slice)),
        half_width_to: slices.map(|slice| to.half_width(theta, slice)),
        best_alone: slices.map(|slice| search::best(from, to.model, theta, slice).number),
    }
}

/// The root of the mean square over the angles.
fn overall(angles: &[AtAngle]) -> Residual {
    let over = |part: fn(&Residual) -> f64| {
        let squares = angles.iter().map(|at| part(&at.residual) * part(&at.residual));
        (squares.sum::<f64>() / angles.len() as f64).sqrt()
    };
    Residual { in_plane: over(|r| r.in_plane), across: over(|r| r.across) }
}
