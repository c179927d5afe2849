"""Work gives the interpreter back, stops when it is told to, and is done once."""

from __future__ import annotations

import copy
import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drawing import covered, dressed

import phong

#: What takes long enough to be stopped.
LONG: dict[str, Any] = {"size": (1920, 1080), "samples": 4096}


def cloud(count: int = 2000) -> phong.Scene:
    scene = phong.Scene()
    rng = np.random.default_rng(5)
    scene.add_spheres(rng.normal(size=(count, 3)), 0.05, colors=rng.random((count, 3)))
    return scene


def test_a_token_stops_a_picture() -> None:
    token = phong.Cancel()
    threading.Timer(0.3, token.cancel).start()
    began = time.monotonic()
    with pytest.raises(phong.Cancelled):
        phong.render(cloud(), cancel=token, **LONG)
    assert time.monotonic() - began < 5


def test_an_exception_of_a_listener_stops_a_picture() -> None:
    def listen(share: float) -> None:
        raise RuntimeError(f"enough at {share}")

    with pytest.raises(RuntimeError, match="enough"):
        phong.render(cloud(), progress=listen, **LONG)


INTERRUPTED = """
import os, signal, sys, threading, time
import numpy as np, phong
scene = phong.Scene()
scene.add_spheres(np.random.default_rng(5).normal(size=(2000, 3)), 0.05)
phong.render(scene, size=(8, 8))
sent = []
def interrupt():
    sent.append(time.monotonic())
    os.kill(os.getpid(), signal.SIGINT)
threading.Timer(0.5, interrupt).start()
try:
    phong.render(scene, size=(1920, 1080), samples=4096)
except KeyboardInterrupt:
    print(time.monotonic() - sent[0])
phong.render(scene, size=(8, 8))
"""


def test_ctrl_c_stops_a_picture_in_a_fifth_of_a_second() -> None:
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, check=True, timeout=60
    )
    # On a busy machine the thread that waits may itself have to wait.
    assert float(done.stdout) < 0.2 * max(1.0, os.getloadavg()[0])


def test_other_threads_run_meanwhile() -> None:
    scene, token, ticks = cloud(), phong.Cancel(), 0

    def work() -> None:
        with pytest.raises(phong.Cancelled):
            phong.render(scene, cancel=token, **LONG)

    thread = threading.Thread(target=work)
    thread.start()
    until = time.monotonic() + 0.3
    while time.monotonic() < until:
        ticks += 1
    token.cancel()
    thread.join(10)
    assert ticks > 1000
    assert not thread.is_alive()


def test_several_threads_may_use_one_scene() -> None:
    scene = cloud()
    options: dict[str, Any] = {"size": (40, 30), "samples": 1}
    expected = np.asarray(phong.render(scene, **options))
    with ThreadPoolExecutor(4) as pool:
        images = list(pool.map(lambda _: phong.render(scene, **options), range(8)))
    assert all(np.array_equal(image, expected) for image in images)


@pytest.mark.parametrize("threads", [1, 2, 7])
def test_any_number_of_threads_gives_the_same_bits(threads: int) -> None:
    scene = cloud(200)
    options: dict[str, Any] = {"size": (60, 40), "samples": 3}
    one = phong.render(scene, threads=threads, **options)
    assert np.array_equal(one, phong.render(scene, **options))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_renders() -> None:
    scene = cloud(50)
    phong.render(scene, size=(8, 8))
    child = os.fork()
    if child == 0:
        try:
            phong.render(scene, size=(8, 8))
            os._exit(0)
        finally:
            os._exit(1)
    for _ in range(600):
        pid, status = os.waitpid(child, os.WNOHANG)
        if pid:
            assert os.waitstatus_to_exitcode(status) == 0
            return
        time.sleep(0.05)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    pytest.fail("the forked process did not end")


def test_looking_from_elsewhere_builds_nothing() -> None:
    scene = cloud(100_000)
    options: dict[str, Any] = {"size": (16, 16), "samples": 1}
    first = phong.render(scene, **options).seconds["build"]
    scene.camera = phong.Camera(eye=(0, 0, 9), look_at=(0, 0, 0))
    scene.lights = [phong.Light(kind="distant", direction=(-1, -1, -1))]
    assert phong.render(scene, **options).seconds["build"] < first / 3


def test_a_moved_part_is_as_one_that_was_there_from_the_beginning() -> None:
    rng = np.random.default_rng(8)
    old, new = rng.normal(size=(2, 300, 3))
    camera = phong.Camera(eye=(0, 0, 9), look_at=(0, 0, 0))
    moved, fresh = phong.Scene(camera=camera), phong.Scene(camera=camera)
    for scene, centers in ((moved, old), (fresh, new)):
        part = scene.add_spheres(centers, 0.1, colors=np.abs(centers))
        scene.add_mesh(np.eye(3), [[0, 1, 2]])
    options: dict[str, Any] = {"size": (64, 48), "samples": 1}
    phong.render(moved, **options)
    moved.update_spheres(moved.parts[0], new, colors=np.abs(new))
    assert np.array_equal(phong.render(moved, **options), phong.render(fresh, **options))
    moved.update_spheres(part, colors="red")
    assert not np.array_equal(phong.render(moved, **options), phong.render(fresh, **options))


@pytest.mark.parametrize("path", sorted(Path(__file__).parents[2].glob("scenes/*.toml")), ids=str)
def test_every_scene_of_the_gallery_survives_a_pickle_to_the_bit(path: Path) -> None:
    scene = phong.Scene.read(path)
    unpickled = pickle.loads(pickle.dumps(scene))
    options: dict[str, Any] = {"size": (24, 16), "samples": 1, "layers": ("object", "material")}
    one, two = phong.render(scene, **options), phong.render(unpickled, **options)
    assert unpickled.digest() == scene.digest()
    assert one.scene_fingerprint == two.scene_fingerprint
    assert one == two


def test_a_copy_goes_its_own_way() -> None:
    scene = cloud(20)
    other = copy.copy(scene)
    other.remove(other.parts[0])
    assert len(scene.parts) == 1
    assert not other.parts


def test_settings_of_a_scene_are_the_tables_of_its_text() -> None:
    options: dict[str, Any] = {"size": (40, 30), "samples": 1}
    fog = {"start": 1.0, "end": 12.0, "color": "#dfe9f4"}
    sun = phong.Light(kind="distant", direction=(-1, -1, -1))
    camera = phong.Camera(eye=(0, 1, 6), look_at=(0, 0, 0))
    scene = phong.Scene(camera, [sun], fog=fog)
    scene.add(phong.Sphere(center=(0, 0, 0), radius=1, name="ball"))
    brass = phong.Material("brass", color="gold")
    scene.add(phong.Sphere(center=(2, 0, 0), radius=0.5, material=brass))
    assert set(scene.settings) == {"fog"}
    foggy = phong.render(scene, **options)
    scene.set_settings(fog=None, ambient_occlusion={"samples": 4})
    assert scene.settings == {"ambient_occlusion": {"samples": 4}}
    assert phong.render(scene, **options) != foggy
    cut = {"point": (0, 0, 0), "normal": (1, 1, 1), "cap": "brass", "objects": ["ball"]}
    scene.set_settings(ambient_occlusion=None, clip=[cut])
    assert scene.settings["clip"][0]["cap"] == "brass"
    clipped = phong.render(scene, **options)
    text = phong.Scene.parse(scene.to_toml())
    assert np.array_equal(phong.render(text, **options), clipped)
    with pytest.raises(phong.SceneError, match="there is no object"):
        scene.set_settings(clip=[{**cut, "objects": ["bell"]}])
    with pytest.raises(phong.SceneError, match="brasss"):
        scene.set_settings(clip=[{**cut, "cap": "brasss"}])
    with pytest.raises(phong.SceneError, match="did you mean `fog`"):
        scene.set_settings(fogg={"end": 3})
    with pytest.raises(ValueError, match="camera is no setting"):
        scene.set_settings(camera={"eye": (0, 0, 1)})
    assert phong.render(scene, **options) == clipped, "what was wrong has changed nothing"


def test_clips_and_images_are_pickled(tmp_path: Path) -> None:
    options: dict[str, Any] = {"size": (40, 30), "samples": 1}
    pixels = phong.Scene(background="tomato")
    pixels.add(phong.Sphere(center=(0, 0, 0), radius=1))
    phong.render(pixels, size=(8, 8), samples=1).save(tmp_path / "image.png")
    phong.render(pixels, size=(4, 4), samples=1).save(tmp_path / "deep.png", bits=16)
    (tmp_path / "scene.toml").write_text(
        """version = 1
        camera = { eye = [0, 1, 5], look_at = [0, 0, 0] }
        light = [{ kind = "distant", direction = [-1, -1, -1] }]
        textures.a = { kind = "image", file = "image.png", wrap = "mirror" }
        textures.b = { kind = "image", file = "deep.png" }
        textures.c = { kind = "image", file = "image.png", filter = "nearest" }
        materials.a = { color = { texture = "a" } }
        materials.b = { color = { texture = "b" } }
        materials.c = { color = { texture = "c" }, shininess = 7 }
        sphere = [{ name = "ball", center = [0, 0, 0], radius = 1, material = "a" },
            { center = [2, 0, 0], radius = 0.8, material = "b" },
            { center = [-2, 0, 0], radius = 0.8, material = "c" }]
        clip = [{ point = [0, 0, 0.5], normal = [0, 0, 1], objects = ["ball"], cap = "b" }]
        """
    )
    scene = phong.Scene.read(tmp_path / "scene.toml")
    picture = phong.render(scene, **options)
    assert scene.camera.eye == (0, 1, 5)
    assert scene.materials["a"].color["texture"].file == str(tmp_path / "image.png")
    packed, digest = pickle.dumps(scene), scene.digest()
    for file in tmp_path.iterdir():
        file.unlink()
    there = pickle.loads(packed)
    assert phong.render(there, **options) == picture
    assert there.digest() == digest
    assert there.to_toml() == scene.to_toml()


def test_what_makes_up_a_look_is_said_in_python_and_each_part_is_seen(tmp_path: Path) -> None:
    options: dict[str, Any] = {"size": (64, 36), "samples": 4}
    scene = dressed(tmp_path)
    assert set(scene.settings) == {"sky", "outline", "clip"}
    whole = phong.render(scene, **options)
    for name in scene.settings:
        without = copy.copy(scene)
        without.set_settings(**{name: None})
        assert phong.render(without, **options) != whole, name
    small = phong.Light(kind="point", position=(0, 4, 2), color=0.8)
    plain = phong.Material("skin", color=0.5)
    for change in (
        lambda other: setattr(other, "lights", [small]),
        lambda other: other.set_material("skin", plain),
        lambda other: other.look("ink"),
    ):
        other = copy.copy(scene)
        change(other)
        assert phong.render(other, **options) != whole
    phong.convert(scene, tmp_path / "scene.toml")
    assert phong.render(phong.Scene.read(tmp_path / "scene.toml"), **options) == whole


def test_points_of_a_gltf_file_with_a_camera_are_as_large_as_the_picture_needs(
    tmp_path: Path,
) -> None:
    places = np.array([[-1, 0, 0], [1, 0, 0], [0, 0.5, 0]], dtype="<f4")
    (tmp_path / "places.bin").write_bytes(places.tobytes())
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "places.bin", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 2000]}],
        "scenes": [{"nodes": [0, 1]}],
    }
    path = tmp_path / "points.gltf"
    path.write_text(json.dumps(document))
    scene = phong.Scene.read(path)
    for size in ((320, 160), (64, 32)):
        pixels = np.asarray(phong.render(scene, size=size, samples=1))
        assert covered(pixels) * size[0] * size[1] > 10
