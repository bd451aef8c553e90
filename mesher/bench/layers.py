#!/usr/bin/env python3
"""Measures boundary layers on shapes and on real parts: how much of the surface they cover, how many cells are
invalid, and how much time they take.

    layers.py PROGRAM [--parts FOLDER_OR_FILE...] [--size-share 20] [--count 3] [--openfoam] [--options ...]

Every shape gets --count layers on all faces; the first layer is a tenth of the size thick. This script reads the mesh
file and measures, without the mesher's code, Jacobians at corners and integration points, first heights and dihedral
angles. With `--openfoam` checkMesh judges each mesh, too. T-junction, airfoil and fin are STEP files that FreeCAD
makes; without FreeCAD they are left out."""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import resource
import statistics
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np

from improve_peers import dihedral_angles
from inputs import Surface, read_surface, sphere
from known_volumes import cube, make_step, prism, rod, tube
from tables import table

growth = 1.2


@dataclass
class Row:
    name: str
    outcome: str = ""
    tets: int = 0
    prisms: int = 0
    pyramids: int = 0
    coverage: float = math.nan       # percent of the walls' area
    full: float = math.nan           # percent of the walls' area with at least 0.9 of the requested thickness
    negative: int = -1               # cells with a Jacobian that is not positive; -1: not measured
    first_error: float = math.nan    # 95th percentile of the unreduced first heights' errors, percent
    step: float = math.nan           # largest ratio of the total heights at two neighbouring nodes
    smallest: float = math.nan       # dihedral angle of the tets outside the layers, degrees
    largest: float = math.nan
    seconds: float = math.nan        # CPU seconds of all threads
    share: float = math.nan          # time for layers, in percent of the elapsed time
    why: str = ""
    openfoam: str = ""               # the verdict of checkMesh
    non_orthogonality: str = ""      # largest and mean, degrees
    skewness: str = ""


def triple(a, b, c):
    return np.einsum("ij,ij->i", np.cross(a, b), c)


def prism_jacobians(p: np.ndarray) -> np.ndarray:
    """Returns Jacobians, by shape functions, at 7 points of the triangle (corners and integration points) times 5
    points along the height (ends and integration points). Shapes: p (n, 6, 3), result (35, n)."""
    third, sixth = 1 / 3, 1 / 6
    across = [(0, 0), (1, 0), (0, 1), (third, third), (sixth, sixth), (4 * sixth, sixth), (sixth, 4 * sixth)]
    found = []
    for z in (0.0, 0.5 - math.sqrt(0.15), 0.5, 0.5 + math.sqrt(0.15), 1.0):
        for x, y in across:
            dx = (1 - z) * (p[:, 1] - p[:, 0]) + z * (p[:, 4] - p[:, 3])
            dy = (1 - z) * (p[:, 2] - p[:, 0]) + z * (p[:, 5] - p[:, 3])
            dz = (1 - x - y) * (p[:, 3] - p[:, 0]) + x * (p[:, 4] - p[:, 1]) + y * (p[:, 5] - p[:, 2])
            found.append(triple(dx, dy, dz))
    return np.stack(found)


def pyramid_jacobians(p: np.ndarray) -> np.ndarray:
    """Returns Jacobians, up to a positive factor, on the lines from the apex to 5 x 5 points of the base (corners
    included). Shapes: p (n, 5, 3), result (25, n)."""
    found = []
    for x in (0.0, 0.2113, 0.5, 0.7887, 1.0):
        for y in (0.0, 0.2113, 0.5, 0.7887, 1.0):
            at = ((1 - x) * (1 - y))
            base = (at * p[:, 0] + x * (1 - y) * p[:, 1] + x * y * p[:, 2] + (1 - x) * y * p[:, 3])
            dx = (1 - y) * (p[:, 1] - p[:, 0]) + y * (p[:, 2] - p[:, 3])
            dy = (1 - x) * (p[:, 3] - p[:, 0]) + x * (p[:, 2] - p[:, 1])
            found.append(triple(dx, dy, p[:, 4] - base))
    return np.stack(found)


def corners_of(mesh, kind: str) -> np.ndarray:
    blocks = [block.data for block in mesh.cells if block.type == kind]
    cells = np.concatenate(blocks) if blocks else np.empty((0, {"tetra": 4, "wedge": 6, "pyramid": 5}[kind]), int)
    return mesh.points[cells]


def layer_numbers(mesh, kind: str) -> np.ndarray:
    data = mesh.cell_data.get("layer")
    if data is None:
        return np.zeros(sum(len(b.data) for b in mesh.cells if b.type == kind))
    chosen = [numbers for block, numbers in zip(mesh.cells, data) if block.type == kind]
    return np.concatenate(chosen) if chosen else np.zeros(0)


def measure(row: Row, path: Path, first: float) -> None:
    mesh = meshio.read(path)
    tets, prisms, pyramids = (corners_of(mesh, kind) for kind in ("tetra", "wedge", "pyramid"))
    row.tets, row.prisms, row.pyramids = len(tets), len(prisms), len(pyramids)
    of_tets = triple(tets[:, 1] - tets[:, 0], tets[:, 2] - tets[:, 0], tets[:, 3] - tets[:, 0])
    row.negative = int((of_tets <= 0).sum())
    if len(prisms):
        jacobians = prism_jacobians(prisms)
        sign = np.sign(np.median(jacobians))   # files differ in which triangle of a prism comes first
        row.negative += int(((sign * jacobians).min(axis=0) <= 0).sum())
    if len(pyramids):
        row.negative += int((pyramid_jacobians(pyramids).min(axis=0) <= 0).sum())
    core = tets[layer_numbers(mesh, "tetra") == 0]
    if len(core):
        angles = dihedral_angles(core.reshape(-1, 3), np.arange(4 * len(core)).reshape(-1, 4))
        row.smallest, row.largest = float(angles.min()), float(angles.max())
    measure_first_heights(row, prisms, layer_numbers(mesh, "wedge"), first)


def measure_first_heights(row: Row, prisms: np.ndarray, layers: np.ndarray, first: float) -> None:
    """Measures the 95th percentile of the relative errors of first heights. Leaves out prisms in which the height at a
    node is below nine tenths of the requested one. A prism's height is the mean over its nodes: on a curved wall,
    heights above the plane of the triangle are too large at some nodes and too small at others."""
    p = prisms[layers == 1]
    if not len(p):
        return
    normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    heights = np.abs(np.stack([np.einsum("ij,ij->i", p[:, k + 3] - p[:, k], normal) for k in range(3)]))
    kept = heights.min(axis=0) > 0.9 * first   # the mesher reduced the others
    if kept.any():
        row.first_error = 100 * float(np.quantile(np.abs(heights[:, kept].mean(axis=0) / first - 1), 0.95))


def cpu_seconds() -> float:
    """Returns the CPU seconds of all ended child processes of this script."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(name: str, path: Path, program: str, arguments, folder: Path) -> Row:
    row = Row(name)
    surface = subprocess.run([program, "info", str(path), "--json"], capture_output=True, text=True)
    try:
        size = json.loads(surface.stdout)["complex"]["diagonal"] / arguments.size_share
    except (ValueError, KeyError):
        row.outcome = (surface.stderr.strip().splitlines() or ["no information"])[-1][:60]
        return row
    first = 0.1 * size
    if arguments.thickness_of_three:
        first *= sum(growth ** k for k in range(3)) / sum(growth ** k for k in range(arguments.count))
    out, report = folder / "mesh.vtu", folder / "report.json"
    started, used = time.monotonic(), cpu_seconds()
    try:
        made = subprocess.run([program, str(path), "-o", str(out), "--size", repr(size), "--report", str(report),
                               "--layers", f"all:first={first!r},growth={growth},count={arguments.count}", "--quiet",
                               *arguments.options], capture_output=True, text=True, timeout=arguments.limit)
    except subprocess.TimeoutExpired:
        row.outcome = "past the limit"
        return row
    elapsed = time.monotonic() - started
    row.seconds = cpu_seconds() - used
    if made.returncode not in (0, 7):
        row.outcome = (made.stderr.strip().splitlines() or ["failed"])[-1][:60]
        return row
    told = json.loads(report.read_text())
    row.outcome = "meshed" if made.returncode == 0 else "missed: " + ", ".join(
        sorted({f["guarantee"] for f in told["check"]["findings"]}))
    layers = told["layers"]
    row.coverage, row.step = 100 * layers["coverage"], layers["largest_step"]
    area = sum(p["area"] for p in layers["patches"])
    row.full = 100 * sum(p["area_by_tenth_of_thickness"][9] for p in layers["patches"]) / area
    row.share = 100 * told["seconds"].get("layers", 0) / elapsed
    row.why = "; ".join(f"{r['nodes']} {r['why'].split(',')[0][:40]}" for r in layers["reductions"])
    measure(row, out, first)
    if arguments.openfoam:
        judge_in_openfoam(row, program, out, folder)
    return row


def judge_in_openfoam(row: Row, program: str, mesh: Path, folder: Path) -> None:
    case = Path(tempfile.mkdtemp(dir=folder))
    (case / "constant" / "polyMesh").mkdir(parents=True)
    (case / "system").mkdir()
    boundary = case / "constant" / "polyMesh" / "boundary"
    subprocess.run([program, "convert", str(mesh), "-o", str(boundary), "--format", "polymesh", "--quiet"], check=True)
    schemes = "".join(f"{kind}Schemes {{}} " for kind in ("ddt", "grad", "div", "laplacian", "interpolation", "snGrad"))
    for name, text in {"controlDict": "deltaT 1; endTime 1; writeInterval 1;", "fvSchemes": schemes,
                       "fvSolution": ""}.items():
        (case / "system" / name).write_text(
            f"FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n{text}\n")
    environment = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "FOAM_ETC": "/usr/share/openfoam/etc"}
    said = subprocess.run(["checkMesh"], cwd=case, env=environment, capture_output=True, text=True).stdout
    failed = re.findall(r"\*\*\*([^\n]*)", said)
    row.openfoam = "Mesh OK" if "Mesh OK" in said else "; ".join(failed) or "no verdict"
    if found := re.search(r"non-orthogonality Max: (\S+) average: (\S+)", said):
        row.non_orthogonality = "{:.1f}, {:.1f}".format(*map(float, found.groups()))
    if found := re.search(r"[Mm]ax skewness = ([\d.e+-]*\d)", said):
        row.skewness = f"{float(found[1]):.2f}"


def bend(around: int, along: int) -> Surface:
    """Returns a quarter of a torus with flat ends."""
    points, polygons = [], []
    for k in range(along + 1):
        turn = 0.5 * math.pi * k / along
        for i in range(around):
            t = 2 * math.pi * i / around
            r = 3 + math.cos(t)
            points.append((r * math.cos(turn), r * math.sin(turn), math.sin(t)))
    for k in range(along):
        for i in range(around):
            j = (i + 1) % around
            polygons.append([k * around + i, (k + 1) * around + i, (k + 1) * around + j, k * around + j])
    polygons.append(list(range(around)))
    polygons.append([along * around + i for i in reversed(range(around))])
    return Surface("bend", points, polygons)


def airfoil() -> str:
    """Returns the points of NACA 0012 with a chord of 1 and a sharp trailing edge, as an expression for FreeCAD."""
    def thickness(x: float) -> float:
        return 0.6 * (0.2969 * math.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    along = [(1 - math.cos(math.pi * k / 40)) / 2 for k in range(41)]
    points = [(x, thickness(x) if x < 1 else 0.0) for x in reversed(along)]
    points += [(x, -y) for x, y in reversed(points[:-1])]
    return "[" + ", ".join(f"V({x + 1!r}, {y + 1!r}, 0)" for x, y in points) + "]"


# Solids, as expressions for FreeCAD's Python: a pipe that branches, the space around an airfoil in a box, a sphere with
# a fin.
solids = {
    "T-junction": "[Part.makeCylinder(1, 8, V(-4, 0, 0), V(1, 0, 0))"
                  ".fuse(Part.makeCylinder(0.7, 4, V(0, 0, 0), V(0, 0, 1))).removeSplitter()]",
    "airfoil in a box": "[(lambda c: (c.interpolate(" + airfoil() + "), "
                        "Part.makeBox(4, 2, 1).cut(Part.Face(Part.Wire(c.toShape()))"
                        ".extrude(V(0, 0, 1))))[1])(Part.BSplineCurve())]",
    "sphere with a fin": "[Part.makeSphere(1).fuse(Part.makeBox(1, 0.2, 1, V(0.6, -0.1, -0.5))).removeSplitter()]",
}


def write_solids(folder: Path) -> list[tuple[str, Path]]:
    paths = [(title, folder / f"{title.replace(' ', '_')}.step") for title in solids]
    lines = "\n".join(f"{path} {solids[title]}" for title, path in paths)
    made = subprocess.run(["/usr/bin/python3", "-c", make_step], input=lines, text=True, capture_output=True)
    if made.returncode != 0:
        print("FreeCAD made no solids:", made.stderr.strip().splitlines()[-1:])
    return [(title, path) for title, path in paths if path.exists()]


def shapes(models: Path) -> list[tuple[str, Surface | Path]]:
    angle = math.radians(20)
    notch = [(0, 0), (4, 0), (4, 2), (2.4, 2), (2, 0.4), (1.6, 2), (0, 2)]
    found: list[tuple[str, Surface | Path]] = [
        ("cube", cube(1)), ("sphere", models / "sphere.off"), ("bracket", models / "bracket.off"),
        ("plate with hole", models / "plate_with_hole.off"), ("pipe", tube(1, 0.7, 4, 48)), ("rod", rod(1, 4, 48)),
        ("bend", bend(48, 40)),
        ("wedge of 20 degrees", prism([(0, 0), (4, 0), (4 * math.cos(angle), 4 * math.sin(angle))], 0, 2)),
        ("gap that narrows to nothing", prism(notch, 0, 1)),
    ]
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--parts", nargs="*", type=Path, default=[])
    parser.add_argument("--most", type=int, default=20, help="at most so many parts of each folder")
    parser.add_argument("--size-share", type=float, default=20, help="the diagonal over the size")
    parser.add_argument("--count", type=int, default=3)
    parser.add_argument("--thickness-of-three", action="store_true",
                        help="make the layers together as thick as three layers")
    parser.add_argument("--limit", type=float, default=120, help="seconds for a part")
    parser.add_argument("--only", nargs="*", help="shapes with these words in their names")
    parser.add_argument("--openfoam", action="store_true", help="let checkMesh judge the meshes")
    parser.add_argument("--options", nargs=argparse.REMAINDER, default=[])
    arguments = parser.parse_args()
    models = Path(__file__).resolve().parents[2] / "resources" / "models"
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        inputs: list[tuple[str, Path]] = []
        if not arguments.parts:
            inputs += write_solids(folder)
            for title, shape in shapes(models):
                if isinstance(shape, Path):
                    inputs.append((title, shape))
                else:
                    shape.write(folder / title.replace(" ", "_"))
                    inputs.append((title, (folder / title.replace(" ", "_")).with_suffix(shape.suffix)))
        for part in arguments.parts:
            files = sorted(p for p in part.iterdir() if p.is_file())[:arguments.most] if part.is_dir() else [part]
            inputs += [(f.name, f) for f in files]
        for title, path in inputs:
            if arguments.only and not any(word in title for word in arguments.only):
                continue
            row = run(title, path, arguments.program, arguments, folder)
            rows.append(row)
            print(row, flush=True)
    print_table(rows)


def print_table(rows: list[Row]) -> None:
    text = [[row.name, row.outcome, str(row.tets), str(row.prisms), str(row.pyramids), f"{row.coverage:.1f}",
             f"{row.full:.0f}", str(row.negative), f"{row.first_error:.1f}", f"{row.step:.2f}",
             f"{row.smallest:.1f}", f"{row.largest:.1f}", f"{row.seconds:.1f}", f"{row.share:.0f}",
             row.openfoam, row.non_orthogonality, row.skewness] for row in rows]
    print(table(["shape", "outcome", "tets", "prisms", "pyramids", "covered %", "full thickness %",
                 "negative Jacobians", "error of the first height %", "largest step", "smallest angle", "largest angle",
                 "CPU s", "layers' share %", "checkMesh", "non-orthogonality: largest, mean", "skewness"],
                text))
    covered = [row.coverage for row in rows if not math.isnan(row.coverage)]
    if covered:
        print(f"\nCoverage: median {statistics.median(covered):.1f}%, least {min(covered):.1f}%, of {len(covered)}")


if __name__ == "__main__":
    main()
