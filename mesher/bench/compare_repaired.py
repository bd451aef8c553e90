#!/usr/bin/env python3
"""Measures how far repaired surfaces are from their inputs, without the mesher's code: this script reads, compares and
measures files with numpy and scipy (and meshio for .ply), and FreeCAD tessellates CAD files.

compare_repaired.py FILES... [--program collarmesh] [--limit 30] [--samples 20000] [--options '--repair-tolerance 1e-4']

Each file goes through `collarmesh repair`. Distances are measured from samples on the triangles of the result to
the triangles of the input and the other way round, relative to the diagonal of the input. Samples of the input that
lie inside the result (absolute winding number above 3/4) are left out, because repair is meant to remove inner walls.
"told" is the larger of the two distances that the program reports.

The result's volume is the volume that its triangles enclose (with several regions, the sum of the reported volumes).
The input's volume is that of the places with an absolute winding number above 1/2, estimated at random points of the
input's box; for CAD files it is OpenCASCADE's volume of the solids. "differs" is the volume that is inside either the
input or the result but not both, estimated at the same points, relative to the input's volume. Bodies are the input's
connected parts that are closed. A body has changed if a point half-way between two of its opposite sides is inside
before the repair and outside after it, or the reverse. Rows are sorted by distance, largest first."""

from __future__ import annotations

import argparse
import json
import math
import resource
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from tables import table

tessellate = """
import sys
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]
import FreeCAD, Part, numpy
shape = Part.read(sys.argv[1])
parts = [s.tessellate(1e-4 * shape.BoundBox.DiagonalLength) for s in shape.Solids or shape.Faces]
triangles = [[points[i] for i in t] for points, ts in parts for t in ts]
numpy.savez(sys.argv[2], triangles=numpy.array(triangles, float).reshape(-1, 3, 3), \
volumes=[s.Volume for s in shape.Solids])
"""


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


def clipped(polygon: list[int], points: np.ndarray) -> list[tuple[int, int, int]]:
    """Cuts a polygon into triangles: into a fan if it has 3 or 4 corners, otherwise by clipping ears. The rest becomes
    a fan when no ear is left."""
    if len(polygon) <= 4 and len(polygon) > 2:
        return fans([polygon])
    rest, triangles = list(polygon), []
    corners = points[polygon]
    normal = np.cross(corners, np.roll(corners, -1, 0)).sum(0)
    while len(rest) > 3:
        for i in range(len(rest)):
            a, b, c = points[[rest[i - 1], rest[i], rest[(i + 1) % len(rest)]]]
            others = points[[v for v in rest if not any((points[v] == q).all() for q in (a, b, c))]]
            inside = np.ones(len(others), bool)
            for q, r in ((a, b), (b, c), (c, a)):
                inside &= np.cross(r - q, others - q) @ normal >= 0
            if np.cross(b - a, c - b) @ normal > 0 and not inside.any():
                triangles.append((rest[i - 1], rest[i], rest[(i + 1) % len(rest)]))
                del rest[i]
                break
        else:
            return triangles + fans([rest])
    return [*triangles, tuple(rest)]


def read_obj(path: Path) -> np.ndarray:
    points, polygons = [], []
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            numbers = [int(x.split("/")[0]) for x in words[1:]]
            polygons.append([n - 1 if n > 0 else len(points) + n for n in numbers])
    corners = np.array(points)
    return corners[np.array([t for polygon in polygons for t in clipped(polygon, corners)], int)]


def read_off(path: Path) -> np.ndarray:
    words = " ".join(line.split("#")[0] for line in path.read_text().splitlines()).split()
    assert words[0] == "OFF", path
    points, facets = int(words[1]), int(words[2])
    at = 4 + 3 * points
    corners = np.array(words[4:at], float).reshape(-1, 3)
    lines = [line.split() for line in path.read_text().splitlines()[-facets:]]
    return corners[np.array(fans([[int(x) for x in w[1:int(w[0]) + 1]] for w in lines]), int)]


def read_ply(path: Path) -> np.ndarray:
    import meshio   # reads binary and textual files, and many types of numbers
    mesh = meshio.read(path)
    polygons = [list(row) for block in mesh.cells if block.type in ("triangle", "quad", "polygon")
                for row in block.data]
    return np.asarray(mesh.points, float)[np.array(fans(polygons), int)]


readers = {".stl": read_stl, ".obj": read_obj, ".off": read_off, ".ply": read_ply}
cad = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")


def areas(triangles: np.ndarray) -> np.ndarray:
    edges = triangles[:, 1:] - triangles[:, :1]
    return 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)


def volume(triangles: np.ndarray) -> float:
    moved = triangles - triangles.mean((0, 1))
    return float(np.einsum("ij,ij->", moved[:, 0], np.cross(moved[:, 1], moved[:, 2])) / 6)


def samples_of(triangles: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Returns `count` random points, evenly distributed over the area, and the centres of up to `count` triangles."""
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
    """Returns the distances of points from triangles, row by row: of p[i] from t[i]."""
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
    """Computes distances of points from triangles. The triangles whose centres are nearest to a point give an upper
    bound of its distance; then all triangles that may be nearer than this bound are measured."""

    def __init__(self, triangles: np.ndarray, diagonal: float):
        self.triangles = self.divided(triangles, diagonal / 50)
        self.centres = self.triangles.mean(1)
        self.radius = float(np.linalg.norm(self.triangles - self.centres[:, None], axis=2).max())
        self.tree = cKDTree(self.centres)

    @staticmethod
    def divided(triangles: np.ndarray, longest: float) -> np.ndarray:
        """Halves triangles at their longest side until no side is longer than `longest`."""
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

    def bounds(self, points: np.ndarray) -> np.ndarray:
        near = self.tree.query(points, min(8, len(self.triangles)))[1].reshape(len(points), -1)
        return np.min([to_triangles(points, self.triangles[column]) for column in near.T], axis=0)

    def distance(self, point: np.ndarray, bound: float) -> float:
        near = self.triangles[self.tree.query_ball_point(point, bound + self.radius)]
        return min(bound, to_triangles(np.repeat(point[None], len(near), 0), near).min()) if len(near) else bound

    def farthest(self, points: np.ndarray, does_not_count: Callable[[np.ndarray], bool]) -> float:
        """Returns the largest distance, from the triangles, of a point that counts. Measures points with large upper
        bounds first, so that most of the others need not be measured."""
        bounds = self.bounds(points)
        most = 0.0
        for k in np.argsort(-bounds):
            if bounds[k] <= most:
                break
            distance = self.distance(points[k], bounds[k])
            if distance > most and not does_not_count(points[k]):
                most = distance
        return most


def winding_numbers(triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Returns winding numbers by the formula of A. Van Oosterom and J. Strackee, 1983. Separate arrays of x, y and z
    are faster than arrays of vectors."""
    corners = np.ascontiguousarray(triangles.transpose(1, 2, 0))
    result = np.empty(len(points))
    for i, p in enumerate(points):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners - p[None, :, None]
        la, lb, lc = (np.sqrt(x * x + y * y + z * z) for x, y, z in ((ax, ay, az), (bx, by, bz), (cx, cy, cz)))
        above = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        below = (la * lb * lc + (ax * bx + ay * by + az * bz) * lc + (bx * cx + by * cy + bz * cz) * la +
                 (cx * ax + cy * ay + cz * az) * lb)
        result[i] = np.arctan2(above, below).sum() / (2 * math.pi)
    return result


@dataclass
class Given:
    triangles: np.ndarray
    solids: list[float] | None   # volumes of the solids of CAD files, by OpenCASCADE


def read_given(path: Path, folder: Path) -> Given:
    if path.suffix.lower() not in cad:
        triangles = readers[path.suffix.lower()](path)
        return Given(triangles[areas(triangles) > 0], None)
    file = folder / "given.npz"
    subprocess.run(["/usr/bin/python3", "-c", tessellate, str(path), str(file)], check=True, capture_output=True,
                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (60, 65)))
    read = np.load(file)
    triangles = read["triangles"]
    return Given(triangles[areas(triangles) > 0], read["volumes"].tolist())


def closed_parts(triangles: np.ndarray, diagonal: float) -> list[np.ndarray]:
    """Returns the closed ones of the parts that are connected by edges: each edge belongs to an even number of
    triangles. Points within about 1e-7 of the diagonal count as one."""
    points = np.unique(np.round(triangles.reshape(-1, 3) / (1e-7 * diagonal)
                                ).astype(np.int64), axis=0, return_inverse=True)[1]
    corners = points.reshape(-1, 3)
    sides = np.sort(np.stack([corners, np.roll(corners, -1, 1)], 2).reshape(-1, 2), 1)
    kinds, edge, uses = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    edge = edge.reshape(-1)
    owner = np.repeat(np.arange(len(triangles)), 3)
    graph = coo_matrix((np.ones(len(edge)), (owner, len(triangles) + edge)), shape=[len(triangles) + len(kinds)] * 2)
    label = connected_components(graph, directed=False)[1][:len(triangles)]
    open_parts = np.unique(label[owner[(uses[edge] % 2 == 1) & (kinds[edge, 0] != kinds[edge, 1])]])
    return [triangles[label == k] for k in np.setdiff1d(np.unique(label), open_parts)]


def place_inside(part: np.ndarray) -> np.ndarray | None:
    """Starts at the centre of the part's largest triangle and returns the point halfway inwards to the opposite side,
    or None if there is no opposite side."""
    largest = part[areas(part).argmax()]
    normal = np.cross(largest[1] - largest[0], largest[2] - largest[0])
    way = -normal / np.linalg.norm(normal) * (1 if volume(part) > 0 else -1)
    start = largest.mean(0)
    a, b, c = part[:, 0], part[:, 1], part[:, 2]
    beside = np.cross(way, c - a)
    determinant = np.einsum("ij,ij->i", b - a, beside)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = np.einsum("ij,ij->i", start - a, beside) / determinant
        across = np.cross(start - a, b - a)
        v = across @ way / determinant
        at = np.einsum("ij,ij->i", c - a, across) / determinant
        met = at[(u >= -1e-12) & (v >= -1e-12) & (u + v <= 1 + 1e-12) & (at > 1e-12)]
    return start + way * met.min() / 2 if len(met) else None


def changed_bodies(given: np.ndarray, repaired: np.ndarray, diagonal: float) -> tuple[int, list[np.ndarray]]:
    """Returns the number of closed parts and, for each changed one of the first 500, a point that shows the change."""
    parts = closed_parts(given, diagonal)
    places = [p for p in (place_inside(part) for part in parts[:500]) if p is not None]
    if not places:
        return len(parts), []
    before = np.abs(winding_numbers(given, np.array(places))) > 0.5
    after = np.abs(winding_numbers(repaired, np.array(places))) > 0.5
    return len(parts), [p for p, was, now in zip(places, before, after) if was != now]


@dataclass
class Row:
    file: str
    of_repaired: float   # largest distance of the result from the input, relative to the diagonal
    of_input: float      # the reverse
    told: float
    volume: float
    of_input_volume: float
    error: float         # standard deviation of of_input_volume; 0: exact
    differs: float       # share of the input's volume
    bodies: int
    changed: list[np.ndarray]
    bodies_after: int
    solids: int | None
    regions: int
    messages: list[str]

    def cells(self) -> list[str]:
        return [self.file, f"{self.of_repaired:.1e}", f"{self.of_input:.1e}", f"{self.told:.1e}", f"{self.volume:.5g}",
                f"{self.of_input_volume:.5g}" +
                (f" +- {self.error:.2g}" if self.error else ""), f"{100 * self.differs:.2f}%",
                str(self.bodies), str(len(self.changed)), str(self.bodies_after),
                "" if self.solids is None else str(self.solids), str(self.regions)]

    @property
    def silent(self) -> bool:
        """Returns whether a distance exceeds the reported one by more than the errors of this comparison, such as
        those of the tessellation of a CAD file."""
        own = 5e-4 if self.solids is not None else 2e-6
        of_repaired = 0.0 if any(
            "filled" in message for message in self.messages) else self.of_repaired   # holes: none reported
        return max(of_repaired, self.of_input) > 1.05 * self.told + own


class NotRepaired(Exception):
    pass


def repair(path: Path, folder: Path, options: argparse.Namespace) -> tuple[np.ndarray, dict]:
    out, report = folder / "repaired.off", folder / "report.json"
    limit = options.limit
    run = subprocess.run([options.program, "repair", str(path), "-o", str(out), "--report", str(report),
                          *shlex.split(options.options)], capture_output=True, text=True, check=False,
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)))
    if run.returncode != 0:
        told = " ".join(run.stderr.split()) or f"not done in {limit} s"
        raise NotRepaired(f"exit code {run.returncode}: {told}")
    return read_off(out), json.loads(report.read_text())


def input_volume(given: Given, repaired: np.ndarray, count: int,
                 random: np.random.Generator) -> tuple[float, float, float]:
    """Returns the input's volume, the standard deviation of this estimate (0: exact), and the volume in which input
    and result differ, relative to the input's volume."""
    corners = given.triangles.reshape(-1, 3)
    low, high = corners.min(0), corners.max(0)
    most = max(len(given.triangles), len(repaired))
    places = random.uniform(low, high, (max(200, min(count, 20_000_000 // most)), 3))
    before = np.abs(winding_numbers(given.triangles, places)) > 0.5
    after = np.abs(winding_numbers(repaired, places)) > 0.5
    share, box = before.mean(), float(np.prod(high - low))
    differs = (before != after).mean() / max(share, 1 / len(places))
    if given.solids:
        return sum(given.solids), 0.0, differs
    return share * box, box * math.sqrt(share * (1 - share) / len(places)), differs


def compare(path: Path, options: argparse.Namespace) -> Row:
    with tempfile.TemporaryDirectory() as name:
        repaired, report = repair(path, Path(name), options)
        given = read_given(path, Path(name))
    count, random = options.samples, np.random.default_rng(1)
    diagonal = float(np.linalg.norm(np.ptp(given.triangles.reshape(-1, 3), 0)))

    def is_inside(point: np.ndarray) -> bool:
        return abs(winding_numbers(repaired, point[None])[0]) > 0.75

    of_repaired = Nearest(given.triangles, diagonal).farthest(samples_of(repaired, count, random), lambda _: False)
    of_given = Nearest(repaired, diagonal).farthest(samples_of(given.triangles, count, random), is_inside)
    bodies, changed = changed_bodies(given.triangles, repaired, diagonal)
    told, regions = report["repair"], report["complex"]["regions"]
    enclosed = volume(repaired) if len(regions) == 1 else sum(
        r["volume"] for r in regions)   # .off has interfaces of regions only once
    return Row(path.name, of_repaired / diagonal, of_given / diagonal,
               max(told["largest_distance"], told["largest_distance_of_input"]) / diagonal, abs(enclosed),
               *input_volume(given, repaired, count, random), bodies, changed, len(closed_parts(repaired, diagonal)),
               None if given.solids is None else len(given.solids), len(regions), told["messages"])


def print_doubts(rows: list[Row]) -> None:
    """Prints the results that a person should look at: distances larger than reported, changed bodies, volumes that
    differ."""
    for row in rows:
        doubts = ["farther off than told"] if row.silent else []
        if row.changed:
            doubts.append(f"{len(row.changed)} bodies or voids changed, at " +
                          "; ".join("(" + ", ".join(f"{x:.6g}" for x in p) + ")" for p in row.changed[:3]))
        if row.differs > (0.01 if row.solids is None else 0.03):
            doubts.append(f"differs in {100 * row.differs:.1f}% of the volume")
        if doubts:
            print(f"\n{row.file}: {'; '.join(doubts)}")
            for message in row.messages:
                print(f"  {message}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--program", default="collarmesh")
    parser.add_argument("--options", default="", help="for the program")
    parser.add_argument("--limit", type=int, default=30, help="CPU seconds for one repair")
    parser.add_argument("--samples", type=int, default=20000)
    options = parser.parse_args()
    rows = []
    for path in options.files:
        if path.suffix.lower() not in (*readers, *cad):
            continue
        try:
            rows.append(compare(path, options))
            print(" ".join(rows[-1].cells()), file=sys.stderr, flush=True)
        except (NotRepaired, subprocess.CalledProcessError) as failure:
            print(f"{path.name}: {failure}", file=sys.stderr, flush=True)
    rows.sort(key=lambda row: -max(row.of_repaired, row.of_input))
    print(table(["file", "repaired from input", "input from repaired", "told", "volume", "of the input", "differs",
                 "bodies", "changed", "after", "solids", "regions"], [row.cells() for row in rows]))
    print_doubts(rows)


if __name__ == "__main__":
    main()
