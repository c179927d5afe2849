//! Input that is meant to hurt.

use phong_scene::{Limits, Memory, Reading, read};
use proptest::prelude::*;

fn read_text(text: &str) -> Reading {
    let files = Memory::new().with("a.toml", text.as_bytes());
    read("a.toml", None, &files, &Limits::default())
}

fn assert_sound(reading: &Reading) {
    let wrong = reading.diagnostics.iter().any(phong_scene::Diagnostic::is_error);
    assert_eq!(reading.scene.is_none(), wrong);
    let _ = crate::told::all(&reading.diagnostics); // panics on a mark beyond its excerpt
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn any_text_is_read_without_a_panic(text in any::<String>()) {
        assert_sound(&read_text(&text));
    }

    #[test]
    fn any_words_of_the_language_are_read_without_a_panic(
        words in prop::collection::vec(prop::sample::select(WORDS), 0..60),
    ) {
        assert_sound(&read_text(&words.concat()));
    }
}

const WORDS: &[&str] = &[
    "version = 1\n",
    "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n",
    "[[sphere]]\n",
    "center = [0, 0, 0]\n",
    "radius = 1\n",
    "[[light]]\nkind = \"distant\"\n",
    "direction = [0, 0, -1]\n",
    "[materials.a]\n",
    "material = \"a\"\n",
    "color = ",
    "\"red\"",
    "[groups.a]\n",
    "[[groups.a.instance]]\n",
    "[[instance]]\n",
    "group = \"a\"\n",
    "[",
    "]",
    "{",
    "}",
    "= ",
    "\"",
    "'''",
    "\"\"\"",
    "\n",
    "\r\n",
    "é",
    "#",
    ", ",
    "1",
    "nan",
    "[[include]]\nfile = \"a.toml\"\n",
];
