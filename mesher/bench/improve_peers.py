#!/usr/bin/env python3
"""Compares the dihedral angles of our improved meshes with those by TetGen -O, by Gmsh with its own and with
Netgen's optimizer, and by CGAL's Mesh_3 with perturbation and exudation, on the same surfaces at the same
number of tetrahedra. Prints a Markdown table: smallest and largest dihedral angle, the first percentile and the
mean of the tets' smallest angles, the share of tets with an angle below 20 degrees, CPU seconds of the whole
program. This script computes the angles from the mesh files."""

from __future__ import annotations

import sys
from pathlib import Path

import meshio
import numpy as np

from comparison import comparison_options, surfaces
from inputs import Surface
from meshers import CgalMesh3, Collarmesh, Gmsh, TetGen
from processes import ProgramFailed, pin_to_core
from tables import machine, seconds, si, table
from tuning import SizeCache, size_for

default_parts = ["cross.off", "itemb.off", "joint.off", "spool.off", "handle.off", "fertility.off"]
header = ["input", "mesher", "tets", "smallest", "1st percentile", "mean", "largest", "below 20", "CPU s"]


def dihedral_angles(points: np.ndarray, tets: np.ndarray) -> np.ndarray:
    """Returns the dihedral angles in degrees: for each tet a row of six."""
    corners = points[tets]
    normals = []   # outward unit normal of the face opposite each corner
    for opposite in range(4):
        a, b, c = (corners[:, k] for k in range(4) if k != opposite)
        n = np.cross(b - a, c - a)
        outwards = np.sign(np.einsum("ij,ij->i", n, a - corners[:, opposite]))
        normals.append(n * outwards[:, None] / np.linalg.norm(n, axis=1)[:, None])
    angles = [180 - np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", normals[i], normals[j]), -1, 1)))
              for i in range(4) for j in range(i + 1, 4)]
    return np.stack(angles, axis=1)


def measures(mesh_file: Path) -> list[str]:
    mesh = meshio.read(mesh_file)
    tets = np.concatenate([cells.data for cells in mesh.cells if cells.type == "tetra"])
    angles = dihedral_angles(mesh.points, tets)
    smallest = angles.min(axis=1)
    return [f"{smallest.min():.3g}", f"{np.percentile(smallest, 1):.1f}", f"{smallest.mean():.1f}",
            f"{angles.max():.1f}", f"{100 * (smallest < 20).mean():.2f}%"]


def rows(surface: Surface, meshers, target: int, cache: SizeCache) -> list[list[str]]:
    found = []
    for label, mesher in meshers:
        folder = cache.folder / f"{surface.name}_improved_{label.replace(' ', '_').replace('/', '_')}"
        folder.mkdir(exist_ok=True)
        try:
            mesher.prepare(surface, folder)
            mesher.name = label   # the cache of sizes uses this name
            run = mesher.mesh(surface, size_for(mesher, surface, target, folder, cache), folder)
        except ProgramFailed as failure:
            found.append([surface.name, label, str(failure).splitlines()[0], *[""] * 6])
            continue
        far = "" if abs(run.tets / target - 1) < 0.15 else " *"
        found.append([surface.name, label, si(run.tets) + far, *measures(folder / mesher.mesh_file), seconds(run.cpu)])
        print(*found[-1], file=sys.stderr, flush=True)
    return found


def main() -> int:
    options = comparison_options(__doc__, default_parts)
    about = machine(options.build)
    pin_to_core(options.core)
    programs = options.build.resolve() / "bin"
    limit = options.time_limit
    ours = {level: Collarmesh(programs / "collarmesh", limit, improve=level) for level in (0, 2, 3)}
    cgal, tetgen = CgalMesh3(programs / "cgal_mesh", limit), TetGen(limit, switches="g")
    gmsh = Gmsh(limit, "hxt")
    meshers = [*((f"collarmesh --improve {level}", mesher) for level, mesher in ours.items()),
               ("TetGen", tetgen), ("TetGen -O7/7", TetGen(limit, switches="O7/7g")), ("Gmsh HXT", gmsh),
               ("Gmsh HXT -optimize", Gmsh(limit, "hxt", switches=("-optimize",))),
               ("Gmsh HXT -optimize_netgen", Gmsh(limit, "hxt", switches=("-optimize_netgen",))), ("CGAL Mesh_3", cgal)]
    versions = (f"collarmesh {ours[2].version()}, TetGen {tetgen.version()}, Gmsh {gmsh.version()}, "
                f"CGAL {cgal.version()}")
    cache = SizeCache()
    lines = []
    for surface in surfaces(options):
        lines += rows(surface, meshers, options.tets, cache)
    print(f"{about}. {versions}. * is further than 15% from {si(options.tets)} tets.\n")
    print(table(header, lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
