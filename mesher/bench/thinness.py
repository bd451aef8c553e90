#!/usr/bin/env python3
"""Measures how the cost of meshing grows as one feature of a body gets thinner, and whether volumes are kept.

thinness.py [--families wedge step ...] [--thinness 1e-1 1e-2 ...] [--program collarmesh] [--limit 60]
            [--options '--order 2']

Each body is about 10 target edge lengths wide. --thinness gives the thickness of its feature, in target edge
lengths. The table has a row for each family and a column for each thickness. Its entries are the vertices that
refinement inserted (in the last try), the tets and the CPU seconds of the whole run; then the exit code unless
it is 0, and the number of regions if it is wrong. The number of vertices grows with a power of 1 / thickness.
Two columns give the largest exponent of this growth between neighbouring thicknesses: "power to S" for
thicknesses down to the feature size S (--feature-size), "below" for smaller ones. "volumes off" is the largest
relative error of a region's volume in runs with exit code 0; if a region is missing, it is the error of the total
volume. --out gets each row as soon as it is measured."""

from __future__ import annotations

import argparse
import contextlib
import csv
import json
import math
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from inputs import Surface
from known_volumes import make_step
from processes import run_limited
from tables import machine, seconds, si, table

size = 1.0
wide = 10.0   # width of every block, in y
memory = 12 << 30


@dataclass
class Body:
    """A body with the exact volumes of its regions. It is given by closed surfaces, a complex, or solids of a CAD file
    (expressions for FreeCAD)."""
    volumes: list[float]
    shells: list[Surface] = field(default_factory=list)
    complex: Surface | None = None
    step: str = ""

    def write(self, folder: Path) -> Path:
        if self.step:
            file = folder / "input.step"
            subprocess.run(["/usr/bin/python3", "-c", make_step], input=f"{file} {self.step}", text=True, check=True,
                           stdout=subprocess.DEVNULL)
            return file
        if self.complex:
            self.complex.write_poly(folder / "input.poly")
            return folder / "input.poly"
        points, polygons = [], []
        for shell in self.shells:
            polygons += [[len(points) + v for v in q] for q in shell.polygons]
            points += shell.points
        Surface("input", points, polygons).write_off(folder / "input.off")
        return folder / "input.off"


def extruded(outline: list[tuple[float, float]]) -> Surface:
    """Returns the prism over a polygon in the plane of x and z, extruded along y. Precondition: the polygon is oriented
    from the x axis towards the z axis."""
    n = len(outline)
    points = [(x, y, z) for y in (0.0, wide) for x, z in outline]
    sides = [[k, n + k, n + (k + 1) % n, (k + 1) % n] for k in range(n)]
    return Surface("extruded", points, [*sides, list(range(n)), list(range(n, 2 * n))[::-1]])


def area(outline: list[tuple[float, float]]) -> float:
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(outline, outline[1:] + outline[:1])) / 2


def profile(*outline: tuple[float, float]) -> Body:
    return Body([wide * area(list(outline))], [extruded(list(outline))])


def wedge(h: float) -> Body:
    """Returns a block with a fin that is h thick at its root and tapers to an edge."""
    return profile((0, 0), (10, 0), (10, 3), (16, 3), (10, 3 + h), (10, 6), (0, 6))


def notch(h: float) -> Body:
    """Returns a block with a slit that is h wide at its mouth and tapers to an edge inside."""
    return profile((0, 0), (10, 0), (10, 3), (4, 3), (10, 3 + h), (10, 6), (0, 6))


def step(h: float) -> Body:
    """Returns a block whose upper face has two halves that differ in height by h."""
    return profile((0, 0), (10, 0), (10, 6), (5, 6), (5, 6 + h), (0, 6 + h))


def fin(h: float) -> Body:
    """Returns a block with a wall that is h thick everywhere."""
    return profile((0, 0), (10, 0), (10, 3), (16, 3), (16, 3 + h), (10, 3 + h), (10, 6), (0, 6))


def slit(h: float) -> Body:
    """Returns a block with a cut that is h wide everywhere."""
    return profile((0, 0), (10, 0), (10, 3), (4, 3), (4, 3 + h), (10, 3 + h), (10, 6), (0, 6))


def sliver_face(h: float) -> Body:
    """Returns a block with an edge that is cut off by a face of width h."""
    c = h / math.sqrt(2)
    return profile((0, 0), (10, 0), (10, 6 - c), (10 - c, 6), (0, 6))


def fold(h: float) -> Body:
    """Returns a block whose upper face is folded like a Z; the folds are about h high."""
    return profile((0, 0), (10, 0), (10, 6), (4, 6), (6, 6 + h), (0, 6 + 2 * h))


def flake(h: float) -> Body:
    """Returns a block and, beside it, a tetrahedron of height h as a second body."""
    block = profile((0, 0), (10, 0), (10, 6), (0, 6))
    corners = [(10.5, 4.0, 2.0), (10.5, 6.0, 2.0), (10.5, 5.0, 4.0), (10.5 + h, 5.0, 2.7)]
    block.shells.append(Surface("flake", corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    return Body([block.volumes[0], 2 * h / 3], block.shells)


def blocks_apart(h: float) -> Body:
    """Returns two blocks, one above the other, with a gap of width h."""
    low, high = profile((0, 0), (10, 0), (10, 3), (0, 3)), profile((0, 3 + h), (10, 3 + h), (10, 6), (0, 6))
    return Body(low.volumes + high.volumes, low.shells + high.shells)


def layer(h: float) -> Body:
    """Returns a block that two parallel sheets divide into three regions; the middle one is h thick."""
    heights = [0.0, 3.0, 3.0 + h, 6.0]
    points = [(x, y, z) for z in heights for x, y in ((0.0, 0.0), (wide, 0.0), (wide, wide), (0.0, wide))]
    polygons = [[4 * k + c for c in range(4)] for k in range(4)]
    polygons += [[4 * k + c, 4 * k + (c + 1) % 4, 4 * k + 4 + (c + 1) % 4, 4 * k + 4 + c]
                 for k in range(3) for c in range(4)]
    return Body([wide * wide * (b - a) for a, b in zip(heights, heights[1:])],
                complex=Surface("layer", points, polygons))


def cylinders(h: float) -> Body:
    """Returns two prisms of 96 sides that face each other with an edge, with a gap of width h."""
    angles = [2 * math.pi * k / 96 for k in range(96)]
    outline = [(3 * math.cos(a), 3 * math.sin(a)) for a in angles]
    bodies = [profile(*((x + at, z) for x, z in outline)) for at in (-3 - h / 2, 3 + h / 2)]
    return Body(bodies[0].volumes + bodies[1].volumes, bodies[0].shells + bodies[1].shells)


def cad_cylinders(h: float) -> Body:
    """Returns two round cylinders side by side, as a STEP file, with a gap of width h."""
    return Body(2 * [math.pi * 9 * wide],
                step=f"[cylinder(3, {wide}, 0, {3 + h / 2}), cylinder(3, {wide}, 0, {-3 - h / 2})]")


families: dict[str, Callable[[float], Body]] = {
    "wedge": wedge, "notch": notch, "step": step, "fin": fin, "slit": slit, "flake": flake,
    "blocks apart": blocks_apart, "layer": layer, "cylinders": cylinders, "cylinders (STEP)": cad_cylinders,
    "sliver face": sliver_face, "fold": fold}


@dataclass
class Row:
    family: str
    thinness: float
    exit_code: int
    cpu: float
    vertices: int = 0
    tets: int = 0
    made: int = 0      # regions of the mesh
    regions: int = 0   # regions of the body
    off: float = math.nan
    said: str = ""

    def cell(self) -> str:
        if not self.tets:
            return f"{seconds(self.cpu)} s, exit code {self.exit_code}"
        return (f"{si(self.vertices)}, {si(self.tets)}, {seconds(self.cpu)} s" +
                (f", exit code {self.exit_code}" if self.exit_code else "") +
                ("" if self.made == self.regions else f", {self.made} of {self.regions} regions"))


def difference(made: list[float], exact: list[float]) -> float:
    """Returns the largest relative error of a region's volume; if the numbers of regions differ, the relative error of
    the total volume. Compares sorted volumes, because the mesher numbers regions in its own order."""
    if len(made) != len(exact):
        return abs(sum(made) / sum(exact) - 1)
    return max(abs(a / b - 1) for a, b in zip(sorted(made), sorted(exact)))


def measure(family: str, thinness: float, options: argparse.Namespace) -> Row:
    body = families[family](thinness * size)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        given = body.write(folder)
        done = run_limited([str(options.program.resolve()), given.name, "-o", "mesh.vtu", "--size", f"{size:g}",
                            "--report", "report.json", "--progress", "none", "--threads", "1",
                            *shlex.split(options.options)], folder, options.limit, memory)
        row = Row(family, thinness, done.exit_code, done.cpu)
        lines = [line for line in done.output.splitlines() if not line.startswith(("repaired:", "  "))]
        row.said = lines[0] if done.exit_code and lines else ""
        with contextlib.suppress(FileNotFoundError, KeyError, TypeError, AttributeError):   # a failed run reports less
            report = json.loads((folder / "report.json").read_text())
            row.vertices = report["statistics"]["vertices_inserted"]
            row.tets = report["mesh"]["tets"]
            made = list(report["mesh"]["region_volumes"].values())
            row.made, row.regions, row.off = len(made), len(body.volumes), difference(made, body.volumes)
        return row


def steepest(rows: list[Row]) -> str:
    powers = [math.log(b.vertices / a.vertices) / math.log(a.thinness / b.thinness) for a, b in zip(rows, rows[1:])
              if a.vertices and b.vertices]  # 0: failed or nothing inserted
    return f"{max(max(powers), 0):.1f}" if powers else ""


def print_table(rows: list[Row], thinness: list[float], share: float) -> None:
    lines = []
    for family in dict.fromkeys(r.family for r in rows):
        of = [r for r in rows if r.family == family]
        first_below = next((k for k, r in enumerate(of) if r.thinness <= share), len(of))
        good = [r.off for r in of if r.exit_code == 0]
        lines.append([family, *(r.cell() for r in of), steepest(of[:first_below + 1]), steepest(of[first_below:]),
                      f"{100 * max(good):.2g}%" if good else ""])
    print(table(["family", *(f"{h:g}" for h in thinness), f"power to {share:g}", "below", "volumes off"], lines))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--families", nargs="+", choices=families, default=list(families))
    parser.add_argument("--thinness", nargs="+", type=float, default=[10.0 ** -k for k in range(1, 7)])
    parser.add_argument("--program", type=Path, default=Path(__file__).parents[2] / "collarmesh")
    parser.add_argument("--options", default="", help="for the program")
    parser.add_argument("--limit", type=int, default=60, help="CPU seconds for one run")
    parser.add_argument("--feature-size", type=float, default=0.01, help="a share of the size, as the program's")
    parser.add_argument("--out", type=Path, help="of rows, tab-separated")
    options = parser.parse_args()
    print(machine(options.program.resolve().parents[1]) + "\n")
    rows: list[Row] = []
    with contextlib.ExitStack() as stack:
        out = stack.enter_context(open(options.out, "w", newline="")) if options.out else None
        for family in options.families:
            for thinness in options.thinness:
                rows.append(measure(family, thinness, options))
                print(family, f"{thinness:g}", rows[-1].cell(), rows[-1].said, file=sys.stderr, flush=True)
                if out:
                    csv.writer(out, delimiter="\t").writerow(vars(rows[-1]).values())
                    out.flush()
    print_table(rows, options.thinness, options.feature_size)


if __name__ == "__main__":
    main()
