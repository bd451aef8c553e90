"""Inputs of the benchmarks: surfaces that are read from files or generated, and written in each mesher's format."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field
from pathlib import Path

Corner = tuple[float, float, float]


@dataclass
class Surface:
    """A surface of polygons over points. Loose points are points that no polygon uses."""
    name: str
    points: list[Corner]
    polygons: list[list[int]] = field(default_factory=list)
    feature_angle = 30   # degrees, collarmesh's default

    @property
    def files(self) -> list[str]:
        """Returns the name of the file that write("input") makes."""
        return [f"input{self.suffix}"]

    @property
    def diagonal(self) -> float:
        return math.dist([min(p[a] for p in self.points) for a in range(3)],
                         [max(p[a] for p in self.points) for a in range(3)])

    def triangles(self):
        for polygon in self.polygons:
            for k in range(1, len(polygon) - 1):
                yield polygon[0], polygon[k], polygon[k + 1]

    @property
    def volume(self) -> float:
        """Returns the volume inside the surface. Precondition: it is closed and all polygons are oriented alike."""
        total = 0.0
        for a, b, c in self.triangles():
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = self.points[a], self.points[b], self.points[c]
            total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        return abs(total) / 6

    @property
    def suffix(self) -> str:
        """Returns the extension of the format to write: .poly if there are loose points, otherwise .off."""
        return ".off" if len({v for q in self.polygons for v in q}) == len(self.points) else ".poly"

    def write(self, path_without_suffix: Path) -> None:
        path = path_without_suffix.with_suffix(self.suffix)
        if self.suffix == ".off":
            self.write_off(path)
        else:
            self.write_poly(path)

    def write_off(self, path: Path) -> None:
        with open(path, "w") as out:
            out.write(f"OFF\n{len(self.points)} {len(self.polygons)} 0\n")
            out.writelines("%.17g %.17g %.17g\n" % p for p in self.points)
            out.writelines(f"{len(q)} {' '.join(map(str, q))}\n" for q in self.polygons)

    def write_stl(self, path: Path) -> None:
        with open(path, "w") as out:
            out.write("solid surface\n")
            for triangle in self.triangles():
                out.write("facet normal 0 0 0\nouter loop\n")
                out.writelines("vertex %.17g %.17g %.17g\n" % self.points[v] for v in triangle)
                out.write("endloop\nendfacet\n")
            out.write("endsolid surface\n")

    def write_geo(self, path: Path) -> None:
        """Writes a .geo file for Gmsh: the box as a solid, other inputs as triangles that Gmsh divides into patches."""
        if self.name == "box":
            path.write_text('SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 1, 1, 1};\n')
            return
        self.write_stl(path.with_suffix(".stl"))
        path.write_text(classified(path.with_suffix(".stl").name))

    def write_poly(self, path: Path) -> None:
        with open(path, "w") as out:
            out.write(f"{len(self.points)} 3 0 0\n")
            out.writelines("%d %.17g %.17g %.17g\n" % (k, *p) for k, p in enumerate(self.points))
            out.write(f"{len(self.polygons)} 0\n")
            out.writelines(f"1\n{len(q)} {' '.join(map(str, q))}\n" for q in self.polygons)
            out.write("0\n0\n")


def classified(stl: str) -> str:
    """Returns the text of a Gmsh model of the solid inside a triangulated surface. Patches end where neighbouring
    triangles are at more than 30 degrees to each other."""
    return (f'Merge "{stl}";\nClassifySurfaces{{30*Pi/180, 1, 1, Pi}};\nCreateGeometry;\n'
            "Surface Loop(1) = Surface{:};\nVolume(1) = {1};\n")


def read_surface(path: Path) -> Surface:
    """Reads .off, .obj and binary .stl, as far as the corpus needs them."""
    readers = {".off": _read_off, ".obj": _read_obj, ".stl": _read_stl}
    if path.suffix.lower() not in readers:
        raise ValueError(f"{path}: not one of {' '.join(readers)}")
    return readers[path.suffix.lower()](path)


def _read_off(path: Path) -> Surface:
    words = [w for line in path.read_text().splitlines() for w in line.split("#")[0].split()]
    if words[0] != "OFF":
        raise ValueError(f"{path}: does not begin with OFF")
    point_count, polygon_count = int(words[1]), int(words[2])
    at = 4
    points = [tuple(map(float, words[at + 3 * k:at + 3 * k + 3])) for k in range(point_count)]
    at += 3 * point_count
    polygons = []
    for _ in range(polygon_count):
        corners = int(words[at])
        polygons.append([int(w) for w in words[at + 1:at + 1 + corners]])
        at += 1 + corners
    return Surface(path.stem, points, polygons)


def _read_obj(path: Path) -> Surface:
    points, polygons = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            polygons.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return Surface(path.stem, points, polygons)


def _read_stl(path: Path) -> Surface:
    numbers: dict[Corner, int] = {}
    polygons = []
    for record in struct.iter_unpack("<3f9fH", path.read_bytes()[84:]):
        polygons.append([numbers.setdefault(record[k:k + 3], len(numbers)) for k in (3, 6, 9)])
    return Surface(path.stem, list(numbers), polygons)


def box() -> Surface:
    """Returns the unit cube."""
    points = [(float(k & 1), float(k >> 1 & 1), float(k >> 2)) for k in range(8)]
    polygons = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return Surface("box", points, polygons)


def skew_lines(points_per_line: int) -> Surface:
    """Returns the unit cube with loose points, evenly spaced, on two skew lines inside it. Every point of
    one line is a Delaunay neighbour of every point of the other line, so with n points per line there are
    about n^2 tetrahedra before refinement."""
    surface = box()
    surface.name = f"skew_lines_{points_per_line}"
    for k in range(points_per_line):
        t = 0.2 + 0.6 * (k + 0.5) / points_per_line
        surface.points.append((t, 0.5, 0.35))
    for k in range(points_per_line):
        t = 0.2 + 0.6 * (k + 0.5) / points_per_line
        surface.points.append((0.5, t, 0.65))
    return surface


def sphere(frequency: int) -> Surface:
    """Returns the unit sphere as 20 frequency^2 triangles: cuts an icosahedron's faces evenly, and pushes the corners
    outwards onto the sphere."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(s * 1.0, t * g, 0.0) for s in (-1, 1) for t in (-1, 1)]
    corners = [c[a:] + c[:a] for a in range(3) for c in corners]
    near = [[k for k in range(12) if abs(math.dist(corners[i], corners[k]) - 2) < 1e-9] for i in range(12)]
    faces = [(i, j, k) for i in range(12) for j in near[i] for k in near[i]
             if i < j and i < k and k in near[j] and _turns_left(corners[i], corners[j], corners[k])]
    surface = Surface(f"sphere_{20 * frequency ** 2}", [])
    numbers: dict[tuple, int] = {}

    def point(weights: dict[int, int]) -> int:
        key = tuple(sorted((c, w) for c, w in weights.items() if w > 0))
        if key not in numbers:
            p = [sum(w * corners[c][a] for c, w in key) for a in range(3)]
            length = math.hypot(*p)
            numbers[key] = len(surface.points)
            surface.points.append((p[0] / length, p[1] / length, p[2] / length))
        return numbers[key]

    for a, b, c in faces:
        def at(u: int, v: int) -> int:
            return point({a: frequency - u - v, b: u, c: v})
        for u in range(frequency):
            for v in range(frequency - u):
                surface.polygons.append([at(u, v), at(u + 1, v), at(u, v + 1)])
                if u + v < frequency - 1:
                    surface.polygons.append([at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)])
    return surface


def _turns_left(a: Corner, b: Corner, c: Corner) -> bool:
    """Returns whether abc is counterclockwise as seen from outside a body around the origin."""
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])) > 0
