//! Paths between files.

use std::path::{Component, Path, PathBuf};

/// `file` as it is written in the file at `path`: relative to that one's folder.
pub(super) fn join(path: &str, file: &str) -> String {
    let folder = Path::new(path).parent().unwrap_or(Path::new(""));
    folder.join(file).to_string_lossy().into_owned()
}

/// A path without `.` and, where that can be told from the path alone, `..`.
pub(super) fn normal(path: &str) -> String {
    let mut normal = PathBuf::new();
    for part in Path::new(path).components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir
                if matches!(normal.components().next_back(), Some(Component::Normal(_))) =>
            {
                normal.pop();
            }
            _ => normal.push(part),
        }
    }
    normal.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_relative_to_the_one_that_names_it() {
        assert_eq!(join("scenes/a.toml", "lights/b.toml"), "scenes/lights/b.toml");
        assert_eq!(join("a.toml", "b.toml"), "b.toml");
        assert_eq!(join("scenes/a.toml", "/b.toml"), "/b.toml");
    }

    #[test]
    fn two_ways_to_the_same_file_have_one_normal_path() {
        assert_eq!(normal("./a/../b/./c.toml"), "b/c.toml");
        assert_eq!(normal("../a.toml"), "../a.toml");
        assert_eq!(normal("../../a/../b.toml"), "../../b.toml");
    }
}
