//! What a figure needs beside its picture, drawn when that is done: title, scale bar, axes, legend and
//! labels.
//!
//! It is outlines, those of the letters too, so it is sharp at any size. [`finish`] draws it in pixels onto a
//! film's picture, [`svg()`] writes it as outlines over one. It is no part of the film, and comes after exposure
//! and tone: ink is ink.

mod layout;
mod raster;
mod round;
mod sheet;
mod svg;
mod text;

use phong::aov::Aov;
use phong::explain::Explanation;
use phong::film::{Film, LayerKind, Window};
use phong::finish::{Finished, Finishing, Patch};
use phong::part::{Settings, furniture_of};
use phong::render::{Cancel, Event, RenderOptions, render};
use phong::terms::TermSet;
use phong::view::View;
use phong_scene::{Diagnostic, Furniture, Hidden, Scene};

use layout::{Layout, pixels_a_unit, place_of};
use sheet::Group;
use text::Font;

pub use svg::svg;

/// Pixels an inch where nobody says.
pub const DPI: f64 = 96.0;

/// The share of its distance by which a point may lie behind what is seen there without being hidden: it
/// lies *on* something more often than not.
const SLACK: f64 = 2e-3;

/// Finishes a film's picture by its settings: lines, and all the scene's furniture over them.
///
/// This is what every picture goes through that is looked at. The film is the whole one; of a share nothing
/// is finished.
pub fn finish<'a>(film: &'a Film, settings: &Settings) -> Finished<'a> {
    phong::finish(film, &finishing(film, settings))
}

/// How a film is to be finished by its settings: lines, and all the scene's furniture over them.
pub fn finishing(film: &Film, settings: &Settings) -> Finishing {
    let mut finishing = settings.finishing();
    if let Some(scene) = settings.furniture() {
        finishing.patches = patches(&scene, film, settings.size);
    }
    finishing
}

/// The furniture of a scene as [`furniture_of`] has it, drawn for a picture of `size`
/// pixels of which this is the film. All of it together has at most three times as many pixels as the picture.
pub fn patches(furniture: &Scene, film: &Film, size: [u32; 2]) -> Vec<Patch> {
    let seen = unhidden(furniture, size, |pixel| depth(film, pixel));
    raster::patches(&groups(&Font::new(), &seen, size), size)
}

/// What of the furniture of a scene as [`furniture_of`] has it lies over one pixel of the picture, the lowest first:
/// pieces of that pixel. Which labels are hidden is found by rays of their own.
pub fn over_pixel(
    furniture: &Scene,
    view: &View,
    options: &RenderOptions,
    [x, y]: [u32; 2],
    cancel: &Cancel,
) -> Vec<Patch> {
    let (size, depth_alone) = (options.size(), options.clone().with_terms(TermSet::NONE));
    let depth_alone = depth_alone.with_lights(None).with_aovs(&[Aov::Depth]);
    let seen = unhidden(furniture, size, |pixel| {
        let there = depth_alone.clone().with_window(Window::pixel(pixel));
        let once = there.and_then(|there| there.with_samples(1)?.with_share(0, 1));
        once.map_or(f32::NEG_INFINITY, |once| {
            depth(&render(view, &once, &|_| {}, cancel).film, pixel)
        })
    });
    let all = raster::patches(&groups(&Font::new(), &seen, size), size);
    let cut = all.iter().filter_map(|patch| patch.cut(Window::pixel([x, y]), [x, y]));
    cut.filter(|patch| patch.pixels.iter().any(|pixel| pixel[3] > 0)).collect()
}

/// Finds out how an explained pixel's light becomes what a PNG of the scene's picture shows
/// ([`Explanation::expose`]), and what of the furniture lies over it.
pub fn expose(
    told: &mut Explanation,
    scene: &Scene,
    view: &View,
    options: &RenderOptions,
    listen: &(dyn Fn(Event<'_>) + Sync),
    cancel: &Cancel,
) {
    told.expose(scene, view, options, listen, cancel);
    let over = |figure: Scene| over_pixel(&figure, view, options, told.pixel, cancel);
    told.furniture = furniture_of(scene).map(over).unwrap_or_default();
}

/// The settings of a film's finished picture as a film of its own, whose furniture is still to be drawn: by
/// the film it is known which labels are hidden, and no other film says so.
#[must_use]
pub fn settled(film: &Film, settings: Settings) -> Settings {
    let Some(scene) = settings.furniture() else { return settings.finished() };
    let seen = unhidden(&scene, settings.size, |pixel| depth(film, pixel));
    settings.with_furniture(seen.furniture).finished()
}

/// What there is to say of a scene's furniture before it is drawn: letters that the font does not have, and what
/// is not drawn at all.
pub fn warnings(scene: &Scene) -> Vec<Diagnostic> {
    let Some(figure) = furniture_of(scene) else { return Vec::new() };
    let Furniture { scale_bar, labels, .. } = &figure.furniture;
    let font = Font::new();
    let edges = Layout::new(&font, &figure, scene.image.size).edges();
    let edges = edges.into_iter().map(|edge| (edge.key.to_owned(), edge.written));
    let labels = labels.iter().enumerate();
    let labels = labels.map(|(i, label)| (format!("label {}", i + 1), label.text.clone()));
    let mut said = Vec::new();
    for (name, text) in edges.chain(labels) {
        let missing = font.missing(&text);
        if !missing.is_empty() {
            let letters: Vec<String> = missing
                .iter()
                .map(|&letter| {
                    let seen = if letter.is_control() { "?".into() } else { letter.to_string() };
                    format!("{seen} (U+{:04X})", u32::from(letter))
                })
                .collect();
            let message = format!("{name}: the font has no {}, left out", letters.join(", "));
            let help = "it has Latin, Greek and Cyrillic letters, and the signs of units, powers and \
                        mathematics";
            said.push(Diagnostic::warning(message, None).with_help(help));
        }
    }
    if scale_bar.is_some() && pixels_a_unit(&scene.camera, scene.image.size).is_none() {
        let message =
            "scale_bar: it is not drawn: this camera has not one scale all over the picture";
        said.push(Diagnostic::warning(message, None));
    }
    said
}

/// What there is to say of furniture for which there is no room in the scene's picture: what reaches out of it, what
/// stands over something else, and bars too short to be seen.
pub fn crowded(scene: &Scene) -> Vec<Diagnostic> {
    let Some(figure) = furniture_of(scene) else { return Vec::new() };
    let (font, size) = (Font::new(), scene.image.size);
    let mut layout = Layout::new(&font, &figure, size);
    let mut said = Vec::new();
    let warning = |message| Diagnostic::warning(message, None);
    let bar = figure.furniture.scale_bar.iter().find_map(|bar| layout.unfit_bar(bar));
    if let Some((pixels, fits)) = bar {
        let message = if pixels < 1.0 {
            "scale_bar: it is not seen: it is shorter than a pixel".to_owned()
        } else {
            let wide = size[0];
            format!(
                "scale_bar: it does not fit: it is {pixels:.0} pixels long in a picture of {wide}"
            )
        };
        said.push(warning(message).with_help(format!("`length = {fits}` fits, or \"auto\"")));
    }
    let edges = layout.edges();
    let [width, height] = size.map(f64::from);
    for (number, edge) in edges.iter().enumerate() {
        let [low, high] = edge.bounds;
        let room =
            "another `place`, a smaller `size` of `[furniture]` or a larger picture makes room";
        let reaches_out = low.x < 0.0 || low.y < 0.0 || high.x > width || high.y > height;
        let is_told = edge.key == "scale_bar" && bar.is_some();
        if reaches_out && !is_told {
            let message = format!("{}: it reaches out of the picture", edge.key);
            said.push(warning(message).with_help(room));
        }
        for other in &edges[..number] {
            let [from, to] = other.bounds;
            if low.cmplt(to).all() && from.cmplt(high).all() {
                let message = format!("{}: it stands over the {}", edge.key, other.key);
                said.push(warning(message).with_help(room));
            }
        }
    }
    said
}

/// All furniture, in the order that it is painted in: labels first.
fn groups(font: &Font, scene: &Scene, size: [u32; 2]) -> Vec<Group> {
    let mut layout = Layout::new(font, scene, size);
    let labels = scene.furniture.labels.iter().filter_map(|label| {
        let (place, _) = place_of(label.at, scene, size)?;
        Some(layout.label(label, place))
    });
    let mut groups: Vec<Group> = labels.collect();
    groups.extend(layout.edges().into_iter().map(|edge| edge.group));
    groups
}

/// A scene of furniture without the labels that are out of the picture or hidden, so that nothing hides the others.
/// `depth` says how far what is seen at a pixel is.
fn unhidden(scene: &Scene, size: [u32; 2], depth: impl Fn([u32; 2]) -> f32) -> Scene {
    let mut unhidden = scene.clone();
    unhidden.furniture.labels.retain_mut(|label| {
        let Some((place, away)) = place_of(label.at, scene, size) else { return false };
        let is_seen = label.hidden == Hidden::Never || {
            let seen = depth([place.x as u32, place.y as u32]);
            f64::from(seen) + label.radius + SLACK * away >= away
        };
        label.hidden = Hidden::Never;
        is_seen
    });
    unhidden
}

/// How far what is seen at a pixel is: of a film without depth farther than anything, and before everything at a
/// pixel that it does not have.
fn depth(film: &Film, [x, y]: [u32; 2]) -> f32 {
    let window = film.window;
    if !(window.x0..window.x1).contains(&x) || !(window.y0..window.y1).contains(&y) {
        return f32::NEG_INFINITY;
    }
    let Some(depth) = film.layer(LayerKind::Aov(Aov::Depth)) else { return f32::INFINITY };
    let pixel = (y - window.y0) as usize * window.width() as usize + (x - window.x0) as usize;
    depth.values.get(pixel).copied().unwrap_or(f32::INFINITY)
}

#[cfg(test)]
mod golden;
#[cfg(test)]
mod tests;
