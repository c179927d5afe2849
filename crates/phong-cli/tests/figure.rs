//! `phong figure`, as typed.

use std::fs;

use assert_cmd::Command;

fn phong(folder: &tempfile::TempDir, words: &[&str]) -> Command {
    let mut command = Command::cargo_bin("phong").expect("the program is built");
    command.current_dir(folder).args(words);
    command
}

#[test]
fn without_a_name_it_lists_the_figures_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let answer = phong(&folder, &["figure"]).assert().success();
    let words = String::from_utf8(answer.get_output().stdout.clone()).unwrap();
    let names: Vec<&str> = words.lines().filter_map(|line| line.split(' ').next()).collect();
    let wanted = "normal vectors shading ambient diffuse scattering cosine specular reflection \
                  shininess grid halfway peak speed blinn terms examples sky microfacets";
    assert_eq!(names, wanted.split(' ').collect::<Vec<_>>());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_figure_is_written_as_svg_and_png_and_twice_the_same() {
    let folder = tempfile::tempdir().unwrap();
    phong(&folder, &["figure", "cosine"]).assert().success().stdout("");
    phong(&folder, &["figure", "cosine", "-d", "a/b"]).assert().success();
    for name in ["cosine.svg", "cosine.png"] {
        let [first, second] =
            ["figures", "a/b"].map(|at| fs::read(folder.path().join(at).join(name)));
        let (first, second) = (first.unwrap(), second.unwrap());
        assert!(first == second, "{name} differs");
        let start: &[u8] = if name.ends_with("svg") { b"<svg " } else { b"\x89PNG\r\n" };
        assert!(first.starts_with(start), "{name}");
    }
    assert_eq!(fs::read_dir(folder.path().join("figures")).unwrap().count(), 2);
}

#[test]
fn a_figure_takes_parameters_and_refuses_those_it_has_no_use_for() {
    let folder = tempfile::tempdir().unwrap();
    let svg = |words: &[&str]| {
        phong(&folder, words).assert().success();
        fs::read_to_string(folder.path().join("figures/cosine.svg")).unwrap()
    };
    assert!(svg(&["figure", "cosine", "--theta", "50"]).contains(" = 50°"));
    assert!(svg(&["figure", "cosine", "--dark"]).contains("#15181c"));
    for (words, told) in [
        (["cosine", "--alpha", "5"], "the figure cosine has no --alpha"),
        (["cosine", "--theta", "89"], "from 5 to 80"),
        (["terms", "--color", "black"], "--color"),
    ] {
        let answer = phong(&folder, &["figure"]).args(words).assert().code(2);
        let said = String::from_utf8(answer.get_output().stderr.clone()).unwrap();
        assert!(said.contains(told), "{said}");
    }
}

#[test]
fn a_name_that_is_nearly_right_is_answered_with_the_right_one() {
    let folder = tempfile::tempdir().unwrap();
    let answer = phong(&folder, &["figure", "shinyness"]).assert().code(2).stdout("");
    let words = String::from_utf8(answer.get_output().stderr.clone()).unwrap();
    assert!(words.contains("a similar value exists: 'shininess'"), "{words}");
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_folder_that_cannot_be_made_is_said_by_name() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    let answer = phong(&folder, &["figure", "cosine", "-d", "file"]).assert().code(2);
    let words = String::from_utf8(answer.get_output().stderr.clone()).unwrap();
    assert!(words.contains("cannot make the folder file"), "{words}");
}
