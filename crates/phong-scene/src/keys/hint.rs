//! What people write who know another program: its words, and what stands for them here.
//!
//! Near misses need no entry: [`closest`](crate::wording::closest) finds those.

/// The way out for a key that table `table` does not know, told as one sentence.
pub(crate) fn of_key(table: &str, key: &str) -> Option<&'static str> {
    let key = plain(key);
    Some(match (table, key.as_str()) {
        ("scene", "cube" | "cuboid" | "block") => "a cube is a `[[box]]`, with `min` and `max`",
        ("scene" | "group", "ball" | "ellipsoid") => {
            "it is a `[[sphere]]`; `scale = [x, y, z]` makes an ellipsoid of it"
        }
        ("group", "cube" | "cuboid" | "block") => "a cube is a `box`, with `min` and `max`",
        ("scene" | "group", "floor" | "ground" | "wall") => {
            "it is a `[[plane]]`, with `point` and `normal`"
        }
        ("scene" | "group", "circle") => "it is a `[[disc]]`, with `center`, `normal` and `radius`",
        ("scene" | "group", "tube" | "pipe" | "capsule") => {
            "it is a `[[cylinder]]`, with `from`, `to` and `radius`"
        }
        ("scene" | "group", "donut" | "doughnut" | "ring") => "it is a `[[torus]]`",
        ("scene" | "group", "model" | "object" | "obj" | "ply" | "trimesh") => {
            "a model file is a `[[mesh]]` with `file = \"..\"`"
        }
        (
            "scene",
            "point_light" | "pointlight" | "sun" | "spotlight" | "spot_light" | "area_light"
            | "directional_light" | "lamp",
        ) => "every light is a `[[light]]`, with `kind = \"point\"`, \"distant\", \"spot\", …",
        ("scene", "render" | "settings" | "output" | "film" | "picture") => {
            "the picture's settings are `[image]`"
        }
        ("scene", "world" | "environment" | "sky" | "background") => {
            "what rays see that hit nothing is `background`, in `[image]`"
        }
        ("light", "intensity" | "brightness" | "power" | "energy" | "strength" | "watts") => {
            "a light's strength is its `color`, which may be above 1: `color = 2` is twice white"
        }
        ("light", "size" | "width" | "samples") => {
            "soft shadows come of `radius`, of `angle` for a distant light, or of \
             `kind = \"rectangle\"`, with `width` and `height`"
        }
        ("light" | "camera" | "texture", "type") => "did you mean `kind`?",
        ("light" | "sphere" | "box" | "disc" | "torus", "location" | "pos" | "origin" | "at") => {
            match table {
                "light" => "did you mean `position`?",
                "box" => "a box lies between its corners `min` and `max`",
                _ => "did you mean `center`?",
            }
        }
        ("sphere" | "disc" | "torus", "position") => "did you mean `center`?",
        ("box", "size" | "center" | "position" | "width") => {
            "a box lies between its corners `min` and `max`"
        }
        ("plane", "position" | "center" | "origin" | "at") => "did you mean `point`?",
        ("cylinder" | "cone", "height" | "length" | "center" | "position" | "axis") => {
            "it runs along the line between the points `from` and `to`"
        }
        ("camera", "position" | "pos" | "location" | "origin" | "from" | "lookfrom") => {
            "did you mean `eye`?"
        }
        ("camera", "target" | "to" | "at" | "center" | "direction") => {
            "the camera is aimed by `look_at`, the point in the middle of the picture"
        }
        ("camera", "angle" | "field_of_view" | "zoom" | "focal_length" | "vfov") => {
            "did you mean `fov`, the vertical angle in degrees?"
        }
        ("image", "width" | "height" | "resolution" | "dimensions") => {
            "write `size = [width, height]`"
        }
        ("image", "spp" | "antialiasing" | "aa" | "samples_per_pixel") => "did you mean `samples`?",
        ("image", "bounces" | "recursion" | "max_bounces") => "did you mean `depth`?",
        ("material", "mirror" | "reflective" | "reflectivity" | "reflectance" | "metallic") => {
            "a mirror is `reflection`, from 0 to 1"
        }
        ("material", "transparency" | "transparent" | "refraction" | "opacity" | "alpha") => {
            "what goes through is `transmission`, from 0 to 1; its rays are bent by `ior`"
        }
        ("material", "index" | "eta" | "refractive_index" | "n") => "did you mean `ior`?",
        ("material", "ambient") => "the weight is `k_a`, the colour `ambient_color`",
        ("material", "diffuse") => "the weight is `k_d`, the colour `color`",
        ("material", "specular") => "the weight is `k_s`, the colour `specular_color`",
        ("material", "emission" | "emissive" | "glow") => {
            "the weight is `k_e`, the colour `emission_color`"
        }
        ("material", "exponent" | "phong_exponent" | "ns" | "hardness" | "gloss") => {
            "did you mean `shininess`, the exponent α?"
        }
        ("material", "diffuse_color" | "albedo" | "base_color" | "basecolor") => {
            "did you mean `color`?"
        }
        ("material", "type" | "kind" | "shader") => "did you mean `model`?",
        (_, "color" | "colour" | "shininess" | "reflection") if is_shape(table) => {
            "a shape's looks are its material's: `material = \"NAME\"`, and a table \
             `[materials.NAME]`"
        }
        (_, "position" | "pos" | "offset" | "move" | "translation") if is_shape(table) => {
            "any shape is moved by `translate = [x, y, z]`"
        }
        (_, "rotation" | "angle") if is_shape(table) => {
            "any shape is turned by `rotate = [ax, ay, az, degrees]`, about an axis"
        }
        ("batch", "input" | "scene" | "scenes" | "files" | "models" | "frames") => {
            "did you mean `inputs`?"
        }
        ("batch", "out" | "folder" | "outputs" | "directory") => "did you mean `output`?",
        ("batch", "sweep" | "vary" | "values" | "set") => {
            "what differs from picture to picture is a table, `[parameters]`"
        }
        ("batch", "size" | "samples" | "seed" | "depth" | "terms" | "view") => {
            "it is one of the `options`: `options = \"--size 640x360 --samples 4\"`"
        }
        ("batch", "format") => "the ending of `name` says it: `name = \"{scene}.exr\"`",
        ("range", "count" | "n" | "num") => "did you mean `steps`?",
        _ => return None,
    })
}

/// The way out for a word that is none of those that `key` of table `table` takes.
pub(crate) fn of_word(table: &str, key: &str, word: &str) -> Option<&'static str> {
    let word = plain(word);
    Some(match (table, key, word.as_str()) {
        ("light", "kind", "area" | "rectangle" | "quad" | "disc" | "sphere" | "soft") => {
            "a soft light is a `point` with a `radius`, or a `distant` one with an `angle`"
        }
        ("light", "kind", "directional" | "sun" | "parallel" | "infinite" | "direction") => {
            "did you mean `distant`?"
        }
        ("light", "kind", "omni" | "bulb" | "lamp" | "pointlight") => "did you mean `point`?",
        ("light", "kind", "spotlight" | "cone") => "did you mean `spot`?",
        ("light", "kind", "ambient") => "ambient light is a table of its own: `[ambient]`",
        ("material", "model", "blinn") => "did you mean `blinn-phong`?",
        ("material", "model", "diffuse" | "matte" | "lambertian") => "did you mean `lambert`?",
        ("material", "model", "specular" | "plastic" | "glossy") => "did you mean `phong`?",
        ("material", "model", "microfacet" | "pbr" | "principled" | "trowbridge_reitz") => {
            "did you mean `ggx`? It is also the model of glTF"
        }
        ("material", "model", "beckmann") => {
            "Beckmann's facets are `cook-torrance`, whose `distribution` is \"beckmann\""
        }
        ("material", "model", "mirror" | "metal" | "conductor" | "reflective") => {
            "a mirror is `reflection = 0.9`, of any model"
        }
        ("material", "model", "glass" | "dielectric" | "transparent") => {
            "glass is `transmission = 1`, `reflection = 1` and `ior = 1.5`, of any model"
        }
        ("material", "model", "flat" | "constant" | "unlit" | "emissive") => {
            "what needs no light is `k_e = 1` beside `k_a = 0`, `k_d = 0` and `k_s = 0`"
        }
        ("camera", "kind", "pinhole" | "persp" | "thin_lens") => "did you mean `perspective`?",
        ("camera", "kind", "ortho" | "parallel") => "did you mean `orthographic`?",
        ("camera", "kind", "equirectangular" | "spherical" | "360" | "latlong") => {
            "did you mean `panorama`?"
        }
        ("texture", "kind", "checkerboard" | "chess" | "chequer") => "did you mean `checker`?",
        ("texture", "kind", "ramp" | "linear") => "did you mean `gradient`?",
        ("texture", "kind", "worley" | "voronoi" | "cellular") => "did you mean `cells`?",
        ("texture", "kind", "perlin" | "fbm" | "turbulence" | "clouds") => "did you mean `noise`?",
        ("texture", "kind", "lines" | "mesh") => "did you mean `grid`?",
        _ => return None,
    })
}

/// Small letters, and underlines for dashes and blanks.
fn plain(word: &str) -> String {
    // Longer words are none of ours, and need not be copied.
    let word = if word.len() <= 24 { word } else { "" };
    word.to_lowercase().replace(['-', ' '], "_")
}

fn is_shape(table: &str) -> bool {
    super::shape::SHAPES.iter().any(|key| key.name == table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::{Kind, SCENE, Table};

    fn tables() -> Vec<&'static Table> {
        let mut tables = vec![&SCENE];
        for key in SCENE.keys() {
            if let Kind::Table(table) | Kind::Tables(table) | Kind::Named(table) = key.kind {
                tables.push(table);
            }
        }
        tables
    }

    /// What stands between backquotes alone, as `` `eye` ``.
    fn quoted(hint: &str) -> impl Iterator<Item = &str> {
        hint.split('`').skip(1).step_by(2)
    }

    #[test]
    fn a_hint_that_asks_whether_a_key_was_meant_names_one_of_the_table() {
        let words = ["location", "position", "origin", "type", "spp", "ns", "albedo", "index"];
        for table in tables() {
            for word in words {
                let Some(hint) = of_key(table.name, word) else { continue };
                let Some(meant) = quoted(hint).next() else { continue };
                let asks = hint.starts_with("did you mean");
                assert!(!asks || table.keys().any(|key| key.name == meant), "{hint}");
            }
        }
    }

    #[test]
    fn words_are_compared_without_case_and_dashes() {
        assert_eq!(of_word("material", "model", "Blinn"), Some("did you mean `blinn-phong`?"));
        assert!(of_key("scene", "Point-Light").is_some());
        assert!(of_key("scene", &"cube".repeat(100_000)).is_none());
    }
}
