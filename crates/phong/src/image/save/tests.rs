use super::*;
use crate::film::{Film, LayerKind, Window};
use crate::finish::{Finishing, finish};

fn written(path: &Path, text: &[u8]) -> Draft {
    let mut draft = Draft::create(path).unwrap();
    draft.write(|out| out.write_all(text)).unwrap();
    draft
}

/// Every name in a folder.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn where_a_later_name_cannot_be_given_every_file_is_what_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let [out, old, new] = ["out", "old", "new"].map(|name| folder.path().join(name));
    fs::write(&old, b"former").unwrap();
    let drafts = vec![written(&out, b"1"), written(&old, b"2"), written(&new, b"3")];
    // It takes its name last, and by then a folder has it.
    fs::create_dir(&out).unwrap();
    assert!(matches!(place(drafts), Err(SaveError::Io { path, .. }) if path == out));
    assert_eq!(fs::read(&old).unwrap(), b"former");
    assert_eq!(names(folder.path()), ["old", "out"]);
}

#[test]
fn a_former_file_that_cannot_be_kept_twice_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let [out, side] = ["out", "side"].map(|name| folder.path().join(name));
    fs::write(&out, b"former").unwrap();
    let drafts = vec![written(&out, b"1"), written(&side, b"2")];
    fs::create_dir(&side).unwrap();
    assert!(place(drafts).is_err());
    assert_eq!(fs::read(&out).unwrap(), b"former");
    assert_eq!(names(folder.path()), ["out", "side"]);
}

#[test]
fn all_are_placed_and_nothing_else_stays() {
    let folder = tempfile::tempdir().unwrap();
    let [out, side] = ["out", "side"].map(|name| folder.path().join(name));
    fs::write(&side, b"former").unwrap();
    place(vec![written(&out, b"1"), written(&side, b"2")]).unwrap();
    assert_eq!((fs::read(&out).unwrap(), fs::read(&side).unwrap()), (b"1".into(), b"2".into()));
    assert_eq!(names(folder.path()), ["out", "side"]);
}

#[test]
fn what_is_given_up_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    drop(written(&folder.path().join("a"), b"half"));
    let mut draft = Draft::create(&folder.path().join("b")).unwrap();
    let failed = draft.write(|_| Err(WriteError::Unsuitable("no such layer".to_owned())));
    assert!(matches!(failed, Err(SaveError::Unsuitable(why)) if why == "no such layer"));
    drop(draft);
    assert!(names(folder.path()).is_empty());
}

#[test]
fn what_cannot_be_a_file_is_known_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("file"), b"").unwrap();
    fs::create_dir(at("folder")).unwrap();
    let long = "x".repeat(300);
    for (name, why) in [
        ("none/a.png", "no such folder"),
        ("file/a.png", "no folder"),
        ("folder", "it is a folder"),
        ("a.png/", "names no file"),
        (".", "it is a folder"),
        (&*long, "too long"),
    ] {
        let error = Draft::create(&at(name)).unwrap_err();
        assert!(matches!(error, SaveError::Place { .. }), "{name}: {error:?}");
        assert!(error.to_string().contains(why), "{name}: {error}");
    }
    assert_eq!(names(folder.path()), ["file", "folder"]);
}

#[test]
fn a_picture_is_saved_with_a_file_for_each_layer() {
    let folder = tempfile::tempdir().unwrap();
    let depth = LayerKind::Aov(crate::aov::Aov::Depth);
    let film = Film::new([3, 2], Window::full([3, 2]), 16, &[LayerKind::Picture, depth]);
    let picture = finish(&film, &Finishing::default());
    save(&picture, &folder.path().join("a.pfm"), &Encoding::default()).unwrap();
    assert_eq!(names(folder.path()), ["a.depth.pfm", "a.pfm"]);
    let error = save(&picture, &folder.path().join("a.jpeg"), &Encoding::default()).unwrap_err();
    assert!(matches!(error, SaveError::Unsuitable(_)), "{error}");
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};

    use super::*;

    #[test]
    fn a_replaced_file_keeps_its_mode_and_its_owner() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("private");
        for mode in [0o600, 0o640, 0o604] {
            fs::write(&path, b"former").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            // Only root can give a file away; all others own what they replace.
            let given = std::os::unix::fs::chown(&path, Some(4321), Some(4321)).is_ok();
            let draft = written(&path, b"new");
            let temporary = fs::metadata(draft.temporary().unwrap()).unwrap();
            assert_eq!(temporary.mode() & 0o7777, mode, "nobody else could read it meanwhile");
            place(vec![draft]).unwrap();
            let meta = fs::metadata(&path).unwrap();
            assert_eq!(meta.mode() & 0o7777, mode);
            assert_eq!(fs::read(&path).unwrap(), b"new");
            if given {
                assert_eq!((meta.uid(), meta.gid()), (4321, 4321));
                std::os::unix::fs::chown(&path, Some(0), Some(0)).unwrap();
            }
        }
    }

    #[test]
    fn links_are_written_through_even_to_what_is_not_there() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("far")).unwrap();
        symlink("far/real", at("link")).unwrap();
        symlink("link", at("chain")).unwrap();
        for text in ["first", "second"] {
            place(vec![written(&at("chain"), text.as_bytes())]).unwrap();
            assert!(at("chain").is_symlink() && at("link").is_symlink());
            assert_eq!(fs::read_to_string(at("far/real")).unwrap(), text);
        }
        symlink("b", at("a")).unwrap();
        symlink("a", at("b")).unwrap();
        let error = Draft::create(&at("a")).unwrap_err();
        assert!(error.to_string().contains("leads back to itself"), "{error}");
        symlink("nowhere/file", at("lost")).unwrap();
        let error = Draft::create(&at("lost")).unwrap_err();
        assert!(error.to_string().contains("no such folder"), "{error}");
    }

    #[test]
    fn a_file_is_known_under_each_of_its_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("input"), b"").unwrap();
        fs::hard_link(at("input"), at("same")).unwrap();
        symlink("input", at("link")).unwrap();
        for name in ["input", "same", "link"] {
            assert!(Draft::create(&at(name)).unwrap().replaces(&at("input")), "{name}");
        }
        assert!(!Draft::create(&at("other")).unwrap().replaces(&at("input")));
        assert!(!Draft::create(&at("input")).unwrap().replaces(&at("none")));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_the_systems_trouble() {
        let mut draft = Draft::create(Path::new("/dev/full")).unwrap();
        draft.write(|out| out.write_all(b"text")).unwrap();
        assert!(matches!(place(vec![draft]), Err(SaveError::Io { .. })));
    }
}
