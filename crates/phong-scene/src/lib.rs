//! A scene as data, and everything that reads or writes one.
//!
//! The door is [`Scene`]: resolved (no name left to look up), checked, with every default filled
//! in. This crate knows no rays and no pixels, and never imports another crate of the project (but
//! the stand-in for rayon where there are no threads). It never prints, exits or panics on input:
//! reading gives *all* [`Diagnostic`]s as data.

// It has no threads; everything else in this crate says `rayon`.
#[cfg(target_arch = "wasm32")]
extern crate serial as rayon;

mod ambient_occlusion;
mod batch;
mod bounds;
mod camera;
mod camera_path;
mod change;
mod check;
mod clip;
mod color;
mod diagnostic;
mod dialect;
mod elements;
mod fog;
mod format;
mod fragment;
mod frame;
mod furniture;
mod keys;
mod light;
mod limits;
mod looks;
mod maps;
mod material;
mod mesh;
mod molecule;
mod outline;
mod scene;
mod shape;
mod sky;
mod source;
mod texels;
mod texture;
mod tone;
mod transform;
mod unpack;
mod wording;

pub use ambient_occlusion::{AmbientOcclusion, OcclusionDistance};
pub use batch::{Batch, BatchReading, Parameter, ParameterValues, Written};
pub use bounds::Bounds;
pub use camera::{Camera, CameraKind};
pub use camera_path::{CameraKey, CameraPath, CameraPathReading};
pub use change::Change;
pub use check::SoundArrays;
pub use clip::{Cap, Clip, ClipKind, CutObjects, Keep};
pub use color::{ColorError, Rgb, srgb_decode, srgb_encode};
pub use diagnostic::{Diagnostic, Label, Place, SceneError, Severity, Span};
pub use fog::{Fog, FogDistance, FogKind};
pub use format::export::{Account, File, PlyEncoding};
pub use format::frames::{FrameRange, Frames};
pub use format::origin::origin_of;
pub use format::table::Format;
pub use format::toml::batch::read_batch;
pub use format::toml::camera_path::read_camera_path;
pub use format::{Export, ExportOptions, read, read_changed};
pub use fragment::Fragment;
pub use frame::{Framing, Side};
pub use furniture::{
    Anchor, Axes, BarLength, Furniture, FurnitureStyle, Hidden, Legend, PointLabel, ScaleBar, Title,
};
pub use keys::{batch_reference_markdown, batch_schema_json, reference_markdown, schema_json};
pub use light::{Light, LightKind};
pub use limits::{LARGEST, Limits};
pub use looks::NamedLook;
pub use maps::{ColorScale, properties_shown};
pub use material::{
    AmbientRule, ConstantMaterial, Dialect, Distribution, Fresnel, Material, MaterialId, Model,
    NormalFormat, OpacityMode, ShadowRule, Shadowing, Tint, VertexColors, Viewer, WardForm,
};
pub use mesh::{Caps, Cylinders, Field, Mesh, NO_INDEX, Points, Shared};
pub use outline::Outline;
pub use scene::{Background, FilterKind, Group, Image, Object, Reading, Scene};
pub use shape::{GroupId, Shape};
pub use sky::{Sky, SkyKind};
pub use source::{Blob, Folder, Jail, Memory, Source, path_of, path_text, read_stream, trouble};
pub use texels::{TexelValues, Texels, TexelsError};
pub use texture::{
    CellsBy, Channel, Encoding, GradientBy, GridAxes, MapRange, MapSource, Param, TexelFilter,
    Texture, TextureId, TextureKind, TextureRef, TextureSpace, TextureUse, Textured, Wrap,
};
pub use tone::{Exposure, Tone, ToneCurve};
pub use transform::{cofactor, even_scale};
pub use wording::closest;
