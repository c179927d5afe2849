//! Where the pictures of a film go: a file each, or one that moves.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use phong::image::{AnimationFormat, Format};

use crate::args::{Bits, OutputFormat, RenderArgs};
use crate::failure::Failure;
use crate::input;

/// Pictures a second where nothing is said.
const RATE: u16 = 25;

/// Where the pictures of a film go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// A file each.
    Files(Names),
    /// All into one file, so many a second.
    Animation { format: AnimationFormat, path: PathBuf, rate: u16 },
}

/// What the files of a film's pictures are called: a name with a place for the picture's number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Names {
    folder: PathBuf,
    before: OsString,
    /// At least so many digits, noughts in front; `None`: there is no place for a number.
    digits: Option<usize>,
    after: String,
}

impl Target {
    /// Where the command line wants so many pictures.
    pub(crate) fn new(args: &RenderArgs, pictures: u32) -> Result<Self, Failure> {
        let stem = input::stem(&args.input.input);
        let output =
            args.output.clone().unwrap_or_else(|| format!("{}-%04d.png", escaped(&stem)).into());
        if output == Path::new("-") {
            return Err(Failure::usage("the pictures of a film do not fit into standard output")
                .with_help(format!("write files, like -o {stem}-%04d.png")));
        }
        let names = Names::parse(&output)?;
        let moving = match args.encoding.output_format {
            None => AnimationFormat::of_path(&output),
            Some(OutputFormat::Png) => Some(AnimationFormat::Png),
            Some(_) => None,
        };
        let target = match moving {
            _ if names.digits.is_some() => Self::Files(names),
            Some(format) if pictures > 1 || format == AnimationFormat::Gif => {
                let rate = args.film.fps.unwrap_or(RATE);
                Self::Animation { format, path: output, rate }
            }
            _ if pictures == 1 => Self::Files(names),
            _ => {
                let message = format!("{pictures} pictures do not fit into {}", output.display());
                // A name that would be refused is no advice.
                let written =
                    args.encoding.output_format.is_some() || Format::of_path(&output).is_some();
                let ending = (!written).then_some("png");
                return Err(Failure::usage(message).with_help(format!(
                    "-o {} is a file for each; a name in .gif or .png without %d one file that moves",
                    names.with_a_place(ending),
                )));
            }
        };
        target.check(args)?;
        Ok(target)
    }

    /// Whether the other options go with it.
    fn check(&self, args: &RenderArgs) -> Result<(), Failure> {
        let refuse = |what: &str, help: &str| Err(Failure::usage(what).with_help(help));
        match self {
            Self::Files(_) if args.film.fps.is_some() => refuse(
                "--fps is for one file that moves",
                "leave it out, or give a name in .gif or .png without %d",
            ),
            Self::Files(names) => {
                let is_called =
                    |end| names.path(0).extension().is_some_and(|e| e.eq_ignore_ascii_case(end));
                let (is_pfm, is_svg) = match args.encoding.output_format {
                    None => (is_called("pfm"), is_called("svg")),
                    Some(format) => (format == OutputFormat::Pfm, format == OutputFormat::Svg),
                };
                let what = match (is_pfm, is_svg) {
                    _ if !args.work.resume => return Ok(()),
                    (true, _) => "--resume: PFM files do not say what they are of",
                    (_, true) => "--resume: SVG files do not say what they are of",
                    _ => return Ok(()),
                };
                refuse(what, "write PNG or EXR files")
            }
            Self::Animation { .. } if args.work.resume => refuse(
                "--resume: a file that moves is written in one go",
                "write a file a picture, with %04d in its name",
            ),
            Self::Animation { .. } if args.terms || !args.aov.is_empty() => refuse(
                "--terms and --aov are layers, which a file that moves has not",
                "write a file a picture, with %04d in its name",
            ),
            Self::Animation { .. } if args.encoding.bits.is_some_and(Bits::is_sixteen) => refuse(
                "--bits 16: a file that moves has 8 bits a channel",
                "write a file a picture, with %04d in its name",
            ),
            Self::Animation { format, rate, .. } if *rate > format.most_a_second() => {
                let most = format.most_a_second();
                let what = format!("--fps {rate}: a GIF shows at most {most} pictures a second");
                refuse(&what, "write a name in .png, which takes more")
            }
            Self::Animation { .. } => Ok(()),
        }
    }

    /// The file that the picture of this number is in.
    pub(crate) fn file(&self, number: u64) -> PathBuf {
        match self {
            Self::Files(names) => names.path(number),
            Self::Animation { path, .. } => path.clone(),
        }
    }

    /// The name as it was given.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Files(names) => names.text(),
            Self::Animation { path, .. } => path.display().to_string(),
        }
    }
}

/// The same text in a name with places.
fn escaped(text: &str) -> String {
    text.replace('%', "_")
}

impl Names {
    /// Looks for the place of the number: `%d`, or `%04d` for four digits at least.
    fn parse(path: &Path) -> Result<Self, Failure> {
        let folder = path.parent().map(Path::to_owned).unwrap_or_default();
        let name = path.file_name().unwrap_or_default();
        let plain = |name: OsString| Self {
            folder: folder.clone(),
            before: name,
            digits: None,
            after: String::new(),
        };
        let Some(text) = name.to_str() else { return Ok(plain(name.to_owned())) };
        let mut places = text.match_indices('%').filter_map(|(at, _)| {
            let (digits, length) = place(&text[at..])?;
            Some((at, digits, length))
        });
        let Some((at, digits, length)) = places.next() else {
            if let Some(other) = foreign_place(text) {
                let better = text.replacen(other, "%04d", 1);
                return Err(Failure::usage(format!(
                    "{other} in {text} is no place for a picture's number"
                ))
                .with_help(format!("write %d or %04d, like -o {better}")));
            }
            return Ok(plain(name.to_owned()));
        };
        if places.next().is_some() {
            return Err(Failure::usage(format!("{text} has more than one place for a number"))
                .with_help("write %d or %04d once"));
        }
        Ok(Self {
            folder: folder.clone(),
            before: text[..at].into(),
            digits: Some(digits),
            after: text[at + length..].to_owned(),
        })
    }

    /// The file of the picture of this number.
    pub(crate) fn path(&self, number: u64) -> PathBuf {
        let mut name = self.before.clone();
        if let Some(digits) = self.digits {
            name.push(format!("{number:0digits$}"));
        }
        name.push(&self.after);
        self.folder.join(name)
    }

    /// The name as it was given.
    fn text(&self) -> String {
        let mut name = self.before.clone();
        match self.digits {
            Some(1) => name.push("%d"),
            Some(digits) => name.push(format!("%0{digits}d")),
            None => {}
        }
        name.push(&self.after);
        self.folder.join(name).display().to_string()
    }

    /// A name like this one that has a place for a number, with this ending if there is one.
    fn with_a_place(&self, ending: Option<&str>) -> String {
        let mut path = self.path(0);
        if let Some(ending) = ending {
            path.set_extension(ending);
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = path.extension().map(|e| format!(".{}", e.to_string_lossy()));
        path.with_file_name(format!("{stem}-%04d{}", ending.unwrap_or_default()))
            .display()
            .to_string()
    }
}

/// The digits that `%d` or `%04d` asks for, and how long it is; `None`: it is neither.
fn place(text: &str) -> Option<(usize, usize)> {
    let rest = text.strip_prefix('%')?;
    let end = rest.find('d')?;
    match &rest.as_bytes()[..end] {
        [] => Some((1, 2)),
        [b'0', digit @ b'1'..=b'9'] => Some((usize::from(digit - b'0'), 4)),
        _ => None,
    }
}

/// What other programs write for a number, like `{}`, `{:04}` or `####`: nobody calls one file so.
fn foreign_place(text: &str) -> Option<&str> {
    let braced = text.match_indices('{').find_map(|(at, _)| {
        let braced = &text[at..=at + text[at..].find('}')?];
        let inner = braced[1..braced.len() - 1].trim_start_matches(':');
        let inner = inner.strip_suffix(['d', 'i', 'n']).unwrap_or(inner);
        (inner == "frame" || inner.bytes().all(|b| b.is_ascii_digit())).then_some(braced)
    });
    let marks = text.find("##").map(|at| {
        let rest = &text[at..];
        &rest[..rest.find(|letter| letter != '#').unwrap_or(rest.len())]
    });
    braced.or(marks)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(text: &str, number: u64) -> String {
        Names::parse(Path::new(text)).unwrap().path(number).display().to_string()
    }

    #[test]
    fn a_number_has_as_many_digits_as_its_place_says_or_more() {
        assert_eq!(name("a/frame-%04d.png", 7), "a/frame-0007.png");
        assert_eq!(name("%d.exr", 12345), "12345.exr");
        assert_eq!(name("f%02d", 123), "f123");
        assert_eq!(name("100%.png", 3), "100%.png");
        assert_eq!(name("%s-%5d.png", 3), "%s-%5d.png");
        assert!(Names::parse(Path::new("%d-%d.png")).is_err());
    }

    #[test]
    fn places_of_other_programs_are_told_from_names() {
        let found = ["f-{}.png", "{:04}", "{:03d}.exr", "a-{n}.gif", "f-####.png", "{frame}.png"];
        let places = ["{}", "{:04}", "{:03d}", "{n}", "####", "{frame}"];
        assert_eq!(found.map(foreign_place), places.map(Some));
        for name in ["{a}.png", "a#1.png", "}{.png", "{{.png", "{1", "é{ü}.png"] {
            assert_eq!(foreign_place(name), None, "{name}");
        }
    }

    #[test]
    fn a_name_tells_itself_and_one_like_it_with_a_place() {
        for text in ["a/frame-%04d.png", "%d.exr", "plain.png"] {
            assert_eq!(Names::parse(Path::new(text)).unwrap().text(), text);
        }
        let exr = Names::parse(Path::new("a/b.exr")).unwrap();
        assert_eq!(exr.with_a_place(None), "a/b-%04d.exr");
        assert_eq!(exr.with_a_place(Some("png")), "a/b-%04d.png");
    }
}
