#!/usr/bin/env python3
"""Measures how thick rods, tubes, shells and roofs are in meshes that default options make of the STEP files by
known_volumes.py. Rays start outside and go inwards along the normals of the exact outer surface, at random points that
are evenly distributed over it. The thickness is the distance between the first two places where a ray crosses the
mesh's surface, each face of which is cut into 16 triangles."""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
from pathlib import Path
from typing import Callable

import meshio
import numpy as np

from few_elements import Triangles, boundary
from known_volumes import diagonal, side
from processes import ProgramFailed, run
from tables import table

Rays = tuple[np.ndarray, np.ndarray]   # starting points outside the body, and unit vectors that point inwards


def around_axis(radius: float, low: float, high: float, length: float, rng: np.random.Generator, count: int) -> Rays:
    """Returns rays towards the axis of a cylinder along x. They start at angles between `low` and `high`, in degrees
    from the y axis."""
    angle = np.radians(rng.uniform(low, high, count))
    outwards = np.stack([np.zeros(count), np.cos(angle), np.sin(angle)], 1)
    start = 1.5 * radius * outwards
    start[:, 0] = rng.uniform(0.02 * length, 0.98 * length, count)   # away from the ends
    return start, -outwards


def around_centre(radius: float, rng: np.random.Generator, count: int) -> Rays:
    outwards = rng.normal(size=(count, 3))
    outwards /= np.linalg.norm(outwards, axis=1)[:, None]
    return 1.5 * radius * outwards, -outwards


def member(name: str) -> tuple[float, Callable[[np.random.Generator, int], Rays]] | None:
    """Returns a body's exact thickness and the function that makes its rays; None if its family is not measured."""
    family, _, number = name.rpartition("_")
    if family in ("rod", "tube"):
        r = float(number)
        return (2 * r if family == "rod" else 0.1 * r), lambda rng, n: around_axis(r, 0, 360, diagonal, rng, n)
    if family == "hollow_ball":
        return float(number), lambda rng, n: around_centre(side / 2, rng, n)
    if family == "roof":
        return float(number), lambda rng, n: around_axis(6, 5, 175, 12, rng, n)
    return None


def first_two(triangles: Triangles, start: np.ndarray, way: np.ndarray) -> float:
    """Returns the distance between the first two crossings of a ray; NaN if there are fewer."""
    a, b, c = (triangles.points[triangles.corners[:, k]] for k in range(3))
    across = np.cross(way, c - a)
    determinant = np.einsum("ij,ij->i", b - a, across)
    with np.errstate(all="ignore"):
        u = np.einsum("ij,ij->i", start - a, across) / determinant
        beside = np.cross(start - a, b - a)
        v = beside @ way / determinant
        at = np.einsum("ij,ij->i", c - a, beside) / determinant
        met = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (at > 0)
    places = np.unique(np.round(at[met], 9))   # crossings on an edge of two triangles count once
    return places[1] - places[0] if len(places) > 1 else math.nan


def measured(path: Path, program: str, order: int, limit: float, count: int) -> list[str]:
    known, rays = member(path.stem)
    with tempfile.TemporaryDirectory() as folder:
        try:
            run([program, str(path.resolve()), "-o", "mesh.vtu", "--progress", "none", "-q", "--order", str(order)],
                Path(folder), limit, accepted=(0, 7))
        except ProgramFailed as failure:
            return [path.stem, str(order), f"{known:g}", "", "", "", "", str(failure)]
        mesh = meshio.read(Path(folder) / "mesh.vtu")
    tets = np.concatenate([block.data for block in mesh.cells if block.type in ("tetra", "tetra10")])
    surface = boundary(mesh.points, tets)
    found = np.array([first_two(surface, *ray) for ray in zip(*rays(np.random.default_rng(1), count))]) / known - 1
    some = found[~np.isnan(found)]
    return [path.stem, str(order), f"{known:g}", str(len(tets)), f"{100 * some.mean():+.2f}%",
            f"{100 * some.min():+.1f}%",
            f"{100 * some.max():+.1f}%", str(len(found) - len(some)) if len(some) < len(found) else ""]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="that known_volumes.py wrote")
    parser.add_argument("names", nargs="+", help="members, such as rod_0.3")
    parser.add_argument("--program", default=str(Path(__file__).parents[2] / "collarmesh"))
    parser.add_argument("--orders", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--limit", type=float, default=120, help="seconds for one run")
    parser.add_argument("--rays", type=int, default=400)
    options = parser.parse_args()
    lines = []
    for name in options.names:
        if member(name) is None:
            parser.error(f"{name}: of no family of known thickness")
        for order in options.orders:
            lines.append(measured(options.folder / f"{name}.step", options.program, order, options.limit, options.rays))
            print(*lines[-1], file=sys.stderr)
    print(table(["member", "order", "thickness", "tets", "mean off", "least", "most", "rays without"], lines))


if __name__ == "__main__":
    sys.exit(main())
