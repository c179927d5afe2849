//! A fit for programs.

use serde_json::{Value as Json, json};

use super::{Fit, Lobe};

/// The fit as one JSON object.
pub fn json(fit: &Fit) -> Json {
    let lobe =
        |lobe: &Lobe| json!({"model": lobe.model.name(), lobe.model.quantity(): lobe.number});
    let angles: Vec<Json> = fit
        .angles
        .iter()
        .map(|at| {
            json!({
                "theta": at.theta,
                "residual": {"in_plane": at.residual.in_plane, "across": at.residual.across},
                "half_width": {
                    "from": {"in_plane": at.half_width_from[0], "across": at.half_width_from[1]},
                    "to": {"in_plane": at.half_width_to[0], "across": at.half_width_to[1]},
                },
                "best_alone": {"in_plane": at.best_alone[0], "across": at.best_alone[1]},
            })
        })
        .collect();
    let in_use: Vec<Json> = fit
        .in_use
        .iter()
        .map(|use_| json!({"source": use_.source, "formula": use_.text, "roughness": use_.roughness}))
        .collect();
    json!({
        "from": lobe(&fit.from),
        "to": lobe(&fit.to),
        "formula": fit.formula.map(|formula| formula.value),
        "formula_text": fit.formula.map(|formula| formula.text),
        "residual": {"in_plane": fit.residual.in_plane, "across": fit.residual.across},
        "at_the_end": fit.at_the_end,
        "angles": angles,
        "in_use": in_use,
    })
}
