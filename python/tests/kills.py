"""Kills workers of a Dask cluster while they render: ``python kills.py --count 100``.

Each picture loses one worker, by SIGKILL, at a random moment. Each has to be equal to the one that
is rendered without a cluster, and no share may be rendered twice but those that were under way or
kept on the worker that died. Prints counts; exits with 1 if any of it is not so.
"""

from __future__ import annotations

import argparse
import logging
import os
import random
import signal
import tempfile
import threading
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from dask import config
from distributed import Client, LocalCluster
from distributed.diagnostics.plugin import WorkerPlugin

import phong
import phong.dask

SIZE = (160, 90)
SHARES = 10


class Diary(WorkerPlugin):
    """Writes down which process begins and ends which task."""

    name = "diary"

    def __init__(self, path: str) -> None:
        self.path = path

    def transition(self, key: Any, start: str, finish: str, **_: Any) -> None:
        if finish == "executing" or (start == "executing" and finish == "memory"):
            with open(self.path, "a") as file:
                file.write(f"{os.getpid()} {'begun' if finish == 'executing' else 'done'} {key}\n")


@dataclass
class Tally:
    """What happened."""

    kills: int = 0
    right: int = 0
    wrong: int = 0
    late: int = 0
    rendered: int = 0
    lost_under_way: int = 0
    lost_when_done: int = 0
    needless: int = 0
    errors: list[str] = field(default_factory=list)

    def __str__(self) -> str:
        return (
            f"{self.kills} workers killed in mid-flight ({self.late} more after the picture): "
            f"{self.right} right pictures, {self.wrong} wrong, {len(self.errors)} errors\n"
            f"{self.rendered} shares rendered to the end, {SHARES} a picture; lost with a worker: "
            f"{self.lost_under_way} under way, {self.lost_when_done} done and not yet fetched; "
            f"rendered twice without need: {self.needless}"
        )


def scene() -> phong.Scene:
    """Some hundred spheres on a floor, one of them a mirror."""
    chance = np.random.default_rng(7)
    made = phong.Scene(camera=phong.Camera(eye=(0, 6, 14), look_at=(0, 1, 0)))
    made.add(phong.Plane(point=(0, 0, 0), normal=(0, 1, 0)))
    places = np.stack(
        [chance.uniform(-8, 8, 300), np.full(300, 0.4), chance.uniform(-8, 8, 300)], axis=1
    )
    made.add_spheres(places, 0.4, colors=chance.uniform(0.1, 0.9, (300, 3)))
    mirror = phong.Material(k_d=0.2, reflection=0.7)
    made.add_spheres([(0, 2.5, 0)], 1.5, material=mirror)
    return made


def note(diary: list[str], dead: int | None, tally: Tally) -> None:
    """Counts what was rendered more than once in one picture, and whether it had to be."""
    begun: dict[str, list[int]] = {}
    done: dict[str, list[int]] = {}
    for line in diary:
        process, what, key = line.split(maxsplit=2)
        if not key.startswith("phong-share-"):
            continue
        share = key.split("-")[3]
        (begun if what == "begun" else done).setdefault(share, []).append(int(process))
    for share, processes in begun.items():
        ended = Counter(done.get(share, []))
        tally.rendered += ended.total()
        by_the_dead = processes.count(dead) if dead is not None else 0
        tally.lost_under_way += by_the_dead - (ended[dead] if dead is not None else 0)
        again = len(processes) - 1
        if dead is not None and ended[dead] and again:
            tally.lost_when_done += 1
        tally.needless += max(0, again - by_the_dead)


def run(count: int, seed: int = 1, samples: int = 100, tell: bool = False) -> Tally:
    """Kills so many workers, each in a picture of its own with so many samples a pixel."""
    chance = random.Random(seed)
    tally = Tally()
    drawn = scene()
    cluster: Any
    client: Any
    wanted = np.asarray(phong.render(drawn, size=SIZE, samples=samples, progress=False))
    with (
        tempfile.TemporaryDirectory() as folder,
        # A cluster asks this long after each death whether the worker is there, and gives it up for
        # ever if it happens to be dead again.
        config.set({"distributed.deploy.lost-worker-timeout": "1 day"}),
        LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=logging.ERROR
        ) as cluster,
        Client(cluster) as client,
    ):
        diary = Path(folder) / "diary"
        diary.touch()
        client.register_plugin(Diary(str(diary)))
        began = time.perf_counter()
        phong.dask.render(drawn, client, size=SIZE, samples=samples, shares=SHARES, progress=False)
        lasts = time.perf_counter() - began
        while tally.kills < count and tally.late < 2 * count + 10:
            client.wait_for_workers(2, timeout=300)
            before = len(diary.read_text())
            got: list[np.ndarray[Any, Any] | str] = []

            def draw(got: list[np.ndarray[Any, Any] | str] = got) -> None:
                try:
                    image = phong.dask.render(
                        drawn,
                        client,
                        size=SIZE,
                        samples=samples,
                        shares=SHARES,
                        progress=False,
                        timeout=300,
                    )
                    got.append(np.asarray(image))
                except Exception as error:  # It is counted.
                    got.append(f"{type(error).__name__}: {error}")

            thread = threading.Thread(target=draw)
            thread.start()
            time.sleep(chance.uniform(0.0, 0.95 * lasts))
            dead = chance.choice([nanny.pid for nanny in cluster.workers.values()])
            if dead is not None:
                os.kill(dead, signal.SIGKILL)
            in_time = thread.is_alive() and dead is not None
            thread.join()
            tally.kills += in_time
            tally.late += not in_time
            result = got[0]
            if isinstance(result, str):
                tally.errors.append(result)
            elif np.array_equal(result, wanted):
                tally.right += in_time
            else:
                tally.wrong += 1
            note(diary.read_text()[before:].splitlines(), dead if in_time else None, tally)
            if tell and tally.kills % 10 == 0:
                print(tally, flush=True)
    return tally


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100, help="workers to kill")
    parser.add_argument("--seed", type=int, default=1, help="of the random moments")
    parser.add_argument("--samples", type=int, default=100, help="a pixel; more take longer")
    given = parser.parse_args()
    tally = run(given.count, given.seed, given.samples, tell=True)
    print(tally, *tally.errors, sep="\n")
    good = tally.right == tally.kills == given.count and not tally.wrong and not tally.errors
    return 0 if good and tally.needless == 0 else 1


if __name__ == "__main__":
    raise SystemExit(main())
