#!/usr/bin/env python3
"""How far repaired surfaces are from their inputs, by other means than the mesher's: files are read, compared and
measured here with numpy and scipy alone.

compare_repaired.py FILES... [--program collarmesh] [--limit 60] [--samples 20000]

Each surface goes through `collarmesh repair`. For the result and the input, samples spread over the triangles are
compared with the nearest triangles of the other, both ways, in shares of the diagonal. What of the input lies inside
(a winding number above 3/4) is left out, as walls inside are meant to vanish. Volumes: that of the result by its
triangles, and that of the input where its winding number is above 1/2, at random points of the box. Rows come with the
largest distance first."""

from __future__ import annotations

import argparse
import math
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from tables import table


def read_stl(path: Path) -> np.ndarray:
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        return np.frombuffer(data[84:], record)["corners"].astype(float)
    words = [line.split()[1:4] for line in data.decode(errors="replace").splitlines()
             if line.strip().startswith("vertex")]
    return np.array(words, float).reshape(-1, 3, 3)


def fans(polygons: list[list[int]]) -> list[tuple[int, int, int]]:
    return [(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)]


def read_obj(path: Path) -> np.ndarray:
    points, polygons = [], []
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            numbers = [int(x.split("/")[0]) for x in words[1:]]
            polygons.append([n - 1 if n > 0 else len(points) + n for n in numbers])
    return np.array(points)[np.array(fans(polygons), int)]


def read_off(path: Path) -> np.ndarray:
    words = " ".join(line.split("#")[0] for line in path.read_text().splitlines()).split()
    assert words[0] == "OFF", path
    points, facets = int(words[1]), int(words[2])
    at = 4 + 3 * points
    corners = np.array(words[4:at], float).reshape(-1, 3)
    lines = [line.split() for line in path.read_text().splitlines()[-facets:]]
    return corners[np.array(fans([[int(x) for x in w[1:int(w[0]) + 1]] for w in lines]), int)]


readers = {".stl": read_stl, ".obj": read_obj, ".off": read_off}


def areas(triangles: np.ndarray) -> np.ndarray:
    edges = triangles[:, 1:] - triangles[:, :1]
    return 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)


def volume(triangles: np.ndarray) -> float:
    moved = triangles - triangles.mean((0, 1))
    return float(np.einsum("ij,ij->", moved[:, 0], np.cross(moved[:, 1], moved[:, 2])) / 6)


def samples_of(triangles: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """All corners' mean and points at random, by area."""
    share = areas(triangles)
    chosen = triangles[random.choice(len(triangles), count, p=share / share.sum())]
    weights = random.dirichlet((1, 1, 1), count)
    centres = triangles.mean(1)
    if len(centres) > count:
        centres = centres[random.choice(len(centres), count, replace=False)]
    return np.concatenate([np.einsum("ij,ijk->ik", weights, chosen), centres])


def to_segment(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    d = b - a
    along = np.clip(np.einsum("ij,ij->i", p - a, d) / np.maximum(np.einsum("ij,ij->i", d, d), 1e-300), 0, 1)
    return np.linalg.norm(p - a - along[:, None] * d, axis=1)


def to_triangles(p: np.ndarray, t: np.ndarray) -> np.ndarray:
    """From each point to the triangle of its row."""
    a, b, c = t[:, 0], t[:, 1], t[:, 2]
    normal = np.cross(b - a, c - a)
    length = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    inside = np.ones(len(p), bool)
    for q, r in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("ij,ij->i", np.cross(r - q, p - q), normal) >= 0
    across = np.abs(np.einsum("ij,ij->i", p - a, normal)) / length
    beside = np.minimum(np.minimum(to_segment(p, a, b), to_segment(p, b, c)), to_segment(p, c, a))
    return np.where(inside, across, beside)


class Nearest:
    """Distances to triangles. Points on them, no farther apart than a share of the diagonal, give a bound for each
    point; all triangles whose circumscribed ball is within that are measured."""

    def __init__(self, triangles: np.ndarray, diagonal: float):
        self.triangles = self.divided(triangles, diagonal / 50)
        self.centres = self.triangles.mean(1)
        self.radius = float(np.linalg.norm(self.triangles - self.centres[:, None], axis=2).max())
        self.tree = cKDTree(self.centres)

    @staticmethod
    def divided(triangles: np.ndarray, longest: float) -> np.ndarray:
        """Halved at the longest side until all are short."""
        done = []
        while len(triangles):
            sides = np.linalg.norm(triangles - np.roll(triangles, -1, 1), axis=2)
            first = sides.argmax(1)
            rows = np.arange(len(triangles))
            short = sides[rows, first] <= longest
            done.append(triangles[short])
            a, b, c = (triangles[rows, (first + i) % 3][~short] for i in range(3))
            middle = (a + b) / 2
            triangles = np.concatenate([np.stack([a, middle, c], 1), np.stack([middle, b, c], 1)])
        return np.concatenate(done)

    def distances(self, points: np.ndarray) -> np.ndarray:
        found = to_triangles(points, self.triangles[self.tree.query(points)[1]])
        for i, near in enumerate(self.tree.query_ball_point(points, found + self.radius)):
            if near:
                rows = self.triangles[near]
                found[i] = min(found[i], to_triangles(np.repeat(points[i:i + 1], len(near), 0), rows).min())
        return found


def winding_numbers(triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    result = np.empty(len(points))
    for i, p in enumerate(points):
        a, b, c = np.moveaxis(triangles - p, 1, 0)
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        above = np.einsum("ij,ij->i", a, np.cross(b, c))
        below = (la * lb * lc + np.einsum("ij,ij->i", a, b) * lc + np.einsum("ij,ij->i", b, c) * la +
                 np.einsum("ij,ij->i", c, a) * lb)
        result[i] = np.arctan2(above, below).sum() / (2 * math.pi)
    return result


def compare(path: Path, program: str, limit: int, count: int) -> list | None:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "repaired.off"
        run = subprocess.run([program, "repair", str(path), "-o", str(out)], capture_output=True, text=True, check=False,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)))
        if run.returncode != 0:
            return None
        repaired = read_off(out)
    given = readers[path.suffix.lower()](path)
    given = given[areas(given) > 0]
    diagonal = float(np.linalg.norm(np.ptp(given.reshape(-1, 3), 0)))
    random = np.random.default_rng(1)
    of_repaired = Nearest(given, diagonal).distances(samples_of(repaired, count, random))
    points = samples_of(given, count, random)
    of_given = Nearest(repaired, diagonal).distances(points)
    far = np.flatnonzero(of_given > 1e-5 * diagonal)
    inside = winding_numbers(repaired, points[far]) > 0.75
    of_given[far[inside]] = 0
    low, high = given.reshape(-1, 3).min(0), given.reshape(-1, 3).max(0)
    places = random.uniform(low, high, (max(200, min(count, 40_000_000 // len(given))), 3))
    hit = winding_numbers(given, places) > 0.5
    box = float(np.prod(high - low))
    share = hit.mean()
    return [path.name, of_repaired.max() / diagonal, of_given.max() / diagonal, volume(repaired), share * box,
            box * math.sqrt(share * (1 - share) / len(places))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--program", default="collarmesh")
    parser.add_argument("--limit", type=int, default=60)
    parser.add_argument("--samples", type=int, default=20000)
    options = parser.parse_args()
    rows = []
    for path in options.files:
        if path.suffix.lower() not in readers:
            continue
        row = compare(path, options.program, options.limit, options.samples)
        if row is None:
            print(f"{path.name}: not repaired", file=sys.stderr)
        else:
            rows.append(row)
    rows.sort(key=lambda row: -max(row[1], row[2]))
    print(table(["file", "repaired from input", "input from repaired", "volume", "of the input", "error of that"],
                [[name, *(f"{x:.3g}" for x in numbers)] for name, *numbers in rows]))


if __name__ == "__main__":
    main()
