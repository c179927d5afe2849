//! Wavefront MTL.
