"""Whatever arrays are thrown at it: a picture, or an exception that names what is wrong."""

from __future__ import annotations

import pickle
import re
from typing import Any

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import phong

#: What may be raised for an argument.
REFUSED = (ValueError, TypeError, OverflowError, MemoryError, OSError)
SETTINGS = settings(
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)

DTYPES = st.one_of(
    arrays.floating_dtypes(),
    arrays.floating_dtypes(endianness=">"),
    arrays.integer_dtypes(),
    arrays.integer_dtypes(endianness=">"),
    arrays.unsigned_integer_dtypes(),
    arrays.boolean_dtypes(),
    arrays.complex_number_dtypes(),
    arrays.byte_string_dtypes(),
    arrays.unicode_string_dtypes(),
    arrays.datetime64_dtypes(),
    st.just(np.dtype(object)),
)


@st.composite
def any_array(draw: st.DrawFn, columns: int | None = None) -> Any:
    """An array of any type, shape and layout."""
    shape = draw(arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5))
    if columns is not None and draw(st.booleans()):
        shape = (draw(st.integers(0, 6)), columns)
    array = draw(arrays.arrays(draw(DTYPES), shape, elements=None))
    if array.dtype.kind == "f" and array.size and draw(st.booleans()):
        flat = array.reshape(-1).copy()
        odd = draw(st.sampled_from([np.nan, np.inf, -np.inf, 1e30, -1e30, 1e-40]))
        with np.errstate(all="ignore"):
            flat[draw(st.integers(0, flat.size - 1))] = odd
        array = flat.reshape(array.shape)
    layout = draw(st.sampled_from(["plain", "fortran", "reversed", "strided", "readonly", "list"]))
    if layout == "fortran":
        array = np.asfortranarray(array)
    elif layout == "reversed" and array.ndim:
        array = array[::-1]
    elif layout == "strided" and array.ndim:
        array = np.repeat(array, 2, axis=array.ndim - 1)[..., ::2]
    elif layout == "readonly":
        array = array.copy()
        array.flags.writeable = False
    elif layout == "list":
        return array.tolist()
    return array


ANYTHING = st.one_of(
    any_array(),
    any_array(3),
    st.none(),
    st.text(max_size=5),
    st.floats(),
    st.integers(),
    st.lists(st.one_of(st.none(), st.text(max_size=2), st.floats()), max_size=4),
    st.just(object()),
    st.just({"a": 1}),
)
CENTERS = st.one_of(any_array(3), ANYTHING)


def tried(call: Any) -> None:
    said = None
    try:
        call()
    except REFUSED as error:
        said = str(error)
    assert said != ""


@SETTINGS
@given(CENTERS, ANYTHING, ANYTHING)
def test_spheres_take_or_refuse_anything(centers: Any, radii: Any, colors: Any) -> None:
    scene = phong.Scene()
    before = np.array(centers, copy=True) if isinstance(centers, np.ndarray) else None
    tried(lambda: scene.add_spheres(centers, radii, colors))
    tried(lambda: scene.add_spheres(centers, 0.5, colors))
    tried(lambda: scene.add_spheres(centers, radii))
    if before is not None and before.dtype.kind in "fiu":
        assert np.array_equal(before, centers, equal_nan=before.dtype.kind == "f")
    part = scene.add_spheres(np.eye(3), 0.5)
    tried(lambda: scene.update_spheres(part, centers, radii, colors))
    tried(lambda: scene.update_spheres(part, centers))
    tried(lambda: scene.update_spheres(part, None, radii, colors))
    phong.render(scene, size=(4, 4), samples=1, threads=1)


@SETTINGS
@given(CENTERS, CENTERS, ANYTHING, ANYTHING, ANYTHING)
def test_meshes_take_or_refuse_anything(
    vertices: Any, faces: Any, normals: Any, uv: Any, colors: Any
) -> None:
    scene = phong.Scene()
    good = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    tried(lambda: scene.add_mesh(vertices, faces))
    tried(lambda: scene.add_mesh(vertices, [[0, 1, 2]]))
    tried(lambda: scene.add_mesh(good, faces))
    tried(lambda: scene.add_mesh(good, [[0, 1, 2]], normals, uv, colors))
    tried(lambda: scene.add_mesh(good, [[0, 1, 2]], smooth=uv))
    tried(lambda: phong.render(scene, size=(4, 4), samples=1, threads=1))


@SETTINGS
@given(CENTERS, CENTERS, ANYTHING, ANYTHING, ANYTHING)
def test_cylinders_and_copies_take_or_refuse_anything(
    starts: Any, ends: Any, radii: Any, colors: Any, transforms: Any
) -> None:
    scene = phong.Scene()
    tried(lambda: scene.add_cylinders(starts, ends, radii, colors))
    tried(lambda: scene.add_cylinders(np.eye(3), ends, 0.1))
    part = scene.add_cylinders(np.eye(3), np.zeros((3, 3)), 0.1)
    tried(lambda: scene.add_cylinders(np.eye(3), np.zeros((3, 3)), radii, colors))
    tried(lambda: scene.instance(part, transforms))
    tried(lambda: scene.add(phong.Sphere(center=(0, 0, 0), radius=1), transforms))
    tried(lambda: phong.render(scene, size=(4, 4), samples=1, threads=1))


@SETTINGS
@given(ANYTHING, ANYTHING)
def test_cameras_materials_and_options_take_or_refuse_anything(one: Any, two: Any) -> None:
    scene = phong.Scene()
    scene.add_spheres(np.eye(3), 0.5)
    tried(lambda: phong.Camera(eye=one, look_at=two))
    tried(lambda: phong.Material(color=one, shininess=two))
    tried(lambda: phong.Light(kind="point", position=one, color=two))
    tried(lambda: phong.Sphere(center=one, radius=two, material=one))
    tried(lambda: phong.Scene(camera=one, lights=two))
    tried(lambda: phong.Scene(ambient=one, background=two))
    tried(lambda: scene.frame(one, two))
    tried(lambda: scene.set_material(one, two))
    tried(lambda: setattr(scene, "background", one))
    small = {"size": (4, 4), "samples": 1, "threads": 1}
    for name in ("size", "samples", "seed", "threads", "crop", "layers", "depth", "shadows"):
        if name == "size" and not (isinstance(one, (list, tuple, str)) or one is None):
            continue
        if name in ("samples", "threads") and isinstance(one, int) and abs(one) > 64:
            continue
        tried(lambda name=name: phong.render(scene, **{**small, name: one}))


@SETTINGS
@given(ANYTHING, ANYTHING)
def test_questions_take_or_refuse_anything(one: Any, two: Any) -> None:
    scene = phong.Scene()
    scene.add_spheres(np.eye(3), 0.5)
    tried(lambda: phong.explain(scene, one, two, size=(4, 4), samples=1, threads=1))
    tried(lambda: phong.merge(one))
    tried(lambda: phong.compare(one, two))
    tried(lambda: phong.evaluate("phong_spec", one, two, (0, 0, 1), alpha=two))
    tried(lambda: phong.evaluate("F_schlick", cos=one, F0=two))


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f4", ">f8", "i1", "i4", ">i8", "u1", "u8"])
def test_every_dtype_that_holds_the_numbers_gives_the_same_bits(dtype: str) -> None:
    centers = np.array([(0, 1, 2), (3, 4, 5), (6, 7, 9)])
    scenes = [phong.Scene(), phong.Scene()]
    scenes[0].add_spheres(centers.astype("f8"), 1)
    scenes[1].add_spheres(centers.astype(dtype), np.ones(3, dtype))
    assert scenes[0].digest() == scenes[1].digest()


def test_every_layout_gives_the_same_bits() -> None:
    centers = np.arange(30, dtype=np.float32).reshape(10, 3)
    wide = np.zeros((10, 7), np.float32)
    wide[:, 2:5] = centers
    padded = np.zeros(10, np.dtype([("a", "u1"), ("p", "f4", 3)]))
    padded["p"] = centers
    digests = set()
    for array in (
        centers,
        np.asfortranarray(centers),
        wide[:, 2:5],
        centers[::-1][::-1],
        padded["p"],  # not aligned
        centers.tolist(),
        np.ma.masked_array(centers),
    ):
        scene = phong.Scene()
        scene.add_spheres(array, 1)
        digests.add(scene.digest())
    assert len(digests) == 1


def test_points_far_away_keep_their_detail() -> None:
    near, far = phong.Scene(), phong.Scene()
    centers = np.random.default_rng(3).random((50, 3))
    near.add_spheres(np.float32(centers), 0.05)
    far.add_spheres(np.float32(centers).astype(float) + np.array((2**22, 0, 0)), 0.05)
    for scene in (near, far):
        scene.frame("front")
    options: dict[str, Any] = {"size": (64, 64), "samples": 1}
    difference = phong.compare(phong.render(near, **options), phong.render(far, **options))
    assert difference.mean < 1e-3


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda s: s.add_spheres([[0, 0, np.nan]], 1), r"centers\[0\] is \(0, 0, NaN\)"),
        (lambda s: s.add_spheres(np.zeros((3, 2)), 1), r"centers must be of shape \(N, 3\)"),
        (lambda s: s.add_spheres(np.eye(3), [1, 1, -2]), r"radii\[2\] is -2: it must be above 0"),
        (lambda s: s.add_spheres(np.eye(3), [1, 2]), r"radii must be one number or .*\(3,\)"),
        (lambda s: s.add_spheres(np.eye(3), 1, np.eye(2)), r"colors must be one colour, or"),
        (lambda s: s.add_spheres(np.eye(3), 1, "re"), "colors: "),
        (lambda s: s.add_spheres(np.eye(3), 1, np.full((3, 3), 200)), "dtype uint8"),
        (lambda s: s.add_spheres(np.eye(3, dtype=bool), 1), "centers must be an array of numbers"),
        (lambda s: s.add_spheres(np.zeros((0, 3)), 1), "centers is empty"),
        (lambda s: s.add_spheres(np.eye(3), 1, material="gold"), "material: the scene has none"),
        (lambda s: s.add_mesh(np.eye(3), [[0, 1, 3]]), r"faces\[0\] is \(0, 1, 3\)"),
        (lambda s: s.add_mesh(np.eye(3), [[0, 1, 2.5]]), "faces must be an array of whole numbers"),
        (lambda s: s.add_mesh(np.eye(3), [[0, 1, 2, 0]]), "cut its polygons"),
        (lambda s: s.add_mesh(np.eye(3), [[0, 1, 2]], np.zeros((3, 3))), r"normals\[0\] .* direc"),
        (lambda s: s.add_cylinders(np.eye(3), np.eye(2, 3), 1), "ends has 2 rows"),
        (lambda s: s.add_cylinders(np.eye(3), np.eye(3), 1, caps="flat"), r"ends\[0\] is where"),
        (lambda s: s.instance(s.add_spheres(np.eye(3), 1), np.zeros((4, 4))), "last row"),
        (lambda s: s.frame("isoo"), "did you mean"),
        (lambda s: phong.render(s, layers=["dept"]), "did you mean"),
        (lambda s: phong.render(s, threads=-1), "threads = -1"),
        (lambda s: phong.render(s, crop=(0, 0, 9999, 1)), "crop"),
        (lambda s: phong.render(s, smples=3), "samples"),
        (lambda s: phong.explain(s, -1, 0), r"pixel \(-1, 0\) is outside"),
        (lambda s: phong.render_part(s, 3, 3), "index = 3 of count = 3"),
    ],
)
def test_what_is_wrong_is_named(call: Any, words: str) -> None:
    scene = phong.Scene()
    scene.add_spheres(np.eye(3), 0.1)
    with pytest.raises((ValueError, TypeError), match=words):
        call(scene)


def test_a_picture_that_no_memory_holds_is_refused() -> None:
    scene = phong.Scene()
    scene.add_spheres(np.eye(3), 0.1)
    with pytest.raises(MemoryError, match=re.escape("size = (1048576, 1048576)")):
        phong.render(scene, size=(1 << 20, 1 << 20))
    with pytest.raises(MemoryError, match="centers"):
        scene.add_spheres(np.broadcast_to(0.0, (1 << 40, 3)), 1)


def test_later_changes_of_an_array_change_nothing() -> None:
    centers = np.eye(3)
    scene = phong.Scene()
    scene.add_spheres(centers, 0.5)
    before = scene.digest()
    centers[:] = 7
    assert scene.digest() == before


def test_fields_of_points_are_shown_by_maps_and_stay_with_them() -> None:
    heat = phong.Texture("heat", kind="map", of="T", stops=[(0, 0), (1, 1)])
    material = phong.Material(color=heat, k_a=1, k_d=0, k_s=0)
    scene = phong.Scene(phong.Camera(eye=(0, 0, 9), look_at=(0, 0, 0), fov=30))
    centers = np.array([(-1, 0, 0), (1, 0, 0)])
    part = scene.add_spheres(centers, 0.9, material=material, fields={"T": [10.0, 20.0]})

    def seen() -> list[float]:
        picture = np.asarray(phong.render(scene, size=(24, 12), samples=1))
        return [float(picture[6, x, 0]) for x in (7, 16)]

    # The range is that of the numbers.
    assert seen() == [0.0, 1.0]
    scene.update_spheres(part, fields={"T": [4, 3]})
    assert seen() == [1.0, 0.0]
    scene.update_spheres(part, centers=centers + 1e-3)
    assert seen() == [1.0, 0.0]
    assert pickle.loads(pickle.dumps(scene)).digest() == scene.digest()
    with pytest.raises(ValueError, match="fields must be given"):
        scene.update_spheres(part, centers=np.zeros((3, 3)))
    with pytest.raises(ValueError, match=r'fields\["T"\]: fields must be one number'):
        scene.add_spheres(centers, 1, fields={"T": [1, 2, 3]})
    rods = scene.add_cylinders(np.zeros((1, 3)), np.eye(1, 3), 0.1, fields={"T": [[3, 4]]})
    scene.remove(rods)


def test_a_map_of_what_points_have_not_is_refused() -> None:
    cold = phong.Texture("cold", kind="map", of="S", stops="viridis")
    scene = phong.Scene()
    scene.add_mesh(np.eye(3), [[0, 1, 2]], material=phong.Material(color=cold), fields={"T": 1.0})
    with pytest.raises(phong.SceneError, match="cold"):
        phong.render(scene, size=(4, 4), samples=1)
