#!/usr/bin/env python3
"""Two workers of a Dask cluster, a thread each, against the program with one thread.

    python3 bench/workers.py target/release/phong [--scene FILE] [--size W H] [--samples N] [--rounds N]

with the package and Dask installed. Told are seconds and CPU seconds of both, in turn. The ideal is
half of the program's seconds, and no CPU second more than its own: on a busy machine only the second
can be relied on. CPU seconds of the cluster are those of both workers, the scheduler and the client
together, from the call to the file; what Dask uses in as many seconds without any work is told too,
for it grows with the seconds that others take from the machine. "At shares" is the part of the seconds
that both workers were rendering: it holds on a busy machine too. Both write the same bytes, or it ends
in an error.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def used() -> float:
    """CPU seconds of this process."""
    own = resource.getrusage(resource.RUSAGE_SELF)
    return own.ru_utime + own.ru_stime


def of_program(program: str, scene: Path, options: list[str], out: Path) -> tuple[float, float]:
    """Seconds and CPU seconds of the program with one thread."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.perf_counter()
    command = [program, "render", scene, *options, "--threads", "1", "--quiet", "-o", out]
    subprocess.run(command, check=True)
    wall = time.perf_counter() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def of_cluster(client, scene: Path, size, samples: int, out: Path) -> tuple[float, float, float]:
    """Seconds, CPU seconds, and seconds at shares of the cluster, each worker's first share included."""
    import phong.dask
    from distributed import get_task_stream

    cpu = used() + sum(client.run(used).values())
    began = time.perf_counter()
    with get_task_stream(client) as stream:
        phong.dask.render(scene, client, size=size, samples=samples, progress=False).save(out)
        wall = time.perf_counter() - began
    cpu = used() + sum(client.run(used).values()) - cpu
    spans = (span for task in stream.data for span in task["startstops"])
    return wall, cpu, sum(s["stop"] - s["start"] for s in spans if s["action"] == "compute")


def ticking(client) -> float:
    """CPU seconds that the cluster uses in a second without work."""
    cpu, began = used() + sum(client.run(used).values()), time.perf_counter()
    time.sleep(10)
    return (used() + sum(client.run(used).values()) - cpu) / (time.perf_counter() - began)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--scene", type=Path, default=ROOT / "scenes/two-balls.toml")
    parser.add_argument("--size", type=int, nargs=2, default=(1920, 1080))
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    size, samples = tuple(given.size), given.samples
    options = ["--size", "{}x{}".format(*size), "--samples", str(samples)]

    from distributed import Client, LocalCluster

    alone, shared = [], []
    with (
        tempfile.TemporaryDirectory() as folder,
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
    ):
        a, b = Path(folder) / "a.png", Path(folder) / "b.png"
        for _ in range(given.rounds):
            alone.append(of_program(given.program, given.scene, options, a))
            # A client of its own each time, so that the scene is sent and built each time.
            with Client(cluster) as client:
                client.wait_for_workers(2)
                # Workers stay; the package is imported before anything is timed.
                client.run(__import__, "phong.dask")
                shared.append(of_cluster(client, given.scene, size, samples, b))
                rate = ticking(client)
            if a.read_bytes() != b.read_bytes():
                sys.exit("the pictures differ")
    print(f"the cluster uses {rate:.3f} CPU seconds a second without work")
    for (wall, cpu), (wall_2, cpu_2, at_shares) in zip(alone, shared):
        print(
            f"program {wall:7.2f} s, CPU {cpu:7.2f} s   two workers {wall_2:7.2f} s, CPU {cpu_2:7.2f} s"
            f"   of the ideal {wall / wall_2 / 2:.3f}, CPU ratio {cpu_2 / cpu:.3f}"
            f" ({(cpu_2 - rate * wall_2) / cpu:.3f} without what it uses without work),"
            f" at shares {at_shares / wall_2 / 2:.3f}"
        )


if __name__ == "__main__":
    main()
