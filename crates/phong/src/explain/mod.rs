//! Why a pixel is the colour it is: every ray, vector, dot product, term and shadow test.
//!
//! Nothing is computed here that the picture is made of: the integrator tells it through its
//! [`Witness`], and the samples are summed by the film's own sums. So the explanation's picture is
//! the film's pixel, bit for bit.

mod record;

use glam::DVec3;
use phong_scene::{ConstantMaterial, Exposure, Place, Rgb, Scene, TextureSpace, srgb_encode};
use thiserror::Error;

use crate::film::{Sums8, Window};
use crate::filter::Filter;
use crate::finish::{Finished, Finishing, Lined, Patch, ToneMap, ToneSteps, finish};
use crate::integrator::{Integrator, Radiance8, RayCounts, SampleGrid, Shares};
use crate::math::Dir3;
use crate::render::{Cancel, Drawn, Event, RenderOptions, camera_ray, render};
use crate::sampling::Sampler;
use crate::terms::{TermSet, Terms};
use crate::texture::ImageLookUp;
use crate::view::View;
use crate::witness::{CutReason, Faded, Witness};
use record::Recorder;

/// A pixel, explained.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The pixel, x to the right and y down from the upper left.
    pub pixel: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The camera's eye, in the world.
    pub eye: DVec3,
    /// Its samples, in the order they are summed.
    pub samples: Vec<Sample>,
    /// The terms as the film has them.
    pub terms: Terms,
    /// The picture as the film has it: the terms' f32 sum. Linear, unclamped.
    pub linear: Rgb,
    /// Coverage in [0, 1]; 1 unless the background is transparent.
    pub alpha: f32,
    /// How its light becomes what a PNG shows: as it is, until that is found out
    /// ([`expose`](Self::expose), [`finish_as`](Self::finish_as)).
    pub tone: ToneMap,
    /// By what the steps of luminance scale its light; `None`: there are none, or it is not
    /// found out.
    pub cel: Option<f32>,
    /// The pixel with the line that an outline draws onto it, after those steps; `None`: there is none, or it was
    /// not found out.
    pub lined: Option<Lined>,
    /// What of the figure's furniture lies over it after that, the lowest first, each cut to this pixel; empty:
    /// nothing does, or it was not found out.
    pub furniture: Vec<Patch>,
}

/// One sample of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Where in the picture, pixels.
    pub place: [f32; 2],
    /// Its weight in the pixel's sum: +1, or −1 where a filter is negative.
    pub weight: f32,
    /// Its ray; `None` outside the image circle of a fisheye.
    pub ray: Option<RayTold>,
    /// What it brought.
    pub terms: Terms,
}

/// A ray and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct RayTold {
    /// Where it starts, in the world.
    pub origin: DVec3,
    /// Its direction.
    pub dir: Dir3,
    /// What it met.
    pub end: End,
    /// What fog made of what it brought; `None`: there is none.
    pub fog: Option<Faded>,
}

/// Where a ray ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// It met nothing and saw this background.
    Background(Rgb),
    /// It saw the surface of a light, and brought its emission.
    Light {
        /// The light's name.
        name: String,
        /// Where it was written.
        at: Place,
        /// Distance along the ray.
        t: f32,
        /// What it brought. Linear.
        emission: Rgb,
    },
    /// It met a surface.
    Surface(Box<Surface>),
}

/// A surface that a ray met, and how it answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The object's name.
    pub object: String,
    /// Its number in the compiled scene, from 0.
    pub object_number: u32,
    /// Where it was written.
    pub at: Place,
    /// The face of a mesh, or the point of a cloud, from 0; `None` where the object is one thing.
    pub element: Option<u32>,
    /// The number of the clip, from 0, whose cut through the object this is; `None`: it is its surface.
    pub cap: Option<usize>,
    /// The material as it was written, with the values here of what textures vary.
    pub material: ConstantMaterial,
    /// What takes its value from a texture.
    pub textures: Vec<TextureTold>,
    /// Its number in the scene, from 0.
    pub material_number: u32,
    /// Distance along the ray.
    pub t: f32,
    /// The point, in the world.
    pub p: DVec3,
    /// Geometric normal as the surface has it, outwards.
    pub ng: Dir3,
    /// Shading normal N, on the side the ray comes from.
    pub n: Dir3,
    /// Unit tangent: the grain of brushed models.
    pub tangent: Dir3,
    /// E, to the eye.
    pub e: Dir3,
    /// Surface coordinates.
    pub uv: [f32; 2],
    /// Whether the ray comes from outside.
    pub from_outside: bool,
    /// The index of refraction of the far side relative to this one, where glasses meet or fill one
    /// another; `None`: it is the material's own.
    pub eta: Option<f32>,
    /// The surface's colour here: the geometry's own, else the material's.
    pub color: Rgb,
    /// `C_a`: the ambient light times the material's ambient colour.
    pub c_a: Rgb,
    /// The share of the surface that is there: a factor of its terms, mirror and refraction; 1 unless it is
    /// see-through.
    pub cover: f32,
    /// How much of the ambient light finds its way here; `None`: nothing takes it away.
    pub openness: Option<Openness>,
    /// The ambient term that belongs to no light.
    pub ambient: Rgb,
    /// Every light, in order.
    pub lights: Vec<Lit>,
    /// The mirror ray.
    pub reflection: Option<Onward>,
    /// The refracted ray.
    pub transmission: Option<Onward>,
    /// The ray that goes straight on, where the surface is see-through.
    pub through: Option<Onward>,
    /// All terms here, summed in the integrator's order, before any fog.
    pub terms: Terms,
}

/// How much of the ambient light finds its way to a surface: a factor of the ambient term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Openness {
    /// The share of the rays that met nothing.
    pub share: f32,
    /// How many rays looked around.
    pub rays: u32,
    /// How far they looked, scene units; infinite: as far as there is anything.
    pub distance: f32,
    /// The mean of the sky's light over all of them, 0 where they met something: the factor in place of the
    /// share. `None`: there is no sky.
    pub sky: Option<Rgb>,
}

/// A parameter of a material that takes its value from a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureTold {
    /// The parameter's key in the scene text.
    pub parameter: &'static str,
    /// The texture's name.
    pub texture: String,
    /// The space that the texture lies in.
    pub space: TextureSpace,
    /// The point in that space: of texture coordinates u, v and 0.
    pub place: DVec3,
    /// How its image is looked up there; `None`: it is none.
    pub image: Option<ImageLookUp>,
    /// What a map shows, and the number there, NaN where there is none; `None`: it is no map.
    pub number: Option<(String, f64)>,
    /// The texture's value there, not yet scaled nor shifted. Linear.
    pub value: Rgb,
}

/// What one light did at a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Lit {
    /// The light's name.
    pub name: String,
    /// Where it was written.
    pub at: Place,
    /// Where its light comes from.
    pub from: LightFrom,
    /// L, to the light; `None` if the point is where the light is.
    pub l: Option<Dir3>,
    /// R, L mirrored at N.
    pub r: Option<Dir3>,
    /// H, halfway between L and E; `None` where they are opposite.
    pub h: Option<Dir3>,
    /// Distance to the light; infinite for a distant one.
    pub distance: f32,
    /// L·N, not clamped.
    pub n_dot_l: f32,
    /// R·E, not clamped.
    pub r_dot_e: f32,
    /// N·H, not clamped.
    pub n_dot_h: f32,
    /// The light's colour here, attenuated.
    pub color: Rgb,
    /// `C_{m,d}`.
    pub c_d: Rgb,
    /// `C_{m,s}`.
    pub c_s: Rgb,
    /// Whether the light is above the horizon: that of N, and where things cast shadows, that of the
    /// geometric normal as well, but for smooth meshes whose shadow rays start above the face.
    pub above: bool,
    /// Whether a ray was sent to look for it.
    pub tested: bool,
    /// Where that ray starts, if it is sent from above the face of a smooth mesh; `None`: just off the
    /// point.
    pub lifted: Option<DVec3>,
    /// Whether it is seen.
    pub visible: bool,
    /// What is left of its light on the way, channel by channel: black if it is not seen, less than white
    /// behind what is see-through.
    pub visibility: Rgb,
    /// The nearest thing between, if there is one.
    pub blocker: Option<Blocker>,
    /// What white light from there would add to the diffuse and specular terms: `C_{m,d}` and
    /// `C_{m,s}` 1, weights and cosines included; 0 where it is not seen.
    pub white: Terms,
    /// What it adds to the ambient term, where that is added per light.
    pub ambient: Rgb,
    /// What it adds to the diffuse term.
    pub diffuse: Rgb,
    /// What it adds to the specular term.
    pub specular: Rgb,
}

/// Where a light's light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightFrom {
    /// A point in the world; of a soft light the one that was sampled.
    Point(DVec3),
    /// Far away: the way the light travels, as it was written, of any length.
    Direction(DVec3),
}

/// What stands between a point and a light.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocker {
    /// The object's name.
    pub object: String,
    /// Where it was written.
    pub at: Place,
    /// The face or point of it, from 0.
    pub element: Option<u32>,
    /// Distance from the point, towards the light.
    pub t: f32,
}

/// A ray that goes on from a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Onward {
    /// Its weight, Fresnel included.
    pub weight: Rgb,
    /// The reflectance F, where the material asks for it.
    pub fresnel: Option<f32>,
    /// The ray; `None` if it was not sent, and brings black.
    pub ray: Option<RayTold>,
    /// Why it was not sent; `None` if it was.
    pub cut: Option<CutReason>,
    /// The product of all weights from the camera on, this one included: what light of 1 adds to the
    /// sample.
    pub path_weight: Rgb,
    /// The light it brought, not yet weighted.
    pub light: Rgb,
}

/// A pixel on its way to a file of 8 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoded {
    /// With its luminance on a step; `None`: there are none. Linear.
    pub stepped: Option<Rgb>,
    /// Its alpha divided out. Linear.
    pub straight: Rgb,
    /// What tone makes of that.
    pub tone: ToneSteps,
    /// Clamped to [0, 1]; linear.
    pub clamped: Rgb,
    /// On the sRGB curve, in [0, 1].
    pub curve: [f64; 3],
    /// The bytes of that.
    pub bytes: [u8; 3],
    /// The bytes in the file: those, with the furniture that lies over them.
    pub shown: [u8; 3],
}

/// Why a pixel cannot be explained.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("pixel ({x}, {y}) is outside the picture of {width} × {height}", x = pixel[0], y = pixel[1], width = size[0], height = size[1])]
pub struct Outside {
    /// The pixel asked for.
    pub pixel: [u32; 2],
    /// The picture's size.
    pub size: [u32; 2],
}

/// Explains a pixel of the full picture.
///
/// # Errors
/// [`Outside`].
pub fn explain(
    scene: &View,
    options: &RenderOptions,
    pixel: [u32; 2],
) -> Result<Explanation, Outside> {
    let road = Road::new(scene, options, pixel)?;
    let sampler = Sampler::new(pixel, 0, options.samples(), options.seed());
    let is_uneven = road.filter.is_uneven(sampler, options.samples());
    let mut sums = [Sums8::NONE];
    let mut samples = Vec::with_capacity(options.samples() as usize);
    for index in 0..options.samples() {
        let mut recorder = Recorder::new(scene);
        let (drawn, brought) = road.trace(index, &mut recorder);
        let weight = if is_uneven { 1.0 } else { drawn.weight };
        Sums8::add(scene.world(), &mut sums, &[brought], &[[weight; 8]]);
        let place = [drawn.place.x as f32, drawn.place.y as f32];
        let terms = brought.terms.get(0);
        samples.push(Sample { place, weight, ray: recorder.finish(), terms });
    }
    let (terms, alpha) = sums[0].resolve(scene.world(), options.samples(), scene.background());
    let (terms, alpha) = (terms.get(0), alpha[0]);
    let eye = scene.look().camera.eye;
    let (size, linear) = (options.size(), terms.total());
    let (tone, cel, lined, furniture) = (ToneMap::default(), None, None, Vec::new());
    Ok(Explanation { pixel, size, eye, samples, terms, linear, alpha, tone, cel, lined, furniture })
}

/// Options of the picture that [`Explanation::expose`] renders to find automatic exposure, the steps of a
/// pixel's luminance, or lines, for who makes room for its film; `None`: nothing is rendered. Of a pixel outside the
/// picture it is the whole.
pub fn exposed_by(
    scene: &Scene,
    options: &RenderOptions,
    pixel: [u32; 2],
) -> Option<RenderOptions> {
    let bare = || options.clone().with_terms(TermSet::NONE).with_aovs(&[]).with_lights(None);
    let finished = |bare: RenderOptions| bare.with_finishing_of(scene);
    if scene.tone.unwrap_or_default().exposure == Exposure::Auto {
        return Some(finished(bare()));
    }
    let is_drawn_onto = scene.image.cel.is_some() || scene.outline.is_some();
    is_drawn_onto.then(|| {
        finished(bare().with_window(Window::pixel(pixel)).unwrap_or_else(|_outside| bare()))
    })
}

/// Traces sample `index` (from 0) of a pixel, and tells `witness` of every step: of the ray's own
/// road, as a picture is made of it.
///
/// # Errors
/// [`Outside`].
pub fn listen<W: Witness>(
    scene: &View,
    options: &RenderOptions,
    pixel: [u32; 2],
    index: u32,
    witness: &mut W,
) -> Result<(), Outside> {
    Road::new(scene, options, pixel)?.trace(index, witness);
    Ok(())
}

/// The samples of one pixel, traced one at a time.
struct Road<'a> {
    integrator: Integrator<'a>,
    options: &'a RenderOptions,
    filter: Filter,
    pixel: [u32; 2],
}

impl<'a> Road<'a> {
    fn new(scene: &'a View, options: &'a RenderOptions, pixel: [u32; 2]) -> Result<Self, Outside> {
        let size = options.size();
        if pixel[0] >= size[0] || pixel[1] >= size[1] {
            return Err(Outside { pixel, size });
        }
        let integrator = Integrator {
            scene,
            depth: options.depth(),
            min_weight: options.min_weight(),
            shadows: options.shadows(),
            terminator: options.terminator(),
            grid: SampleGrid { size, samples: options.samples() },
            shares: Shares::NONE,
            stop: None,
        };
        Ok(Self { integrator, options, filter: Filter::new(options.filter()), pixel })
    }

    fn trace<W: Witness>(&self, index: u32, witness: &mut W) -> (Drawn, Radiance8) {
        let Self { integrator, options, filter, pixel } = self;
        let sampler = Sampler::new(*pixel, index, options.samples(), options.seed());
        let drawn = camera_ray(integrator, options, filter, *pixel, sampler);
        let brought = drawn.ray.map_or(Radiance8::NONE, |ray| {
            integrator.trace_one(ray, &mut RayCounts::default(), witness)
        });
        (drawn, brought)
    }
}

impl Explanation {
    /// Finds out how the pixel's light becomes what a PNG of the scene's picture shows. Automatic exposure is that
    /// of the picture, and the steps of luminance and the lines are those of the pixel among its neighbours, which are
    /// rendered to find them ([`exposed_by`]), and tell `listen` how far that is; who cancels it gets some
    /// exposure or other.
    pub fn expose(
        &mut self,
        scene: &Scene,
        view: &View,
        options: &RenderOptions,
        listen: &(dyn Fn(Event<'_>) + Sync),
        cancel: &Cancel,
    ) {
        let Some(options) = exposed_by(scene, options, self.pixel) else {
            self.tone = ToneMap::new(&scene.tone.unwrap_or_default(), &[], None);
            return;
        };
        let film = render(view, &options, listen, cancel).film;
        self.finish_as(&finish(&film, &Finishing::of(&options)));
    }

    /// Takes tone, steps and lines from a finished picture that shows the pixel.
    pub fn finish_as(&mut self, picture: &Finished<'_>) {
        let (Window { x0, y0, .. }, [x, y]) = (picture.film().window, self.pixel);
        let place = x.checked_sub(x0).zip(y.checked_sub(y0));
        self.cel = place.and_then(|(x, y)| picture.scale_at([x, y]));
        self.lined = place.and_then(|(x, y)| picture.lined_at([x, y]));
        self.tone = *picture.tone();
    }

    /// The pixel as a PNG of 8 bits has it.
    pub fn encoded(&self) -> Encoded {
        let stepped = self.cel.map(|scale| self.linear * scale);
        let beneath = (stepped.unwrap_or(self.linear), self.alpha);
        let (linear, alpha) = self.lined.map_or(beneath, |lined| (lined.linear, lined.alpha));
        let straight = |v: f32| if alpha > 0.0 { v / alpha } else { 0.0 };
        let straight = Rgb::from(linear.to_array().map(straight));
        let tone = self.tone.steps(straight);
        // NaN becomes 0, as in files.
        let clamped =
            tone.last().to_array().map(|v| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) });
        let curve = clamped.map(|v| srgb_encode(f64::from(v)));
        let level = |v: f64| (v * 255.0 + 0.5).floor() as u8;
        let bytes = curve.map(level);
        let [r, g, b] = bytes;
        let mut shown = [r, g, b, level(f64::from(alpha.clamp(0.0, 1.0)))];
        for patch in &self.furniture {
            patch.over_levels(patch.window, &mut shown, true, 1, false);
        }
        let [r, g, b, _] = shown;
        Encoded { stepped, straight, tone, clamped: clamped.into(), curve, bytes, shown: [r, g, b] }
    }
}

impl Surface {
    /// `C_e`: the colour of the surface's own light.
    pub fn c_e(&self) -> Rgb {
        self.material.emission_color.unwrap_or(self.color)
    }
}

impl RayTold {
    /// All the light it brought, behind fog if there is some.
    pub fn terms(&self) -> Terms {
        let terms = match &self.end {
            End::Background(background) => Terms { background: *background, ..Terms::default() },
            End::Light { emission, .. } => Terms { emission: *emission, ..Terms::default() },
            End::Surface(surface) => surface.terms,
        };
        match self.fog {
            Some(Faded { clear, light, .. }) => terms.behind(clear, light),
            None => terms,
        }
    }
}
