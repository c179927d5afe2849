//! The page as static files, which any web server serves: a module of WebAssembly is in it in place
//! of the studio's own server.
//!
//! Every address in it is relative, so that it works in any folder; its policy lets it load nothing
//! from elsewhere; and a service worker keeps it for when there is no network.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io;
use std::sync::{Mutex, PoisonError};

use phong::scene::{Blob, Diagnostic, Limits, Memory, NamedLook, Source, read};
use serde_json::{Value, json};
use thiserror::Error;

use crate::engine::{EXAMPLE, EXAMPLE_NAME};
use crate::page;

/// What has to be there beside the page's own files: the module, the rest of it, which few scenes need and is
/// fetched for them, and the script that loads it. `.ci/wasm` makes them.
pub const MODULES: [&str; 3] = ["phong-simd.js", "phong-simd_bg.wasm", "phong-simd_rest.wasm"];

/// The same without vector instructions, for browsers that have none. May be left out.
pub const PLAIN_MODULES: [&str; 3] =
    ["phong-plain.js", "phong-plain_bg.wasm", "phong-plain_rest.wasm"];

/// What the page may do, as a header of the studio's server says it too.
const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; \
    img-src 'self' blob: data:; connect-src 'self'; worker-src 'self'; base-uri 'self'; form-action 'none'";

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SiteFile {
    /// Its path in the folder, with `/`.
    pub path: String,
    /// All of it.
    pub bytes: Vec<u8>,
}

/// Why there is no such folder.
#[derive(Clone, Debug, Error)]
pub enum SiteError {
    /// A scene cannot be drawn: what there is to say about it.
    #[error("a scene cannot be drawn")]
    Scene(Vec<Diagnostic>),
    /// A file of the scenes has a name that leaves the folder.
    #[error("{0} lies outside the folder of the scene: what the page reads has to lie in it")]
    Outside(String),
}

/// Everything in the folder but the `modules`, of which the names are given: the page, these scenes and
/// models, and what they read. The first scene is opened first; where there is none, one of the studio's. The look
/// is put on it then.
///
/// # Errors
/// [`SiteError`].
pub fn files(
    scenes: &[String],
    source: &dyn Source,
    limits: &Limits,
    modules: &[&str],
    look: Option<NamedLook>,
) -> Result<Vec<SiteFile>, SiteError> {
    let own = Memory::new().with(EXAMPLE_NAME, EXAMPLE.as_bytes());
    let example = [EXAMPLE_NAME.to_owned()];
    let (scenes, source) =
        if scenes.is_empty() { (&example[..], &own as &dyn Source) } else { (scenes, source) };
    let read_files = Recorder { source, taken: Mutex::default() };
    for scene in scenes {
        let reading = read(scene, None, &read_files, limits);
        if reading.scene.is_none() {
            return Err(SiteError::Scene(reading.diagnostics));
        }
    }
    let taken = read_files.taken.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut files: Vec<SiteFile> = page::FILES.iter().map(static_file).collect();
    let mut known = serde_json::Map::new();
    for (path, bytes) in taken {
        let is_outside = |part: &str| part == ".." || part.is_empty();
        if path.split('/').any(is_outside) || path.contains(['\\', ':']) {
            return Err(SiteError::Outside(path));
        }
        let (length, hidden) = (bytes.len(), !scenes.contains(&path));
        known.insert(path.clone(), json!({ "bytes": length, "hidden": hidden }));
        files.push(SiteFile { path: format!("scenes/{path}"), bytes });
    }
    let all = files.iter().map(|file| file.path.clone());
    let all = all.chain(modules.iter().map(|&name| name.to_owned()));
    let all: Vec<Value> = all.map(Value::from).collect();
    let list = json!({ "open": scenes[0], "scenes": known, "files": all, "look": look.map(NamedLook::name) });
    files.push(SiteFile { path: "files.json".to_owned(), bytes: list.to_string().into_bytes() });
    Ok(files)
}

/// A file of the page as it is without a server.
fn static_file(file: &page::PageFile) -> SiteFile {
    let path = file.name.to_owned();
    if file.name != "index.html" {
        return SiteFile { path, bytes: file.bytes.to_vec() };
    }
    // The module is what takes longest: it is asked for first. Then all scripts at once, and not each when another
    // that needs it is there.
    let mut head = format!(
        "<meta charset=\"utf-8\">\n    <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n    \
         <script type=\"module\" async src=\"module.js\"></script>"
    );
    let later = ["module.js", "worker.js", "offline.js"];
    let scripts = page::FILES.iter().filter(|file| file.media_type.starts_with("text/javascript"));
    for script in scripts.filter(|file| !later.contains(&file.name)) {
        // Writing to a string does not fail.
        let _ = write!(head, "\n    <link rel=\"modulepreload\" href=\"{}\">", script.name);
    }
    let text = String::from_utf8_lossy(file.bytes)
        .replacen("data-engine=\"server\"", "data-engine=\"worker\"", 1)
        .replacen("<meta charset=\"utf-8\">", &head, 1);
    SiteFile { path, bytes: text.into_bytes() }
}

/// Remembers what is read.
#[derive(Debug)]
struct Recorder<'a> {
    source: &'a dyn Source,
    taken: Mutex<BTreeMap<String, Vec<u8>>>,
}

impl Source for Recorder<'_> {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let blob = self.source.open(path)?;
        let mut bytes = vec![0; blob.len() as usize];
        let length = blob.read_full(&mut bytes, 0)?;
        bytes.truncate(length);
        self.taken.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned(), bytes);
        Ok(blob)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
        [[mesh]]\nfile = \"parts/one.off\"\n";
    const MODEL: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

    fn shelf() -> Memory {
        let unread = "never asked for";
        let shelf = Memory::new().with("a.toml", SCENE).with("parts/one.off", MODEL);
        shelf.with("secret.txt", unread)
    }

    fn list(files: &[SiteFile]) -> Value {
        let list = files.iter().find(|file| file.path == "files.json").unwrap();
        serde_json::from_slice(&list.bytes).unwrap()
    }

    #[test]
    fn a_scene_comes_with_the_files_that_it_reads_and_no_others() {
        let files =
            files(&["a.toml".to_owned()], &shelf(), &Limits::default(), &MODULES, None).unwrap();
        let paths: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
        assert!(paths.contains(&"scenes/a.toml") && paths.contains(&"scenes/parts/one.off"));
        assert!(!paths.iter().any(|path| path.contains("secret")), "{paths:?}");
        let list = list(&files);
        assert_eq!(list["open"], "a.toml");
        assert_eq!(list["scenes"]["parts/one.off"]["hidden"], true);
        assert_eq!(list["scenes"]["a.toml"]["bytes"], SCENE.len());
    }

    #[test]
    fn the_page_is_told_of_its_worker_and_may_load_nothing_from_elsewhere() {
        let files = files(&[], &Memory::new(), &Limits::default(), &MODULES, None).unwrap();
        assert_eq!(list(&files)["open"], EXAMPLE_NAME);
        let page = files.iter().find(|file| file.path == "index.html").unwrap();
        let page = String::from_utf8(page.bytes.clone()).unwrap();
        assert!(page.contains("data-engine=\"worker\"") && page.contains("'wasm-unsafe-eval'"));
        assert!(page.find("async src=\"module.js\"") < page.find("href=\"studio.js\""));
        assert!(!page.contains("href=\"worker.js\""));
        let is_script =
            |path: &str| path.rsplit_once('.').is_some_and(|(_, ending)| ending == "js");
        for file in files.iter().filter(|file| is_script(&file.path)) {
            let text = String::from_utf8(file.bytes.clone()).unwrap();
            assert!(!text.contains("https://"), "{}", file.path);
        }
    }

    #[test]
    fn a_scene_that_cannot_be_drawn_or_leaves_its_folder_is_refused() {
        let broken = Memory::new().with("a.toml", "version = 1\n[[sphere]]\n");
        let said =
            files(&["a.toml".to_owned()], &broken, &Limits::default(), &MODULES, None).unwrap_err();
        assert!(matches!(said, SiteError::Scene(diagnostics) if !diagnostics.is_empty()));
        let scene = SCENE.replace("parts/one.off", "../one.off");
        let above = Memory::new().with("a.toml", scene).with("../one.off", MODEL);
        let said =
            files(&["a.toml".to_owned()], &above, &Limits::default(), &MODULES, None).unwrap_err();
        assert!(matches!(said, SiteError::Outside(path) if path == "../one.off"));
    }
}
