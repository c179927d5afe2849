"""One picture, a film and a sweep by a Dask cluster: here two processes of this machine.

pip install phong distributed
python cluster.py
"""

from __future__ import annotations

import numpy as np
from distributed import Client, LocalCluster

import phong
import phong.dask


def scene(turn: float = 0.0) -> phong.Scene:
    """A ring of balls, turned by so many radians."""
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False) + turn
    centers = np.stack([3 * np.cos(angle), 0.5 + 0 * angle, 3 * np.sin(angle)], axis=1)
    made = phong.Scene(
        camera=phong.Camera(eye=(0, 4, 9), look_at=(0, 0.3, 0)),
        lights=[phong.Light(kind="point", position=(3, 6, 5))],
    )
    colors = phong.from_matplotlib_colormap("twilight", np.arange(24) / 24)
    made.add_spheres(centers, 0.5, colors=colors)
    made.add(phong.Plane(point=(0, 0, 0), normal=(0, 1, 0)))
    return made


def main() -> None:
    """Draws all three."""
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        # Finished shares are kept in a folder: after a mishap, the same call goes on from there.
        image = phong.dask.render(scene(), client, size=(960, 540), samples=16, store="shares")
        image.save("ring.png")

        turns = np.linspace(0, 2 * np.pi / 24, 8, endpoint=False)
        frames = (scene(float(turn)) for turn in turns)
        phong.dask.render_frames(frames, client, "frames/ring-{:03}.png", size=(320, 180))

        parameters: dict[str, list[float]] = {
            "camera.fov": [25, 40, 60],
            "light.1.color": [0.5, 1.0],
        }
        for number, one in enumerate(
            phong.dask.sweep(scene(), parameters, client, size=(320, 180), samples=4)
        ):
            print(number, one.parameters)
            one.image.save(f"sweep-{number}.png")


# Workers are new processes that read this file: only the first one may begin.
if __name__ == "__main__":
    main()
