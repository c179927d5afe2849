//! Writes down what the integrator tells.

use phong_bvh::Ray;
use phong_scene::{Rgb, TextureKind, TextureUse};

use super::{Blocker, End, LightFrom, Lit, Onward, Openness, RayTold, Surface, TextureTold};
use crate::interaction::SurfaceInteraction;
use crate::material::Material;
use crate::math::Dir3;
use crate::reflectance::Incident;
use crate::terms::Terms;
use crate::texture::TexturePoint;
use crate::view::{Occlusion, View};
use crate::witness::{Branch, Cut, Faded, LightContribution, Witness};

/// Listens to one ray and all that follow from it.
pub(super) struct Recorder<'a> {
    scene: &'a View,
    /// Rays on their way, the first from the camera, each with what sent it.
    open: Vec<Open>,
}

struct Open {
    told: Option<RayTold>,
    /// The surface that was met, and its material there.
    at: Option<(SurfaceInteraction, Material)>,
    sent: Option<(Rgb, Option<f32>)>,
    /// The product of all weights from the camera on.
    path_weight: Rgb,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(scene: &'a View) -> Self {
        Self {
            scene,
            open: vec![Open { told: None, at: None, sent: None, path_weight: Rgb::WHITE }],
        }
    }

    /// The camera's ray; `None` if none was traced.
    pub(super) fn finish(mut self) -> Option<RayTold> {
        self.open.pop().and_then(|open| open.told)
    }

    fn tell(&mut self, ray: &Ray, at: Option<(SurfaceInteraction, Material)>, end: End) {
        let told = RayTold { origin: ray.origin, dir: Dir3::from_unit(ray.dir), end, fog: None };
        if let Some(open) = self.open.last_mut() {
            open.told = Some(told);
            open.at = at;
        }
    }

    fn surface(&mut self) -> Option<&mut Surface> {
        match &mut self.open.last_mut()?.told.as_mut()?.end {
            End::Surface(surface) => Some(surface),
            End::Background(_) | End::Light { .. } => None,
        }
    }

    fn goes_on(&mut self, branch: Branch, onward: Onward) {
        let Some(surface) = self.surface() else { return };
        let brought = onward.weight * onward.light;
        surface.terms[branch.term()] += brought;
        match branch {
            Branch::Through => surface.through = Some(onward),
            Branch::Reflection => surface.reflection = Some(onward),
            Branch::Transmission => surface.transmission = Some(onward),
        }
    }

    fn blocker(&self, shadow: &Ray) -> Option<Blocker> {
        let hit = self.scene.intersect(shadow);
        hit.is_some().then(|| {
            let object = self.scene.object(&hit);
            let record = &self.scene.objects()[object as usize];
            Blocker {
                object: record.name.clone(),
                at: record.place.clone(),
                element: self.scene.element(&hit),
                t: hit.t,
            }
        })
    }
}

impl Witness for Recorder<'_> {
    fn missed(&mut self, ray: &Ray, background: Rgb) {
        self.tell(ray, None, End::Background(background));
    }

    fn saw(&mut self, ray: &Ray, light: usize, t: f32, emission: Rgb) {
        let written = &self.scene.written_lights()[light];
        let (name, at) = (written.name.clone(), written.place.clone());
        self.tell(ray, None, End::Light { name, at, t, emission });
    }

    fn met(&mut self, ray: &Ray, at: &SurfaceInteraction, terms: Terms) {
        let scene = self.scene;
        let object = scene.object(&at.hit);
        let record = &scene.objects()[object as usize];
        let coordinates = scene.coordinates(ray, &at.hit);
        let point = scene.texture_point_of(ray, at);
        let material = scene.written_at(at.material, &point);
        let c_a = scene.ambient() * material.ambient_color.unwrap_or(at.color);
        let surface = Surface {
            object: record.name.clone(),
            object_number: object,
            at: record.place.clone(),
            element: scene.element(&at.hit),
            cap: scene.cap(&at.hit),
            material,
            textures: textures(scene, at.material, &point),
            material_number: at.material,
            t: at.hit.t,
            p: at.p,
            ng: at.ng,
            n: at.n,
            tangent: Dir3::from_unit(coordinates.tangent),
            e: at.e,
            uv: coordinates.uv.to_array(),
            from_outside: at.from_outside(),
            eta: at.eta,
            color: at.color,
            c_a,
            cover: 1.0,
            openness: None,
            ambient: terms.ambient,
            lights: Vec::with_capacity(scene.lights().len()),
            reflection: None,
            transmission: None,
            through: None,
            terms,
        };
        let met = (*at, scene.material_at(at.material, &point));
        self.tell(ray, Some(met), End::Surface(Box::new(surface)));
    }

    fn covered(&mut self, share: f32) {
        if let Some(surface) = self.surface() {
            surface.cover = share;
        }
    }

    fn opened(&mut self, share: f32) {
        let occlusion = self.scene.occlusion();
        if let (Some(surface), Some(Occlusion { samples: rays, distance })) =
            (self.surface(), occlusion)
        {
            surface.openness = Some(Openness { share, rays, distance, sky: None });
        }
    }

    fn lit_by_sky(&mut self, light: Rgb) {
        if let Some(open) = self.surface().and_then(|surface| surface.openness.as_mut()) {
            open.sky = Some(light);
        }
    }

    fn lit(&mut self, light: &LightContribution) {
        let Some((at, material)) = self.open.last().and_then(|open| open.at.clone()) else {
            return;
        };
        let scene = self.scene;
        let written = &scene.written_lights()[light.light];
        let l = light.sample.map(|sample| sample.l);
        let e = material.eye(at.e);
        let r = l.map(|l| at.n.mirror(l));
        let h = l.and_then(|l| l.halfway(e));
        let cover = self.surface().map_or(1.0, |surface| surface.cover);
        let open = self.surface().and_then(|surface| surface.openness);
        let open = open.map_or(1.0, |open| open.share);
        let ambient = light.sample.map_or(Rgb::BLACK, |sample| {
            material.ambient_of_light(at.color, scene.ambient(), &sample) * cover * open
        });
        let blocker = light
            .shadow
            .filter(|_| light.visibility != Rgb::WHITE)
            .and_then(|shadow| self.blocker(&shadow));
        let tangent = self.surface().map(|surface| surface.tangent);
        let white = match (l, tangent) {
            (Some(l), Some(tangent)) if light.visible => {
                let white = Incident { l, c_d: Rgb::WHITE, c_s: Rgb::WHITE, color: at.color };
                material.reflectance.shade_light(at.n, tangent, e, white)
            }
            _ => Terms::default(),
        };
        let from = if let Some(direction) = written.kind.direction() {
            LightFrom::Direction(direction)
        } else {
            let soft = written.kind.extent() > 0.0;
            let sampled = light
                .sample
                .filter(|_| soft)
                .map(|sample| at.p + f64::from(sample.distance) * sample.l.to_vec().as_dvec3());
            LightFrom::Point(sampled.or(written.kind.position()).unwrap_or(at.p))
        };
        let lit = Lit {
            name: written.name.clone(),
            at: written.place.clone(),
            from,
            l,
            r,
            h,
            distance: light.sample.map_or(0.0, |sample| sample.distance),
            n_dot_l: l.map_or(0.0, |l| l.dot(at.n)),
            r_dot_e: r.map_or(0.0, |r| r.dot(e)),
            n_dot_h: h.map_or(0.0, |h| at.n.dot(h)),
            color: light.sample.map_or(Rgb::BLACK, |sample| sample.color),
            c_d: light.incident.map_or(Rgb::BLACK, |incident| incident.c_d),
            c_s: light.incident.map_or(Rgb::BLACK, |incident| incident.c_s),
            above: light.above,
            tested: light.shadow.is_some(),
            lifted: light.shadow.filter(|_| light.lifted).map(|shadow| shadow.origin),
            visible: light.visible,
            visibility: light.visibility,
            blocker,
            white,
            ambient,
            diffuse: light.terms.diffuse,
            specular: light.terms.specular,
        };
        if let Some(surface) = self.surface() {
            surface.terms.ambient += ambient;
            surface.terms += light.terms;
            surface.lights.push(lit);
        }
    }

    fn faded(&mut self, faded: &Faded) {
        if let Some(told) = self.open.last_mut().and_then(|open| open.told.as_mut()) {
            told.fog = Some(*faded);
        }
    }

    fn entered(&mut self, _: Branch, weight: Rgb, fresnel: Option<f32>, _: &Ray) {
        let so_far = self.open.last().map_or(Rgb::WHITE, |open| open.path_weight);
        let (sent, path_weight) = (Some((weight, fresnel)), so_far * weight);
        self.open.push(Open { told: None, at: None, sent, path_weight });
    }

    fn left(&mut self, branch: Branch, light: Rgb) {
        let Some(Open { told: ray, sent: Some((weight, fresnel)), path_weight, .. }) =
            self.open.pop()
        else {
            return;
        };
        self.goes_on(branch, Onward { weight, fresnel, ray, cut: None, path_weight, light });
    }

    fn cut(&mut self, branch: Branch, &Cut { weight, fresnel, path_weight, reason }: &Cut) {
        let (ray, cut, light) = (None, Some(reason), Rgb::BLACK);
        self.goes_on(branch, Onward { weight, fresnel, ray, cut, path_weight, light });
    }
}

/// What a material takes from textures at a point.
fn textures(scene: &View, material: u32, point: &TexturePoint) -> Vec<TextureTold> {
    let look = scene.look();
    let told = |(parameter, asked): (&'static str, TextureUse)| {
        let written = look.textures.get(asked.texture.0 as usize)?;
        let texture = scene.textures().get(asked.texture.0 as usize)?;
        Some(TextureTold {
            parameter,
            texture: written.name.clone(),
            space: written.space,
            place: texture.place(point),
            image: texture.image_look_up(point),
            number: match &written.kind {
                TextureKind::Map { of, .. } => {
                    texture.number(point).map(|number| (of.clone(), number))
                }
                _ => None,
            },
            value: texture.value(point, asked),
        })
    };
    look.materials[material as usize].texture_uses().into_iter().filter_map(told).collect()
}
