"""The first things that people do."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import phong

TEXT = """
version = 1
[camera]
eye = [0, 2, 8]
look_at = [0, 1, 0]
[[light]]
kind = "point"
position = [3, 4, 5]
[materials.plastic]
color = "tomato"
shininess = 60
[[sphere]]
center = [0, 1, 0]
radius = 1
material = "plastic"
[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
"""
SMALL: dict[str, Any] = {"size": (48, 32), "samples": 2}


def built() -> phong.Scene:
    scene = phong.Scene(
        camera=phong.Camera(eye=(0, 2, 8), look_at=(0, 1, 0)),
        lights=[phong.Light(kind="point", position=(3, 4, 5))],
    )
    material = phong.Material("plastic", color="tomato", shininess=60)
    scene.add(phong.Sphere(center=(0, 1, 0), radius=1, material=material))
    scene.add(phong.Plane(point=(0, 0, 0), normal=(0, 1, 0)))
    return scene


def test_text_and_code_give_the_same_bits() -> None:
    text = phong.render(phong.Scene.parse(TEXT), **SMALL)
    code = phong.render(built(), **SMALL)
    assert np.asarray(text).shape == (32, 48, 4)
    assert np.asarray(text).dtype == np.float32
    assert np.array_equal(text, code)


def test_a_frame_of_a_trajectory_is_read(tmp_path: Path) -> None:
    run = "".join(f"2\n\nC 0 0 0\nO {1 + number} 0 0\n" for number in range(3))
    (tmp_path / "run.xyz").write_text(run)
    (tmp_path / "second.xyz").write_text("2\n\nC 0 0 0\nO 2 0 0\n")
    text = TEXT.split("[[sphere]]", maxsplit=1)[0] + '[[molecule]]\nfile = "run.xyz"\n'
    (tmp_path / "a.toml").write_text(text)
    drawn = phong.render(phong.Scene.read(tmp_path / "a.toml", frame=1), **SMALL)
    parsed = phong.Scene.parse(text, tmp_path, frame=1)
    alone = phong.Scene.parse(text.replace("run", "second"), tmp_path)
    assert np.array_equal(drawn, phong.render(parsed, **SMALL))
    assert np.array_equal(drawn, phong.render(alone, **SMALL))
    first = phong.Scene.read(tmp_path / "a.toml", frame=0)
    assert not np.array_equal(drawn, phong.render(first, **SMALL))
    with pytest.raises(phong.SceneError, match="there is no frame 3"):
        phong.Scene.read(tmp_path / "a.toml", frame=3)
    with pytest.raises(phong.SceneError, match="no file that is read has several frames"):
        phong.Scene.parse(TEXT, frame=1)


def test_a_cloud_of_arrays_is_drawn() -> None:
    rng = np.random.default_rng(1)
    scene = phong.Scene()
    part = scene.add_spheres(rng.normal(size=(100, 3)), radii=0.2, colors=rng.random((100, 3)))
    scene.frame("iso")
    first = phong.render(scene, **SMALL)
    scene.update_spheres(part, rng.normal(size=(100, 3)))
    second = phong.render(scene, **SMALL)
    assert not np.array_equal(first, second)


def test_a_pickled_scene_gives_the_same_bits() -> None:
    scene = built()
    scene.add_spheres(np.eye(3), radii=[0.1, 0.2, 0.3], colors="#ff8000")
    copy = pickle.loads(pickle.dumps(scene))
    assert copy.digest() == scene.digest()
    assert np.array_equal(phong.render(copy, **SMALL), phong.render(scene, **SMALL))


def test_shares_make_the_whole() -> None:
    scene = built()
    parts = [phong.render_part(scene, index, 3, **SMALL) for index in range(3)]
    assert np.array_equal(phong.merge(parts), phong.render(scene, **SMALL))


def test_an_image_is_saved_and_pickled(tmp_path: Path) -> None:
    image = phong.render(built(), **SMALL, layers=("depth", "diffuse"))
    image.save(tmp_path / "a.png")
    image.save(tmp_path / "a.exr")
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "a.depth.png",
        "a.diffuse.png",
        "a.exr",
        "a.png",
    ]
    assert image.layers["depth"].shape == (32, 48)
    assert image.layers["diffuse"].shape == (32, 48, 3)
    copy = pickle.loads(pickle.dumps(image))
    assert copy == image
    assert np.array_equal(copy, image)


def test_a_pixel_is_explained_to_the_bit() -> None:
    scene = built()
    image = np.asarray(phong.render(scene, **SMALL))
    why = phong.explain(scene, 20, 16, **SMALL)
    assert np.array_equal(why.linear, image[16, 20, :3])
    assert "phong" in why.text.lower()
    assert why.samples[0].hit.n.shape == (3,)


def test_a_misspelt_key_is_told_with_the_right_one() -> None:
    with pytest.raises(phong.SceneError, match="shininess") as caught:
        phong.Material(**{"shinines": 3})  # type: ignore[arg-type]
    assert caught.value.diagnostics[0].severity == "error"


def test_a_broken_text_is_told_with_its_line() -> None:
    with pytest.raises(phong.SceneError) as caught:
        phong.Scene.parse(TEXT.replace("radius = 1", "radius = -1"))
    assert caught.value.diagnostics[0].line == 14


def test_without_lights_two_stand_behind_the_camera_and_none_if_none_are_wanted() -> None:
    camera = phong.Camera(eye=(0, 0, 5), look_at=(0, 0, 0))
    scenes = [phong.Scene(camera=camera), phong.Scene(camera=camera, lights=[])]
    for scene in scenes:
        scene.add(phong.Sphere(center=(0, 0, 0), radius=1))
    lit, unlit = (phong.explain(scene, 24, 16, **SMALL) for scene in scenes)
    assert len(scenes[0].lights) == 2
    assert max(lit.terms.diffuse) > 0
    assert max(unlit.terms.diffuse) == 0


def test_warnings_stay_with_every_picture() -> None:
    scene = phong.Scene(camera=phong.Camera(eye=(0, 0, 5), look_at=(0, 0, 0)))
    scene.add(phong.Sphere(center=(0, 0, 0), radius=1))
    scene.add(phong.Sphere(center=(0, 0, 0), radius=1))
    first, second = (phong.render(scene, **SMALL).warnings for _ in range(2))
    assert first == second


def test_what_can_hardly_be_meant_is_told_of_what_code_makes_as_of_text() -> None:
    glass = phong.Material("glass", transmission=1)
    scene = phong.Scene(camera=phong.Camera(eye=(0, 0, 5), look_at=(0, 0, 0), fov=0.7))
    scene.add(phong.Sphere(center=(0, 0, 0), radius=0.01, material=glass))
    told = [said.message for said in phong.render(scene, **SMALL).warnings]
    assert [word for m in told for word in ("radians", "Fresnel") if word in m] == [
        "radians",
        "Fresnel",
    ]
    assert [said.message for said in scene.check()] == told
    scene.camera = phong.Camera(eye=(0, 0, 5), look_at=(0, 0, 0))
    scene.set_material("glass", phong.Material(transmission=1, reflection=1))
    assert phong.render(scene, **SMALL).warnings == []
