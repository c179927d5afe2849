//! Texture statements: which file is meant, among options before and behind its name.

use crate::format::text::name_of;

/// The file a texture statement names; `None` if `keyword` is no texture statement.
pub(super) fn file_name(keyword: &[u8], rest: &[u8]) -> Option<String> {
    let keyword = keyword.to_ascii_lowercase();
    let known: [&[u8]; 7] = [b"bump", b"disp", b"decal", b"refl", b"norm", b"map_bump", b"bmp"];
    if !keyword.starts_with(b"map_") && !known.contains(&keyword.as_slice()) {
        return None;
    }
    let text = name_of(rest);
    // Names may hold blanks: all from the first word that is no option to the last of them.
    let (mut start, mut end) = (None, 0);
    let mut words = words(&text).peekable();
    while let Some((at, word)) = words.next() {
        let (numbers, others) = match word {
            "-o" | "-s" | "-t" => (3, 0),
            "-mm" => (2, 0),
            "-bm" | "-boost" | "-texres" => (1, 0),
            "-blendu" | "-blendv" | "-clamp" | "-cc" | "-imfchan" | "-type" | "-colorspace" => {
                (0, 1)
            }
            _ => {
                start = start.or(Some(at));
                end = at + word.len();
                continue;
            }
        };
        for _ in 0..numbers {
            if words.next_if(|(_, word)| word.parse::<f64>().is_ok()).is_none() {
                break;
            }
        }
        for _ in 0..others {
            words.next();
        }
        if start.is_some() {
            // Options behind the name end it.
            break;
        }
    }
    Some(start.map_or(String::new(), |start| text[start..end].to_owned()))
}

/// The words of a text and where they begin.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split_whitespace().map(|word| (word.as_ptr() as usize - text.as_ptr() as usize, word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(statement: &str) -> Option<String> {
        let (keyword, rest) = statement.split_once(' ').unwrap();
        file_name(keyword.as_bytes(), rest.as_bytes())
    }

    #[test]
    fn the_name_is_found_before_behind_and_between_options() {
        for statement in [
            "map_Kd wood grain.png",
            "map_Kd -o 0 0.5 -s 1 wood grain.png",
            "map_Kd -mm 0 1 -clamp on -imfchan r wood grain.png",
            "bump wood grain.png -bm 0.5",
            "refl -type sphere -blendu off wood grain.png -texres 512",
        ] {
            assert_eq!(name(statement).as_deref(), Some("wood grain.png"), "{statement}");
        }
        assert_eq!(name("map_Kd -o 1 2").as_deref(), Some(""));
        assert_eq!(name("Kq 1 2"), None);
    }
}
