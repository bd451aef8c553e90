#!/usr/bin/env python3
"""Meshes families of bodies with known volumes at default options, and measures how far the volumes of regions are off
and how many elements the meshes have. Most lengths are in target edge lengths (a twentieth of the diagonal), so a rod
of radius 0.02 has a radius of a fiftieth of the target edge length.

known_volumes.py write FOLDER makes the inputs: surfaces with 24 edges per circle (coarse) and with 96 (fine),
complexes of several regions, and STEP files (these need FreeCAD). known_volumes.py run FOLDER meshes them and prints a
table."""

from __future__ import annotations

import argparse
import concurrent.futures
import contextlib
import csv
import json
import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from inputs import Surface
from processes import run_limited
from tables import table

diagonal = 20.0             # so that the target edge length is 1
side = diagonal / math.sqrt(3)   # of a cube with this diagonal
memory_limit = 12 << 30     # bytes
cuts = {"coarse": 24, "fine": 96}   # edges per circle

# The script for FreeCAD's Python. It reads lines of "PATH EXPRESSION"; an expression makes a list of solids.
make_step = """
import sys, json, math
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]
import FreeCAD, Part
V = FreeCAD.Vector
def cylinder(r, length, x=0, y=0, z=0): return Part.makeCylinder(r, length, V(x, y, z), V(1, 0, 0))
def ball(r): return Part.makeSphere(r)
def box(side): return Part.makeBox(side, side, side, V(-side / 2, -side / 2, -side / 2))
def slab(side, low, high): return Part.makeBox(side, side, high - low, V(-side / 2, -side / 2, low))
def wave(radius, height, teeth):
    curve = Part.BSplineCurve()
    steps = 24 * teeth
    curve.interpolate([V(r * math.cos(a), r * math.sin(a), 0) for k in range(steps) for a in [2 * math.pi * k / steps]
                       for r in [radius + height * math.sin(teeth * a)]], PeriodicFlag=True)
    return Part.Face(Part.Wire(curve.toShape()))
def ring(radius, r): return Part.makeTorus(radius, r)
for line in sys.stdin:
    path, made = line.split(" ", 1)
    solids = [s for x in eval(made) for s in x.Solids]
    (Part.makeCompound(solids) if len(solids) > 1 else solids[0]).exportStep(path)
    json.dump([s.Volume for s in solids], open(path + ".json", "w"))
"""


@dataclass
class Family:
    """A folder of bodies. Beside the file of each body is a .json file with the volumes of its regions."""
    folder: Path
    step: list[str] = field(default_factory=list)
    given: dict[str, list[float]] = field(default_factory=dict)

    def solids(self, name: str, expression: str, volumes: list[float] | None = None) -> None:
        """Adds a STEP file. OpenCASCADE computes its volumes unless `volumes` gives them, as for waves, which
        OpenCASCADE integrates badly."""
        self.step.append(f"{self.folder / name}.step {expression}")
        if volumes:
            self.given[f"{name}.step"] = volumes

    def shells(self, name: str, shells: list[Surface]) -> None:
        """Adds closed surfaces, each inside the previous one. A region lies between each surface and the next,
        and one inside the last surface."""
        volumes = [s.volume for s in shells] + [0.0]
        self.surfaces(name, shells, [a - b for a, b in zip(volumes, volumes[1:])])

    def surfaces(self, name: str, shells: list[Surface], volumes: list[float]) -> None:
        points, polygons = [], []
        for shell in shells:
            polygons += [[len(points) + v for v in q] for q in shell.polygons]
            points += shell.points
        Surface(name, points, polygons).write_off(self.folder / f"{name}.off")
        self.keep(f"{name}.off", volumes)

    def keep(self, file: str, volumes: list[float]) -> None:
        (self.folder / f"{file}.json").write_text(json.dumps(volumes))

    def write_step(self) -> None:
        subprocess.run(["/usr/bin/python3", "-c", make_step], input="\n".join(self.step), text=True, check=True,
                       stdout=subprocess.DEVNULL)
        for file, volumes in self.given.items():
            self.keep(file, volumes)


def turned(profile: list[tuple[float, float]], around: int, closed: bool = False) -> Surface:
    """Returns the surface of revolution of a profile of (x, radius) about the x axis. Precondition: a profile
    that is not closed begins and ends on the axis."""
    points, rows, polygons = [], [], []
    for x, radius in profile:
        rows.append([len(points) + k if radius else len(points) for k in range(around)])
        angles = [2 * math.pi * k / around for k in range(around if radius else 1)]
        points += [(x, radius * math.cos(a), radius * math.sin(a)) for a in angles]
    pairs = list(zip(rows, rows[1:])) + ([(rows[-1], rows[0])] if closed else [])
    for a, b in pairs:
        for k in range(around):
            n = (k + 1) % around
            for triangle in ([a[k], a[n], b[n]], [a[k], b[n], b[k]]):
                if len(set(triangle)) == 3:
                    polygons.append(triangle)
    return Surface("turned", points, polygons)


def rod(radius: float, length: float, around: int) -> Surface:
    return turned([(0, 0), (0, radius), (length, radius), (length, 0)], around)


def tube(outer: float, inner: float, length: float, around: int) -> Surface:
    return turned([(0, inner), (0, outer), (length, outer), (length, inner)], around, closed=True)


def ball(radius: float, around: int, stretch: tuple[float, float, float] = (1, 1, 1)) -> Surface:
    angles = [2 * math.pi * k / around for k in range(around // 2 + 1)]
    ends = (0, len(angles) - 1)
    surface = turned([(-radius * math.cos(a), 0 if k in ends else radius * math.sin(a))
                     for k, a in enumerate(angles)], around)
    surface.points = [tuple(c * s for c, s in zip(p, stretch)) for p in surface.points]
    return surface


def cube(edge: float) -> Surface:
    h = edge / 2
    points = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    return Surface("cube", points, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def torus(radius: float, wire: float, around: int, along: int) -> Surface:
    points = [((radius + wire * math.cos(b)) * math.cos(a), (radius + wire * math.cos(b)) * math.sin(a),
               wire * math.sin(b))
              for a in (2 * math.pi * i / along for i in range(along))
              for b in (2 * math.pi * j / around for j in range(around))]
    polygons = []
    for i in range(along):
        for j in range(around):
            a, b = i * around, (i + 1) % along * around
            n = (j + 1) % around
            polygons += [[a + j, b + j, b + n], [a + j, b + n, a + n]]
    return Surface("torus", points, polygons)


def prism(outline: list[tuple[float, float]], low: float, high: float) -> Surface:
    """Returns the prism over a polygon. Precondition: it is convex, or star-shaped as seen from the origin."""
    n = len(outline)
    points = [(x, y, z) for z in (low, high) for x, y in outline]
    polygons = [[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
    return Surface("prism", points, [*polygons, list(range(n))[::-1], list(range(n, 2 * n))])


def wing(chord: float, span: float, around: int) -> Surface:
    """Returns a wing with the profile NACA 0012 and a sharp trailing edge."""
    def half(x: float) -> float:
        return 0.6 * chord * (0.2969 * math.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    xs = [(1 - math.cos(math.pi * k / (around // 2))) / 2 for k in range(around // 2 + 1)]
    upper = [(chord * (x - 0.5), half(x)) for x in xs]
    lower = [(x, -y) for x, y in upper[1:-1]]
    upper[-1] = (chord / 2, 0.0)
    return prism(upper[::-1] + lower, -span / 2, span / 2)


def screw(radius: float, height: float, pitch: float, length: float, around: int) -> Surface:
    """Returns a rod with a thread of triangular section and flat ends."""
    along = round(length / pitch * 8)
    points, polygons = [], []
    for i in range(along + 1):
        for j in range(around):
            turn = (i / 8 - j / around) % 1.0
            r, a = radius + height * (1 - abs(2 * turn - 1)), 2 * math.pi * j / around
            points.append((length * i / along, r * math.cos(a), r * math.sin(a)))
    for i in range(along):
        for j in range(around):
            n = (j + 1) % around
            a, b = i * around, (i + 1) * around
            polygons += [[a + j, a + n, b + n], [a + j, b + n, b + j]]
    points += [(0, 0, 0), (length, 0, 0)]
    for j in range(around):
        n = (j + 1) % around
        polygons += [[len(points) - 2, n, j], [len(points) - 1, along * around + j, along * around + n]]
    return Surface("screw", points, polygons)


def write_layers(family: Family, name: str, steps: int, heights: list[float], amplitude: float) -> None:
    """Writes a block that wavy sheets divide into layers; each layer is a region."""
    grid = [[(side * (i / steps - 0.5), side * (j / steps - 0.5)) for j in range(steps + 1)] for i in range(steps + 1)]
    flat = (0, len(heights) - 1)
    index, points, polygons, volumes = {}, [], [], []
    for k, z in enumerate(heights):
        for i, row in enumerate(grid):
            for j, (x, y) in enumerate(row):
                index[k, i, j] = len(points)
                wave = 0 if k in flat else amplitude * \
                    math.sin(2 * math.pi * x / side) * math.cos(2 * math.pi * y / side)
                points.append((x, y, z + wave))
    under = []
    for k in range(len(heights)):
        total = 0.0
        for i in range(steps):
            for j in range(steps):
                corners = index[k, i, j], index[k, i + 1, j], index[k, i + 1, j + 1], index[k, i, j + 1]
                polygons += [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
                for q in polygons[-2:]:
                    total += sum(points[v][2] for v in q) / 3 * (side / steps)**2 / 2
        under.append(total)
    rim = [(i, 0) for i in range(steps)], [(steps, j) for j in range(steps)], \
        [(i, steps) for i in range(steps, 0, -1)], [(0, j) for j in range(steps, 0, -1)]
    for wall, following in zip(rim, [*rim[1:], rim[0]]):
        path = [*wall, following[0]]
        for k in range(len(heights) - 1):
            polygons.append([index[k, i, j] for i, j in path] + [index[k + 1, i, j] for i, j in reversed(path)])
    surface = Surface(name, points, polygons)
    surface.write_poly(family.folder / f"{name}.poly")
    family.keep(f"{name}.poly", [b - a for a, b in zip(under, under[1:])])


def write(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    family = Family(folder)
    for r in (0.005, 0.02, 0.1, 0.3, 1):
        family.solids(f"rod_{r}", f"[cylinder({r}, {diagonal})]")
        family.solids(f"tube_{r}", f"[cylinder({r}, {diagonal}).cut(cylinder({0.9 * r}, {diagonal}))]")
    ball_radius = side / 2
    for t in (0.002, 0.01, 0.05, 0.2, 0.5):
        family.solids(f"hollow_ball_{t}", f"[ball({ball_radius}).cut(ball({ball_radius - t}))]")
        family.solids(f"roof_{t}", f"[cylinder(6, 12).cut(cylinder({6 - t}, 12)).common("
                      "Part.makeBox(12, 12, 6, V(0, -6, 0)))]")
        family.solids(f"slab_{t}", f"[slab({side}, -5, 0), slab({side}, 0, {t}), slab({side}, {t}, 5)]")
    for r in (0.01, 0.03, 0.1, 0.3):
        radius = r * side
        family.solids(f"ball_in_box_{r}", f"[box({side}).cut(ball({radius})), ball({radius})]")
    for share in (0.005, 0.02, 0.1):
        inner = ball_radius * (1 - share)
        family.solids(f"coating_{share}", f"[ball({ball_radius}).cut(ball({inner})), ball({inner})]")
    for r in (0.02, 0.1):
        family.solids(
            f"wire_{r}", f"[box({side}).cut(cylinder({r}, {side}, {-side / 2})), cylinder({r}, {side}, {-side / 2})]")
        family.solids(f"ring_{r}", f"[box({side}).cut(ring(3, {r})), ring(3, {r})]")
    for height in (0.05, 0.3):
        family.solids(f"gear_{height}", f"[wave(6, {height}, 20).extrude(V(0, 0, 2)).cut(Part.makeCylinder(2, 2))]",
                      [2 * math.pi * (6**2 + height**2 / 2 - 2**2)])
    for cut, around in cuts.items():
        for r in (0.005, 0.02, 0.1, 0.3, 1):
            family.shells(f"rod_{r}_{cut}", [rod(r, diagonal, around)])
            family.shells(f"tube_{r}_{cut}", [tube(r, 0.9 * r, diagonal, around)])
        for t in (0.002, 0.01, 0.05, 0.2, 0.5):
            shell = [ball(ball_radius, around), ball(ball_radius - t, around)]
            # Reverse the inner surface, because it bounds a void.
            shell[1].polygons = [q[::-1] for q in shell[1].polygons]
            family.surfaces(f"hollow_ball_{t}_{cut}", shell, [shell[0].volume - shell[1].volume])
        for r in (0.01, 0.03, 0.1, 0.3):
            family.shells(f"ball_in_box_{r}_{cut}", [cube(side), ball(r * side, around)])
        for share in (0.005, 0.02, 0.1):
            family.shells(f"coating_{share}_{cut}", [ball(ball_radius, around),
                          ball(ball_radius * (1 - share), around)])
        family.shells(f"heads_{cut}", [ball(r, around, (1, 0.8, 0.9)) for r in (5.7, 5.3, 4.9, 4.75)])
        family.shells(f"wing_{cut}", [cube(side), wing(1.5, 4, around)])
        for r in (0.02, 0.1):
            family.shells(f"ring_{r}_{cut}", [cube(side), torus(3, r, around, 4 * around)])
        family.shells(f"gear_{cut}", [prism([(r * math.cos(a), r * math.sin(a)) for k in range(10 * around)
                                             for a in [2 * math.pi * k / (10 * around)]
                                             for r in [6 + 0.3 * math.sin(20 * a)]],
                                            0, 2)])
        family.shells(f"screw_{cut}", [screw(1.5, 0.25, 0.5, 8, around)])
        for t in (0.01, 0.05, 0.3):
            write_layers(family, f"layers_{t}_{cut}", around // 2, [-5, 0, t, 5], 1.0)
    family.write_step()


@dataclass
class Row:
    file: str
    order: int
    outcome: str
    cpu: float = math.nan     # seconds
    tets: int = 0
    off: float = math.nan     # the largest relative error of a region's volume


def differences(made: list[float], known: list[float]) -> float:
    """Returns the largest relative error of a region's volume; 1 if the number of regions is wrong. Compares the sorted
    volumes."""
    if len(made) != len(known):
        return 1.0
    return max(abs(a / b - 1) for a, b in zip(sorted(made), sorted(known)))


def measure(path: Path, program: str, order: int, limit: int) -> Row:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        command = [program, str(path.resolve()), "-o", "mesh.vtu", "--report", "report.json", "--progress", "none",
                   "--threads", "1", "--order", str(order)]
        done = run_limited(command, folder, limit, memory_limit)
        if done.exit_code < 0:
            return Row(path.name, order, f"not done in {limit} s", done.cpu)
        if done.exit_code not in (0, 7):
            return Row(path.name, order, f"exit code {done.exit_code}", done.cpu)
        mesh = json.loads((folder / "report.json").read_text())["mesh"]
        known = json.loads(Path(f"{path}.json").read_text())
        return Row(path.name, order, "good" if done.exit_code == 0 else f"exit code {done.exit_code}", done.cpu,
                   mesh["tets"], differences(list(mesh["region_volumes"].values()), known))


def read_rows(path: Path) -> list[Row]:
    """Reads the rows that an earlier run wrote."""
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return [Row(file_name, int(order), outcome, float(cpu), int(tets), float(off))
                for file_name, order, outcome, cpu, tets, off in csv.reader(file, delimiter="\t")]


def print_table(rows: list[Row]) -> None:
    files = sorted({r.file for r in rows})
    of = {(r.file, r.order): r for r in rows}
    lines = []
    for file in files:
        line = [file]
        for order in sorted({r.order for r in rows}):
            r = of[file, order]
            off = f"{100 * r.off:.2f}%" + ("" if r.outcome == "good" else f" ({r.outcome})")
            line += [off, str(r.tets), f"{r.cpu:.2f}"] if r.tets else [r.outcome, "", f"{r.cpu:.2f}"]
        lines.append(line)
    header = ["input"]
    for order in sorted({r.order for r in rows}):
        header += [f"order {order}: off", "tets", "CPU s"]
    print(table(header, lines))
    for order in sorted({r.order for r in rows}):
        off = [r.off for r in rows if r.order == order and r.outcome == "good"]
        counts = ", ".join(f"{100 * most:g}%: {sum(o > most for o in off)}" for most in (0.01, 0.02, 0.05))
        print(f"\norder {order}: {len(off)} of {len(files)} good; volumes off by more than {counts}; "
              f"largest {100 * max(off, default=0):.2f}%")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=["write", "run"])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--program", default=str(Path(__file__).parents[2] / "collarmesh"))
    parser.add_argument("--orders", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--limit", type=int, default=120, help="CPU seconds for one run")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", default="", help="names that contain this")
    parser.add_argument("--out", type=Path,
                        help="rows as they come: file, order, outcome, CPU seconds, tets, difference; a run that it "
                             "holds is not made again")
    options = parser.parse_args()
    if options.action == "write":
        write(options.folder)
        return
    files = [Path(str(f)[:-5]) for f in sorted(options.folder.glob("*.json")) if options.only in f.name]
    rows = read_rows(options.out) if options.out else []
    held = {(r.file, r.order) for r in rows}
    jobs = [(f, order) for f in files for order in options.orders if (f.name, order) not in held]
    with contextlib.ExitStack() as stack:
        out = stack.enter_context(open(options.out, "a", newline="")) if options.out else None
        pool = stack.enter_context(concurrent.futures.ThreadPoolExecutor(options.jobs))
        for row in pool.map(lambda job: measure(job[0], options.program, job[1], options.limit), jobs):
            rows.append(row)
            if out:
                csv.writer(out, delimiter="\t").writerow(vars(row).values())
                out.flush()
    print_table(rows)


if __name__ == "__main__":
    sys.exit(main())
