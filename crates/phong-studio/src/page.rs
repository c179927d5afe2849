//! The page: its files as they are, whoever serves or writes them.

/// A file of the page.
#[derive(Clone, Copy, Debug)]
pub struct PageFile {
    /// Its name, as the page asks for it.
    pub name: &'static str,
    /// Its media type.
    pub media_type: &'static str,
    /// All of it.
    pub bytes: &'static [u8],
}

macro_rules! page_files {
    ($($name:literal $media_type:literal),* $(,)?) => {
        /// Every file of the page, the page itself first.
        pub const FILES: &[PageFile] = &[$(PageFile {
            name: $name,
            media_type: $media_type,
            bytes: include_bytes!(concat!("../page/", $name)),
        }),*];
    };
}

page_files! {
    "index.html" "text/html; charset=utf-8",
    "studio.css" "text/css; charset=utf-8",
    "picture.css" "text/css; charset=utf-8",
    "studio.js" "text/javascript; charset=utf-8",
    "words.js" "text/javascript; charset=utf-8",
    "engine.js" "text/javascript; charset=utf-8",
    "frame.js" "text/javascript; charset=utf-8",
    "module.js" "text/javascript; charset=utf-8",
    "workers.js" "text/javascript; charset=utf-8",
    "worker.js" "text/javascript; charset=utf-8",
    "offline.js" "text/javascript; charset=utf-8",
    "picture.js" "text/javascript; charset=utf-8",
    "controls.js" "text/javascript; charset=utf-8",
    "file.js" "text/javascript; charset=utf-8",
    "explained.js" "text/javascript; charset=utf-8",
    "editor.js" "text/javascript; charset=utf-8",
    "completion.js" "text/javascript; charset=utf-8",
    "compare.js" "text/javascript; charset=utf-8",
    "curtain.js" "text/javascript; charset=utf-8",
    "elements.js" "text/javascript; charset=utf-8",
    "handles.js" "text/javascript; charset=utf-8",
    "hands.js" "text/javascript; charset=utf-8",
    "history.js" "text/javascript; charset=utf-8",
    "keys.js" "text/javascript; charset=utf-8",
    "lobe.js" "text/javascript; charset=utf-8",
    "looks.js" "text/javascript; charset=utf-8",
    "saving.js" "text/javascript; charset=utf-8",
    "teaching.js" "text/javascript; charset=utf-8",
    "whatif.js" "text/javascript; charset=utf-8",
}

/// The file of this name.
#[must_use]
pub fn file(name: &str) -> Option<&'static PageFile> {
    FILES.iter().find(|file| file.name == name)
}
