//! The protocol, against the engine and against the server.
#![allow(clippy::unwrap_used, reason = "tests")]

mod changing;
mod client;
mod dressing;
mod engine;
mod finishing;
mod frames;
#[cfg(feature = "server")]
mod hostile;
#[cfg(feature = "server")]
mod saving;
#[cfg(feature = "server")]
mod server;
mod teaching;

/// A small scene: two balls, of which one mirrors, a floor, two lights.
const SCENE: &str = r##"version = 1
[image]
size = [40, 22]
samples = 3
background = "#88aacc"
[camera]
eye = [0, 2.2, 8]
look_at = [0, 0.9, 0]
fov = 30
[[light]]
kind = "point"
position = [-4, 6, 5]
color = 0.75
[[light]]
kind = "distant"
direction = [-2, -3, -2]
color = 0.35
[materials.plastic]
color = "#c8402f"
shininess = 60
[materials.glassy]
color = 0.2
reflection = 0.6
[[sphere]]
center = [-1.15, 1, 0]
radius = 1
material = "plastic"
[[sphere]]
center = [1.2, 0.8, 0.6]
radius = 0.8
material = "glassy"
[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
"##;
