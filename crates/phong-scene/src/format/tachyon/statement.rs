//! Statements: a name, and what belongs to it.

use glam::Vec3;

use super::camera::Frame;
use super::sky::{Gradient, Haze};
use super::texture::Texture;
use super::things::{Array, Lamp, Mode, Statement, Things, Triangle};
use crate::format::text::{Fault, Parsed, Words};
use crate::limits::LARGEST;

/// The names of all statements, in small letters.
const NAMES: [&str; 34] = [
    "sphere",
    "tri",
    "stri",
    "vcstri",
    "fcylinder",
    "vertexarray",
    "texdef",
    "texalias",
    "light",
    "directional_light",
    "spotlight",
    "plane",
    "box",
    "ring",
    "cylinder",
    "polycylinder",
    "camera",
    "background",
    "background_gradient",
    "resolution",
    "shader_mode",
    "fog",
    "include",
    "start_clipgroup",
    "end_clipgroup",
    "scalarvol",
    "scape",
    "tpolyfile",
    "mgffile",
    "imagedef",
    "begin_scene",
    "end_scene",
    "outfile",
    "verbose",
];

/// Whether a statement begins with this word.
pub(super) fn is_statement(word: &[u8]) -> bool {
    NAMES.iter().any(|name| word.eq_ignore_ascii_case(name.as_bytes()))
}

/// Whether all are numbers that a scene can hold.
#[inline]
fn held(numbers: &[f32]) -> bool {
    numbers.iter().all(|n| n.abs() <= LARGEST as f32)
}

impl Things {
    /// Reads one statement; `false`: none begins here.
    #[inline]
    pub(super) fn statement(&mut self, words: &mut Words<'_>) -> Parsed<bool> {
        let mut lower = [0; 24];
        let line = {
            words.is_there();
            words.line()
        };
        let word = words.word();
        let Some(name) = lower.get_mut(..word.len()) else { return Ok(false) };
        name.copy_from_slice(word);
        name.make_ascii_lowercase();
        match &*name {
            b"sphere" => self.sphere(words)?,
            b"fcylinder" => self.cylinder(words)?,
            b"tri" => self.triangle(words, false, false)?,
            b"stri" => self.triangle(words, true, false)?,
            b"vcstri" => self.triangle(words, true, true)?,
            b"begin_scene" | b"end_scene" => {}
            b"outfile" => drop(words.some("a name")?),
            b"verbose" => drop(words.number()?),
            other => match self.other(other, words)? {
                Some(statement) => self.statements.push((line, statement)),
                None => return Ok(false),
            },
        }
        Ok(true)
    }

    fn sphere(&mut self, words: &mut Words<'_>) -> Parsed<()> {
        let center = words.keyed("CENTER")?;
        let radius = words.keyed_number("RAD")?;
        let texture = self.texture(words)?;
        let sphere = [center.x, center.y, center.z, radius];
        if held(&sphere) && radius > 0.0 {
            self.spheres.push((sphere, texture));
        } else {
            self.left_out += 1;
        }
        Ok(())
    }

    fn cylinder(&mut self, words: &mut Words<'_>) -> Parsed<()> {
        let (base, apex) = (words.keyed("BASE")?, words.keyed("APEX")?);
        let radius = words.keyed_number("RAD")?;
        let texture = self.texture(words)?;
        let ends = [base, apex].map(|p| [p.x, p.y, p.z, radius]);
        if held(ends.as_flattened()) && radius > 0.0 && base != apex {
            self.cylinders.push((ends, texture));
        } else {
            self.left_out += 1;
        }
        Ok(())
    }

    fn triangle(&mut self, words: &mut Words<'_>, normals: bool, colors: bool) -> Parsed<()> {
        let mut three = |keys: [&str; 3]| -> Parsed<[[f32; 3]; 3]> {
            let [a, b, c] = keys;
            Ok([words.keyed(a)?, words.keyed(b)?, words.keyed(c)?].map(|v| v.to_array()))
        };
        let corners = three(["V0", "V1", "V2"])?;
        let normals = if normals { Some(three(["N0", "N1", "N2"])?) } else { None };
        let (colors, texture) = if colors {
            let mut colors = [[0.0; 3]; 3];
            for (color, key) in colors.iter_mut().zip(["C0", "C1", "C2"]) {
                words.key(key)?;
                *color = words.three()?;
            }
            let texture = Texture::of_vertices(words)?;
            (Some(colors), self.own(texture))
        } else {
            (None, self.texture(words)?)
        };
        let normals = normals.filter(|all| held(all.as_flattened()));
        if held(corners.as_flattened()) {
            self.triangles.push(Triangle { corners, normals, colors, texture });
        } else {
            self.left_out += 1;
        }
        Ok(())
    }

    /// Statements of which there are few; `None`: there is none of this name.
    fn other(&mut self, name: &[u8], words: &mut Words<'_>) -> Parsed<Option<Statement>> {
        Ok(Some(match name {
            b"texdef" => {
                let name = words.some("a name")?.to_vec();
                self.define(&name);
                Statement::Define(name, Texture::read(words)?)
            }
            b"texalias" => {
                let name = words.some("a name")?.to_vec();
                self.define(&name);
                Statement::Alias(name, words.some("the name of a texture")?.to_vec())
            }
            b"light" | b"directional_light" | b"spotlight" => Statement::Light(lamp(name, words)?),
            b"plane" => Statement::Plane {
                point: words.keyed_double("CENTER")?,
                normal: words.keyed_double("NORMAL")?,
                texture: self.texture(words)?,
            },
            b"box" => Statement::Box {
                min: words.keyed_double("MIN")?,
                max: words.keyed_double("MAX")?,
                texture: self.texture(words)?,
            },
            b"ring" => Statement::Ring {
                center: words.keyed_double("CENTER")?,
                normal: words.keyed_double("NORMAL")?,
                inner: words.keyed_number("INNER")?.into(),
                outer: words.keyed_number("OUTER")?.into(),
                texture: self.texture(words)?,
            },
            b"cylinder" => Statement::Cylinder {
                center: words.keyed_double("CENTER")?,
                axis: words.keyed_double("AXIS")?,
                radius: words.keyed_number("RAD")?.into(),
                texture: self.texture(words)?,
            },
            b"polycylinder" => {
                words.key("POINTS")?;
                let points = vectors(words.whole()?, words)?;
                let radius = words.keyed_number("RAD")?;
                Statement::Chain { points, radius, texture: self.texture(words)? }
            }
            b"vertexarray" => Statement::Mesh(self.array(words)?),
            b"resolution" => Statement::Resolution([words.whole()?, words.whole()?]),
            b"camera" => Statement::Camera(Frame::read(words)?),
            b"background" => Statement::Background(words.three()?),
            b"background_gradient" => gradient(words)?,
            b"shader_mode" => mode(words)?,
            b"fog" => Statement::Fog(Haze::read(words)?),
            b"include" => Statement::Include(words.some("the name of a file")?.to_vec()),
            b"start_clipgroup" => {
                words.key("NUMPLANES")?;
                let plane = |words: &mut Words<'_>| -> Parsed<(Vec3, f32)> {
                    Ok((words.vector()?, words.number()?))
                };
                // What is said to be there need not be: nothing is set aside for it.
                let planes = (0..words.whole()?).map(|_| plane(words)).collect::<Parsed<_>>()?;
                self.begin_group();
                Statement::BeginClip(planes)
            }
            b"end_clipgroup" => {
                self.begin_group();
                Statement::EndClip
            }
            b"scalarvol" => {
                words.keyed("MIN")?;
                words.keyed("MAX")?;
                words.keyed("DIM")?;
                words.key("FILE")?;
                words.some("the name of a file")?;
                self.texture(words)?;
                Statement::Ignored("volumes (`SCALARVOL`)")
            }
            b"scape" => {
                words.key("RES")?;
                words.whole()?;
                words.whole()?;
                words.keyed_number("SCALE")?;
                words.number()?;
                words.keyed("CENTER")?;
                self.texture(words)?;
                Statement::Ignored("landscapes (`SCAPE`)")
            }
            b"tpolyfile" => {
                words.keyed("SCALE")?;
                words.keyed("ROT")?;
                words.keyed("CENTER")?;
                words.key("FILE")?;
                words.some("the name of a file")?;
                self.texture(words)?;
                Statement::Ignored("files of triangles (`TPOLYFILE`)")
            }
            b"mgffile" => {
                words.some("the name of a file")?;
                Statement::Ignored("files of the Materials and Geometry Format (`MGFFILE`)")
            }
            b"imagedef" => {
                words.some("a name")?;
                words.key("FORMAT")?;
                words.some("`RGB24`")?;
                words.key("RESOLUTION")?;
                let mut size = [0; 3];
                for side in &mut size {
                    *side = words.whole()?;
                }
                words.key("ENCODING")?;
                words.some("`HEX`")?;
                // A word for each pixel.
                for _ in 0..size.into_iter().fold(1, u64::saturating_mul) {
                    words.some("a colour")?;
                }
                Statement::Ignored("images in the text (`IMAGEDEF`)")
            }
            _ => return Ok(None),
        }))
    }

    /// Vertices, and lists that say what they make.
    fn array(&mut self, words: &mut Words<'_>) -> Parsed<Array> {
        words.key("NUMVERTS")?;
        let count = words.whole()?;
        words.key("COORDS")?;
        let mut array = Array { positions: vectors(count, words)?, ..Array::default() };
        let mut textured = false;
        loop {
            let word = words.some("`END_VERTEXARRAY`")?;
            let is = |key: &str| word.eq_ignore_ascii_case(key.as_bytes());
            if is("END_VERTEXARRAY") {
                return Ok(array);
            } else if is("NORMALS") {
                array.normals = vectors(count, words)?;
            } else if is("COLORS") {
                array.colors = Vec::new();
                for _ in 0..count {
                    array.colors.push(words.three()?);
                }
            } else if is("TRIMESH") || is("TRISTRIP") {
                if !textured {
                    return Err(Fault::Wrong("the texture must stand before `TRIMESH`".to_owned()));
                }
                array.faces(words, is("TRISTRIP"))?;
            } else if is("TEXTURE") {
                let texture = if array.colors.is_empty() {
                    Texture::read(words)?
                } else {
                    Texture::of_array(words)?
                };
                (array.texture, textured) = (self.own(texture), true);
            } else {
                let named = self.named(word, words.line());
                (array.texture, textured) = (named, true);
            }
        }
    }
}

impl Array {
    fn faces(&mut self, words: &mut Words<'_>, strip: bool) -> Parsed<()> {
        let count = words.whole()?;
        let there = self.positions.len() as u64;
        let mut last = [0; 2];
        let mut turned = false;
        for i in 0..if strip { count } else { count.saturating_mul(3) } {
            let index = words.whole()?;
            let ends = if strip { i >= 2 } else { i % 3 == 2 };
            if ends {
                let [a, b] = last;
                if [a, b, index].iter().all(|index| *index < there) {
                    let [a, b, c] = [a, b, index].map(|index| index as u32);
                    self.indices.push(if turned { [b, a, c] } else { [a, b, c] });
                } else {
                    self.outside += 1;
                }
                turned = strip && !turned;
            }
            last = [last[1], index];
        }
        Ok(())
    }
}

fn vectors(count: u64, words: &mut Words<'_>) -> Parsed<Vec<Vec3>> {
    // What is said to be there need not be: nothing is set aside for it.
    (0..count).map(|_| words.vector()).collect()
}

fn lamp(name: &[u8], words: &mut Words<'_>) -> Parsed<Lamp> {
    let mut lamp = Lamp {
        position: None,
        direction: None,
        falloff: None,
        attenuation: [1.0, 0.0, 0.0],
        color: [1.0; 3],
    };
    if name == b"directional_light" {
        lamp.direction = Some(words.keyed_double("DIRECTION")?);
    } else {
        lamp.position = Some(words.keyed_double("CENTER")?);
        words.keyed_number("RAD")?;
    }
    if name == b"spotlight" {
        lamp.direction = Some(words.keyed_double("DIRECTION")?);
        let start = words.keyed_number("FALLOFF_START")?;
        lamp.falloff = Some([start.into(), words.keyed_number("FALLOFF_END")?.into()]);
    }
    if words.has("ATTENUATION") {
        let keys = ["CONSTANT", "LINEAR", "QUADRATIC"];
        for (share, key) in lamp.attenuation.iter_mut().zip(keys) {
            *share = words.keyed_number(key)?.into();
        }
    }
    words.key("COLOR")?;
    lamp.color = words.three()?;
    Ok(lamp)
}

fn gradient(words: &mut Words<'_>) -> Parsed<Statement> {
    let sphere = words.some("`SKY_SPHERE`")?.eq_ignore_ascii_case(b"sky_sphere");
    let up = words.keyed_double("UPDIR")?;
    let values = [words.keyed_number("TOPVAL")?.into(), words.keyed_number("BOTTOMVAL")?.into()];
    words.key("TOPCOLOR")?;
    let top = words.three()?;
    words.key("BOTTOMCOLOR")?;
    Ok(Statement::Gradient(Gradient { sphere, up, values, colors: [top, words.three()?] }))
}

fn mode(words: &mut Words<'_>) -> Parsed<Statement> {
    let mut mode = Mode { samples: 16, ..Mode::default() };
    loop {
        let word = words.some("`END_SHADER_MODE`")?;
        let is = |key: &str| word.eq_ignore_ascii_case(key.as_bytes());
        if is("END_SHADER_MODE") {
            return Ok(Statement::Mode(mode));
        } else if is("MEDIUM") || is("LOW") || is("LOWEST") {
            mode.no_shadows = true;
        } else if is("TRANS_VMD") {
            mode.mixed = true;
        } else if is("FOG_VMD") {
            mode.planar = true;
        } else if is("AMBIENT_OCCLUSION") {
            mode.open = Some([1.0; 3]);
        } else if is("AMBIENT_COLOR") {
            mode.open = Some(words.three()?);
        } else if is("SAMPLES") || is("NUMSAMPLES") {
            mode.samples = words.whole()?;
        } else if is("RESCALE_DIRECT") {
            mode.rescale = Some(words.number()?);
        }
    }
}
