"""Pictures, films and sweeps by a Dask cluster, with the bits of one machine.

A picture is rendered in shares, which partition its pixels; each is a task. The first are large and
the last small, so that no worker waits long for another at the end. The scene goes to the
scheduler once and to each worker once, by its content; a client's last few scenes are kept there. A
share that was under way or kept on a worker that died is rendered again by another, and no other
share is. With ``store=FOLDER`` finished shares are also kept in files, so that a call goes on where
an earlier one was interrupted.

No call waits for ever: where no worker can work for ``timeout`` seconds, and where workers die of a
task one after another, it ends in a :class:`ClusterError` that says why. Ctrl-C cancels what is
under way. What a scene or an option has wrong raises what it would raise here.
"""

from __future__ import annotations

import copy
import itertools
import json
import os
import pickle
import tempfile
import threading
import time
import uuid
import weakref
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

import phong

from ._cluster import ClusterError, Task, run_tasks
from ._phong import _compile, _Join, _tiles, arithmetic
from ._progress import Listener
from ._shares import Equal, Falling, Share, fitting
from ._store import Store, digest_of, write_whole

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["ClusterError", "Variation", "render", "render_frames", "sweep"]

#: How many scenes of a client its workers keep.
SCENES_KEPT: Final = 4

Progress = bool | Callable[[float], object] | None
#: Pictures of two versions of the arithmetic do not go together.
_ARITHMETIC: Final = f"arithmetic {arithmetic()}"

SceneOrPath = phong.Scene | str | os.PathLike[str]


@dataclass(frozen=True)
class Variation:
    """A picture of a sweep."""

    #: What was changed, by the path of each key.
    parameters: dict[str, Any]
    #: The picture.
    image: phong.Image


def render(
    scene: SceneOrPath,
    client: Client | None = None,
    *,
    shares: int | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress = None,
    timeout: float | None = 300.0,
    **options: Any,
) -> phong.Image:
    """What ``phong.render(scene, **options)`` draws, to the bit, by the workers of ``client``.

    ``client``: None is the current one. ``shares``: so many tasks of one size; None is tasks that
    get smaller the less is left of the picture. ``store``: a folder
    for finished shares; it may be deleted when the picture is there. ``progress``: as in
    ``phong.render``, told for each share. ``timeout``: seconds without a worker that can work
    before giving up; None waits for ever. ``options``: those of ``phong.render``; ``threads``
    (None: the worker's) is for each worker.

    Raises ClusterError where the cluster cannot do it, and what ``phong.render`` raises.
    """
    on = _client(client)
    scene = _read(scene)
    digest = scene.digest()
    threads = options.pop("threads", None)
    asked = digest_of(digest, _text(options), _ARITHMETIC)
    if shares is not None and shares < 1:
        raise ValueError(f"shares is {shares}; wanted is a whole number above 0")
    # What is wrong with an option is told here, before anything is sent.
    tiles = _tiles(scene, options)
    kept = Store(store) if store is not None else None
    whole = _Join()
    cut, done = _begun(tiles, shares, kept, asked, whole)
    kind = f"phong-share-{uuid.uuid4().hex[:12]}"
    tries = itertools.count()

    def next_task(threads_now: int) -> Task[Share, tuple[bytes, float]] | None:
        share = cut.next(threads_now)
        if share is None:
            return None
        index, count = share.index, share.count

        def submit(**where: Any) -> Any:
            return on.submit(
                _share, _sent(scene, digest, on), index, count, threads, options,
                key=f"{kind}-{index}of{count}-{next(tries)}", pure=False, **where,
            )  # fmt: skip

        return Task(share, _title(share), submit)

    with Listener(progress) as listener:
        _tell(listener, done, cut.finest)
        for share, (part, seconds) in run_tasks(on, next_task, timeout=timeout):
            cut.took(share, seconds)
            whole.add(_title(share), part)
            if kept is not None:
                kept.write(asked, share.index, share.count, part)
            done += cut.finest // share.count
            _tell(listener, done, cut.finest)
    return whole.finish()


def _begun(
    tiles: int, shares: int | None, kept: Store | None, asked: str, whole: _Join
) -> tuple[Equal | Falling, int]:
    """How a picture is cut, and how many of its finest shares are stored; they are joined."""
    stored = {Share(*one) for one in kept.names(asked)} if kept is not None else set()
    count, there = fitting(tiles, shares, stored)
    done = []
    for share in there:
        part = kept.read(asked, share.index, share.count) if kept is not None else None
        if part is not None:
            whole.add(_title(share), part)
            done.append(share)
    cut = Falling(tiles, done) if count is None else Equal(count, done)
    return cut, sum(cut.finest // share.count for share in done)


def _title(share: Share) -> str:
    return f"share {share.index} of {share.count}"


def render_frames(
    scenes: Iterable[SceneOrPath],
    client: Client | None = None,
    out: str | os.PathLike[str] = "frame-{:05}.png",
    *,
    skip: bool = False,
    progress: Progress = None,
    timeout: float | None = 300.0,
    bits: int = 8,
    exposure: float | Literal["auto"] | None = None,
    **options: Any,
) -> list[Path]:
    """Renders the frames of a film, each a task, and writes each to a file as it comes.

    ``scenes`` may be a generator: it is asked for the next scene when a worker is about to be free.
    ``out``: the files' name, in which ``{}`` or ``{:05}`` stands for the frame's number, from 0;
    its ending says the format, as in ``Image.save``, which ``bits`` and ``exposure`` are for.
    ``skip``: frames whose files are there are not rendered, so that a call goes on where an earlier
    one was interrupted; files are complete or absent. ``progress``, ``timeout`` and ``options`` as
    in :func:`render`.

    Returns the files, in order. Raises ClusterError, ValueError where ``out`` names all frames
    alike, and what ``phong.render`` and ``Image.save`` raise.
    """
    on = _client(client)
    pattern = os.fspath(out)
    if pattern.format(0) == pattern.format(1):
        raise ValueError(f"out is {pattern!r}; wanted is a name with {{}} for the frame's number")
    threads = options.pop("threads", None)
    files: list[Path] = []
    kind = f"phong-frame-{uuid.uuid4().hex[:12]}"
    tries = itertools.count()
    total = len(scenes) if isinstance(scenes, Sequence) else 0

    def tasks() -> Iterator[Task[int, bytes]]:
        for number, one in enumerate(scenes):
            path = Path(pattern.format(number))
            files.append(path)
            if skip and path.exists():
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            packed = pickle.dumps(_read(one), protocol=5)

            def submit(
                packed: bytes = packed,
                number: int = number,
                suffix: str = path.suffix,
                **where: Any,
            ) -> Any:
                with _large():
                    return on.submit(
                        _file, packed, suffix, bits, exposure, threads, options,
                        key=f"{kind}-{number}-{next(tries)}", pure=False, **where,
                    )  # fmt: skip

            yield Task(number, f"frame {number}", submit)

    left = tasks()
    with Listener(progress) as listener:
        come = run_tasks(on, lambda _: next(left, None), timeout=timeout)
        for done, (number, content) in enumerate(come, 1):
            write_whole(files[number], content)
            _tell(listener, done, total or len(files))
    return files


def sweep(
    scene: SceneOrPath,
    parameters: Mapping[str, Sequence[Any]] | Iterable[Mapping[str, Any]],
    client: Client | None = None,
    *,
    store: str | os.PathLike[str] | None = None,
    progress: Progress = None,
    timeout: float | None = 300.0,
    **options: Any,
) -> list[Variation]:
    """A picture of the scene for each set of parameters, each a task.

    ``parameters``: ``{"camera.fov": [20, 40], "samples": [1, 16]}`` is all combinations, the last
    key changing fastest; a sequence of dicts is just those. A key is an option of ``phong.render``,
    or a path as in ``phong batch``: ``camera.KEY``, ``light.NUMBER.KEY`` (from 1),
    ``materials.NAME.KEY``, ``image.KEY`` or ``ambient.color``. The scene itself is not changed.
    ``store``, ``progress``, ``timeout`` and ``options`` as in :func:`render`.

    Returns the variations, in order. Raises ClusterError, KeyError for a path that is not
    there, and what ``phong.render`` raises.
    """
    on = _client(client)
    scene = _read(scene)
    threads = options.pop("threads", None)
    chosen = list(_combinations(parameters))
    # What is wrong with a path or a value is told here, before anything is rendered.
    changes = [_split(scene, one) for one in chosen]
    kept = Store(store) if store is not None else None
    base = scene.digest()
    names = [
        digest_of(base, json.dumps(one, default=repr, sort_keys=True), _text(options), _ARITHMETIC)
        for one in chosen
    ]
    images: dict[int, phong.Image] = {}
    kind = f"phong-variation-{uuid.uuid4().hex[:12]}"
    tries = itertools.count()

    def tasks() -> Iterator[Task[int, bytes]]:
        for number, (paths, own) in enumerate(changes):
            there = kept.read(names[number], 0, 1) if kept is not None else None
            if there is not None:
                images[number] = phong.merge([there])
                continue

            def submit(
                number: int = number,
                paths: dict[str, Any] = paths,
                own: dict[str, Any] = own,
                **where: Any,
            ) -> Any:
                return on.submit(
                    _variation, _sent(scene, base, on), paths, threads, {**options, **own},
                    key=f"{kind}-{number}-{next(tries)}", pure=False, **where,
                )  # fmt: skip

            yield Task(number, f"variation {number} ({chosen[number]})", submit)

    left = tasks()
    with Listener(progress) as listener:
        for number, part in run_tasks(on, lambda _: next(left, None), timeout=timeout):
            images[number] = phong.merge([part])
            if kept is not None:
                kept.write(names[number], 0, 1, part)
            _tell(listener, len(images), len(chosen))
    return [Variation(dict(one), images[number]) for number, one in enumerate(chosen)]


# What workers do.


def _unpacked(packed: bytes) -> phong.Scene:
    scene: phong.Scene = pickle.loads(packed)
    return scene


#: Held while a worker compiles a scene: the tasks that it begins at once do it once.
_compiling = threading.Lock()


def _share(
    scene: phong.Scene, index: int, count: int, threads: int | None, options: dict[str, Any]
) -> tuple[bytes, float]:
    """The share, and the seconds that its rays took."""
    options = {**options, "threads": _threads(threads)}
    with _compiling:
        _compile(scene, options)
    began = time.perf_counter()
    part = phong.render_part(scene, index, count, **options)
    return part, time.perf_counter() - began


def _variation(
    scene: phong.Scene, paths: dict[str, Any], threads: int | None, options: dict[str, Any]
) -> bytes:
    return phong.render_part(_varied(scene, paths), 0, 1, threads=_threads(threads), **options)


def _file(
    packed: bytes,
    suffix: str,
    bits: int,
    exposure: float | Literal["auto"] | None,
    threads: int | None,
    options: dict[str, Any],
) -> bytes:
    image = phong.render(_unpacked(packed), threads=_threads(threads), progress=False, **options)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"frame{suffix}"
        image.save(path, bits=bits, exposure=exposure)
        return path.read_bytes()


def _threads(threads: int | None) -> int:
    """How many threads a task uses: those of its worker, whose tasks share them."""
    if threads is not None:
        return threads
    from distributed import get_worker

    return int(get_worker().state.nthreads)


# Scenes on the cluster.

_scenes: weakref.WeakKeyDictionary[Any, OrderedDict[str, Any]] = weakref.WeakKeyDictionary()


def _sent(scene: phong.Scene, digest: str, client: Any) -> Any:
    """The scene on the cluster, sent unless it is there.

    It is a task that unpacks what the scheduler holds, so that it is made again where the workers
    die that have it; scattered data would be lost.
    """
    sent = _scenes.setdefault(client, OrderedDict())
    future = sent.get(digest)
    if future is None or future.status not in ("pending", "finished"):
        packed = pickle.dumps(scene, protocol=5)
        with _large():
            future = client.submit(
                _unpacked, packed, key=f"phong-scene-{digest}-{uuid.uuid4().hex[:8]}", pure=False
            )
        sent[digest] = future
    sent.move_to_end(digest)
    while len(sent) > SCENES_KEPT:
        sent.popitem(last=False)
    return future


def _large() -> Any:
    """Dask warns of large arguments; here they are meant, and sent once."""
    from dask import config

    return config.set({"distributed.admin.large-graph-warning-threshold": "1 TB"})


# What was asked for.


def _client(client: Client | None) -> Any:
    try:
        import distributed
    except ModuleNotFoundError as error:
        raise ImportError(
            "phong.dask needs Dask: pip install distributed", name=error.name
        ) from error
    if client is None:
        return distributed.get_client()
    if not isinstance(client, distributed.Client):
        raise TypeError(f"client is a {type(client).__qualname__}; wanted is distributed.Client")
    if client.asynchronous:
        raise TypeError(
            "client is asynchronous; wanted is one that waits: Client(asynchronous=False)"
        )
    return client


def _read(scene: SceneOrPath) -> phong.Scene:
    return scene if isinstance(scene, phong.Scene) else phong.Scene.read(scene)


def _text(options: Mapping[str, Any]) -> str:
    return json.dumps(options, default=repr, sort_keys=True)


def _tell(listener: Listener, done: int, total: int) -> None:
    if listener.listen is not None:
        listener.listen(done, total)


def _combinations(
    parameters: Mapping[str, Sequence[Any]] | Iterable[Mapping[str, Any]],
) -> Iterator[dict[str, Any]]:
    if isinstance(parameters, Mapping):
        names = [str(name) for name in parameters]
        for values in itertools.product(*parameters.values()):
            yield dict(zip(names, values, strict=True))
    else:
        for one in parameters:
            yield dict(one)


def _split(scene: phong.Scene, chosen: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """What changes the scene, and what are options; tried out, so that errors are told at once."""
    of_scene = ("camera", "light", "materials", "ambient", "image")
    paths = {path: value for path, value in chosen.items() if path.partition(".")[0] in of_scene}
    _varied(scene, paths)
    return paths, {key: value for key, value in chosen.items() if key not in paths}


def _varied(scene: phong.Scene, paths: Mapping[str, Any]) -> phong.Scene:
    """A copy of the scene, changed."""
    made = copy.copy(scene)
    for path, value in paths.items():
        kind, _, rest = path.partition(".")
        name, _, key = rest.rpartition(".")
        if path == "ambient.color":
            made.ambient = value
        elif kind in ("camera", "image") and key and not name:
            if kind == "image":
                made.image = {key: value}
            else:
                made.camera = made.camera.replace(**{key: value})
        elif kind == "light" and name:
            lights = made.lights
            if not name.isdecimal() or not 1 <= int(name) <= len(lights):
                raise KeyError(f"{path}: the scene has {len(lights)} lights, counted from 1")
            lights[int(name) - 1] = lights[int(name) - 1].replace(**{key: value})
            made.lights = lights
        elif kind == "materials" and name:
            materials = made.materials
            if name not in materials:
                raise KeyError(f"{path}: the scene has the materials {', '.join(materials)}")
            made.set_material(name, materials[name].replace(**{key: value}))
        else:
            raise KeyError(
                f"{path}: wanted is camera.KEY, light.NUMBER.KEY, materials.NAME.KEY, image.KEY "
                "or ambient.color"
            )
    return made
