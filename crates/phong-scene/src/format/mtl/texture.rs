//! Texture statements: what they are for, which file is meant, and the options before and behind its name.

use crate::format::text::name_of;
use crate::texture::Channel;

/// What a texture statement says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Map {
    pub(super) of: MapOf,
    /// The file; empty: none is named.
    pub(super) name: String,
    /// `-o`, and `-s`: what is added to texture coordinates after they are multiplied.
    pub(super) offset: [f64; 3],
    pub(super) scale: [f64; 3],
    /// `-clamp on`.
    pub(super) clamp: bool,
    /// Options that are not drawn, as they are written.
    pub(super) ignored: Vec<String>,
    /// `-bm`: how much bumps count.
    pub(super) bump: f64,
    /// `-mm`: what is added to values after they are multiplied.
    pub(super) base: f64,
    pub(super) gain: f64,
    /// `-imfchan`.
    pub(super) channel: Option<Channel>,
}

/// What an image says of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MapOf {
    Ambient,
    Diffuse,
    Specular,
    Exponent,
    Dissolve,
    Emission,
    Bump,
    /// Heights by which the surface would be moved: it is shaded as by a bump.
    Displacement,
    Normal,
    Roughness,
    Metallic,
    /// What mirrors show, which is not drawn.
    Reflection,
    /// Something else that is not drawn.
    Other,
}

impl MapOf {
    /// The statement that says it.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Ambient => "map_Ka",
            Self::Diffuse => "map_Kd",
            Self::Specular => "map_Ks",
            Self::Exponent => "map_Ns",
            Self::Dissolve => "map_d",
            Self::Emission => "map_Ke",
            Self::Bump => "bump",
            Self::Displacement => "disp",
            Self::Normal => "norm",
            Self::Roughness => "map_Pr",
            Self::Metallic => "map_Pm",
            Self::Reflection => "refl",
            Self::Other => "decal",
        }
    }
}

/// What a texture statement says; `None` if `keyword` is none.
pub(super) fn statement(keyword: &[u8], rest: &[u8]) -> Option<Map> {
    let keyword = keyword.to_ascii_lowercase();
    let of = match &*keyword {
        b"map_ka" => MapOf::Ambient,
        b"map_kd" => MapOf::Diffuse,
        b"map_ks" => MapOf::Specular,
        b"map_ke" => MapOf::Emission,
        b"map_ns" => MapOf::Exponent,
        b"map_d" => MapOf::Dissolve,
        b"bump" | b"map_bump" | b"bmp" => MapOf::Bump,
        b"norm" | b"map_kn" => MapOf::Normal,
        b"map_pr" => MapOf::Roughness,
        b"map_pm" => MapOf::Metallic,
        b"disp" | b"map_disp" => MapOf::Displacement,
        b"refl" => MapOf::Reflection,
        b"decal" => MapOf::Other,
        other if other.starts_with(b"map_") => MapOf::Other,
        _ => return None,
    };
    let mut map = Map {
        of,
        name: String::new(),
        offset: [0.0; 3],
        scale: [1.0; 3],
        clamp: false,
        ignored: Vec::new(),
        bump: 1.0,
        base: 0.0,
        gain: 1.0,
        channel: None,
    };
    let text = name_of(rest);
    // Names may hold blanks: all from the first word that is no option to the last of them.
    let (mut start, mut end) = (None, 0);
    let mut words = words(&text).peekable();
    while let Some((at, option)) = words.next() {
        let (numbers, others) = match option {
            "-o" | "-s" | "-t" => (3, 0),
            "-mm" => (2, 0),
            "-bm" | "-boost" | "-texres" => (1, 0),
            "-blendu" | "-blendv" | "-clamp" | "-cc" | "-imfchan" | "-type" | "-colorspace" => {
                (0, 1)
            }
            _ => {
                start = start.or(Some(at));
                end = at + option.len();
                continue;
            }
        };
        let mut said = Vec::new();
        let mut last = option;
        for _ in 0..numbers {
            let Some((_, word)) = words.next_if(|(_, word)| word.parse::<f64>().is_ok()) else {
                break;
            };
            said.extend(word.parse::<f64>());
            last = word;
        }
        for _ in 0..others {
            last = words.next().map_or("", |(_, word)| word);
        }
        if !map.option(option, &said, last) {
            let end = last.as_ptr() as usize + last.len() - text.as_ptr() as usize;
            map.ignored.push(text[at..end].to_owned());
        }
        if start.is_some() {
            // Options behind the name end it.
            break;
        }
    }
    map.name = start.map_or(String::new(), |start| text[start..end].to_owned());
    Some(map)
}

impl Map {
    /// Takes an option; whether it is drawn.
    fn option(&mut self, option: &str, numbers: &[f64], word: &str) -> bool {
        if !numbers.iter().all(|number| number.is_finite()) {
            return false;
        }
        let into = |to: &mut [f64]| to.iter_mut().zip(numbers).for_each(|(to, from)| *to = *from);
        match option {
            "-o" => into(&mut self.offset),
            "-s" => into(&mut self.scale),
            "-t" | "-boost" => return numbers.iter().all(|number| *number == 0.0),
            "-cc" => return !word.eq_ignore_ascii_case("on"),
            "-mm" => {
                let mut both = [self.base, self.gain];
                into(&mut both);
                [self.base, self.gain] = both;
            }
            "-bm" => self.bump = numbers.first().copied().unwrap_or(1.0),
            "-clamp" => self.clamp = word.eq_ignore_ascii_case("on"),
            "-imfchan" => {
                self.channel = match word {
                    "r" => Some(Channel::Red),
                    "g" => Some(Channel::Green),
                    "b" => Some(Channel::Blue),
                    "m" => Some(Channel::Alpha),
                    "l" => Some(Channel::Luminance),
                    _ => return false,
                }
            }
            _ => {}
        }
        true
    }
}

/// The words of a text and where they begin.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split_whitespace().map(|word| (word.as_ptr() as usize - text.as_ptr() as usize, word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(statement: &str) -> Option<Map> {
        let (keyword, rest) = statement.split_once(' ').unwrap();
        self::statement(keyword.as_bytes(), rest.as_bytes())
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
            assert_eq!(map(statement).unwrap().name, "wood grain.png", "{statement}");
        }
        assert_eq!(map("map_Kd -o 1 2").unwrap().name, "");
        assert_eq!(map("Kq 1 2"), None);
    }

    #[test]
    fn options_are_of_the_place_the_value_and_the_edge() {
        let read = map("map_Kd -o 0.25 0.5 -s 2 -mm 0.1 0.8 -clamp on -imfchan m a.png").unwrap();
        assert_eq!((read.offset, read.scale), ([0.25, 0.5, 0.0], [2.0, 1.0, 1.0]));
        assert_eq!((read.base, read.gain, read.clamp), (0.1, 0.8, true));
        assert_eq!((read.of, read.channel), (MapOf::Diffuse, Some(Channel::Alpha)));
        let bump = map("map_Bump -bm 0.3 a.png").unwrap();
        assert_eq!((bump.of, bump.bump), (MapOf::Bump, 0.3));
    }

    #[test]
    fn options_that_are_not_drawn_are_kept_as_they_are_written() {
        for (option, is_ignored) in [
            ("-s 1e400", true),
            ("-mm 0 nan", true),
            ("-boost 2", true),
            ("-boost 0", false),
            ("-cc  on", true),
            ("-cc off", false),
            ("-t 0 1", true),
            ("-imfchan z", true),
            ("-imfchan l", false),
            ("-blendu off", false),
        ] {
            let read = map(&format!("map_d {option} a.png")).unwrap();
            assert_eq!(read.ignored, vec![option; usize::from(is_ignored)], "{option}");
            assert_eq!((read.gain, read.scale), (1.0, [1.0; 3]), "{option}");
        }
        for statement in ["map_d -imfchan l a.png", "map_Kd -imfchan l a.png"] {
            assert_eq!(map(statement).unwrap().channel, Some(Channel::Luminance), "{statement}");
        }
    }
}
