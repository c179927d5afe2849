//! Whatever a glTF file holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check_file, spell};

const WORDS: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "0",
    "1",
    "2",
    "3",
    "-1",
    "0.5",
    "1e400",
    "null",
    "true",
    "\"\"",
    "\"asset\":{\"version\":\"2.0\"}",
    "\"scene\":0",
    "\"scenes\":[{\"nodes\":[0]}]",
    "\"nodes\":[{\"mesh\":0,\"children\":[1]},{\"mesh\":0,\"scale\":[1,2,3]}]",
    "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"camera\":0}]",
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"mode\":4}]}]",
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":0},\"mode\":2}]}]",
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0},\"material\":0}]}]",
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3},{\"bufferView\":1,\"componentType\":5123,\"type\":\"SCALAR\",\"count\":3}]",
    "\"accessors\":[{\"componentType\":5121,\"type\":\"VEC4\",\"count\":2,\"normalized\":true,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":0}}}]",
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6,\"byteStride\":2}]",
    "\"buffers\":[{\"byteLength\":42,\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA\"}]",
    "\"buffers\":[{\"byteLength\":42}]",
    "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0.5},\"emissiveFactor\":[1,1,1]}]",
    "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1}}]",
    "\"skins\":[{\"joints\":[0]}]",
    "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]",
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\"}]}}",
];

fuzz_target!(|data: &[u8]| {
    let Some((first, rest)) = data.split_first() else { return };
    let mut file = spell(rest, WORDS);
    if first % 4 == 1 {
        let mut head = b"glTF\x02\0\0\0".to_vec();
        head.extend((20 + file.len() as u32).to_le_bytes());
        head.extend((file.len() as u32).to_le_bytes());
        head.extend(b"JSON");
        file.splice(0..0, head);
    }
    check_file("a.gltf", file);
});
