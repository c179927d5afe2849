//! Colours of vertices and points on materials of a colour of their own: in its place, or times it.

use phong::aov::Aov;
use phong::explain::{End, explain};
use phong::film::LayerKind;
use phong_bvh::Ray;
use phong_scene::{Limits, Memory, Object, Scene, Shape, VertexColors, read};

use super::images::png;
use super::{drawn, picture};

/// A sheet with texture coordinates, the same without and standing as an instance, and points, all of many colours
/// and cut open.
fn scene() -> Scene {
    let text = "version = 1\n[image]\nsize = [40, 24]\nsamples = 1\n[camera]\neye = [0, 0, 9]\n\
        look_at = [0, 0, 0]\nfov = 40\n[[light]]\nkind = \"point\"\nposition = [3, 5, 4]\n\
        [textures.tiles]\nkind = \"checker\"\ncolors = [[0.9, 0.4, 0.2], 0.7]\nscale = 3\n\
        [textures.image]\nkind = \"image\"\nfile = \"a.png\"\n\
        [materials.even]\ncolor = [0.5, 0.25, 0.75]\nvertex_colors = \"multiply\"\n\
        [materials.image]\ncolor = { texture = \"image\", scale = 0.9 }\nvertex_colors = \"multiply\"\n\
        [materials.tiles]\ncolor = { texture = \"tiles\" }\nk_s = { texture = \"tiles\" }\n\
        vertex_colors = \"multiply\"\n\
        [[mesh]]\nfile = \"sheet.obj\"\nmaterial = \"image\"\ntranslate = [-2, 1, 0]\n\
        [[groups.sheet.mesh]]\nfile = \"sheet.ply\"\nmaterial = \"even\"\n\
        [[instance]]\ngroup = \"sheet\"\ntranslate = [-2, -1, 0]\nrotate = [1, 1, 0, 30]\n\
        [[points]]\nfile = \"sheet.ply\"\nmaterial = \"tiles\"\nradius = 1.2\ntranslate = [1, 0, 0]\n\
        [[points]]\nfile = \"sheet.ply\"\nmaterial = \"even\"\nradius = 0.6\ntranslate = [4, 0, 0]\n";
    let clips = "[[clip]]\npoint = [0, 0, 0.5]\nnormal = [0, 0, 1]\n\
        [[clip]]\npoint = [2.5, 0, 0.3]\nnormal = [1, 0, 1]\ncap = \"tiles\"\n";
    let obj = "v -1 -1 0 1 0.2 0.3\nv 1 -1 0 0.1 0.9 0.3\nv 1 1 0 0.7 0.7 0.1\nv -1 1 0 0.2 0.1 1\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
        property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n\
        -1 -1 0 255 30 60\n1 -1 0 20 240 70\n1 1 0 180 180 20\n-1 1 0 30 20 250\n4 0 1 2 3\n";
    let image = png([2, 1], png::ColorType::Rgb, &[250, 120, 30, 40, 90, 200]);
    let files = Memory::new()
        .with("a.toml", format!("{text}{clips}").into_bytes())
        .with("sheet.obj", obj.as_bytes())
        .with("sheet.ply", ply.as_bytes())
        .with("a.png", image);
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

/// The same with the colours of its vertices and points alone.
pub(super) fn replaced(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.materials.iter_mut().for_each(|m| m.vertex_colors = VertexColors::Replace);
    scene
}

/// The same without them.
pub(super) fn bare(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let of_groups = scene.groups.iter_mut().flat_map(|group| &mut group.objects);
    for Object { shape, .. } in scene.objects.iter_mut().chain(of_groups) {
        match shape {
            Shape::Mesh(mesh) => mesh.colors = Vec::new().into(),
            Shape::Points(points) => points.colors = Vec::new().into(),
            _ => {}
        }
    }
    scene
}

#[test]
fn what_is_multiplied_is_the_materials_colour_times_that_of_vertices_and_points() {
    let scene = scene();
    let albedo = |scene: &Scene| {
        let film = drawn(scene, &[Aov::Albedo]).2;
        film.layer(LayerKind::Aov(Aov::Albedo)).unwrap().values.to_vec()
    };
    let [got, own, written] = [scene.clone(), replaced(&scene), bare(&scene)].map(|s| albedo(&s));
    let mut count = 0;
    for ((got, own), written) in got.into_iter().zip(own).zip(written) {
        // Caps of a material of their own, and of meshes, have no colours of vertices.
        let is_brought = own != written;
        assert_eq!(got, if is_brought { written * own } else { written });
        count += u32::from(is_brought && got != own);
    }
    assert!(count > 500, "{count} channels were multiplied");
    let mut ignored = scene.clone();
    ignored.materials.iter_mut().for_each(|m| m.vertex_colors = VertexColors::Ignore);
    assert_eq!(picture(&ignored), picture(&bare(&scene)));
}

#[test]
fn colours_that_are_multiplied_are_the_same_for_one_surface_and_for_eight() {
    let scene = scene();
    let (view, options, film) = drawn(&scene, &[]);
    let mut caps = 0;
    for (x, y) in (0..24).flat_map(|y| (0..40).map(move |x| (x, y))) {
        let told = explain(&view, &options, [x, y]).unwrap();
        assert_eq!(told.linear.to_array()[..], *film.at(LayerKind::Picture, x, y).unwrap());
        let Some(ray) = &told.samples[0].ray else { continue };
        let End::Surface(s) = &ray.end else { continue };
        let ray = Ray::new(ray.origin, ray.dir.to_vec());
        let one = view.interaction(&ray, &view.intersect(&ray));
        assert_eq!(one.color, s.color, "{x} {y}");
        caps += u32::from(s.cap.is_some());
    }
    assert!(caps > 10, "{caps} caps");
}
