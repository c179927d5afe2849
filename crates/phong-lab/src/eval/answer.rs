//! Queries and answers as JSON: what `phong eval` reads and writes, a line each.

use serde_json::Value as Json;

use super::{Value, line, query};

/// The `id` of a query, as one line of JSON, and its value as JSON, or what is wrong with it.
///
/// ```
/// let query = br#"{"id": 1, "model": "cos_power", "params": {"x_deg": 60, "i": 3}}"#;
/// assert_eq!(phong_lab::eval::answer(query), (1.into(), Ok("0.125".to_owned())));
/// ```
pub fn answer(line: &[u8]) -> (Json, Result<String, String>) {
    let line = line.trim_ascii_end();
    if line.is_empty() {
        return (Json::Null, Err("an empty line: every line is one query".to_owned()));
    }
    let mut query = match line::read(line) {
        Ok(Json::Object(query)) => query,
        Ok(_) => return (Json::Null, Err("a query is a JSON object, {\"model\": ..}".to_owned())),
        Err(error) => return (line::id(line), Err(error)),
    };
    let id = query.remove("id").unwrap_or(Json::Null);
    let answer = query::read(&query).and_then(|(query, grey)| {
        let value = query.value().map_err(|error| error.to_string())?;
        Ok(match value {
            Value::Number(number) => digits(number),
            Value::Color(color) if grey => digits(color.r),
            Value::Color(color) => list(color.to_array()),
            Value::Direction(direction) => list(direction.to_array()),
        })
    });
    (id, answer)
}

/// The shortest text that reads back as this very f32.
fn digits(number: f32) -> String {
    // Debug prints 1e-7 where Display would write out the zeros.
    format!("{number:?}")
}

fn list(numbers: [f32; 3]) -> String {
    format!("[{}]", numbers.map(digits).join(", "))
}
