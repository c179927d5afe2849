"""The package and the program say the same."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import phong

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "scenes" / "two-balls.toml"
SMALL: dict[str, Any] = {"size": (60, 40), "samples": 2}


def program(*arguments: object, ok: int = 0, text: str | None = None, **variables: str) -> str:
    command = [sys.executable, "-m", "phong", *map(str, arguments)]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        input=text,
        timeout=120,
        env={**os.environ, **variables},
    )
    assert done.returncode == ok, done.stderr
    return done.stdout


@pytest.mark.parametrize("name", ["two-balls", "glass", "instances"])
def test_a_picture_has_the_same_bytes(name: str, tmp_path: Path) -> None:
    scene = ROOT / "scenes" / f"{name}.toml"
    program("render", scene, "--size", "60x40", "--samples", 2, "-o", tmp_path / "a.png", "--quiet")
    program("render", scene, "--size", "60x40", "--samples", 2, "-o", tmp_path / "a.exr", "--quiet")
    image = phong.render(scene, **SMALL)
    image.save(tmp_path / "b.png")
    image.save(tmp_path / "b.exr")
    for ending in ("png", "exr"):
        assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


def test_every_set_of_vector_instructions_gives_the_same_bytes(tmp_path: Path) -> None:
    scene, options = ROOT / "scenes/glass.toml", ("--size", "60x40", "--samples", 2, "--quiet")
    for level in ("", "scalar"):
        program("render", scene, *options, "-o", tmp_path / f"a{level}.png", PHONG_SIMD=level)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "ascalar.png").read_bytes()


def test_an_unknown_set_of_vector_instructions_is_told(tmp_path: Path) -> None:
    program("render", SCENE, "-o", tmp_path / "a.png", ok=2, PHONG_SIMD="sse9")
    code = "import phong, sys; phong.render(sys.argv[1], size=(2, 2), samples=1)"
    environment = {**os.environ, "PHONG_SIMD": "sse9"}
    done = subprocess.run(
        [sys.executable, "-c", code, str(SCENE)], env=environment, capture_output=True, text=True
    )
    assert 'PHONG_SIMD is "sse9": it names vector instructions' in done.stderr


def test_shares_of_both_go_together(tmp_path: Path) -> None:
    program(
        *("render", SCENE, "--size", "60x40", "--samples", 2, "--tile", "0/2"),
        *("-o", tmp_path / "0.part", "--quiet"),
    )
    parts: list[bytes | Path] = [tmp_path / "0.part", phong.render_part(SCENE, 1, 2, **SMALL)]
    assert np.array_equal(phong.merge(parts), phong.render(SCENE, **SMALL))


@pytest.mark.parametrize(("scene", "y"), [(SCENE, 20), (SCENE.with_name("figure.toml"), 3)])
def test_a_pixel_is_explained_alike(scene: Path, y: int) -> None:
    told = program("explain", scene, 20, y, "--json", "--size", "60x40", "--samples", 2)
    assert phong.explain(scene, 20, y, **SMALL).to_dict() == json.loads(told)


def test_formulas_have_the_same_values() -> None:
    rng = np.random.default_rng(2)
    vectors = rng.normal(size=(3, 20, 3))
    vectors /= np.linalg.norm(vectors, axis=-1, keepdims=True)
    n, l, e = vectors  # noqa: E741
    alphas = rng.uniform(1, 50, 20)
    queries = [
        json.dumps(
            {
                "model": "phong_spec",
                "N": n[i].tolist(),
                "L": l[i].tolist(),
                "E": e[i].tolist(),
                "params": {"alpha": alphas[i]},
            }
        )
        for i in range(20)
    ]
    told = program("eval", text="\n".join(queries) + "\n").splitlines()
    expected = np.array([json.loads(line)["value"] for line in told], np.float32)
    assert np.array_equal(phong.evaluate("phong_spec", n, l, e, alpha=alphas), expected)


def test_formulas_are_evaluated_at_a_million_places_at_once() -> None:
    rng = np.random.default_rng(3)
    n = rng.normal(size=(1000, 1, 3))
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    l = rng.normal(size=(1, 1000, 3))  # noqa: E741
    l /= np.linalg.norm(l, axis=-1, keepdims=True)  # noqa: E741
    values = np.asarray(phong.evaluate("lambert", n, l))
    assert values.shape == (1000, 1000)
    assert np.allclose(values, np.maximum(0, (n * l).sum(-1)), atol=1e-6)
    few = phong.evaluate("lambert", n[:3], l[:, :4])
    assert np.array_equal(few, values[:3, :4])
    with pytest.raises(ValueError, match=r"alpha is NaN.* \(at flat index 1\)"):
        phong.evaluate("phong_spec", n[0, 0], n[0, 0], n[0, 0], alpha=[1, np.nan])


def test_a_parameter_named_as_the_normal_is_written_with_an_underscore() -> None:
    told = json.loads(
        program("eval", text='{"model": "D_blinn", "params": {"NH": 0.9, "n": 12}}\n')
    )
    assert phong.evaluate("D_blinn", NH=0.9, n_=12) == np.float32(told["value"])


def test_fits_and_comparisons_and_grades_are_alike(tmp_path: Path) -> None:
    told = json.loads(program("fit", "phong:32", "blinn-phong", "--json"))
    assert phong.fit("phong:32", "blinn-phong").to_dict() == told
    phong.render(SCENE, shadows=False, **SMALL).save(tmp_path / "a.png")
    phong.render(SCENE, **SMALL).save(tmp_path / "b.png")
    told = json.loads(program("compare", tmp_path / "a.png", tmp_path / "b.png", "--json", ok=1))
    assert phong.compare(tmp_path / "a.png", tmp_path / "b.png").to_dict() == told
    told = json.loads(program("grade", SCENE, tmp_path / "a.png", "--json", ok=1))
    del told["image"]
    assert phong.grade(SCENE, tmp_path / "a.png").to_dict() == told


def test_a_scene_is_converted_and_checked(tmp_path: Path) -> None:
    scene = phong.Scene()
    scene.add_spheres(np.eye(3), 0.5, colors=np.eye(3))
    done = phong.convert(scene, tmp_path / "copy.toml")
    assert len(done.files) == 2
    assert not [said for said in phong.check(tmp_path / "copy.toml") if said.severity == "error"]
    assert np.array_equal(
        phong.render(tmp_path / "copy.toml", **SMALL), phong.render(scene, **SMALL)
    )
    (tmp_path / "broken.toml").write_text("version = 1\n[camera]\neye = [0, 0]\n")
    assert {said.severity for said in phong.check(tmp_path / "broken.toml")} == {"error"}


def test_a_figure_is_drawn(tmp_path: Path) -> None:
    figure = phong.figure("cosine")
    figure.save(tmp_path / "cosine.svg")
    assert "<svg" in (tmp_path / "cosine.svg").read_text(encoding="utf-8")
    assert figure.png.startswith(b"\x89PNG")


def test_bytes_are_those_of_the_png(tmp_path: Path) -> None:
    image = phong.render(SCENE, background="transparent", **SMALL)
    image.save(tmp_path / "a.png")
    difference = phong.compare(image.to_srgb8(), tmp_path / "a.png")
    assert difference.max == 0


def test_a_look_is_put_on_by_its_name() -> None:
    scene = phong.Scene()
    scene.add_spheres([(0, 0, 0)], 1.0)
    scene.frame("front")
    scene.look("ink")
    assert "[outline]" in scene.to_toml()
    pixels = np.asarray(phong.render(scene, size=(32, 32), samples=1))
    assert pixels[16, 16, 0] == pixels[0, 0, 0] == 1.0
    assert pixels[16, :, 0].min() < 0.5, "a line, on two pixels side by side"
    with pytest.raises(ValueError, match=r"did you mean .ink."):
        scene.look("inc")


def test_importing_is_quick() -> None:
    # Seconds of CPU, so that others on the machine do not count.
    code = (
        "import time, numpy; began = time.process_time(); import phong; "
        "print(time.process_time() - began)"
    )
    runs = [
        float(subprocess.check_output([sys.executable, "-c", code], text=True)) for _ in range(3)
    ]
    assert min(runs) < 0.1


def test_every_process_writes_the_same_bytes(tmp_path: Path) -> None:
    code = (
        "import sys, phong; image = phong.render(sys.argv[1], size=(20, 10), samples=1, "
        "layers=('depth', 'diffuse', 'normal')); image.save(sys.argv[2])"
    )
    written = set()
    for run in range(4):
        path = tmp_path / f"{run}.exr"
        subprocess.run([sys.executable, "-c", code, str(SCENE), str(path)], check=True)
        written.add(path.read_bytes())
    assert len(written) == 1


def test_a_picture_is_exposed_by_itself_and_toned_as_its_scene_says(tmp_path: Path) -> None:
    scene = phong.Scene()
    scene.add_spheres([(0, 0, 0)], 1.0)
    scene.frame("front")
    image = phong.render(scene, size=(32, 32), samples=1)
    assert not np.array_equal(image.to_srgb8("auto"), image.to_srgb8())
    image.save(tmp_path / "auto.png", exposure="auto")
    assert phong.compare(image.to_srgb8("auto"), tmp_path / "auto.png").max == 0
    with pytest.raises(ValueError, match="exposure = lots"):
        image.to_srgb8("lots")  # type: ignore[arg-type]
