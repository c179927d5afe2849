//! Whatever a Tachyon scene holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check_file, spell};

const WORDS: &[&str] = &[
    "\n",
    " ",
    "0",
    "1",
    "-1",
    "0.5",
    "nan",
    "1e39",
    "99999999999",
    "# a\n",
    "BEGIN_SCENE\n",
    "END_SCENE\n",
    "RESOLUTION 8 6\n",
    "CAMERA\n",
    "PROJECTION PERSPECTIVE_DOF\n",
    "PROJECTION ORTHOGRAPHIC\n",
    "ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 4\n",
    "CENTER 0 0 -5 VIEWDIR 0 0 1 UPDIR 0 1 0\n",
    "FRUSTUM -1 1 -1 2\n",
    "FOCALDIST 4 APERTURE 0.1\n",
    "END_CAMERA\n",
    "SHADER_MODE MEDIUM TRANS_VMD AMBIENT_OCCLUSION RESCALE_DIRECT 0.2 END_SHADER_MODE\n",
    "LIGHT CENTER 1 2 3 RAD 1 COLOR 1 1 1\n",
    "DIRECTIONAL_LIGHT DIRECTION 0 0 1 COLOR 1 1 1\n",
    "SPOTLIGHT CENTER 1 2 3 RAD 1 DIRECTION 0 0 1 FALLOFF_START 9 FALLOFF_END 5 COLOR 1 1 1\n",
    "BACKGROUND 0 0 1\n",
    "TEXDEF a AMBIENT 0 DIFFUSE 1 SPECULAR 0.5 OPACITY 0.5 PHONG METAL 1 PHONG_SIZE 4 COLOR 1 0 0 TEXFUNC 0\n",
    "TEXALIAS b a\n",
    "TEXTURE AMBIENT 0 DIFFUSE 1 SPECULAR 0 OPACITY 1 COLOR 1 0 0 TEXFUNC 9 i CENTER 0 0 0 ROTATE 0 0 0 SCALE 1 1 1 UAXIS 1 0 0 VAXIS 0 1 0\n",
    "AMBIENT 0 DIFFUSE 1 SPECULAR 0 OPACITY 1 PHONG PLASTIC 1 PHONG_SIZE 4 VCST\n",
    "SPHERE CENTER 0 0 0 RAD 1 ",
    "FCYLINDER BASE 0 0 0 APEX 1 0 0 RAD 1 ",
    "CYLINDER CENTER 0 0 0 AXIS 1 0 0 RAD 1 ",
    "POLYCYLINDER POINTS 2 0 0 0 1 1 1 RAD 0.1 ",
    "PLANE CENTER 0 0 0 NORMAL 0 1 0 ",
    "BOX MIN 0 0 0 MAX 1 1 1 ",
    "RING CENTER 0 0 0 NORMAL 0 1 0 INNER 0.5 OUTER 1 ",
    "TRI V0 0 0 0 V1 1 0 0 V2 0 1 0 ",
    "STRI V0 0 0 0 V1 1 0 0 V2 0 1 0 N0 0 0 1 N1 0 0 1 N2 0 1 1 ",
    "VCSTRI V0 0 0 0 V1 1 0 0 V2 0 1 0 N0 0 0 1 N1 0 0 1 N2 0 1 1 C0 1 0 0 C1 1 0 0 C2 0 0 1 ",
    "VERTEXARRAY NUMVERTS 3 COORDS 0 0 0 1 0 0 0 1 0 a TRIMESH 1 0 1 2 END_VERTEXARRAY\n",
    "NORMALS 0 0 1 0 0 1 0 0 1\n",
    "TRISTRIP 4 0 1 2 3\n",
    "FOG EXP START 0 END 1 DENSITY 1 COLOR 0 0 0\n",
    "START_CLIPGROUP NUMPLANES 1 0 0 1 0\n",
    "INCLUDE a.dat\n",
    "a\n",
    "b\n",
];

fuzz_target!(|data: &[u8]| {
    let Some((first, rest)) = data.split_first() else { return };
    let mut file = spell(rest, WORDS);
    if first % 4 > 0 {
        file.splice(0..0, *b"BEGIN_SCENE RESOLUTION 8 6\n");
    }
    check_file("a.dat", file);
});
