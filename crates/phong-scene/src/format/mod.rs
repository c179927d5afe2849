//! The formats scenes and models come in.

pub(crate) mod model;
pub(crate) mod mtl;
pub(crate) mod obj;
mod origin;
pub(crate) mod ply;
mod text;
