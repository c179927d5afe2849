//! The library of known mistakes.

/// One known mistake.
#[derive(Clone, Copy, Debug)]
pub struct Mistake {
    /// What `cause` says.
    pub cause: &'static str,
    /// What is wrong, and what would be right, in a sentence.
    pub says: &'static str,
    /// What a scene has in which it can be seen, and told from other mistakes: to be read after "a
    /// scene with".
    pub needs: &'static str,
}

macro_rules! mistakes {
    ($($cause:literal: $says:literal; $needs:literal;)+) => {
        /// Every mistake that `grade` knows. Of those that explain a picture equally well the
        /// earlier is named first.
        pub const MISTAKES: &[Mistake] =
            &[$(Mistake { cause: $cause, says: $says, needs: $needs },)+];
    };
}

mistakes! {
    "not-a-number":
        "values are NaN: 0/0 (a vector of length 0 was normalised), or a fractional power or the \
         root of a number below 0";
        "any surface";
    "gamma-missing": "linear values were written as they are; encode them with the sRGB curve last";
        "a surface of middle brightness";
    "gamma-twice": "the sRGB curve was applied twice"; "a surface of middle brightness";
    "gamma-2.2":
        "the power 1/2.2 was used for the sRGB curve, which has a straight piece at its foot";
        "dark surfaces, with linear values below 0.01";
    "tone-mapped":
        "values were compressed by a tone curve such as x/(1 + x); clamp them to [0, 1] instead";
        "bright and dark surfaces";
    "exposure": "all values are multiplied by one factor";
        "ambient light besides the lights, and a background";
    "byte-overflow": "values above 1 begin at 0 again in the byte; clamp them to [0, 1] first";
        "a highlight that is brighter than white";
    "upside-down": "rows run from bottom to top; pixel (0, 0) is the upper left";
        "different things above and below";
    "left-right": "columns run from right to left: the camera's right vector has the wrong sign";
        "different things to the left and the right";
    "turned":
        "the picture is turned by 180°: both the right and the up vector have the wrong sign";
        "different things in opposite corners";
    "blue-first": "red and blue are exchanged"; "red or blue surfaces";
    "shifted": "the picture is shifted by whole pixels"; "edges across and down";
    "half-pixel":
        "rays do not go through the middle of their pixels: pixel (x, y) is sampled at (x + ½, y + ½)";
        "many edges, across and down";
    "fov-horizontal": "the field of view was taken as horizontal: it is vertical";
        "a picture that is not square";
    "aspect-ignored":
        "the picture is stretched: its width and height are not in the ratio of its pixels";
        "a picture that is not square";
    "fov-half": "the field of view was taken as its half: use tan(fov / 2)"; "any object";
    "up-ignored": "the camera's up vector was not used"; "an up vector other than (0, 1, 0)";
    "far-root": "the far intersection with a sphere was taken: use the smaller root above 0";
        "a sphere seen from outside";
    "ambient-missing": "the ambient term k_a C_a is missing"; "k_a above 0";
    "ambient-per-light": "the ambient term is added once for every light";
        "three lights of different colours";
    "ambient-not-in-shadow": "a point in shadow loses its ambient term too";
        "shadows, k_a above 0, and sides that no light reaches";
    "ambient-factor": "the ambient term is multiplied by a factor; is k_a, or the ambient light, used?";
        "materials of different k_a";
    "diffuse-missing": "the diffuse term is missing"; "k_d above 0";
    "specular-missing": "the specular term is missing"; "highlights that are seen";
    "shadows-missing": "nothing casts a shadow"; "shadows of every light";
    "shadow-ray-endless": "things behind a point light cast shadows: a shadow ray ends at the light";
        "a thing behind a point light, seen from a surface";
    "shadow-half": "shadows are not black: a light that is blocked still adds a share";
        "shadows, and k_a above 0";
    "shadow-acne":
        "surfaces shadow themselves at random points: start the shadow ray off the surface";
        "a wide surface with shadows";
    "one-light-no-shadow": "nothing casts a shadow in the light of one of the lights";
        "shadows of each light";
    "reflection-sign": "R, or E, points the wrong way: R = 2(L·N)N − L, E towards the eye";
        "highlights that are seen";
    "half-unnormalized": "H = L + E was not normalised"; "highlights of the Blinn–Phong model";
    "half-mean": "H = (L + E)/2 was not normalised"; "highlights of the Blinn–Phong model";
    "phong-not-blinn": "the lobe is Phong's (R·E)^α where the scene says Blinn–Phong";
        "highlights seen at a slant";
    "blinn-not-phong": "the lobe is Blinn's (N·H)^α where the scene says Phong";
        "highlights seen at a slant";
    "exponent-quarter": "the exponent is a quarter of the scene's"; "highlights that are seen";
    "exponent-half": "the exponent is half of the scene's"; "highlights that are seen";
    "exponent-double": "the exponent is twice the scene's"; "highlights that are seen";
    "exponent-fourfold": "the exponent is four times the scene's"; "highlights that are seen";
    "clamp-missing-diffuse": "L·N below 0 takes light away: clamp it at 0";
        "a light without shadows, beside another light";
    "clamp-missing-specular": "R·E below 0 is raised to the power: clamp it at 0";
        "a light without shadows, and a low odd exponent";
    "highlight-behind": "highlights show where L·N ≤ 0: cut them there";
        "a light without shadows behind a shiny surface";
    "clamp-missing-both": "neither L·N nor R·E is clamped at 0";
        "a light without shadows, beside another light, and a low odd exponent";
    "clamp-abs": "the absolute value was taken of cosines below 0: clamp them at 0";
        "a light without shadows, beside surfaces that face away from it";
    "normal-inside-out": "normals point into the objects: n = p − c, not c − p";
        "a light without shadows";
    "normal-unnormalized": "N was not normalised: p − c is as long as the sphere's radius";
        "spheres whose radius is not 1";
    "light-unnormalized": "L was not normalised: far lights are too strong"; "point lights";
    "light-reversed": "L points away from point lights: it is the light's place minus the point";
        "point lights without shadows, beside another light";
    "distant-reversed": "a distant light's direction was taken as the way to it";
        "a distant light without shadows, beside another light";
    "eye-constant": "one E was used for all points: it leads from each point to the eye";
        "highlights all over the picture";
    "eye-at-origin": "E leads to the origin instead of the eye"; "highlights, and an eye far from the origin";
    "eye-unnormalized": "E was not normalised"; "highlights that are seen";
    "ray-unnormalized": "the ray's direction was not normalised, and so E is too long towards the corners";
        "highlights near the picture's border";
    "specular-tinted": "the highlight is multiplied by the object's colour"; "highlights on coloured surfaces";
    "specular-times-cosine": "the highlight is multiplied by L·N"; "highlights of low exponents, seen at a slant";
    "k_d-ignored": "the diffuse term is not multiplied by k_d"; "materials of different k_d, below 1";
    "k_s-ignored": "the specular term is not multiplied by k_s"; "materials of different k_s, below 1";
    "hex-not-decoded": "colours written as hex or by name were taken as linear: decode them with the sRGB curve";
        "colours written as hex";
    "materials-swapped": "objects have each other's materials"; "objects of different materials";
    "background-wrong": "the background is not the scene's"; "a background that is seen";
    "first-light-only": "only the first light counts"; "three lights that reach every surface";
    "one-light-missing": "one of the lights is missing"; "three lights that reach every surface";
    "lights-averaged": "the lights' sum is divided by their number"; "three lights, ambient light, and a background";
    "light-color-ignored": "the colour of the lights is not used"; "lights of different colours";
    "inverse-square": "light falls off with the square of its distance, unasked";
        "point lights at different distances";
    "falloff-linear": "light falls off with its distance, unasked"; "point lights at different distances";
    "attenuation-missing": "lights do not fall off with distance"; "a light with attenuation";
    "clamped-too-early": "each light's sum is clamped before the lights are added";
        "surfaces of which one light alone makes more than white";
    "reflection-missing": "mirror and glass rays bring nothing"; "mirrors or glass";
    "diffuse-factor": "the diffuse term is multiplied by a factor"; "materials of different k_d";
    "specular-factor": "the specular term is multiplied by a factor"; "materials of different k_s";
}

impl Mistake {
    /// The mistake of that name, which is in the table.
    pub(super) fn named(cause: &str) -> &'static Self {
        let found = MISTAKES.iter().find(|mistake| mistake.cause == cause);
        found.unwrap_or(&MISTAKES[0])
    }

    /// Its place in the table.
    pub(super) fn place(&self) -> usize {
        MISTAKES.iter().position(|mistake| mistake.cause == self.cause).unwrap_or(MISTAKES.len())
    }
}
