//! The renderer: from a [`phong_scene::Scene`] to light, and from light to pixels.
//!
//! Rooms, lowest storey first; a room imports only rooms below it: `math`; `terms`,
//! `reflectance`, `sampling`, `filter`; `material`, `light`, `camera`; `interaction`, `geometry`,
//! `look`, `view`; `integrator`, `witness`; `film`, `aov`, `render`; `finish`, `image`, `part`,
//! `explain`.

pub mod aov;
pub mod camera;
pub mod explain;
pub mod film;
pub mod filter;
pub mod finish;
pub mod geometry;
pub mod image;
pub mod integrator;
pub mod interaction;
pub mod light;
pub mod look;
pub mod material;
pub mod math;
pub mod part;
pub mod reflectance;
pub mod render;
pub mod sampling;
pub mod terms;
pub mod view;
pub mod witness;
