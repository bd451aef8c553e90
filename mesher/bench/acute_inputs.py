"""Shapes of the tests' acute families, as input files for each mesher. The program acute_shape generates the
shapes."""

from __future__ import annotations

import subprocess
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from inputs import Corner, classified

Loop = tuple[int, ...]   # corners; a loop of one corner is a point, a loop of two is a segment inside the facet


@dataclass
class Part:
    """The content of a .poly file. Facets are lists of polygons; the first polygon has at least three corners,
    unless the facet is a lone segment."""
    points: list[Corner]
    facets: list[list[Loop]]


@dataclass
class AcuteInput:
    """An input that the program acute_shape writes. `family` and `parameters` are arguments of this program;
    `copies` is the number of copies in a grid (0: the shape alone)."""
    program: Path
    family: str
    parameters: tuple[float, ...]
    copies: int = 0
    feature_angle: float = 0
    suffix = ".poly"
    volume = diagonal = 1.0   # approximate; gives a first guess of the size for a wanted number of tets
    parts: list[Part] = field(default_factory=list)
    small_copy: float = 0   # scale of a smaller copy beside the shape, 0: none; polylines only

    @property
    def name(self) -> str:
        return f"{self.family} {' '.join(f'{p:g}' for p in self.parameters)}".strip()

    @property
    def polygons(self) -> list[list[Loop]]:
        """Returns the facets of all parts; each facet is a list of polygons. Call it after write()."""
        return [facet for part in self.parts for facet in part.facets]

    @property
    def files(self) -> list[str]:
        """Returns the names of the files, one for each solid. Call it after write("input")."""
        return [f"input_{k + 1}.poly" for k in range(len(self.parts))]

    def write(self, path_without_suffix: Path) -> None:
        """Writes one file for each solid, and one file with all of them."""
        self._generate(path_without_suffix)
        merged = merge(self.parts)
        with open(path_without_suffix.with_suffix(".poly"), "w") as out:
            out.write(f"{len(merged.points)} 3 0 0\n")
            out.writelines("%d %.17g %.17g %.17g\n" % (k, *p) for k, p in enumerate(merged.points))
            out.write(f"{len(merged.facets)} 0\n")
            for facet in merged.facets:
                out.write(f"{len(facet)} 0\n" + "".join(f"{len(q)} {' '.join(map(str, q))}\n" for q in facet))
            out.write("0\n0\n")

    def write_geo(self, path: Path) -> None:
        """Writes a file for Gmsh. Curved shapes are written as triangles that Gmsh divides into patches; other
        shapes as points, lines, plane surfaces and volumes."""
        self._generate(path.with_suffix(""))
        if self.feature_angle > 0:
            write_stl(self.parts[0], path.with_suffix(".stl"))
            path.write_text(classified(path.with_suffix(".stl").name))
        else:
            path.write_text(GeoModel(self.parts).text())

    def _generate(self, path_without_suffix: Path) -> None:
        for old in path_without_suffix.parent.glob(f"{path_without_suffix.name}_*.poly"):
            old.unlink()
        command = [str(self.program), str(path_without_suffix), self.family, *(f"{p:.17g}" for p in self.parameters)]
        command += ["--copies", str(self.copies)] if self.copies else []
        command += ["--small-copy", f"{self.small_copy:.17g}"] if self.small_copy else []
        subprocess.run(command, check=True)
        count = len(list(path_without_suffix.parent.glob(f"{path_without_suffix.name}_*.poly")))
        self.parts = [read_part(path_without_suffix.parent / f"{path_without_suffix.name}_{k + 1}.poly")
                      for k in range(count)] if self.copies == 0 else [Part([], [])] * count


def read_part(path: Path) -> Part:
    lines = iter(path.read_text().splitlines())
    points = []
    for _ in range(int(next(lines).split()[0])):
        x, y, z = map(float, next(lines).split()[1:4])
        points.append((x, y, z))
    facets = []
    for _ in range(int(next(lines).split()[0])):
        polygons = int(next(lines).split()[0])
        facets.append([tuple(map(int, next(lines).split()[1:])) for _ in range(polygons)])
    return Part(points, facets)


def merge(parts: list[Part]) -> Part:
    """Returns all parts as one. Points at the same place become one point, facets with the same corners one facet."""
    numbers: dict[Corner, int] = {}
    facets: dict[frozenset, list[Loop]] = {}
    for part in parts:
        place = [numbers.setdefault(p, len(numbers)) for p in part.points]
        for facet in part.facets:
            moved = [tuple(place[v] for v in loop) for loop in facet]
            facets.setdefault(frozenset(v for loop in moved for v in loop), moved)
    return Part(list(numbers), list(facets.values()))


def write_stl(part: Part, path: Path) -> None:
    with open(path, "w") as out:
        out.write("solid surface\n")
        for facet in part.facets:
            loop = facet[0]
            for k in range(1, len(loop) - 1):
                out.write("facet normal 0 0 0\nouter loop\n")
                out.writelines("vertex %.17g %.17g %.17g\n" % part.points[v] for v in (loop[0], loop[k], loop[k + 1]))
                out.write("endloop\nendfacet\n")
        out.write("endsolid surface\n")


class GeoModel:
    """A model of some solids in Gmsh's built-in geometry. Facets with a free border and lone segments are embedded in
    volumes; points and segments in facets are embedded in surfaces. Numbers start at 1."""

    def __init__(self, parts: list[Part]):
        self.lines: dict[frozenset, int] = {}
        self.surfaces: dict[frozenset, int] = {}
        self.numbers: dict[Corner, int] = {}
        self.commands: list[str] = []
        for part in parts:
            self._add(part)

    def text(self) -> str:
        return "\n".join(self.commands) + "\n"

    def _add(self, part: Part) -> None:
        place = [self._point(p) for p in part.points]
        facets = [[tuple(place[v] for v in loop) for loop in facet] for facet in part.facets]
        shell = closed_part(facets)
        inside = [facet for facet in facets if facet not in shell]
        loop = ", ".join(str(self._surface(facet)) for facet in shell)
        volume = 1 + sum(command.startswith("Volume") for command in self.commands)
        self.commands += [f"Surface Loop({volume}) = {{{loop}}};", f"Volume({volume}) = {{{volume}}};"]
        for facet in inside:
            if len(facet[0]) == 2:
                self.commands.append(f"Curve{{{abs(self._line(*facet[0]))}}} In Volume{{{volume}}};")
            else:
                self.commands.append(f"Surface{{{self._surface(facet)}}} In Volume{{{volume}}};")

    def _point(self, p: Corner) -> int:
        if p not in self.numbers:
            self.numbers[p] = len(self.numbers) + 1
            self.commands.append("Point(%d) = {%.17g, %.17g, %.17g};" % (self.numbers[p], *p))
        return self.numbers[p]

    def _line(self, a: int, b: int) -> int:
        """Returns the number of the line between a and b, with a minus sign if the line goes from b to a. Every
        line begins at the point with the lower number."""
        key = frozenset((a, b))
        if key not in self.lines:
            self.lines[key] = len(self.lines) + 1
            self.commands.append(f"Line({self.lines[key]}) = {{{min(a, b)}, {max(a, b)}}};")
        return self.lines[key] if a < b else -self.lines[key]

    def _surface(self, facet: list[Loop]) -> int:
        key = frozenset(facet[0])
        if key in self.surfaces:
            return self.surfaces[key]
        number = self.surfaces[key] = len(self.surfaces) + 1
        lines = ", ".join(str(self._line(a, b)) for a, b in edges(facet[0]))
        self.commands += [f"Curve Loop({number}) = {{{lines}}};", f"Plane Surface({number}) = {{{number}}};"]
        for mark in facet[1:]:
            embedded = f"Point{{{mark[0]}}}" if len(mark) == 1 else f"Curve{{{abs(self._line(*mark))}}}"
            self.commands.append(f"{embedded} In Surface{{{number}}};")
        return number


def edges(loop: Loop) -> list[Loop]:
    return list(zip(loop, loop[1:] + loop[:1]))


def closed_part(facets: list[list[Loop]]) -> list[list[Loop]]:
    """Returns the facets that are left after removing lone segments and, repeatedly, all facets with a free border."""
    shell = [facet for facet in facets if len(facet[0]) > 2]
    while True:
        uses = Counter(frozenset(edge) for facet in shell for edge in edges(facet[0]))
        kept = [facet for facet in shell if all(uses[frozenset(edge)] > 1 for edge in edges(facet[0]))]
        if len(kept) == len(shell):
            return shell
        shell = kept
