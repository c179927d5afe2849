//! `phong fit` as a program.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use std::fs;
use std::process::{Command, Output};

use assert_cmd::prelude::*;

fn phong_fit(folder: &tempfile::TempDir, args: &[&str]) -> Output {
    let mut command = Command::cargo_bin("phong").unwrap();
    command.current_dir(folder).arg("fit").args(args).output().unwrap()
}

#[test]
fn a_plot_is_written_beside_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    let output = phong_fit(&folder, &["phong:32", "blinn-phong", "--plot", "fit.svg"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout.starts_with(b"phong:32 looks most like blinn-phong:129.3,"));
    let plot = fs::read_to_string(folder.path().join("fit.svg")).unwrap();
    assert!(plot.starts_with("<svg ") && plot.ends_with("</svg>\n"));
}

#[test]
fn a_plot_on_standard_output_is_alone_there() {
    let folder = tempfile::tempdir().unwrap();
    let output = phong_fit(&folder, &["phong:32", "ggx", "--plot", "-"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout.starts_with(b"<svg ") && output.stdout.ends_with(b"</svg>\n"));
}

#[test]
fn what_is_no_model_is_exit_code_2_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let output = phong_fit(&folder, &["fong:32", "ggx", "--plot", "fit.svg"]);
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("no model `fong`") && told.contains("did you mean `phong`?"), "{told}");
    assert!(output.stdout.is_empty());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_plot_that_cannot_be_written_is_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let output = phong_fit(&folder, &["phong:32", "ggx", "--plot", "nowhere/fit.svg"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("nowhere/fit.svg"));
}
