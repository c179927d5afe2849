//! Where furniture stands, and what it is made of.

use glam::DVec3;
use phong::camera::Camera;
use phong_scene::{
    Anchor, Axes, BarLength, CameraKind, Furniture, Legend, PointLabel, Rgb, ScaleBar, Scene, Title,
};

use super::round::{Round, number};
use super::sheet::{Group, Paint, ink};
use super::text::{CAPITAL, Font};
use crate::draw::{Ink, Path, Point, Stroke};

/// The most pixels of a point: where there were more, there are so many.
const MOST_PIXELS: f64 = 500.0;

/// The most of the picture's width that an automatic scale bar takes.
const BAR_SHARE: f64 = 0.25;

/// The most of the picture's height that the colours of a legend take.
const LEGEND_SHARE: f64 = 0.6;

/// A title's letters against the others.
const TITLE: f64 = 1.5;

/// Red, green and blue for x, y and z: on bright paper, and on dark.
const AXES: [[Ink; 3]; 2] = [
    [Ink::rgb(0xc0, 0x2b, 0x1d), Ink::rgb(0x1b, 0x7d, 0x2c), Ink::rgb(0x1f, 0x4e, 0xc4)],
    [Ink::rgb(0xff, 0x6b, 0x5a), Ink::rgb(0x5f, 0xd6, 0x6e), Ink::rgb(0x6f, 0x9d, 0xff)],
];

/// Where labels are put; which of them are hidden is known elsewhere.
pub(super) struct Layout<'a> {
    pub(super) font: &'a Font,
    scene: &'a Scene,
    /// The full picture, pixels.
    size: [u32; 2],
    /// Pixels of a point.
    point: f64,
    /// Height of letters, pixels.
    letters: f64,
    ink: Ink,
    halo: Option<(Ink, f64)>,
    /// How far what is at each place already reaches in from the edge, pixels.
    taken: [f64; Anchor::COUNT],
}

/// Something that is to stand somewhere: its paints from (0, 0), and how large it is.
struct Block {
    paints: Vec<Paint>,
    size: Point,
    says: String,
    /// All that is written in it.
    written: String,
}

/// Something that stands at an edge of the picture.
pub(super) struct Standing {
    /// The table of the scene that asks for it.
    pub(super) key: &'static str,
    /// All that is written in it.
    pub(super) written: String,
    /// Its upper left and its lower right corner, without the edge around it.
    pub(super) bounds: [Point; 2],
    pub(super) group: Group,
}

impl<'a> Layout<'a> {
    /// Of a scene's furniture in a picture of `size` pixels.
    pub(super) fn new(font: &'a Font, scene: &'a Scene, size: [u32; 2]) -> Self {
        let style = scene.furniture.style;
        let point = (scene.image.dpi.unwrap_or(super::DPI) / 72.0).min(MOST_PIXELS);
        let color = style.color.unwrap_or(Rgb::BLACK);
        let dark = color.luminance() <= 0.179;
        let around = if dark { Ink::rgb(255, 255, 255) } else { Ink::rgb(0, 0, 0) };
        Self {
            font,
            scene,
            size,
            point,
            letters: style.size * point,
            ink: ink(color),
            halo: (style.halo > 0.0).then_some((around, style.halo * point)),
            taken: [0.0; Anchor::COUNT],
        }
    }

    /// All that stands at the picture's edges, in the order that it is painted in.
    pub(super) fn edges(&mut self) -> Vec<Standing> {
        let Furniture { title, scale_bar, axes, legend, .. } = &self.scene.furniture;
        let title = title.as_ref().map(|title| ("title", self.title(title), title.place));
        let bar = scale_bar.as_ref();
        let bar = bar.and_then(|bar| Some(("scale_bar", self.scale_bar(bar)?, bar.place)));
        let axes = axes.as_ref().map(|axes| ("axes", self.axes(axes), axes.place));
        let legend = legend.as_ref().map(|legend| ("legend", self.legend(legend), legend.place));
        let all = [title, bar, axes, legend].into_iter().flatten();
        all.map(|(key, block, place)| self.stand(key, block, place)).collect()
    }

    /// Distance from the picture's edges, pixels.
    fn margin(&self) -> f64 {
        self.scene.furniture.style.margin * self.point
    }

    /// Puts a block at a place of the picture, beside what is there already.
    fn stand(&mut self, key: &'static str, block: Block, place: Anchor) -> Standing {
        use Anchor::{Bottom, BottomLeft, BottomRight, Left, Right, Top, TopLeft, TopRight};
        let picture = Point::from(self.size.map(f64::from));
        let margin = self.margin();
        let taken = &mut self.taken[place.number()];
        let x = match place {
            TopLeft | BottomLeft => margin,
            Left => margin + *taken,
            Top | Bottom => 0.5 * (picture.x - block.size.x),
            TopRight | BottomRight => picture.x - margin - block.size.x,
            Right => picture.x - margin - *taken - block.size.x,
        };
        let y = match place {
            TopLeft | Top | TopRight => margin + *taken,
            Left | Right => 0.5 * (picture.y - block.size.y),
            BottomLeft | Bottom | BottomRight => picture.y - margin - *taken - block.size.y,
        };
        let along = if matches!(place, Left | Right) { block.size.x } else { block.size.y };
        *taken += along + 0.75 * self.letters;
        // Whole pixels: what is level is sharp.
        let at = Point::new(x.round(), y.round());
        let paints = block.paints.iter().map(|paint| paint.moved(at)).collect();
        let group = Group { says: block.says, paints, halo: self.halo };
        Standing { key, written: block.written, bounds: [at, at + block.size], group }
    }

    fn title(&self, title: &Title) -> Block {
        let size = TITLE * self.letters;
        let most = f64::from(self.size[0]) - 2.0 * self.margin();
        let words = self.font.words(&self.font.broken(&title.text, size, most), size);
        let top = Point::new(0.0, CAPITAL * size);
        Block {
            paints: vec![Paint::Fill(words.path.moved(top), self.ink)],
            size: Point::new(words.width, CAPITAL * size + words.drop),
            says: title.text.clone(),
            written: title.text.clone(),
        }
    }

    /// Pixels of a unit of a scale bar; `None`: the camera has no one scale.
    fn bar_unit(&self, bar: &ScaleBar) -> Option<f64> {
        Some(pixels_a_unit(&self.scene.camera, self.size)? / bar.factor)
    }

    /// The longest round number that takes no more than [`BAR_SHARE`] of the picture's width.
    fn bar_length(&self, pixels: f64) -> Option<Round> {
        Round::below(BAR_SHARE * f64::from(self.size[0]) / pixels)
    }

    /// How many pixels a scale bar of a length that was asked for takes, where that is less than one or more than
    /// the picture has, and a length that is neither.
    pub(super) fn unfit_bar(&self, bar: &ScaleBar) -> Option<(f64, f64)> {
        let BarLength::Units(length) = bar.length else { return None };
        let pixels = self.bar_unit(bar)?;
        let room = f64::from(self.size[0]) - 2.0 * self.margin();
        let width = length * pixels;
        let fits = width >= 1.0 && width <= room;
        (!fits).then_some((width, self.bar_length(pixels)?.value()))
    }

    /// `None`: the camera has no one scale.
    fn scale_bar(&self, bar: &ScaleBar) -> Option<Block> {
        let pixels = self.bar_unit(bar)?;
        let (length, written) = match bar.length {
            BarLength::Units(length) => (length, number(length, decimals(length))),
            BarLength::Auto => {
                let round = self.bar_length(pixels)?;
                (round.value(), number(round.value(), round.decimals()))
            }
        };
        let width = length * pixels;
        if !width.is_finite() {
            return None;
        }
        let says = with_unit(&written, &bar.unit);
        let words = self.font.words(&says, self.letters);
        let whole = width.max(words.width);
        let thick = (0.22 * self.letters).round().max(1.0);
        let top = CAPITAL * self.letters;
        let low = (top + words.drop + 0.45 * self.letters).round();
        let from = (0.5 * (whole - width)).round();
        let corners =
            [(from, low), (from + width, low), (from + width, low + thick), (from, low + thick)];
        let at = Point::new(0.5 * (whole - words.width), top);
        Some(Block {
            paints: vec![
                Paint::Fill(words.path.moved(at), self.ink),
                Paint::Fill(polygon(&corners), self.ink),
            ],
            size: Point::new(whole, low + thick),
            written: says.clone(),
            says,
        })
    }

    fn axes(&self, axes: &Axes) -> Block {
        let length = axes.length * self.point;
        let [right, up, forward] = frame(&self.scene.camera);
        let dark = self.halo.is_some_and(|(around, _)| around.srgb == [0; 3]);
        let inks = AXES[usize::from(dark)];
        let middle = Point::ZERO;
        let mut arrows = [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")]
            .map(|(axis, name)| (axis, name, axis.dot(forward)))
            .into_iter()
            .zip(inks)
            .collect::<Vec<_>>();
        // What points away from the viewer lies below what points towards him.
        arrows.sort_by(|(a, _), (b, _)| b.2.total_cmp(&a.2));
        let mut paints = Vec::new();
        let width = 0.17 * self.letters;
        for ((axis, name, _), ink) in arrows {
            let along = Point::new(axis.dot(right), -axis.dot(up));
            let tip = middle + along * length;
            let (shaft, flat) = (along * length, along.length());
            let head = (2.8 * width).min(shaft.length());
            let heading = shaft.normalize_or_zero();
            let base = tip - heading * head;
            paints.push(Paint::Line(Path::polyline([middle, base]), Stroke::new(ink, width)));
            let wing = Point::new(-heading.y, heading.x) * 0.45 * head;
            paints.push(Paint::Fill(Path::polygon([tip, base + wing, base - wing]), ink));
            let words = self.font.words(name, self.letters);
            // Beyond the tip; of an arrow that points at the viewer, beside it.
            let beyond = if flat > 0.2 { heading } else { Point::new(0.7, -0.7) };
            let at = tip + beyond * 0.55 * self.letters;
            let x_height = 0.54 * self.letters;
            let at = at + Point::new(-0.5 * words.width, 0.5 * x_height);
            paints.push(Paint::Fill(words.path.moved(at), ink));
        }
        // As much room as the arrows take: they point into any direction.
        let group = Group { says: "x, y and z".to_owned(), paints, halo: None };
        let [low, high] = group.bounds().unwrap_or_default();
        let paints = group.paints.iter().map(|paint| paint.moved(-low)).collect();
        Block { paints, size: high - low, says: group.says, written: "xyz".to_owned() }
    }

    fn legend(&self, legend: &Legend) -> Block {
        let (from, to) = (legend.from.unwrap_or(0.0), legend.to.unwrap_or(1.0));
        let stops = legend.map.clone().unwrap_or_default();
        let letters = self.letters;
        let mut paints = Vec::new();
        let heading = match (&*legend.text, &*legend.unit) {
            ("", unit) => unit.to_owned(),
            (text, "") => text.to_owned(),
            (text, unit) => format!("{text} ({unit})"),
        };
        let words = self.font.words(&heading, letters);
        let mut top = (0.5 * CAPITAL * letters).round();
        if !heading.is_empty() {
            top = (CAPITAL * letters + words.drop + 0.9 * letters).round();
        }
        let most = LEGEND_SHARE * f64::from(self.size[1]) - top;
        let height = (13.0 * letters).min(most).max(letters).round();
        let bar = Point::new((1.3 * letters).round().max(1.0), height);
        let at = Point::new(0.0, top);
        let line = (0.09 * letters).max(1.0);
        paints.push(Paint::Ramp { at, size: bar, stops });
        let edge = [(0.0, 0.0), (bar.x, 0.0), (bar.x, bar.y), (0.0, bar.y)];
        let edge = polygon(&edge).moved(at);
        paints.push(Paint::Line(edge, Stroke::new(self.ink, line)));
        let (mut widest, mut all) = (0.0_f64, heading.clone());
        for (value, written) in ticks(from, to, legend.ticks) {
            let t = (value - from) / (to - from);
            let y = top + height * (1.0 - t);
            let (left, right) = (bar.x, bar.x + 0.35 * letters);
            let tick = Path::polyline([Point::new(left, y), Point::new(right, y)]);
            paints.push(Paint::Line(tick, Stroke::new(self.ink, line)));
            let words = self.font.words(&written, letters);
            let at = Point::new(right + 0.3 * letters, y + 0.5 * CAPITAL * letters);
            widest = widest.max(at.x + words.width);
            paints.push(Paint::Fill(words.path.moved(at), self.ink));
            all += &written;
        }
        let width = widest.max(bar.x).max(words.width);
        if matches!(legend.place, Anchor::Right | Anchor::TopRight | Anchor::BottomRight) {
            // Its right side is even with the picture's.
            let by = Point::new((width - widest.max(bar.x)).round(), 0.0);
            paints = paints.iter().map(|paint| paint.moved(by)).collect();
        }
        paints.push(Paint::Fill(words.path.moved(Point::new(0.0, CAPITAL * letters)), self.ink));
        Block {
            paints,
            size: Point::new(width, top + height + 0.5 * CAPITAL * letters),
            says: format!(
                "{heading}: from {} to {}",
                number(from, decimals(from)),
                number(to, decimals(to))
            ),
            written: all,
        }
    }

    /// A label at its place in the picture.
    pub(super) fn label(&self, label: &PointLabel, place: Point) -> Group {
        let words = self.font.words(&label.text, self.letters);
        let right = label.offset.x * self.point;
        let x = match label.offset.x.partial_cmp(&0.0) {
            Some(std::cmp::Ordering::Greater) => right,
            Some(std::cmp::Ordering::Less) => right - words.width,
            _ => -0.5 * words.width,
        };
        let high = 0.5 * (CAPITAL * self.letters - words.drop);
        let at = place + Point::new(x, high - label.offset.y * self.point);
        Group {
            says: label.text.clone(),
            paints: vec![Paint::Fill(words.path.moved(at), self.ink)],
            halo: self.halo,
        }
    }
}

fn polygon(corners: &[(f64, f64)]) -> Path {
    Path::polygon(corners.iter().map(|&(x, y)| Point::new(x, y)))
}

fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_owned() } else { format!("{number} {unit}") }
}

/// Digits behind the point that a number was written with, at most six.
fn decimals(value: f64) -> usize {
    (0..6).find(|&digits| format!("{value:.digits$}").parse() == Ok(value)).unwrap_or(6)
}

/// Round numbers from one number to another, about `count` of them, as numbers and as they are written.
fn ticks(from: f64, to: f64, count: u32) -> Vec<(f64, String)> {
    let (low, high) = (from.min(to), from.max(to));
    let Some(step) = Round::below((high - low) / f64::from(count.max(2) - 1) * 1.000_001) else {
        return Vec::new();
    };
    let (first, last) = ((low / step.value()).ceil(), (high / step.value()).floor());
    // A range of a few numbers far from 0 has no round numbers in it.
    if !(last.abs().max(first.abs()) < 1e12 && last - first < 100.0) {
        return vec![(from, number(from, decimals(from))), (to, number(to, decimals(to)))];
    }
    step.multiples(first as i64, last as i64)
}

/// The camera's right, up and forward.
fn frame(camera: &phong_scene::Camera) -> [DVec3; 3] {
    let forward = (camera.look_at - camera.eye).normalize_or(-DVec3::Z);
    let right = forward.cross(camera.up).normalize_or(forward.any_orthonormal_vector());
    [right, right.cross(forward), forward]
}

/// Pixels of a scene unit that lies across the view at the camera's focus; `None`: it is not the same
/// all over the picture.
pub(super) fn pixels_a_unit(camera: &phong_scene::Camera, size: [u32; 2]) -> Option<f64> {
    if matches!(camera.kind, CameraKind::Fisheye { .. } | CameraKind::Panorama) {
        return None;
    }
    let [right, _, forward] = frame(camera);
    let distance = camera.focus_distance();
    let middle = camera.eye + forward * distance;
    let across = 0.01 * distance;
    let made = Camera::new(camera);
    let [from, to] = [0.0, across].map(|by| made.place(middle + right * by, size));
    let pixels = (to? - from?).length() / across;
    (pixels.is_finite() && pixels > 0.0).then_some(pixels)
}

/// Where a point of the scene is in the picture, and how far away along the ray to it; `None`: nowhere.
pub(super) fn place_of(point: DVec3, scene: &Scene, size: [u32; 2]) -> Option<(Point, f64)> {
    let camera = &scene.camera;
    let place = Camera::new(camera).seen_at(point, size)?;
    let [width, height] = size.map(f64::from);
    if !(0.0..width).contains(&place.x) || !(0.0..height).contains(&place.y) {
        return None;
    }
    let to = point - camera.eye;
    let away = match camera.kind {
        CameraKind::Orthographic { .. } => to.dot(frame(camera)[2]),
        _ => to.length(),
    };
    (away > 0.0).then_some((place, away))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(from: f64, to: f64, count: u32) -> Vec<String> {
        ticks(from, to, count).into_iter().map(|(_, written)| written).collect()
    }

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        assert_eq!(numbers(0.0, 40.0, 5), ["0", "10", "20", "30", "40"]);
        assert_eq!(numbers(0.13, 0.87, 5), ["0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8"]);
        assert_eq!(numbers(1.0, -1.0, 5), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(numbers(0.0, 3e8, 4), ["0", "10⁸", "2 · 10⁸", "3 · 10⁸"]);
        assert_eq!(numbers(1e15, 1e15 + 1.0, 5).len(), 2);
    }

    #[test]
    fn ticks_of_a_legend_are_written_in_one_way() {
        assert_eq!(numbers(8e5, 1.2e6, 3), ["800000", "1000000", "1200000"]);
        assert_eq!(numbers(-5e-10, 5e-10, 3), ["−5 · 10⁻¹⁰", "0", "5 · 10⁻¹⁰"]);
        assert_eq!(numbers(0.0, 1e-9, 3), ["0", "0.5 · 10⁻⁹", "1.0 · 10⁻⁹"]);
        assert_eq!(numbers(0.0, 2e-3, 3), ["0.000", "0.001", "0.002"]);
        assert_eq!(numbers(1e6, 1e6 + 2.0, 3), ["1000000", "1000001", "1000002"]);
    }

    #[test]
    fn a_unit_has_so_many_pixels_at_the_focus() {
        let camera =
            |kind, focus| phong_scene::Camera { kind, focus, ..phong_scene::Camera::default() };
        let orthographic = camera(CameraKind::Orthographic { height: 4.0 }, None);
        let pixels = |camera: &phong_scene::Camera| pixels_a_unit(camera, [300, 200]);
        assert!((pixels(&orthographic).unwrap() - 50.0).abs() < 1e-9);
        let perspective = CameraKind::Perspective { fov: 90.0 };
        // At distance 5 the picture is 10 units high, at 20 it is 40.
        assert!((pixels(&camera(perspective, None)).unwrap() - 20.0).abs() < 1e-9);
        assert!((pixels(&camera(perspective, Some(20.0))).unwrap() - 5.0).abs() < 1e-9);
        assert_eq!(pixels(&camera(CameraKind::Panorama, None)), None);
    }
}
