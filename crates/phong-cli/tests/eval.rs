//! `phong eval` as a program: what goes in, what comes out, and the exit code.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

use assert_cmd::prelude::*;

fn phong_eval() -> Command {
    let mut command = Command::cargo_bin("phong").unwrap();
    command.arg("eval");
    command
}

/// Standard output and the exit code for `lines` on standard input.
fn answers(lines: &str) -> (String, i32) {
    let mut child = phong_eval().stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(lines.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    (String::from_utf8(output.stdout).unwrap(), output.status.code().unwrap())
}

const GOOD: &str = r#"{"id": "x1", "model": "phong_spec", "N": [0,0,1], "L": [0.6,0,0.8], "E": [0,0,1], "params": {"alpha": 5}}"#;
const BAD: &str = r#"{"id": "x2", "model": "lambert", "N": [0,0,1], "L": [0,0,2]}"#;

#[test]
fn good_queries_have_values_and_exit_code_0() {
    let (out, code) = answers(&format!("{GOOD}\n{GOOD}\n"));
    assert_eq!(out, "{\"id\": \"x1\", \"value\": 0.32768002}\n".repeat(2));
    assert_eq!(code, 0);
}

#[test]
fn a_grain_along_the_normal_is_no_grain() {
    let (out, code) = answers(
        r#"{"id": 1, "model": "ward_brdf", "N": [0,0,1], "L": [0.6,0,0.8], "E": [0,0,1],
            "params": {"ks": 0.5, "ax": 0.1, "ay": 0.3, "X": [0,0,-1]}}"#
            .replace('\n', " ")
            .as_str(),
    );
    assert!(out.contains("X is along N"), "{out}");
    assert_eq!(code, 2);
}

#[test]
fn one_bad_query_is_exit_code_2_and_all_are_answered() {
    let (out, code) = answers(&format!("{GOOD}\n{BAD}\n{GOOD}"));
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[1], r#"{"id": "x2", "error": "L is not a unit vector: its length is 2"}"#);
    assert_eq!(lines[2], lines[0]);
    assert_eq!(code, 2);
}

#[test]
fn no_queries_are_no_answers_and_no_error() {
    assert_eq!(answers(""), (String::new(), 0));
}

#[test]
fn a_query_is_answered_before_the_next_is_asked() {
    let mut child = phong_eval().stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut queries = child.stdin.take().unwrap();
    let mut answers = BufReader::new(child.stdout.take().unwrap()).lines();
    for _ in 0..3 {
        writeln!(queries, "{GOOD}").unwrap();
        queries.flush().unwrap();
        assert_eq!(answers.next().unwrap().unwrap(), r#"{"id": "x1", "value": 0.32768002}"#);
    }
    drop(queries);
    assert!(child.wait().unwrap().success());
}

#[test]
fn a_reader_that_has_had_enough_is_no_error() {
    let mut child = phong_eval()
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut queries = child.stdin.take().unwrap();
    // The program may be gone before all are written.
    let _ = queries.write_all(format!("{GOOD}\n").repeat(5000).as_bytes());
    drop(queries);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty());
}

#[test]
fn an_answer_has_its_id_whatever_cannot_be_read() {
    let far = GOOD.replace("\"alpha\": 5", "\"alpha\": 1e999");
    let behind = r#"{"model": "lambert", "N": [0,0,NaN], "L": [0,0,1], "id": 3}"#;
    let twice = GOOD.replace("\"alpha\": 5", "\"alpha\": 5, \"alpha\": 6");
    let (out, code) = answers(&format!("{far}\n{behind}\n{twice}\n{GOOD}\n"));
    let lines: Vec<serde_json::Value> =
        out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    for (line, (id, told)) in lines.iter().zip([
        (serde_json::json!("x1"), "all must be finite"),
        (serde_json::json!(3), "NaN is not a number"),
        (serde_json::json!("x1"), "the key \"alpha\" stands twice"),
    ]) {
        assert_eq!(line["id"], id, "{line}");
        assert!(line["error"].as_str().unwrap().contains(told), "{line}");
    }
    assert_eq!((lines.len(), lines[3]["value"].is_f64(), code), (4, true, 2));
}

#[test]
#[cfg(unix)]
fn a_folder_is_no_list_of_queries() {
    let folder = std::fs::File::open(env!("CARGO_MANIFEST_DIR")).unwrap();
    let output = phong_eval().stdin(folder).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(
        told.contains("standard input: it is a folder") && !told.contains("os error"),
        "{told}"
    );
}
