//! What the fuzz targets share: a way to spell files, and what every reading must hold.

use phong_scene::{Limits, Memory, Mesh, NO_INDEX, Reading, Shape, read};

/// A file that random bytes spell. Those that begin with an odd byte are words of a format, one a
/// byte, so that the fuzzer finds its way into the format without examples; 255 takes the next
/// byte as it is. Others are the file themselves.
pub fn spell(data: &[u8], words: &[&str]) -> Vec<u8> {
    let Some((1, rest)) = data.split_first().map(|(first, rest)| (first % 2, rest)) else {
        return data.get(1..).unwrap_or_default().to_vec();
    };
    let mut file = Vec::new();
    let mut bytes = rest.iter();
    while let Some(byte) = bytes.next() {
        match byte {
            255 => file.extend(bytes.next()),
            _ => file.extend(words[usize::from(*byte) % words.len()].bytes()),
        }
    }
    file
}

/// What is read of a file, strictly and leniently, holds what every reading must.
pub fn check_file(name: &str, file: Vec<u8>) {
    let source = Memory::new().with(name, file);
    for lenient in [false, true] {
        let limits = Limits { bytes: 64 << 20, lenient, ..Limits::default() };
        check(&read(name, None, &source, &limits));
    }
}

/// A scene exactly if there is no error, and what the types promise about its geometry.
pub fn check(reading: &Reading) {
    let error = reading.diagnostics.iter().any(|d| d.is_error());
    assert_eq!(reading.scene.is_none(), error, "{:?}", reading.diagnostics);
    for diagnostic in &reading.diagnostics {
        if let Some(span) = &diagnostic.span {
            // Panics unless within the excerpt and on character boundaries.
            let _ = &span.excerpt[span.range.clone()];
        }
    }
    let Some(scene) = &reading.scene else { return };
    for object in &scene.objects {
        match &object.shape {
            Shape::Mesh(mesh) => check_mesh(mesh, scene.materials.len()),
            Shape::Points(points) => {
                assert!(points.spheres.iter().flatten().all(|c| c.is_finite()));
                assert!(points.spheres.iter().all(|s| s[3] > 0.0));
                assert!([0, points.spheres.len()].contains(&points.colors.len()));
            }
            _ => {}
        }
    }
}

fn check_mesh(mesh: &Mesh, materials: usize) {
    assert!(mesh.origin.is_finite() && mesh.positions.iter().all(|p| p.is_finite()));
    assert!(!mesh.indices.is_empty());
    let count = mesh.indices.len();
    let within = |numbers: &[[u32; 3]], most: usize| {
        numbers.iter().flatten().all(|i| *i == NO_INDEX || (*i as usize) < most)
    };
    assert!(mesh.indices.iter().flatten().all(|i| (*i as usize) < mesh.positions.len()));
    for (values, numbers) in
        [(mesh.normals.len(), &mesh.normal_indices), (mesh.uvs.len(), &mesh.uv_indices)]
    {
        assert!(within(numbers, values) && [0, count].contains(&numbers.len()));
        assert!(values == 0 || !numbers.is_empty() || within(&mesh.indices, values));
    }
    let used = |n: &u32| *n != NO_INDEX;
    for index in mesh.normal_indices.iter().flatten().filter(|n| used(n)) {
        let squared = mesh.normals[*index as usize].length_squared();
        assert!(squared.is_normal(), "a normal of length² {squared}");
    }
    assert!([0, mesh.positions.len()].contains(&mesh.colors.len()));
    assert!([0, count].contains(&mesh.face_materials.len()));
    assert!(mesh.face_materials.iter().all(|m| (*m as usize) < materials));
}
