#!/usr/bin/env python3
"""Remeshes meshes of Gmsh (Delaunay, without its optimization), of Netgen, and of TetGen (with bounds on quality, and
without these, so with slivers and needles). Remeshing keeps the edge lengths. Each mesh is remeshed twice: with
--against and the input from which it was made, and without. Prints a Markdown table: whether every guarantee holds,
tets, smallest and largest dihedral angle, share of tets with an angle below 8 or above 150 degrees, CPU seconds."""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

from adaptation import dihedral_angles
from inputs import classified
from meshers import debian_version
from processes import Measured, ProgramFailed, run
from tables import machine, seconds, table

cad_suffixes = (".step", ".stp", ".brep")
guarantee_missed = 7
bounds = (8, 150)   # on dihedral angles, in degrees
header = ["input", "mesher", "follows", "tets", "angles", "beyond 8 to 150", "then: tets", "angles", "beyond 8 to 150",
          "certified", "CPU s"]


class Peers:
    """The programs that mesh an input at a size. The method of each peer returns the path of its mesh."""

    def __init__(self, program: Path, limit: float) -> None:
        self.program, self.limit = program, limit

    def gmsh(self, part: Path, folder: Path, size: float) -> Path:
        if part.suffix.lower() not in cad_suffixes:
            self.ours(["repair", str(part), "-o", "surface.stl", "-q"], folder)
            (folder / "model.geo").write_text(classified("surface.stl"))
            part = folder / "model.geo"
        run(["gmsh", "-3", "-nt", "1", "-algo", "del3d", "-clmin", f"{size:g}", "-clmax", f"{size:g}", "-setnumber",
             "Mesh.Optimize", "0", str(part), "-o", "gmsh.msh"], folder, self.limit)
        return folder / "gmsh.msh"

    def tetgen(self, part: Path, folder: Path, size: float, switches: str) -> Path:
        self.ours(["repair", str(part), "-o", "complex.smesh", "-q"], folder)
        run(["tetgen", f"{switches}g", "complex.smesh"], folder, self.limit)
        return folder / "complex.1.mesh"

    def tetgen_quality(self, part: Path, folder: Path, size: float) -> Path:
        return self.tetgen(part, folder, size, f"-pq1.414a{size ** 3 / 6 / 2 ** 0.5:.20f}")

    def tetgen_plain(self, part: Path, folder: Path, size: float) -> Path:
        return self.tetgen(part, folder, size, "-p")

    def netgen(self, part: Path, folder: Path, size: float) -> Path:
        script = str(Path(__file__).resolve().with_name("netgen_part.py"))
        if part.suffix.lower() not in cad_suffixes:
            raise ProgramFailed("")
        run([sys.executable, script, str(part), "netgen.msh", f"{size:g}"], folder, self.limit)
        return folder / "netgen.msh"

    def ours(self, arguments: list[str], folder: Path) -> Measured:
        return run([str(self.program), *arguments], folder, self.limit, accepted=(0, guarantee_missed))


def angles_of(path: Path) -> list[str]:
    mesh = meshio.read(path)
    tets = np.concatenate([cells.data for cells in mesh.cells if cells.type == "tetra"])
    with np.errstate(invalid="ignore", divide="ignore"):
        angles = np.nan_to_num(dihedral_angles(mesh.points[tets]))
    beyond = (angles[:, 0] < bounds[0]) | (angles[:, 1] > bounds[1])
    return [f"{len(tets)}", f"{angles[:, 0].min():.2g} to {angles[:, 1].max():.4g}", f"{100 * beyond.mean():.2f}%"]


def rows(peers: Peers, part: Path, size: float) -> list[list[str]]:
    found = []
    for name, make in (("Gmsh", peers.gmsh), ("Netgen", peers.netgen), ("TetGen -pq", peers.tetgen_quality),
                       ("TetGen -p", peers.tetgen_plain)):
        with tempfile.TemporaryDirectory() as text:
            folder = Path(text)
            try:
                mesh = make(part, folder, size)
            except ProgramFailed as failure:
                if str(failure):
                    found.append([part.name, name, "", "no mesh: " + str(failure).replace("|", " ")[:60], *[""] * 7])
                continue
            before = angles_of(mesh)
            # TetGen gets triangles, so its nodes on curves are on chords: compare with these triangles.
            shape = folder / "complex.smesh" if name.startswith("TetGen") else part
            for follows, against in (("input", ["--against", str(shape)]), ("itself", [])):
                found.append([part.name, name, follows, *before, *remeshed(peers, mesh, against, folder)])
                print(*found[-1], file=sys.stderr, flush=True)
    return found


def remeshed(peers: Peers, mesh: Path, against: list[str], folder: Path) -> list[str]:
    try:
        made = peers.ours(["remesh", str(mesh), "-o", "next.vtu", "--threads", "1", "-q", "--report", "report.json",
                           *against],
                          folder)
    except ProgramFailed as failure:
        return [str(failure).replace("|", " ")[:160], "", "", "no mesh", ""]
    findings = json.loads((folder / "report.json").read_text())["check"]["findings_total"]
    return [*angles_of(folder / "next.vtu"), f"{findings} findings" if findings else "yes", seconds(made.cpu)]


def diagonal(path: Path) -> float:
    points = meshio.read(path).points
    return float(np.linalg.norm(points.max(0) - points.min(0)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("inputs", nargs="+", type=Path)
    parser.add_argument("--limit", type=float, default=120, help="seconds for each program")
    options = parser.parse_args()
    peers = Peers(options.program.resolve(), options.limit)
    lines = []
    for part in options.inputs:
        with tempfile.TemporaryDirectory() as folder:
            peers.ours(["repair", str(part.resolve()), "-o", "surface.stl", "-q"], Path(folder))
            size = diagonal(Path(folder) / "surface.stl") / 20
        lines += rows(peers, part.resolve(), size)
    print(f"{machine(options.program.parents[1])}. " + ", ".join(
        f"{package} {debian_version(package)}" for package in ("gmsh", "tetgen", "python3-netgen")), "\n")
    print(table(header, lines))


if __name__ == "__main__":
    main()
