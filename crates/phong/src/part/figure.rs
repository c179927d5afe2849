//! The furniture of a scene's figure as one line of text, so that shares carry what is drawn onto the whole.

use phong_scene::{Background, Image, Limits, Memory, Rgb, Scene, read};

/// What a scene is called that holds nothing but furniture.
const NAME: &str = "furniture.toml";

/// A scene of nothing but the furniture of this one, with the camera and the resolution that it is drawn by,
/// and with all in itself that it takes from the rest of the scene; `None`: there is none.
pub fn furniture_of(scene: &Scene) -> Option<Scene> {
    let mut furniture = scene.furniture.clone();
    if furniture.is_empty() {
        return None;
    }
    furniture.legend = scene.legend();
    furniture.style.color.get_or_insert_with(|| ink(scene));
    let image = Image { dpi: scene.image.dpi, ..Image::default() };
    Some(Scene { image, camera: scene.camera.clone(), furniture, ..Scene::default() })
}

/// A scene's furniture and all that it is drawn by, if there is any.
pub(super) fn to_line(scene: &Scene) -> Option<String> {
    // Numbers that no text holds are in no scene that was checked.
    let text = furniture_of(scene)?.look_text().ok()?;
    Some(text.replace('\\', "\\\\").replace('\n', "\\n"))
}

/// A scene of nothing but furniture, and what that is drawn by; `None`: the line was none of it.
pub(super) fn from_line(line: &str) -> Option<Scene> {
    let mut text = String::with_capacity(line.len());
    let mut letters = line.chars();
    while let Some(letter) = letters.next() {
        text.push(match letter {
            '\\' => match letters.next()? {
                'n' => '\n',
                other => other,
            },
            letter => letter,
        });
    }
    let files = Memory::new().with(NAME, text.as_bytes());
    read(NAME, None, &files, &Limits::default()).scene
}

/// Black or white, whichever stands out from the background.
fn ink(scene: &Scene) -> Rgb {
    let behind = match (&scene.sky, scene.image.background) {
        // Transparent pictures are laid on paper more often than not.
        (_, Background::Transparent) | (Some(_), _) => 1.0,
        (None, Background::Color(color)) => color.luminance(),
        (None, Background::Gradient { top, bottom }) => {
            0.5 * (top.luminance() + bottom.luminance())
        }
    };
    // Where the contrasts of black and of white, as (L + 0.05) / (l + 0.05), are the same.
    if behind > 0.179 { Rgb::BLACK } else { Rgb::WHITE }
}

/// What the line is called.
pub(super) const LINE: &str = "furniture";

#[cfg(test)]
mod tests {
    use phong_scene::{Furniture, Hidden, PointLabel, ScaleBar, Title};

    use super::*;

    #[test]
    fn furniture_comes_back_from_its_line() {
        let label = PointLabel {
            text: "a \\n \"b\"\nc".to_owned(),
            hidden: Hidden::Never,
            ..PointLabel::default()
        };
        let furniture = Furniture {
            title: Some(Title { text: "Ångström".to_owned(), ..Title::default() }),
            scale_bar: Some(ScaleBar { unit: "nm".to_owned(), factor: 0.1, ..ScaleBar::default() }),
            labels: vec![label],
            ..Furniture::default()
        };
        let image = Image {
            dpi: Some(300.0),
            background: Background::Color(Rgb::WHITE),
            ..Image::default()
        };
        let scene = Scene { furniture, image, ..Scene::default() };
        let line = to_line(&scene).expect("there is some");
        assert!(!line.contains('\n'), "{line}");
        let mut back = from_line(&line).expect("a scene");
        assert_eq!((back.image.dpi, back.furniture.style.color), (Some(300.0), Some(Rgb::BLACK)));
        (back.furniture.style.color, back.furniture.labels[0].place) = Default::default();
        assert_eq!(back.furniture, scene.furniture);
        assert_eq!(to_line(&Scene::default()), None);
        assert!(from_line("no scene").is_none());
    }
}
