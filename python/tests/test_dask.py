"""Pictures by a Dask cluster: the bits of one machine, whatever dies meanwhile."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drawing import dressed, need

import phong

# Dask leaves sockets to the collector, and warns of ports that are taken.
pytestmark = pytest.mark.filterwarnings("default")

SCENES = Path(__file__).resolve().parents[2] / "scenes"
THREE = ["two-balls.toml", "glass.toml", "solids.toml"]
SMALL: dict[str, Any] = {"size": (96, 54), "samples": 4, "progress": False}


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    need("distributed")
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
        yield cluster


@pytest.fixture
def client(cluster: Any) -> Iterator[Any]:
    from distributed import Client

    with Client(cluster) as client:
        client.wait_for_workers(2, timeout=300)
        yield client


def balls(count: int = 40) -> phong.Scene:
    chance = np.random.default_rng(3)
    scene = phong.Scene(camera=phong.Camera(eye=(0, 3, 9), look_at=(0, 0, 0)))
    scene.add_spheres(
        chance.normal(0, 1.5, (count, 3)), 0.3, colors=chance.uniform(0.1, 0.9, (count, 3))
    )
    return scene


@pytest.mark.parametrize(
    "name", [*THREE, "clipping.toml", "outline.toml", "figure.toml", "cel.toml", "mesh-light.toml"]
)
def test_the_picture_has_the_bits_of_one_machine(name: str, client: Any) -> None:
    path = SCENES / name
    alone = phong.render(path, layers=("depth", "diffuse"), **SMALL)
    shared = phong.dask.render(path, client, shares=7, layers=("depth", "diffuse"), **SMALL)
    assert np.array_equal(np.asarray(alone), np.asarray(shared))
    assert np.asarray(alone).any()
    for layer in ("depth", "diffuse"):
        assert np.array_equal(alone.layers[layer], shared.layers[layer])


def test_images_travel_with_their_scene(client: Any, tmp_path: Path) -> None:
    scene = dressed(tmp_path)
    (tmp_path / "photo.png").unlink()
    for _ in range(2):
        alone = phong.render(scene, layers=("diffuse",), **SMALL)
        shared = phong.dask.render(scene, client, shares=5, layers=("diffuse",), **SMALL)
        assert np.array_equal(np.asarray(alone), np.asarray(shared))
        assert np.array_equal(alone.layers["diffuse"], shared.layers["diffuse"])
        scene.look("technical")


def test_a_scene_of_arrays_is_sent_once_and_its_changes_are_seen(client: Any) -> None:
    scene = balls()
    first = phong.dask.render(scene, client, **SMALL)
    from phong.dask import _scenes

    sent = dict(_scenes[client])
    assert len(sent) == 1
    again = phong.dask.render(scene, client, **SMALL)
    assert dict(_scenes[client]) == sent, "it was there"
    assert np.array_equal(np.asarray(first), np.asarray(again))
    scene.camera = phong.Camera(eye=(9, 3, 0), look_at=(0, 0, 0))
    turned = phong.dask.render(scene, client, **SMALL)
    assert not np.array_equal(np.asarray(first), np.asarray(turned))
    for count in range(1, 8):
        phong.dask.render(balls(count), client, shares=1, **SMALL)
    assert len(_scenes[client]) == phong.dask.SCENES_KEPT


def test_progress_is_told_for_each_share(client: Any) -> None:
    told: list[float] = []
    options: dict[str, Any] = {**SMALL, "progress": told.append}
    phong.dask.render(balls(), client, shares=5, **options)
    assert told == [done / 5 for done in range(6)]


def test_shares_get_smaller_and_make_the_whole_picture(client: Any) -> None:
    scene = balls()
    options: dict[str, Any] = {"size": (480, 270), "tile": 16, "samples": 1}
    told: list[float] = []
    image = phong.dask.render(scene, client, progress=told.append, **options)
    assert np.array_equal(np.asarray(image), np.asarray(phong.render(scene, **options)))
    shares = np.diff(told)
    assert max(shares) == 1 / 8, "a quarter of what each of two threads has to do"
    assert min(shares) < 1 / 8
    assert told[-1] == 1


def test_what_is_left_is_cut_anew_whatever_is_done() -> None:
    from phong._shares import Falling, Share, fitting

    def tiles(share: Share) -> set[int]:
        return set(range(share.index, 100, share.count))

    for done in ([], [Share(1, 4)], [Share(3, 8), Share(0, 2), Share(63, 64)]):
        for threads in (0, 1, 2, 7, 1000):
            cut = Falling(100, done)
            shares: list[Share] = []
            while (share := cut.next(threads)) is not None:
                shares.append(share)
                cut.took(share, 0.01)
            covered = [tile for share in [*done, *shares] for tile in tiles(share)]
            assert sorted(covered) == list(range(100))
            assert all(map(tiles, shares)), "none is empty"
    stored = [Share(0, 4), Share(4, 8), Share(5, 12), Share(6, 12), Share(3, 1 << 40)]
    assert fitting(100, None, stored) == (None, [Share(0, 4)]), "4 of 8 is in 0 of 4"
    assert fitting(100, None, stored[2:4]) == (12, stored[2:4])
    assert fitting(100, 12, stored) == (12, stored[2:4])
    assert fitting(100, None, []) == (None, [])


def test_what_is_stored_of_a_picture_is_kept_by_another_number_of_shares(
    client: Any, tmp_path: Path
) -> None:
    def stop(done: float) -> None:
        if done > 0.5:
            raise KeyboardInterrupt

    options: dict[str, Any] = {"size": (480, 270), "samples": 1, "store": tmp_path}
    with pytest.raises(KeyboardInterrupt):
        phong.dask.render(balls(), client, progress=stop, **options)
    kept = {path.name: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    told: list[float] = []
    image = phong.dask.render(balls(), client, progress=told.append, **options)
    assert told[0] > 0.5
    assert kept.items() <= {p.name: p.stat().st_mtime_ns for p in tmp_path.iterdir()}.items()
    options.pop("store")
    assert np.array_equal(np.asarray(image), np.asarray(phong.render(balls(), **options)))


def test_what_is_wrong_is_raised_here(client: Any) -> None:
    with pytest.raises(ValueError, match="samples"):
        phong.dask.render(balls(), client, size=(32, 32), samples=-1)
    with pytest.raises(phong.SceneError):
        phong.dask.render(SCENES / "none.toml", client)
    with pytest.raises(ValueError, match="shares is 0"):
        phong.dask.render(balls(), client, shares=0)
    with pytest.raises(TypeError, match=r"wanted is distributed\.Client"):
        phong.dask.render(balls(), "tcp://127.0.0.1:8786")  # type: ignore[arg-type]


def test_frames_of_a_film_are_written_in_order(client: Any, tmp_path: Path) -> None:
    def film() -> Iterator[phong.Scene]:
        for step in range(6):
            scene = balls()
            scene.camera = phong.Camera(eye=(step, 3, 9), look_at=(0, 0, 0))
            yield scene

    out = tmp_path / "film/frame-{:03}.png"
    files = phong.dask.render_frames(film(), client, out, **SMALL)
    assert [f.name for f in files] == [f"frame-{n:03}.png" for n in range(6)]
    for file, scene in zip(files, film(), strict=True):
        alone = tmp_path / "alone.png"
        phong.render(scene, **SMALL).save(alone)
        assert file.read_bytes() == alone.read_bytes()
    files[2].unlink()
    times = {file: file.stat().st_mtime_ns for file in files if file.exists()}
    phong.dask.render_frames(film(), client, out, skip=True, **SMALL)
    assert files[2].exists()
    assert all(f.stat().st_mtime_ns == t for f, t in times.items())
    with pytest.raises(ValueError, match="for the frame's number"):
        phong.dask.render_frames(film(), client, tmp_path / "same.png")


def test_a_sweep_draws_every_combination(client: Any, tmp_path: Path) -> None:
    parameters = {"camera.fov": [20, 60], "samples": [1, 4]}
    options: dict[str, Any] = {"size": (64, 36), "progress": False}
    found = phong.dask.sweep(balls(), parameters, client, store=tmp_path, **options)
    assert [v.parameters for v in found] == [
        {"camera.fov": fov, "samples": samples} for fov in (20, 60) for samples in (1, 4)
    ]
    scene = balls()
    scene.camera = phong.Camera(eye=(0, 3, 9), look_at=(0, 0, 0), fov=60)
    alone = phong.render(scene, samples=1, **options)
    assert np.array_equal(np.asarray(found[2].image), np.asarray(alone))
    stored = {p.name: p.stat().st_mtime_ns for p in tmp_path.iterdir()}
    assert len(stored) == 4
    phong.dask.sweep(balls(), parameters, client, store=tmp_path, **options)
    assert {p.name: p.stat().st_mtime_ns for p in tmp_path.iterdir()} == stored
    with pytest.raises(phong.SceneError, match="zoom"):
        phong.dask.sweep(balls(), [{"camera.zoom": 1}], client)
    with pytest.raises(KeyError, match="the scene has 2 lights"):
        phong.dask.sweep(balls(), [{"light.7.color": 1}], client)


def test_ctrl_c_cancels_what_is_under_way(client: Any) -> None:
    def stop(done: float) -> None:
        if done >= 0.05:
            raise KeyboardInterrupt

    options: dict[str, Any] = {**SMALL, "progress": stop}
    with pytest.raises(KeyboardInterrupt):
        phong.dask.render(balls(), client, shares=40, **options)
    until = time.monotonic() + 10
    left = [""]
    while left and time.monotonic() < until:
        left = [
            str(k)
            for keys in client.processing().values()
            for k in keys
            if str(k).startswith("phong-share")
        ]
        time.sleep(0.05)
    assert not left


def test_no_worker_for_the_task_is_an_error_and_no_hang(client: Any) -> None:
    from dask.base import annotate

    with (
        annotate(resources={"GPU": 1}),
        pytest.raises(phong.dask.ClusterError, match="resources"),
    ):
        phong.dask.render(balls(), client, timeout=3.0, **SMALL)


def test_no_worker_at_all_is_an_error_and_no_hang() -> None:
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=0, dashboard_address=":0") as cluster,
        Client(cluster) as client,
        pytest.raises(phong.dask.ClusterError, match="the cluster has no worker"),
    ):
        phong.dask.render(balls(), client, timeout=2.0, **SMALL)


def test_workers_without_memory_end_in_an_error_that_says_so() -> None:
    from distributed import Client, LocalCluster

    with (
        LocalCluster(
            n_workers=1, threads_per_worker=1, dashboard_address=":0", memory_limit="300MB"
        ) as cluster,
        Client(cluster) as client,
        pytest.raises(phong.dask.ClusterError, match=r"4 workers died .* 300 MB of memory"),
    ):
        # Their tree alone takes more.
        phong.dask.render(balls(2_000_000), client, shares=1, timeout=60, **SMALL)


def test_killed_workers_cost_their_shares_and_nothing_else() -> None:
    import kills

    tally = kills.run(5)
    assert (tally.kills, tally.right, tally.wrong, tally.errors) == (5, 5, 0, []), str(tally)
    assert tally.needless == 0, str(tally)


class Processes:
    """A scheduler and workers as processes of their own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.running: list[subprocess.Popen[bytes]] = []
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            self.address = f"tcp://127.0.0.1:{one.getsockname()[1]}"

    def start(self, *command: str) -> subprocess.Popen[bytes]:
        log = (self.folder / f"{len(self.running)}.log").open("wb")
        # What is sent to workers may be of a module of these tests.
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
        process = subprocess.Popen(
            command, stdout=log, stderr=subprocess.STDOUT, cwd=self.folder, env=environment,
            start_new_session=True,
        )  # fmt: skip
        self.running.append(process)
        return process

    def scheduler(self) -> subprocess.Popen[bytes]:
        port = self.address.rpartition(":")[2]
        return self.start(
            sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1",
            "--port", port, "--no-dashboard", "--dashboard-address", ":0",
        )  # fmt: skip

    def worker(self, *before: str) -> subprocess.Popen[bytes]:
        return self.start(
            *before, sys.executable, "-m", "distributed.cli.dask_worker", self.address,
            "--nthreads", "1", "--no-nanny", "--no-dashboard", "--dashboard-address", ":0",
            "--death-timeout", "120",
        )  # fmt: skip

    def stop(self) -> None:
        for process in self.running:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.fixture
def processes(tmp_path: Path) -> Iterator[Processes]:
    need("distributed")
    made = Processes(tmp_path)
    yield made
    made.stop()


def test_after_the_scheduler_died_another_call_goes_on_from_the_store(
    processes: Processes, tmp_path: Path
) -> None:
    from distributed import Client

    scene, store = balls(), tmp_path / "store"
    scheduler = processes.scheduler()
    processes.worker()
    options: dict[str, Any] = {"size": (160, 90), "samples": 16}

    def kill(done: float) -> None:
        if done >= 4 / 12 and scheduler.poll() is None:
            os.killpg(scheduler.pid, signal.SIGKILL)
            scheduler.wait()

    with Client(processes.address, timeout=120) as client:
        client.wait_for_workers(1, timeout=300)
        with pytest.raises(phong.dask.ClusterError, match="scheduler"):
            phong.dask.render(
                scene, client, shares=12, store=store, progress=kill, timeout=5.0, **options
            )
    kept = {p.name for p in store.iterdir()}
    assert 4 <= len(kept) < 12
    processes.scheduler()
    processes.worker()
    told: list[float] = []
    with Client(processes.address, timeout=120) as client:
        client.wait_for_workers(1, timeout=300)
        image = phong.dask.render(scene, client, store=store, progress=told.append, **options)
    assert told[0] == len(kept) / 12, "what is there is not rendered again"
    assert kept < {p.name for p in store.iterdir()}
    assert np.array_equal(np.asarray(image), np.asarray(phong.render(scene, **options)))


def test_workers_of_different_vector_instructions_give_the_same_bits(
    processes: Processes, tmp_path: Path
) -> None:
    import kills
    from distributed import Client

    processes.scheduler()
    processes.worker("env", "PHONG_SIMD=scalar")
    processes.worker()
    diary = tmp_path / "diary"
    diary.touch()
    with Client(processes.address, timeout=120) as client:
        client.wait_for_workers(2, timeout=300)
        levels: Any = client.run(os.getenv, "PHONG_SIMD")
        assert sorted(map(str, levels.values())) == ["None", "scalar"]
        client.register_plugin(kills.Diary(str(diary)))
        for name in THREE:
            image = phong.dask.render(SCENES / name, client, shares=8, **SMALL)
            alone = phong.render(SCENES / name, **SMALL)
            assert np.array_equal(np.asarray(image), np.asarray(alone)), name
    lines = [line.split(maxsplit=2) for line in diary.read_text().splitlines()]
    worked = {process for process, what, key in lines if what == "done" and "share" in key}
    assert len(worked) == 2, "both have rendered shares"


def test_an_unlucky_scene_is_sent_anew_and_a_share_that_kills_its_workers_is_not() -> None:
    need("distributed")
    from distributed import KilledWorker
    from distributed.core import Status
    from distributed.scheduler import WorkerState

    from phong._cluster import Task, _result, _Submitted

    class Lost:
        key = "phong-share-1-0-0"

        def __init__(self, task: str) -> None:
            self.task = task

        def result(self, timeout: float | None) -> bytes:
            worker = WorkerState(address="tcp://there:1", status=Status.closed, pid=0, name="there",
                                 nthreads=1, memory_limit=0, local_directory="", nanny="",
                                 server_id="there")  # fmt: skip
            raise KilledWorker(self.task, worker, 3)

    def result(task: str, tried: int) -> bytes | None:
        lost: Any = Lost(task)
        known = _Submitted(Task(0, "share 0", lambda: lost), lost, "", tried, done_before=0)
        return _result(known, 0, None)

    assert result("phong-scene-1", 0) is None
    for task, tried in (("phong-scene-1", 1), (Lost.key, 0)):
        with pytest.raises(phong.dask.ClusterError, match="4 workers died"):
            result(task, tried)


def test_a_damaged_file_of_the_store_is_rendered_again(client: Any, tmp_path: Path) -> None:
    first = phong.dask.render(balls(), client, shares=3, store=tmp_path, **SMALL)
    for file in tmp_path.iterdir():
        content = bytearray(file.read_bytes())
        content[-20] ^= 1
        file.write_bytes(content)
    again = phong.dask.render(balls(), client, store=tmp_path, shares=3, **SMALL)
    assert np.array_equal(np.asarray(first), np.asarray(again))
