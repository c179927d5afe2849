//! What picture a part is of, as lines of text.

use std::fmt::Write as _;

use phong_scene::{Furniture, Image, Scene, Tone};

use super::{ARITHMETIC, checksum, figure, fingerprint, tone};
use crate::film::{Film, LayerKind, Window};
use crate::finish::Finishing;
use crate::image::{Bits, Encoding};
use crate::render::{Lines, RenderOptions};

/// What picture a part is of, and how it is to be written when it is whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Width and height of the full picture, pixels.
    pub size: [u32; 2],
    /// The part of it that is rendered at all.
    pub window: Window,
    /// Edge of a tile in pixels.
    pub tile: u32,
    /// The layers of the film.
    pub layers: Vec<LayerKind>,
    /// `(i, n)`: which share of how many. `None`: all of it, a checkpoint.
    pub share: Option<(u32, u32)>,
    /// How the whole is to be written.
    pub encoding: Encoding,
    /// How its light becomes what a PNG shows.
    pub tone: Tone,
    /// All else that the pixels depend on: names and values, for comparison only.
    pub picture: Vec<(String, String)>,
}

impl Settings {
    /// A scene of nothing but the furniture that is to be drawn onto the picture, with the camera and the
    /// resolution that it is drawn by; `None`: there is none.
    pub fn furniture(&self) -> Option<Scene> {
        figure::from_line(self.said(figure::LINE)?)
    }

    /// The same settings with other furniture; none where that is empty.
    #[must_use]
    pub fn with_furniture(mut self, furniture: Furniture) -> Self {
        let line =
            self.furniture().and_then(|scene| figure::to_line(&Scene { furniture, ..scene }));
        self.picture.retain(|(name, _)| name != figure::LINE);
        self.picture.extend(line.map(|line| (figure::LINE.to_owned(), line)));
        self
    }

    /// The settings of a rendering of a scene.
    pub fn of(scene: &Scene, options: &RenderOptions, encoding: Encoding) -> Self {
        let picture = [
            ("scene", format!("{:08x}", fingerprint(scene))),
            ("samples", options.samples().to_string()),
            ("seed", options.seed().to_string()),
            ("depth", options.depth().to_string()),
            ("min_weight", options.min_weight().to_string()),
            ("shadows", options.shadows().to_string()),
            ("terminator", options.terminator().to_string()),
            ("filter", format!("{:?}", options.filter())),
            ("background", format!("{:?}", scene.image.background)),
        ];
        let mut picture = picture.map(|(name, value)| (name.to_owned(), value)).to_vec();
        let mut more = |name: &str, value| picture.push((name.to_owned(), value));
        if let Some(lines) = options.lines() {
            more("lines", lines.to_string());
        }
        if let Some(steps) = options.cel() {
            more("cel", steps.to_string());
        }
        if options.keeps_more() {
            more("shown", corners(options.shown()));
            more("kept", names(&options.shown_layers()));
        }
        if let Some(line) = figure::to_line(scene) {
            more(figure::LINE, line);
        }
        if let Some(dpi) = scene.image.dpi {
            more("dpi", dpi.to_string());
        }
        Self {
            size: options.size(),
            window: options.window(),
            tile: options.tile(),
            layers: options.layers(),
            share: options.share(),
            encoding,
            tone: scene.tone.unwrap_or_default(),
            picture,
        }
    }

    /// The scene's [`fingerprint`](super::fingerprint()); `None` in a part that does not say it.
    pub fn scene(&self) -> Option<u32> {
        let (_, sum) = self.picture.iter().find(|(name, _)| name == "scene")?;
        u32::from_str_radix(sum, 16).ok()
    }

    pub(super) fn said(&self, name: &str) -> Option<&str> {
        self.picture.iter().find(|(said, _)| said == name).map(|(_, value)| value.as_str())
    }

    /// The part of the film that is shown, and its layers; `None`: all of it.
    fn shown(&self) -> Option<(Window, Vec<LayerKind>)> {
        let shown = window_of(self.said("shown")?)?;
        let layers: Option<Vec<_>> =
            self.said("kept")?.split(',').map(LayerKind::from_name).collect();
        let layers = layers?.into_iter().filter(|kind| self.layers.contains(kind)).collect();
        let within = shown.intersection(&self.window) == shown && shown.fits(self.size);
        within.then_some((shown, layers))
    }

    /// The layers that files are to hold.
    pub fn shown_layers(&self) -> Vec<LayerKind> {
        self.shown().map_or_else(|| self.layers.clone(), |(_, layers)| layers)
    }

    /// Those of the finished picture as a film of its own ([`Finished::into_film`]): nothing more is to be
    /// drawn onto it.
    ///
    /// [`Finished::into_film`]: crate::finish::Finished::into_film
    #[must_use]
    pub fn finished(mut self) -> Self {
        if let Some((window, layers)) = self.shown() {
            (self.window, self.layers) = (window, layers);
        }
        self.picture.retain(|(name, _)| !["lines", "cel", "shown", "kept"].contains(&&**name));
        self
    }

    /// How the film is to be finished, but for its [furniture](Self::furniture), which somebody has to draw.
    pub fn finishing(&self) -> Finishing {
        let dpi = self.said("dpi").and_then(|dpi| dpi.parse().ok());
        Finishing {
            scene: self.scene(),
            picture: None,
            lines: self.said("lines").and_then(Lines::from_text),
            cel: self.said("cel").and_then(cel),
            shown: self.shown(),
            dpi: dpi.filter(|dpi: &f64| *dpi > 0.0 && dpi.is_finite()),
            patches: Vec::new(),
            tone: self.tone,
        }
    }

    /// A checksum of all that the picture and its file depend on, the version of the arithmetic
    /// included, and nothing else: not the share, not the edge of a tile.
    pub fn checksum(&self) -> u32 {
        let mut text = format!("arithmetic {ARITHMETIC}\n");
        for (name, value) in self.lines() {
            if name != "share" && name != "tile" {
                let _ = writeln!(text, "{name} {value}");
            }
        }
        checksum(text.as_bytes())
    }

    /// A film of this picture without any tile.
    pub fn empty_film(&self) -> Film {
        Film::new(self.size, self.window, self.tile, &self.layers)
    }

    /// Tiles in the window, whatever is done of them.
    pub(super) fn tiles(&self) -> usize {
        let [across, down] = [self.window.width(), self.window.height()];
        across.div_ceil(self.tile) as usize * down.div_ceil(self.tile) as usize
    }

    /// Bytes that the film takes.
    pub fn film_bytes(&self) -> u64 {
        let values: usize = self.layers.iter().map(|kind| kind.channels()).sum();
        let pixels = u64::from(self.window.width()) * u64::from(self.window.height());
        pixels.saturating_mul(4 * values as u64)
    }

    /// The first thing in which two parts are not of one picture: its name, here and there.
    pub fn difference(&self, other: &Self) -> Option<(String, String, String)> {
        let (here, there) = (self.lines(), other.lines());
        let said = |lines: &[(String, String)], name: &str| {
            let line = lines.iter().find(|(said, _)| said == name);
            line.map_or_else(|| "nothing".to_owned(), |(_, value)| value.clone())
        };
        let names = here.iter().chain(&there).map(|(name, _)| name);
        let each = names.map(|name| (name.clone(), said(&here, name), said(&there, name)));
        let mut each = each.filter(|(name, ..)| name != "share");
        each.find(|(_, here, there)| here != there)
    }

    pub(super) fn to_text(&self) -> String {
        self.lines().into_iter().fold(String::new(), |mut text, (name, value)| {
            let _ = writeln!(text, "{name} {value}");
            text
        })
    }

    fn lines(&self) -> Vec<(String, String)> {
        let share = self.share.map_or("none".to_owned(), |(i, n)| format!("{i}/{n}"));
        let bits = match self.encoding.bits {
            Bits::Eight => "8",
            Bits::Sixteen => "16",
        };
        let fixed = [
            ("size", format!("{}x{}", self.size[0], self.size[1])),
            ("crop", corners(self.window)),
            ("tile", self.tile.to_string()),
            ("layers", names(&self.layers)),
            ("share", share),
            ("bits", bits.to_owned()),
            ("linear", self.encoding.linear.to_string()),
            ("exposure", tone::exposure(&self.tone)),
        ];
        let fixed = fixed.into_iter().chain(tone::more(&self.tone));
        fixed
            .map(|(name, value)| (name.to_owned(), value))
            .chain(self.picture.iter().cloned())
            .collect()
    }

    /// Settings from their text; `None` where it is none.
    pub(super) fn from_text(text: &str) -> Option<Self> {
        let mut lines = text.lines().map(|line| line.split_once(' '));
        let mut next = |name: &str| lines.next()?.filter(|(n, _)| *n == name).map(|(_, v)| v);
        let (width, height) = next("size")?.split_once('x')?;
        let size = [width.parse().ok()?, height.parse().ok()?];
        let window = window_of(next("crop")?)?;
        let tile = next("tile")?.parse().ok().filter(|&edge| edge > 0)?;
        let layers = next("layers")?.split(',').map(LayerKind::from_name).collect::<Option<_>>()?;
        let share = match next("share")? {
            "none" => None,
            share => {
                let (i, n) = share.split_once('/')?;
                Some((i.parse().ok()?, n.parse().ok()?)).filter(|(i, n): &(u32, u32)| i < n)
            }
        };
        let bits = match next("bits")? {
            "8" => Bits::Eight,
            "16" => Bits::Sixteen,
            _ => return None,
        };
        let linear = next("linear")?.parse().ok()?;
        let mut tone = tone::exposed(next("exposure")?)?;
        let mut picture = Vec::new();
        for line in lines {
            let (name, value) = line?;
            if !tone::read(&mut tone, name, value)? {
                picture.push((name.to_owned(), value.to_owned()));
            }
        }
        let encoding = Encoding { bits, linear };
        let settings = Self { size, window, tile, layers, share, encoding, tone, picture };
        window.fits(size).then_some(settings)
    }
}

/// In how many steps luminance comes; `None`: this says nothing of it.
fn cel(text: &str) -> Option<u32> {
    text.parse().ok().filter(|steps| (2..=Image::MOST_STEPS).contains(steps))
}

fn corners(Window { x0, y0, x1, y1 }: Window) -> String {
    format!("{x0},{y0},{x1},{y1}")
}

fn window_of(text: &str) -> Option<Window> {
    let corners = text.split(',').map(|n| n.parse().ok());
    let [x0, y0, x1, y1] = <[u32; 4]>::try_from(corners.collect::<Option<Vec<_>>>()?).ok()?;
    Some(Window { x0, y0, x1, y1 })
}

fn names(layers: &[LayerKind]) -> String {
    layers.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(",")
}
