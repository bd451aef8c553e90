#!/usr/bin/python3
"""Compares our boundary layers with Netgen's and Gmsh's: how much of the surface they cover, how many cells are
invalid, and how much time they take.

    layer_peers.py PROGRAM [--parts FILE...] [--only WORDS] [--size-share 20] [--limit 300]

The peers get the surface of our mesh without layers, with a size of 1/20 of the diagonal. Netgen fills it with tets
and pushes layers into them; Gmsh divides it into patches at edges above 40 degrees, meshes these at the same size,
extrudes them and fills the rest. All three programs are asked for three layers on all faces: the first a tenth of the
size, growth 1.2. All meshes are measured in the same way. `covered` is the area of the boundary's triangles that belong
to prisms, relative to the area of the peers' input; `folded` counts cells with a Jacobian that is not positive;
`volume` compares the total volume of the cells with the volume inside the peers' input. Needs Debian's python3-netgen,
python3-gmsh and python3-meshio; shapes that are STEP files need FreeCAD."""

from __future__ import annotations

import argparse
import collections
import math
import resource
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np

from inputs import Surface
from layers import growth, prism_jacobians, pyramid_jacobians, shapes, triple, write_solids
from tables import table

count = 3
kinds = {4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron"}
meshers = ("collarmesh", "Netgen", "Gmsh")
shown = ("cube", "rod", "bracket", "pipe", "T-junction", "sphere with a fin")


def surface_of(mesh: meshio.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Returns the triangles of a mesh and their tags."""
    chosen = [(block.data, tags) for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"])
              if block.type == "triangle"]
    return np.concatenate([cells for cells, _ in chosen]), np.concatenate([tags for _, tags in chosen])


def heights(first: float) -> list[float]:
    return [first * growth**k for k in range(count)]


def by_netgen(surface: str, out: str, size: float) -> None:
    from netgen import meshing

    source = meshio.read(surface)
    triangles, tags = surface_of(source)
    mesh = meshing.Mesh(dim=3)
    number = {v: mesh.Add(meshing.MeshPoint(meshing.Pnt(*source.points[v]))) for v in np.unique(triangles)}
    faces = {tag: mesh.Add(meshing.FaceDescriptor(surfnr=k, domin=1, domout=0, bc=1))
             for k, tag in enumerate(np.unique(tags), 1)}
    edges = collections.defaultdict(list)
    for tag, corners in zip(tags, triangles):
        mesh.Add(meshing.Element2D(faces[tag], [number[v] for v in corners]))
        for i in range(3):
            a, b = corners[i], corners[(i + 1) % 3]
            edges[min(a, b), max(a, b)].append((tag, a, b))
    for sides in edges.values():  # an edge between two faces gets a segment for each of them
        if len(sides) == 2 and sides[0][0] != sides[1][0]:
            for (tag, a, b), (other, _, _) in (sides, sides[::-1]):
                mesh.Add(meshing.Element1D([number[a], number[b]], [faces[tag], faces[other]], faces[tag]))
    mesh.GenerateVolumeMesh(meshing.MeshingParameters(maxh=size))
    # Begin with the thickness of all layers together. Each further call inserts a thinner layer at the walls, into
    # the layer that the previous call made. In a single call with all heights, cells would overlap.
    for volume, top in enumerate(reversed(np.cumsum(heights(0.1 * size))), 1):
        mesh.BoundaryLayer(1, [float(top)], volume, [f"layer{volume}"])
    cells = collections.defaultdict(list)
    for element in mesh.Elements3D():
        cells[len(element.vertices)].append([v.nr - 1 for v in element.vertices])
    points = np.array([point.p for point in mesh.Points()])
    meshio.write(out, meshio.Mesh(points, [(kinds[n], np.array(some)) for n, some in cells.items()]))


def by_gmsh(surface: str, out: str, size: float) -> None:
    import gmsh

    source = meshio.read(surface)
    stl = out + ".stl"
    meshio.write(stl, meshio.Mesh(source.points, [("triangle", surface_of(source)[0])]))
    gmsh.initialize(["gmsh"])
    for option, value in (("General.NumThreads", 1), ("General.Terminal", 0), ("Mesh.MeshSizeMin", size),
                          ("Mesh.MeshSizeMax", size), ("Geometry.ExtrudeReturnLateralEntities", 0)):
        gmsh.option.setNumber(option, value)
    gmsh.merge(stl)
    gmsh.model.mesh.classifySurfaces(math.radians(40), True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    tops = np.cumsum(heights(0.1 * size))
    extruded = gmsh.model.geo.extrudeBoundaryLayer(gmsh.model.getEntities(2), [1] * count, list(-tops), True)
    loop = gmsh.model.geo.addSurfaceLoop([tag for dimension, tag in extruded if dimension == 2])
    gmsh.model.geo.addVolume([loop])
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.generate(3)
    # Take the cells of all volumes. They are of first order, so their nodes are their corners.
    nodes, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(nodes.max()) + 1, int)
    row[nodes] = np.arange(len(nodes))
    types, _, corners = gmsh.model.mesh.getElements(3)
    names = {4: ("tetra", 4), 5: ("hexahedron", 8), 6: ("wedge", 6), 7: ("pyramid", 5)}
    cells = [(names[kind][0], row[np.array(of).reshape(-1, names[kind][1])]) for kind, of in zip(types, corners)]
    meshio.write(out, meshio.Mesh(np.array(coordinates).reshape(-1, 3), cells))


@dataclass
class Row:
    shape: str
    mesher: str
    outcome: str = "meshed"
    tets: int = 0
    prisms: int = 0
    pyramids: int = 0
    covered: float = math.nan  # percent
    folded: int = -1           # -1: not measured
    volume: float = math.nan   # error in percent
    seconds: float = math.nan  # CPU seconds for the mesh and the layers


def signed(jacobians: np.ndarray) -> np.ndarray:
    """Returns the Jacobians of one kind of cell, with the opposite sign if most of them are negative. This is
    necessary because programs order corners differently."""
    return jacobians * (np.sign(np.median(jacobians)) or 1) if jacobians.size else jacobians


def sides_of(cells: dict[str, np.ndarray]) -> dict[frozenset, tuple[str, np.ndarray]]:
    """Returns the triangular faces of only one cell, each with the kind of its cell."""
    places = {"tetra": ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)), "wedge": ((0, 1, 2), (3, 4, 5)),
              "pyramid": ((0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))}
    found: dict[frozenset, tuple[str, np.ndarray]] = {}
    for kind, of in places.items():
        for place in of:
            for corners in cells[kind][:, place]:
                key = frozenset(corners.tolist())
                if found.pop(key, None) is None:
                    found[key] = kind, corners
    return found


def judge(row: Row, path: Path, area: float, volume: float) -> None:
    mesh = meshio.read(path)
    cells = {kind: np.concatenate([block.data for block in mesh.cells if block.type == kind] or [np.zeros((0, n), int)])
             for n, kind in kinds.items()}
    row.tets, row.prisms, row.pyramids = (len(cells[kind]) for kind in ("tetra", "wedge", "pyramid"))
    t, w, p = (mesh.points[cells[kind]] for kind in ("tetra", "wedge", "pyramid"))
    tets = signed(triple(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0], t[:, 3] - t[:, 0]))
    prisms, pyramids = signed(prism_jacobians(w)), signed(pyramid_jacobians(p))
    row.folded = int((tets <= 0).sum() + (prisms.min(axis=0) <= 0).sum() + (pyramids.min(axis=0) <= 0).sum())
    inside = tets.sum() / 6 + volume_of_prisms(w) + volume_of_pyramids(p)
    row.volume = 100 * (inside / volume - 1)
    covered = 0.0
    for kind, corners in sides_of(cells).values():
        if kind == "wedge":
            a, b, c = mesh.points[corners]
            covered += 0.5 * np.linalg.norm(np.cross(b - a, c - a))
    row.covered = 100 * covered / area


def volume_of_prisms(p: np.ndarray) -> float:
    """Returns the sum of the volumes. Integrates with 2 points along the height times 3 points in the triangle, which
    is exact for prisms."""
    found = 0.0
    for z in (0.5 - math.sqrt(1 / 12), 0.5 + math.sqrt(1 / 12)):
        for x, y in ((1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)):
            dx = (1 - z) * (p[:, 1] - p[:, 0]) + z * (p[:, 4] - p[:, 3])
            dy = (1 - z) * (p[:, 2] - p[:, 0]) + z * (p[:, 5] - p[:, 3])
            dz = (1 - x - y) * (p[:, 3] - p[:, 0]) + x * (p[:, 4] - p[:, 1]) + y * (p[:, 5] - p[:, 2])
            found += np.abs(triple(dx, dy, dz)).sum() / 12
    return found


def volume_of_pyramids(p: np.ndarray) -> float:
    """Returns the sum of the volumes: the mean over the two ways to divide each base into triangles."""
    halves = [np.abs(triple(p[:, j] - p[:, i], p[:, k] - p[:, i], p[:, 4] - p[:, i])).sum()
              for i, j, k in ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3))]
    return sum(halves) / 12


def area_and_volume(points: np.ndarray, triangles: np.ndarray) -> tuple[float, float]:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum(), abs(np.einsum("ij,ij->", np.cross(a, b), c)) / 6


def timed(command: list[str], limit: float, folder: Path) -> tuple[float, str]:
    """Runs a command in a folder, in which Netgen leaves a log. Returns the command's CPU seconds and, if it failed,
    the last line of its error output (otherwise an empty text)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        made = subprocess.run(command, capture_output=True, text=True, timeout=limit, cwd=folder)
    except subprocess.TimeoutExpired:
        return limit, "past the limit"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    words = (made.stderr.strip().splitlines() or [f"ends with {made.returncode}"])[-1]
    return seconds, "" if made.returncode in (0, 7) else words[:70]


def run(name: str, path: Path, arguments, folder: Path) -> list[Row]:
    surface, out = folder / "surface.msh", folder / "mesh.vtu"
    size = diagonal(path, folder, arguments.program) / arguments.size_share
    _, error = timed([arguments.program, str(path), "-o", str(surface), "--size", repr(size), "--quiet"],
                     arguments.limit, folder)
    if error:
        return [Row(name, "collarmesh", error)]
    source = meshio.read(surface)
    area, volume = area_and_volume(source.points, surface_of(source)[0])
    rows = []
    for mesher in meshers:
        row = Row(name, mesher)
        out.unlink(missing_ok=True)
        command = [sys.executable, str(Path(__file__).resolve()), "--work", mesher, str(surface), str(out), repr(size)]
        if mesher == "collarmesh":
            command = [arguments.program, str(path), "-o", str(out), "--size", repr(size), "--threads", "1", "--quiet",
                       "--layers", f"all:first={0.1 * size!r},growth={growth},count={count}"]
        row.seconds, error = timed(command, arguments.limit, folder)
        row.outcome = error or row.outcome
        if out.exists():
            judge(row, out, area, volume)
        rows.append(row)
        print(row, flush=True)
    return rows


def diagonal(path: Path, folder: Path, program: str) -> float:
    out = folder / "coarse.msh"
    subprocess.run([program, str(path), "-o", str(out), "--quiet"], capture_output=True)
    points = meshio.read(out).points
    return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))


def inputs_of(arguments, folder: Path) -> list[tuple[str, Path]]:
    found = [(title, path) for title, path in write_solids(folder)]
    for title, shape in shapes(Path(__file__).resolve().parents[2] / "resources" / "models"):
        path = shape
        if isinstance(shape, Surface):
            shape.write(folder / title.replace(" ", "_"))
            path = (folder / title.replace(" ", "_")).with_suffix(shape.suffix)
        found.append((title, path))
    found = [each for each in found if each[0] in shown]
    found += [(part.name, part.resolve()) for part in arguments.parts]
    return [each for each in found if not arguments.only or any(word in each[0] for word in arguments.only)]


def print_table(rows: list[Row]) -> None:
    text = [[row.shape, row.mesher, row.outcome, str(row.tets), str(row.prisms), str(row.pyramids),
             f"{row.covered:.1f}", str(row.folded), f"{row.volume:+.2f}", f"{row.seconds:.1f}"] for row in rows]
    print(table(["shape", "mesher", "outcome", "tets", "prisms", "pyramids",
          "covered %", "folded", "volume off %", "CPU s"], text))


def main() -> None:
    if sys.argv[1:2] == ["--work"]:
        mesher, surface, out, size = sys.argv[2:]
        {"Netgen": by_netgen, "Gmsh": by_gmsh}[mesher](surface, out, float(size))
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--parts", nargs="*", type=Path, default=[])
    parser.add_argument("--only", nargs="*", help="shapes with these words in their names")
    parser.add_argument("--size-share", type=float, default=20, help="the diagonal over the size")
    parser.add_argument("--limit", type=float, default=300, help="seconds for a mesh")
    arguments = parser.parse_args()
    arguments.program = str(Path(arguments.program).resolve())
    rows = []
    with tempfile.TemporaryDirectory() as name:
        for title, path in inputs_of(arguments, Path(name)):
            rows += run(title, path, arguments, Path(name))
    print_table(rows)


if __name__ == "__main__":
    main()
