//! Something done wrong on purpose: what one or more mistakes change.

use std::sync::Arc;

use phong::look::Look;
use phong::view::{View, ViewError};
use phong_scene::{Background, Rgb, Scene};

use super::picture::Layout;
use super::points::{MaterialHere, Surface, shared};
use super::tone::Tone;
use super::wrong::Wrong;

/// One change that a mistake makes.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// Of the sum at each point.
    Sum(fn(&mut Wrong)),
    /// Of the sum at each point, by a number found from the picture.
    Fitted(fn(&mut Wrong, f32), f32),
    /// Of what one light adds.
    Light(usize, fn(&mut Wrong)),
    /// Of materials and background.
    Look(Arc<OtherLook>),
    /// Of the way from linear values to levels.
    Tone(Tone),
    /// Linear values are multiplied by this.
    Gain(f32),
    /// Of where pixels are put.
    Layout(Layout),
    /// The background is whatever they drew.
    AnyBackground,
}

/// Something done wrong on purpose.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    pub(super) wrong: Wrong,
    /// What is wrong with one light alone.
    pub(super) light: Option<(usize, Wrong)>,
    pub(super) look: Option<Arc<OtherLook>>,
    pub(super) tone: Tone,
    pub(super) gain: f32,
    pub(super) layout: Option<Layout>,
    pub(super) any_background: bool,
    /// The objects that it is wrong with, by number; `None`: all.
    pub(super) objects: Option<Arc<Vec<bool>>>,
}

impl Default for Fault {
    fn default() -> Self {
        Self {
            wrong: Wrong::default(),
            light: None,
            look: None,
            tone: Tone::Right,
            gain: 1.0,
            layout: None,
            any_background: false,
            objects: None,
        }
    }
}

impl Fault {
    /// This fault and another change.
    pub(super) fn with(&self, change: &Change) -> Self {
        let mut fault = self.clone();
        let mut of_all = |change: &dyn Fn(&mut Wrong)| {
            change(&mut fault.wrong);
            if let Some((_, wrong)) = &mut fault.light {
                change(wrong);
            }
        };
        match change {
            Change::Sum(change) => of_all(&|wrong| change(wrong)),
            Change::Fitted(change, by) => of_all(&|wrong| change(wrong, *by)),
            Change::Light(light, change) => {
                let mut wrong = fault.wrong;
                change(&mut wrong);
                fault.light = Some((*light, wrong));
            }
            Change::Look(look) => fault.look = Some(Arc::clone(look)),
            Change::Tone(tone) => fault.tone = *tone,
            Change::Gain(gain) => fault.gain = *gain,
            Change::Layout(layout) => fault.layout = Some(*layout),
            Change::AnyBackground => fault.any_background = true,
        }
        fault
    }

    /// Whether it is wrong with an object.
    pub(super) fn is_of(&self, object: u32) -> bool {
        self.objects.as_ref().is_none_or(|of| of.get(object as usize).copied().unwrap_or(false))
    }
}

/// Materials and a background other than the scene's.
#[derive(Debug)]
pub(super) struct OtherLook {
    view: View,
    materials: Vec<Option<Arc<MaterialHere>>>,
    /// The colours that the scene's own materials have: a surface of another colour has its own.
    colors: Vec<Option<Rgb>>,
    /// By object, which number of material it has instead; empty: as it was.
    of_object: Vec<u32>,
    /// Light colours are replaced by these.
    lights: Vec<[Rgb; 2]>,
    former_lights: Vec<[Rgb; 2]>,
    pub(super) background: Option<Rgb>,
}

impl OtherLook {
    /// The look of `changed`, which differs from the scene of `view` in its look alone; `of_object`
    /// as the field has it.
    pub(super) fn new(
        view: &View,
        changed: &Scene,
        of_object: Vec<u32>,
    ) -> Result<Self, ViewError> {
        let former = view;
        let view = View::new(Arc::clone(former.geometry()), Look::new(changed))?;
        let color = |m: &phong_scene::Material| m.color.constant();
        let colors = |lights: &[phong_scene::Light]| {
            lights.iter().map(|light| [light.color, light.specular_color]).collect()
        };
        let background = match (view.background(), former.background()) {
            (now, before) if now == before => None,
            (Background::Color(color), _) => Some(color),
            _ => None,
        };
        Ok(Self {
            materials: shared(&view),
            colors: former.written_materials().iter().map(color).collect(),
            of_object,
            lights: colors(view.written_lights()),
            former_lights: colors(former.written_lights()),
            background,
            view,
        })
    }

    /// A surface as it is with this look.
    pub(super) fn dress(&self, surface: &Surface) -> Surface {
        let number = self.of_object.get(surface.object as usize).copied().unwrap_or(surface.number);
        let mut out = surface.clone();
        let Some(Some(material)) = self.materials.get(number as usize) else { return out };
        if self.colors.get(surface.number as usize) == Some(&Some(surface.color)) {
            out.color = material.written.color;
        }
        out.material = Arc::clone(material);
        let ambient = self.view.ambient();
        out.ambient = material.ready.ambient(out.color, ambient) * out.openness;
        for light in &mut out.lights {
            let [now, before] = [&self.lights, &self.former_lights].map(|l| l[light.number]);
            let scaled = |here: Rgb, now: Rgb, before: Rgb| match before.max_channel() {
                most if most > 0.0 => now * (here.max_channel() / most),
                _ => here,
            };
            if now != before {
                light.color = scaled(light.color, now[0], before[0]);
                light.specular_color = scaled(light.specular_color, now[1], before[1]);
            }
            let sample = phong::light::LightSample {
                l: light.l,
                distance: light.distance,
                color: light.color,
                specular_color: light.specular_color,
            };
            let more = material.ready.ambient_of_light(out.color, ambient, &sample);
            out.ambient += more * out.openness;
        }
        out
    }
}
