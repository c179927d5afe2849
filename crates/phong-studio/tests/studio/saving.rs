//! The text saved in its file, and a file that somebody else changes.

use std::fs;
use std::path::Path;

use phong_studio::engine::{Bounds, EXAMPLE_NAME, Engine};
use phong_studio::folder::Shelf;
use serde_json::json;
use tempfile::TempDir;

use crate::SCENE;
use crate::client::Page;
use crate::engine::Talk;

/// A page of the server on a folder with a scene in it.
fn page(folder: &Path, open: &str) -> Talk {
    let own = (open != EXAMPLE_NAME).then(|| open.to_owned());
    let shelf = Shelf::new(folder, own).unwrap();
    let engine = Engine::new(shelf.clone(), Bounds::default()).with_keeper(shelf);
    let mut talk = Talk { engine, page: Page::default(), stops: false };
    talk.ask(&json!({ "do": "open", "path": open }));
    talk
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), SCENE).unwrap();
    folder
}

fn changed() -> String {
    SCENE.replace("shininess = 60", "shininess = 61")
}

fn error(talk: &Talk) -> &str {
    talk.page.last("error")["message"].as_str().unwrap()
}

#[test]
fn a_text_is_saved_in_its_file_and_nothing_else_is_left_there() {
    let folder = folder();
    let mut talk = page(folder.path(), "a.toml");
    talk.ask(&json!({ "do": "edit", "text": changed() }));
    talk.ask(&json!({ "do": "save" }));
    assert_eq!(talk.page.last("saved")["path"], "a.toml");
    assert_eq!(fs::read_to_string(folder.path().join("a.toml")).unwrap(), changed());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    // It is the text of the file now: saved again, it is no change of somebody else's.
    talk.ask(&json!({ "do": "edit", "text": SCENE }));
    talk.ask(&json!({ "do": "check-file" }));
    talk.ask(&json!({ "do": "save" }));
    assert!(talk.page.all("file-changed").is_empty());
    assert_eq!(fs::read_to_string(folder.path().join("a.toml")).unwrap(), SCENE);
    // The studio's own scene becomes a file.
    let mut talk = page(folder.path(), EXAMPLE_NAME);
    talk.ask(&json!({ "do": "save" }));
    assert!(folder.path().join(EXAMPLE_NAME).is_file(), "{:?}", talk.page.replies);
}

#[test]
fn what_somebody_else_has_written_is_not_written_over_without_asking() {
    let folder = folder();
    let file = folder.path().join("a.toml");
    let mut talk = page(folder.path(), "a.toml");
    talk.ask(&json!({ "do": "edit", "text": changed() }));
    let theirs = SCENE.replace("shininess = 60", "shininess = 5");
    fs::write(&file, &theirs).unwrap();
    talk.ask(&json!({ "do": "save" }));
    assert_eq!(
        talk.page.last("file-changed"),
        &json!({ "is": "file-changed", "path": "a.toml", "gone": false })
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), theirs);
    assert!(talk.page.all("saved").is_empty());
    // Theirs is taken; then nothing is changed any more.
    talk.ask(&json!({ "do": "take-file" }));
    let text = talk.page.last("text");
    assert_eq!((text["text"].as_str(), &text["from_file"]), (Some(&*theirs), &json!(true)));
    assert_eq!(talk.page.last("look")["values"]["materials"]["plastic"]["shininess"], 5);
    let told = talk.page.all("file-changed").len();
    talk.ask(&json!({ "do": "check-file" }));
    assert_eq!(talk.page.all("file-changed").len(), told);
    // Or ours is written all the same, even where the file is gone.
    fs::remove_file(&file).unwrap();
    talk.ask(&json!({ "do": "check-file" }));
    assert_eq!(talk.page.last("file-changed")["gone"], true);
    talk.ask(&json!({ "do": "save", "over": true }));
    assert_eq!(fs::read_to_string(&file).unwrap(), theirs);
}

#[test]
fn a_text_that_the_engine_has_not_taken_is_not_said_to_be_saved() {
    let folder = folder();
    let mut talk = page(folder.path(), "a.toml");
    let long = "#".repeat(Bounds::TEXT as usize + 1);
    talk.ask(&json!({ "do": "edit", "text": long }));
    talk.ask(&json!({ "do": "save", "text": long, "over": true }));
    assert_eq!(error(&talk), "a.toml is not saved: the text of the page was not taken");
    assert!(talk.page.all("saved").is_empty());
    talk.ask(&json!({ "do": "edit", "text": changed() }));
    talk.ask(&json!({ "do": "save", "text": changed() }));
    assert_eq!(talk.page.all("saved").len(), 1);
    assert_eq!(fs::read_to_string(folder.path().join("a.toml")).unwrap(), changed());
}

#[test]
fn what_cannot_be_saved_says_why() {
    let mut talk = Talk::of(SCENE);
    talk.ask(&json!({ "do": "save" }));
    assert!(error(&talk).contains("no folder"), "{}", error(&talk));
    let folder = folder();
    fs::write(folder.path().join("m.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap();
    let mut talk = page(folder.path(), "m.off");
    talk.ask(&json!({ "do": "save" }));
    assert!(error(&talk).contains("no text to save"), "{}", error(&talk));
    let file = folder.path().join("a.toml");
    let mut rights = fs::metadata(&file).unwrap().permissions();
    rights.set_readonly(true);
    fs::set_permissions(&file, rights).unwrap();
    let mut talk = page(folder.path(), "a.toml");
    talk.ask(&json!({ "do": "edit", "text": changed() }));
    talk.ask(&json!({ "do": "save" }));
    assert_eq!(error(&talk), "cannot write a.toml: it is write-protected");
    assert_eq!(fs::read_to_string(&file).unwrap(), SCENE);
}

#[cfg(unix)]
#[test]
fn a_link_is_written_through_within_the_folder_and_never_out_of_it() {
    use std::os::unix::fs::symlink;

    let outside = folder();
    let folder = folder();
    symlink("a.toml", folder.path().join("inner.toml")).unwrap();
    let mut talk = page(folder.path(), "inner.toml");
    talk.ask(&json!({ "do": "edit", "text": changed() }));
    talk.ask(&json!({ "do": "save" }));
    assert!(folder.path().join("inner.toml").is_symlink());
    assert_eq!(fs::read_to_string(folder.path().join("a.toml")).unwrap(), changed());
    // A file that becomes a link out of the folder while it is open, to a file or to none.
    for target in ["a.toml", "none.toml"] {
        fs::remove_file(folder.path().join("inner.toml")).unwrap();
        symlink(outside.path().join(target), folder.path().join("inner.toml")).unwrap();
        talk.ask(&json!({ "do": "save", "over": true }));
        assert!(error(&talk).starts_with("cannot write inner.toml: "), "{}", error(&talk));
    }
    assert_eq!(fs::read_to_string(outside.path().join("a.toml")).unwrap(), SCENE);
    assert_eq!(fs::read_dir(outside.path()).unwrap().count(), 1);
}
