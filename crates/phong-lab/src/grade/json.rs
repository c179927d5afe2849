//! A grade for programs.

use serde_json::{Value, json};

use super::Grade;

/// The grade as one JSON object; `size` is that of the picture, width and height.
pub fn json(graded: &Grade, size: [u32; 2]) -> Value {
    let candidates: Vec<Value> = graded
        .candidates
        .iter()
        .map(|one| {
            json!({
                "cause": one.cause,
                "says": one.says,
                "evidence": one.evidence,
                "rms": one.rms,
                "explains": one.explains,
            })
        })
        .collect();
    let terms: serde_json::Map<String, Value> =
        graded.terms.iter().map(|(name, factor)| ((*name).clone(), json!(factor))).collect();
    json!({
        "verdict": if graded.pass { "pass" } else { "fail" },
        "size": size,
        "cause": graded.cause,
        "tied": graded.tied,
        "told_apart_by": graded.told_apart_by,
        "confidence": graded.confidence,
        "candidates": candidates,
        "unrevealed": graded.unrevealed,
        "objects": graded.objects,
        "terms": terms,
        "rms": graded.residual.rms,
        "worst": { "difference": graded.residual.worst, "at": graded.residual.worst_at },
        "share_noticed": graded.residual.over,
        "pixels_compared": graded.residual.pixels,
    })
}
