#!/usr/bin/env python3
"""Compares how many elements meshes of CAD files have, and how near the meshes are to the exact shapes: collarmesh with
its defaults and Gmsh (HXT), both at a twentieth of the diagonal, with elements of the first and of the second order.

Distances are relative to the diagonal. They are measured from points on the mesh's outer faces (curved if these have
six nodes) to a dense tessellation by OpenCASCADE (FreeCAD's Shape.tessellate, with an error of 1e-4), and from the
vertices of the tessellation to the mesh's outer faces. The tessellation has the walls between solids, but the outer
faces of a conforming mesh do not, so points on walls count as distant. The total volume of the solids is compared with
OpenCASCADE's. Angles are the dihedral angles of the straight tets between the corners. The file --out keeps the results
of all runs; a run that is in this file is not made again."""

from __future__ import annotations

import argparse
import csv
import math
import statistics
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

from improve_peers import dihedral_angles
from meshers import Collarmesh, debian_version, gmsh_part_command
from processes import pin_to_core, run_limited
from real_parts import cad_suffixes
from tables import machine, table

reference_share = 1e-4   # relative to the diagonal
tessellate = """
import sys
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]
import FreeCAD, Part, numpy
shape = Part.Shape()
shape.read(sys.argv[1])
points, triangles = shape.tessellate(float(sys.argv[3]) * shape.BoundBox.DiagonalLength)
numpy.savez(sys.argv[2], volume=shape.Volume, points=[tuple(p) for p in points], triangles=triangles, \
diagonal=shape.BoundBox.DiagonalLength)
"""
# The corners of a tetrahedron's faces, and the mid-edge node between each pair of corners (VTK's order).
faces = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))
middles = {(0, 1): 4, (1, 2): 5, (0, 2): 6, (0, 3): 7, (1, 3): 8, (2, 3): 9}


@dataclass
class Row:
    file: str
    mesher: str
    order: int
    outcome: str
    cpu: float = math.nan       # seconds of the whole program
    tets: int = 0
    points: int = 0
    smallest: float = math.nan  # dihedral angle, degrees
    largest: float = math.nan
    to_shape: float = math.nan  # largest distance of the mesh from the shape, relative to the diagonal
    to_mesh: float = math.nan   # the reverse
    volume_off: float = math.nan   # relative error of the total volume of the solids


@dataclass
class Triangles:
    points: np.ndarray      # shape (n, 3)
    corners: np.ndarray     # shape (m, 3), indices of points

    def poly_data(self) -> vtk.vtkPolyData:
        data, points, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(self.points, float), deep=True))
        cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(self.corners, np.int64).ravel(), deep=True))
        data.SetPoints(points)
        data.SetPolys(cells)
        return data

    def volume(self) -> float:
        a, b, c = (self.points[self.corners[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)

    def distance_of(self, points: np.ndarray) -> float:
        """Returns the largest distance of a point from the triangles."""
        measure = vtk.vtkImplicitPolyDataDistance()
        measure.SetInput(self.poly_data())
        found = vtk.vtkDoubleArray()
        found.SetNumberOfTuples(len(points))
        measure.FunctionValue(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True), found)
        return float(np.abs(vtk_to_numpy(found)).max())


def lattice(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Cuts a triangle into n * n triangles. Returns the barycentric coordinates of their points, and for each of them
    the indices of its corners."""
    index, points = {}, []
    for i in range(n + 1):
        for j in range(n + 1 - i):
            index[i, j] = len(points)
            points.append(((n - i - j) / n, i / n, j / n))
    cells = [(index[i, j], index[i + 1, j], index[i, j + 1]) for i, j in index if i + j < n]
    cells += [(index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]) for i, j in index if i + j < n - 1]
    return np.array(points), np.array(cells)


def boundary(points: np.ndarray, tets: np.ndarray, n: int = 4) -> Triangles:
    """Returns the faces of only one tetrahedron, each cut into n * n triangles with corners on the (curved) face."""
    corners = np.concatenate([tets[:, face] for face in faces])
    _, first, count = np.unique(np.sort(corners, axis=1), axis=0, return_index=True, return_counts=True)
    outer = first[count == 1]
    a, b, c = (points[corners[outer, k]][:, None] for k in range(3))
    where, cells = lattice(n)
    u, v, w = (where[None, :, k, None] for k in range(3))
    if tets.shape[1] == 4:
        placed = u * a + v * b + w * c
    else:
        between = np.concatenate([tets[:, [middles[tuple(sorted(pair))] for pair in
                                           ((face[0], face[1]), (face[1], face[2]), (face[2], face[0]))]]
                                  for face in faces])[outer]
        ab, bc, ca = (points[between[:, k]][:, None] for k in range(3))
        placed = (u * (2 * u - 1) * a + v * (2 * v - 1) * b + w * (2 * w - 1) * c
                  + 4 * u * v * ab + 4 * v * w * bc + 4 * w * u * ca)
    offsets = np.arange(len(outer))[:, None, None] * len(where)
    return Triangles(placed.reshape(-1, 3), (cells[None] + offsets).reshape(-1, 3))


def volume_of(points: np.ndarray, tets: np.ndarray) -> float:
    """Returns the total volume of curved elements: extrapolated from a coarse and a fine division of the outer faces
    into triangles, because the error of a division is proportional to the square of its triangles' size."""
    points = points - points.mean(0)
    coarse, fine = (abs(boundary(points, tets, n).volume()) for n in (2, 4))
    return (4 * fine - coarse) / 3


def reference(path: Path, folder: Path) -> tuple[Triangles, float, float] | None:
    """Returns the dense tessellation, the diagonal and the volume; None if OpenCASCADE fails. Keeps them in the
    folder."""
    kept = folder / (path.name + ".npz")
    if not kept.exists():
        part = kept.with_suffix(".part.npz")
        command = [sys.executable, "-c", tessellate, str(path), str(part), str(reference_share)]
        try:
            if subprocess.run(command, capture_output=True, timeout=300).returncode == 0:
                part.rename(kept)
        except subprocess.TimeoutExpired:
            part.unlink(missing_ok=True)
    if not kept.exists():
        return None
    with np.load(kept) as data:
        if len(data["triangles"]) == 0:
            return None
        return Triangles(data["points"], data["triangles"]), float(data["diagonal"]), float(data["volume"])


def command_of(mesher: str, path: Path, out: str, order: int, program: Path) -> list[str]:
    if mesher == "collarmesh":
        return [str(program), str(path), "-o", out, "--order", str(order), "--threads", "1", "--progress", "none", "-q"]
    return gmsh_part_command(path, out, order)


def measured(path: Path, mesher: str, order: int, folder: Path, references: Path, options) -> Row:
    row = Row(path.name, mesher, order, "failed")
    out = folder / "mesh.msh"
    out.unlink(missing_ok=True)
    run = run_limited(command_of(mesher, path.resolve(), out.name, order, options.program), folder, options.limit,
                      int(12e9))
    row.cpu = run.cpu
    if run.exit_code not in (0, 7) or not out.exists():
        return row
    mesh = meshio.read(out)
    tets = [block.data for block in mesh.cells if block.type == ("tetra", "tetra10")[order - 1]]
    if not tets:
        return row
    tets = np.concatenate(tets)
    row.outcome = "guarantee missed" if run.exit_code == 7 else "meshed"
    row.tets, row.points = len(tets), len(np.unique(tets))
    with np.errstate(all="ignore"):
        angles = dihedral_angles(mesh.points, tets[:, :4])
    row.smallest, row.largest = np.nanmin(angles), np.nanmax(angles)
    exact = reference(path, references)
    if exact:
        shape, diagonal, volume = exact
        surface = boundary(mesh.points, tets)
        row.to_shape = shape.distance_of(surface.points) / diagonal
        row.to_mesh = surface.distance_of(shape.points) / diagonal
        row.volume_off = volume_of(mesh.points, tets) / volume - 1
    return row


def read_rows(out: Path) -> list[Row]:
    if not out.exists():
        return []
    with open(out, newline="") as lines:
        return [Row(**{f.name: {"int": int, "float": float, "str": str}[f.type](line[f.name]) for f in fields(Row)})
                for line in csv.DictReader(lines, delimiter="\t")]


def append_row(out: Path, row: Row) -> None:
    new = not out.exists()
    with open(out, "a", newline="") as lines:
        writer = csv.DictWriter(lines, [f.name for f in fields(Row)], delimiter="\t", lineterminator="\n")
        if new:
            writer.writeheader()
        writer.writerow(asdict(row))


def percentile(values: list[float], share: float) -> str:
    known = [value for value in values if not math.isnan(value)]
    return f"{np.percentile(known, share):.3g}" if known else ""


def tables(rows: list[Row], sound: float) -> str:
    lines = []
    for order in (1, 2):
        by = {mesher: {row.file: row for row in rows if (row.mesher, row.order) == (mesher, order)
                       and row.tets > 0} for mesher in ("collarmesh", "gmsh")}
        for name, files in (("all", [file for file in by["gmsh"] if file in by["collarmesh"]]),
                            (f"Gmsh's smallest angle at least {sound:g}",
                             [file for file, row in by["gmsh"].items()
                              if file in by["collarmesh"] and row.smallest >= sound])):
            if not files:
                continue
            ours, theirs = ([by[mesher][file] for file in files] for mesher in ("collarmesh", "gmsh"))
            ratios = [a.tets / b.tets for a, b in zip(ours, theirs)]
            nearer = [a.to_shape <= b.to_shape + reference_share for a, b in zip(ours, theirs)
                      if not math.isnan(a.to_shape + b.to_shape)]
            lines.append([str(order), name, str(len(files)), percentile(ratios, 50), percentile(ratios, 90),
                          percentile([a.cpu / b.cpu for a, b in zip(ours, theirs)], 50),
                          *(percentile([getattr(row, member) for row in side], share)
                            for member, share in (("to_shape", 50), ("to_shape", 90), ("to_mesh", 50), ("to_mesh", 90))
                            for side in (ours, theirs)),
                          *(percentile([100 * abs(row.volume_off) for row in side], share)
                            for share in (50, 90) for side in (ours, theirs)),
                          f"{sum(nearer)} of {len(nearer)}",
                          f"{min(row.smallest for row in ours):.3g}", f"{max(row.largest for row in ours):.4g}",
                          str(sum(row.outcome == "guarantee missed" for row in ours))])
    return table(["order", "files", "number", "tets / Gmsh's, median", "90%", "CPU s / Gmsh's, median",
                  "mesh to shape, median", "Gmsh", "90%", "Gmsh", "shape to mesh, median", "Gmsh", "90%", "Gmsh",
                  "volume off, %, median", "Gmsh", "90%", "Gmsh",
                  "no farther than Gmsh's", "smallest angle", "largest", "guarantee missed"], lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("folders", type=Path, nargs="*", metavar="FOLDER")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--program", type=Path, help="collarmesh (default: of the build)")
    parser.add_argument("--orders", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--limit", type=int, default=60, help="CPU seconds for one run of one program")
    parser.add_argument("--out", type=Path, default=Path("few_elements.tsv"))
    parser.add_argument("--references", type=Path, default=Path("references"), help="keeps the dense tessellations")
    parser.add_argument("--sound", type=float, default=1,
                        help="second row: files where Gmsh's smallest angle is at least this, in degrees")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    options.program = (options.program or options.build / "bin" / "collarmesh").resolve()
    options.references.mkdir(parents=True, exist_ok=True)
    rows = read_rows(options.out)
    done = {(row.file, row.mesher, row.order) for row in rows}
    with tempfile.TemporaryDirectory() as scratch:
        for path in (p for folder in options.folders for p in sorted(folder.iterdir())):
            if path.suffix.lower() not in cad_suffixes:
                continue
            for order in options.orders:
                for mesher in ("gmsh", "collarmesh"):
                    if (path.name, mesher, order) in done:
                        continue
                    rows.append(measured(path, mesher, order, Path(scratch), options.references, options))
                    append_row(options.out, rows[-1])
                    print(rows[-1], file=sys.stderr, flush=True)
    print(f"{about}. collarmesh {Collarmesh(options.program, 0).version()}, gmsh {debian_version('gmsh')}.\n")
    print(tables(rows, options.sound))
    return 0


if __name__ == "__main__":
    sys.exit(main())
