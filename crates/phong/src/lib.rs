//! The renderer: from a [`Scene`] to light, and from light to pixels.
//!
//! A picture of a scene, written whole or not at all:
//!
//! ```no_run
//! use phong::{Cancel, Encoding, Finishing, RenderOptions, View, finish, render, save, scene};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//!
//! let reading = scene::read("scenes/two-balls.toml", None, &scene::Folder, &scene::Limits::default());
//! let scene = reading.into_scene()?;
//! let options = RenderOptions::of(&scene.image)?;
//! let film = render(&View::of(&scene)?, &options, &|_| {}, &Cancel::default()).film;
//! save(&finish(&film, &Finishing::default()), "two-balls.png".as_ref(), &Encoding::default())?;
//! # Ok(())
//! # }
//! ```
//!
//! What it does not look at here: the warnings of [`scene::Reading`], the passes and events of a
//! [`render::Rendering`], and why a pixel has its colour, which [`explain`] tells.
//!
//! A program that draws pictures needs no other crate of the project: what it builds scenes of is
//! re-exported as [`scene`], and what rays are made of as [`bvh`]. Points and vectors are those of
//! [`glam`], re-exported too; directions are [`math::Dir3`].
//!
//! `ARCHITECTURE.md` shows the rooms and their order.

// It has no threads; everything else in this crate says `rayon`.
#[cfg(target_arch = "wasm32")]
extern crate serial as rayon;

pub mod aov;
pub mod camera;
pub mod explain;
pub mod film;
mod filter;
pub mod finish;
pub mod geometry;
pub mod image;
mod integrator;
pub mod interaction;
pub mod light;
pub mod look;
pub mod material;
pub mod math;
pub mod part;
pub mod reflectance;
pub mod render;
mod sampling;
mod sky;
pub mod terms;
pub mod texture;
pub mod view;
pub mod witness;

pub use glam;
pub use phong_bvh as bvh;
pub use phong_scene as scene;
pub use phong_scene::Scene;

pub use finish::{Finishing, finish};
pub use image::{Encoding, save};
pub use render::{Cancel, RenderOptions, render};
pub use view::View;

// The Rust of the README is compiled with the documentation's tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
