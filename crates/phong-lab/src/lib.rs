//! What is asked of the renderer: figures, what a figure needs beside its picture, fits, grades,
//! comparisons, formulas evaluated by name, measured memory and speed, and explanations of a pixel as
//! text, JSON, LaTeX, SVG and HTML.
//!
//! Everything here is made from the public items of [`phong`]. A program that only draws pictures
//! does not need this crate.

// It has no threads; everything else in this crate says `rayon`.
#[cfg(target_arch = "wasm32")]
extern crate serial as rayon;

pub mod compare;
mod draw;
pub mod eval;
pub mod figures;
pub mod fit;
pub mod furniture;
pub mod grade;
mod markup;
pub mod measure;
pub mod stereo;
pub mod tell;
