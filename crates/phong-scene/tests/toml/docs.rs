//! The examples in the docs of concepts are scene text: they must read.

use phong_scene::{Limits, Memory, read};

const CONCEPTS: [(&str, &str); 12] = [
    ("ambient_occlusion.rs", include_str!("../../src/ambient_occlusion.rs")),
    ("camera.rs", include_str!("../../src/camera.rs")),
    ("clip.rs", include_str!("../../src/clip.rs")),
    ("fog.rs", include_str!("../../src/fog.rs")),
    ("furniture.rs", include_str!("../../src/furniture.rs")),
    ("light.rs", include_str!("../../src/light.rs")),
    ("material.rs", include_str!("../../src/material.rs")),
    ("outline.rs", include_str!("../../src/outline.rs")),
    ("scene.rs", include_str!("../../src/scene.rs")),
    ("shape.rs", include_str!("../../src/shape.rs")),
    ("sky.rs", include_str!("../../src/sky.rs")),
    ("tone.rs", include_str!("../../src/tone.rs")),
];

#[test]
fn the_examples_in_the_docs_of_concepts_are_valid() {
    for (file, source) in CONCEPTS {
        let lines = source.lines().map_while(|line| line.strip_prefix("//!"));
        let lines: Vec<_> = lines.map(|line| line.strip_prefix(' ').unwrap_or(line)).collect();
        let doc = lines.join("\n") + "\n";
        let examples = doc.split("```toml\n").skip(1).map(|rest| rest.split("```").next());
        for example in examples.flatten() {
            let files = Memory::new().with("a.toml", example.as_bytes());
            let said = read("a.toml", None, &files, &Limits::default()).diagnostics;
            // Other files, materials and the camera are not part of every example.
            let absent = ["there is no", "no such file", "the scene has no"];
            let wrong = said
                .iter()
                .find(|d| d.is_error() && !absent.iter().any(|absent| d.message.contains(absent)));
            assert_eq!(wrong, None, "{file}:\n{example}");
        }
    }
}
