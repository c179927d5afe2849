"""A picture by workers that Slurm starts: run it on a login node.

    pip install phong distributed dask-jobqueue
    python slurm.py scene.toml poster.exr --workers 40
    python slurm.py                     # prints the job that each worker is, and submits nothing

With ``--store`` on a file system that stays, the same command goes on where it was interrupted.
"""

from __future__ import annotations

import argparse
from typing import Any

from dask_jobqueue.slurm import SLURMCluster
from distributed import Client

import phong.dask


def main() -> None:
    """Reads the command line, and does it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", nargs="?")
    parser.add_argument("out", nargs="?", default="poster.exr")
    parser.add_argument("--size", type=int, nargs=2, default=(30000, 20000))
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--workers", type=int, default=8)
    parser.add_argument("--store", default="shares")
    asked = parser.parse_args()
    cluster: Any
    with SLURMCluster(cores=8, processes=1, memory="16GB", walltime="01:00:00") as cluster:
        if asked.scene is None:
            print(cluster.job_script())
            return
        cluster.scale(asked.workers)
        with Client(cluster) as client:
            image = phong.dask.render(
                asked.scene,
                client,
                size=asked.size,
                samples=asked.samples,
                # More shares than workers: a worker that is lost costs little.
                shares=8 * asked.workers,
                store=asked.store,
                progress=True,
                timeout=None,  # The queue may be long.
            )
        image.save(asked.out)


if __name__ == "__main__":
    main()
