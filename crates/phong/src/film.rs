//! The film: what has been rendered so far, layer by layer.

mod sums;
mod values;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use thiserror::Error;

use crate::aov::Aov;
use crate::terms::Term;
pub(crate) use sums::{Sums8, TileSums, coverage, eights_of};
pub use values::Values;

/// A half-open rectangle of pixels of the full picture: `x0 ≤ x < x1`, `y0 ≤ y < y1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Left edge.
    pub x0: u32,
    /// Upper edge.
    pub y0: u32,
    /// Right edge, not included.
    pub x1: u32,
    /// Lower edge, not included.
    pub y1: u32,
}

impl Window {
    /// All of a picture of `size` (width, height).
    pub const fn full([width, height]: [u32; 2]) -> Self {
        Self { x0: 0, y0: 0, x1: width, y1: height }
    }

    /// The one pixel at `x`, `y`.
    pub const fn pixel([x, y]: [u32; 2]) -> Self {
        Self { x0: x, y0: y, x1: x.saturating_add(1), y1: y.saturating_add(1) }
    }

    /// Pixels across.
    pub const fn width(&self) -> u32 {
        self.x1 - self.x0
    }

    /// Pixels down.
    pub const fn height(&self) -> u32 {
        self.y1 - self.y0
    }

    /// One of the square tiles of this edge that it is cut into, row by row; those at the right and
    /// lower edge may be smaller.
    #[must_use]
    pub const fn tile(&self, edge: u32, index: usize) -> Self {
        let across = self.width().div_ceil(edge);
        let (column, row) = (index % across as usize, index / across as usize);
        let (x0, y0) = (self.x0 + column as u32 * edge, self.y0 + row as u32 * edge);
        let [right, lower] = [self.x1 - x0, self.y1 - y0];
        let x1 = x0 + if edge < right { edge } else { right };
        let y1 = y0 + if edge < lower { edge } else { lower };
        Self { x0, y0, x1, y1 }
    }

    /// The pixels that are in both; nothing to be counted on where there is none.
    pub(crate) fn intersection(&self, other: &Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }

    /// Pixels in it.
    pub const fn pixels(&self) -> u64 {
        self.width() as u64 * self.height() as u64
    }

    /// Whether it holds at least one pixel and lies within a picture of `size`.
    pub const fn fits(&self, [width, height]: [u32; 2]) -> bool {
        self.x0 < self.x1 && self.y0 < self.y1 && self.x1 <= width && self.y1 <= height
    }
}

/// What a layer holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LayerKind {
    /// The f32 sum of the terms; linear, unclamped. Where the background is transparent it adds
    /// nothing, so the values are premultiplied by the alpha.
    Picture,
    /// Coverage in [0, 1]; 1 everywhere unless the background is transparent.
    Alpha,
    /// One term of the sum.
    Term(Term),
    /// What one light brought, by its number from 0: its diffuse and specular light, its surface where
    /// that is seen, and all of it that mirrors and glass show. Linear, unclamped.
    Light(u32),
    /// What no light brought: background, ambient light, what glows, and fog. With all lights it sums to
    /// the picture, but for rounding.
    Unlit,
    /// One arbitrary output variable.
    Aov(Aov),
}

impl LayerKind {
    /// Its name: `picture`, `alpha`, that of the term or variable, `light.1` for the first light, or
    /// `light.rest`.
    pub fn name(self) -> Cow<'static, str> {
        match self {
            Self::Picture => "picture".into(),
            Self::Alpha => "alpha".into(),
            Self::Term(term) => term.name().into(),
            Self::Light(number) => format!("light.{}", u64::from(number) + 1).into(),
            Self::Unlit => "light.rest".into(),
            Self::Aov(aov) => aov.name().into(),
        }
    }

    /// The layer of that [name](Self::name).
    pub fn from_name(name: &str) -> Option<Self> {
        let light = |number: &str| {
            let number = number.parse::<u32>().ok()?.checked_sub(1)?;
            Some(Self::Light(number)).filter(|layer| layer.name() == name)
        };
        match name {
            "picture" => Some(Self::Picture),
            "alpha" => Some(Self::Alpha),
            "light.rest" => Some(Self::Unlit),
            _ => (Term::from_name(name).map(Self::Term))
                .or_else(|| Aov::from_name(name).map(Self::Aov))
                .or_else(|| name.strip_prefix("light.").and_then(light)),
        }
    }

    /// Whether it is the weighted mean of a pixel's samples; else it is of the ray through the
    /// pixel's centre alone.
    pub const fn is_averaged(self) -> bool {
        match self {
            Self::Picture | Self::Alpha | Self::Term(_) | Self::Light(_) | Self::Unlit => true,
            Self::Aov(_) => false,
        }
    }

    /// Values a pixel.
    pub const fn channels(self) -> usize {
        match self {
            Self::Picture | Self::Term(_) | Self::Light(_) | Self::Unlit => 3,
            Self::Alpha => 1,
            Self::Aov(aov) => aov.channels(),
        }
    }
}

/// One layer of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What it holds.
    pub kind: LayerKind,
    /// `kind.channels()` values a pixel, rows from top to bottom. 0 where not yet rendered.
    pub values: Values,
}

/// What has been rendered so far. Pixels are gathered in square tiles, row by row over the window.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width and height of the full picture, of which `window` is a part.
    pub size: [u32; 2],
    /// The part of the picture this film holds.
    pub window: Window,
    /// Edge of a tile in pixels.
    pub tile: u32,
    /// Which tiles have all their samples, row by row over the window. What a layer holds of the
    /// others is 0, or what an earlier pass left there.
    pub done: Vec<bool>,
    /// The picture, the alpha, then what else was asked for.
    pub layers: Vec<Layer>,
    /// Of tiles that have some of their samples: what it takes to go on with them.
    sums: BTreeMap<usize, Arc<TileSums>>,
}

/// What a film holds of a tile: all that it takes to go on with it.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmTile {
    pub(crate) index: usize,
    /// For each layer of the film, in order, the tile's own rows.
    pub(crate) values: Vec<Vec<f32>>,
    /// Where samples are lacking: what goes on.
    pub(crate) sums: Option<Arc<TileSums>>,
}

/// Why two films cannot be one.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum MergeError {
    /// They are not parts of the same picture: the caller's fault.
    #[error("the parts differ in {0}: they are not shares of one picture")]
    Differ(&'static str),
    /// Both hold this tile.
    #[error("tile {0} is in more than one part")]
    Overlap(usize),
}

/// Values that are looked through without a branch.
const PIECE: usize = 4096;

impl Film {
    /// An empty film.
    pub fn new(size: [u32; 2], window: Window, tile: u32, kinds: &[LayerKind]) -> Self {
        let pixels = window.width() as usize * window.height() as usize;
        let layer =
            |&kind: &LayerKind| Layer { kind, values: Values::zeroed(pixels * kind.channels()) };
        let [across, down] = tiles(&window, tile);
        Self {
            size,
            window,
            tile,
            done: vec![false; across as usize * down as usize],
            layers: kinds.iter().map(layer).collect(),
            sums: BTreeMap::new(),
        }
    }

    /// Width in pixels of what it holds.
    pub fn width(&self) -> u32 {
        self.window.width()
    }

    /// Height in pixels of what it holds.
    pub fn height(&self) -> u32 {
        self.window.height()
    }

    /// The layer of a kind, if it was asked for.
    pub fn layer(&self, kind: LayerKind) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.kind == kind)
    }

    /// The values of the layer at a pixel of the full picture; `None` outside the window.
    pub fn at(&self, kind: LayerKind, x: u32, y: u32) -> Option<&[f32]> {
        let w = self.window;
        if !(w.x0..w.x1).contains(&x) || !(w.y0..w.y1).contains(&y) {
            return None;
        }
        let pixel = (y - w.y0) as usize * w.width() as usize + (x - w.x0) as usize;
        let n = kind.channels();
        self.layer(kind).map(|layer| &layer.values[pixel * n..][..n])
    }

    /// Tiles in the window, whatever is done of them.
    pub fn tiles(&self) -> usize {
        self.done.len()
    }

    /// The pixels of a tile; those at the right and lower edge may be smaller.
    pub fn tile_window(&self, index: usize) -> Window {
        self.window.tile(self.tile, index)
    }

    /// A part of a whole film, with these of its layers.
    pub(crate) fn cut(&self, window: Window, kinds: &[LayerKind]) -> Self {
        let mut cut = Self::new(self.size, window, self.tile, kinds);
        cut.done.fill(true);
        for to in &mut cut.layers {
            if let Some(from) = self.layer(to.kind) {
                let values = self.cut_values(&from.values, to.kind.channels(), window);
                to.values.copy_from_slice(&values);
            }
        }
        cut
    }

    /// The values of a part, of so many a pixel of the film.
    pub(crate) fn cut_values(&self, values: &[f32], channels: usize, window: Window) -> Vec<f32> {
        let own = self.window;
        let across = own.width() as usize;
        let mut cut = Vec::with_capacity(window.pixels() as usize * channels);
        for y in window.y0..window.y1 {
            let first = (y - own.y0) as usize * across + (window.x0 - own.x0) as usize;
            let end = first + window.width() as usize;
            cut.extend_from_slice(&values[first * channels..end * channels]);
        }
        cut
    }

    /// Whether every tile is rendered.
    pub fn is_complete(&self) -> bool {
        self.done.iter().all(|&done| done)
    }

    /// Pixels that are infinite or NaN in the picture or in a term: numbers in a scene may each be in
    /// range, and their product too large for an f32.
    pub fn not_finite(&self) -> usize {
        let colors = |layer: &&Layer| matches!(layer.kind, LayerKind::Picture | LayerKind::Term(_));
        let colors: Vec<_> = self.layers.iter().filter(colors).collect();
        // All of a piece, without a branch for each.
        let is_finite = |piece: &[f32]| piece.iter().fold(true, |all, v| all & v.is_finite());
        let sound = |layer: &Layer| layer.values.chunks(PIECE).all(is_finite);
        if colors.iter().all(|layer| sound(layer)) {
            return 0;
        }
        let pixels = self.window.pixels() as usize;
        let is_bad = |&pixel: &usize| {
            let values = colors.iter().flat_map(|layer| &layer.values[3 * pixel..3 * pixel + 3]);
            values.into_iter().any(|value| !value.is_finite())
        };
        (0..pixels).filter(is_bad).count()
    }

    /// Samples that each pixel of a tile has of so many asked for.
    pub fn samples_of(&self, index: usize, of: u32) -> u32 {
        if self.done[index] { of } else { self.sums.get(&index).map_or(0, |sums| sums.samples()) }
    }

    /// Takes a rendered tile: for each layer, in order, the tile's own rows.
    ///
    /// # Panics
    /// If the layers do not have the sizes that [`Film::tile_window`] and the kinds demand.
    pub fn put(&mut self, index: usize, values: &[Vec<f32>]) {
        self.put_values(index, values);
        self.done[index] = true;
        self.sums.remove(&index);
    }

    /// Takes a tile as another film of the same picture holds it.
    pub(crate) fn put_tile(&mut self, FilmTile { index, values, sums }: FilmTile) {
        if sums.is_some() {
            self.put_unfinished(index, &values, sums);
        } else {
            self.put(index, &values);
        }
    }

    /// Takes a tile that lacks samples: its values, and the sums from which it goes on; none
    /// where it begins anew.
    pub(crate) fn put_unfinished(
        &mut self,
        index: usize,
        values: &[Vec<f32>],
        sums: Option<Arc<TileSums>>,
    ) {
        self.put_values(index, values);
        self.sums.extend(sums.map(|sums| (index, sums)));
    }

    /// What it takes to go on with a tile that has some of its samples.
    pub(crate) fn sums(&self, index: usize) -> Option<&Arc<TileSums>> {
        self.sums.get(&index)
    }

    fn put_values(&mut self, index: usize, values: &[Vec<f32>]) {
        let part = self.tile_window(index);
        assert_eq!(values.len(), self.layers.len(), "a tile has the film's layers");
        for (layer, from) in self.layers.iter_mut().zip(values) {
            let n = layer.kind.channels();
            let row = part.width() as usize * n;
            for (y, from) in (part.y0..part.y1).zip(from.chunks_exact(row)) {
                let pixel = (y - self.window.y0) as usize * self.window.width() as usize
                    + (part.x0 - self.window.x0) as usize;
                layer.values[pixel * n..][..row].copy_from_slice(from);
            }
        }
    }

    /// Takes the tiles of another film of the same picture.
    ///
    /// # Errors
    /// [`MergeError`]; this film is then as it was.
    pub fn merge(&mut self, other: &Self) -> Result<(), MergeError> {
        let kinds = |film: &Self| film.layers.iter().map(|l| l.kind).collect::<Vec<_>>();
        for (same, what) in [
            (self.size == other.size, "size"),
            (self.window == other.window, "crop"),
            (self.tile == other.tile, "tile size"),
            (kinds(self) == kinds(other), "layers"),
        ] {
            if !same {
                return Err(MergeError::Differ(what));
            }
        }
        if let Some(tile) = (0..self.tiles()).find(|&i| self.done[i] && other.done[i]) {
            return Err(MergeError::Overlap(tile));
        }
        for tile in (0..other.tiles()).filter(|&i| other.done[i]) {
            self.put(tile, &other.take(tile));
        }
        Ok(())
    }

    /// The values of a tile, for each layer its rows.
    pub fn take(&self, index: usize) -> Vec<Vec<f32>> {
        self.layers.iter().map(|layer| self.rows(layer, index)).collect()
    }

    /// The same of the arbitrary output variables alone, put among a tile's values.
    pub(crate) fn take_variables(&self, index: usize, values: &mut [Vec<f32>]) {
        for (layer, values) in self.layers.iter().zip(values) {
            if matches!(layer.kind, LayerKind::Aov(_)) {
                *values = self.rows(layer, index);
            }
        }
    }

    fn rows(&self, layer: &Layer, index: usize) -> Vec<f32> {
        let part = self.tile_window(index);
        let n = layer.kind.channels();
        let row = part.width() as usize * n;
        let mut out = Vec::with_capacity(row * part.height() as usize);
        for y in part.y0..part.y1 {
            let pixel = (y - self.window.y0) as usize * self.window.width() as usize
                + (part.x0 - self.window.x0) as usize;
            out.extend_from_slice(&layer.values[pixel * n..][..row]);
        }
        out
    }

    /// All that there is of a tile; `None` if it has no sample of every pixel yet.
    pub fn film_tile(&self, index: usize) -> Option<FilmTile> {
        let sums = self.sums.get(&index).cloned();
        let begun = self.done[index] || sums.is_some();
        begun.then(|| FilmTile { index, values: self.take(index), sums })
    }

    /// All that there is of each tile that has something of it, one after another.
    pub fn film_tiles(&self) -> impl Iterator<Item = FilmTile> {
        (0..self.tiles()).filter_map(|index| self.film_tile(index))
    }

    /// Whether it has as many values and tiles as its window asks for.
    pub(crate) fn is_sound(&self) -> bool {
        let pixels = self.window.pixels() as usize;
        let [across, down] = tiles(&self.window, self.tile);
        let full = |layer: &Layer| layer.values.len() == pixels * layer.kind.channels();
        self.done.len() == across as usize * down as usize && self.layers.iter().all(full)
    }
}

fn tiles(window: &Window, tile: u32) -> [u32; 2] {
    [window.width().div_ceil(tile), window.height().div_ceil(tile)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [LayerKind; 2] = [LayerKind::Picture, LayerKind::Alpha];

    fn film() -> Film {
        Film::new([10, 7], Window { x0: 1, y0: 2, x1: 10, y1: 7 }, 4, &KINDS)
    }

    fn filled(mut film: Film, tiles: impl Iterator<Item = usize>, value: f32) -> Film {
        for tile in tiles {
            let w = film.tile_window(tile);
            let pixels = (w.width() * w.height()) as usize;
            film.put(tile, &[vec![value; 3 * pixels], vec![1.0; pixels]]);
        }
        film
    }

    #[test]
    fn tiles_cover_the_window_once() {
        let film = film();
        let mut seen = std::collections::BTreeSet::new();
        for tile in 0..film.tiles() {
            let w = film.tile_window(tile);
            for y in w.y0..w.y1 {
                for x in w.x0..w.x1 {
                    assert!(seen.insert((x, y)), "({x}, {y}) twice");
                }
            }
        }
        assert_eq!(seen.len(), 9 * 5);
    }

    #[test]
    fn tiles_are_told_apart_where_there_are_more_than_32_bits_can_number() {
        let tile = Window::full([1 << 20; 2]).tile(1, (1 << 32) + 5);
        assert_eq!(tile, Window { x0: 5, y0: 1 << 12, x1: 6, y1: (1 << 12) + 1 });
    }

    #[test]
    fn shares_put_together_are_the_whole() {
        let whole = filled(film(), 0..6, 0.5);
        let mut merged = filled(film(), (0..6).step_by(2), 0.5);
        merged.merge(&filled(film(), (1..6).step_by(2), 0.5)).unwrap();
        assert!(merged.is_complete());
        assert_eq!(merged, whole);
    }

    #[test]
    fn parts_that_overlap_or_differ_are_refused() {
        let mut a = filled(film(), 0..2, 0.5);
        assert_eq!(a.merge(&filled(film(), 1..3, 0.5)), Err(MergeError::Overlap(1)));
        let other = Film::new([10, 7], Window::full([10, 7]), 4, &KINDS);
        assert_eq!(a.merge(&other), Err(MergeError::Differ("crop")));
    }
}
