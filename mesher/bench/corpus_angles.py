#!/usr/bin/env python3
"""Measures dihedral angles in meshes of a corpus' files at levels 2 (default) and 3 of improvement: of all tets; of
the tets "away", which share no vertex with a thin tet or with a tet of a collar; and of the tets away that have a
corner in the interior and therefore do not span a thin wall.

Prints a Markdown table. This script computes the angles from the mesh files."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

from improve_peers import dihedral_angles
from meshers import Collarmesh
from processes import ProgramFailed, pin_to_core, run
from tables import machine, seconds, table


def on_boundary(tets: np.ndarray, points: int) -> np.ndarray:
    """Returns an array that says for each point whether it is a corner of a face of only one tet."""
    sides = np.sort(np.concatenate([np.delete(tets, corner, axis=1) for corner in range(4)]), axis=1)
    outer, uses = np.unique(sides, axis=0, return_counts=True)
    on = np.zeros(points, bool)
    on[outer[uses == 1].ravel()] = True
    return on


def angles(mesh_file: Path) -> list[str]:
    """Returns columns: the numbers of tets and of thin tets; the smallest and the largest angle of all tets; then the
    number, the smallest and the largest angle of the tets that touch no thin tet and no collar; and these three values
    again, of the ones of these tets that have a corner in the interior."""
    mesh = meshio.read(mesh_file)
    blocks = [i for i, cells in enumerate(mesh.cells) if cells.type == "tetra"]
    tets = np.concatenate([mesh.cells[i].data for i in blocks])
    thin, collar = (np.concatenate([mesh.cell_data[name][i] for i in blocks]) > 0 if name in mesh.cell_data
                    else np.zeros(len(tets), bool) for name in ("thin", "collar"))
    of_tets = dihedral_angles(mesh.points, tets)
    touched = np.zeros(len(mesh.points), bool)
    touched[tets[thin | collar].ravel()] = True
    away = ~touched[tets].any(axis=1)
    found = [str(len(tets)), str(int(thin.sum())), f"{of_tets.min():.1f}", f"{of_tets.max():.1f}"]
    for chosen in (away, away & ~on_boundary(tets, len(mesh.points))[tets].all(axis=1)):
        found += [str(int(chosen.sum()))]
        found += [f"{of_tets[chosen].min():.1f}", f"{of_tets[chosen].max():.1f}"] if chosen.any() else ["", ""]
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--corpus", type=Path, default=os.environ.get("COLLARMESH_CORPUS"))
    parser.add_argument("--levels", type=int, nargs="+", default=[2, 3])
    parser.add_argument("--limit", type=float, default=120, help="seconds for one run")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    if options.corpus is None:
        parser.error("name a corpus with --corpus or $COLLARMESH_CORPUS")
    about = machine(options.build)
    pin_to_core(options.core)
    program = (options.build / "bin" / "collarmesh").resolve()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(Path(options.corpus).resolve().iterdir()):
            if path.suffix == ".tsv":
                continue
            for level in options.levels:
                command = [str(program), str(path), "-o", "mesh.vtu", "--improve", str(level), "--threads", "1",
                           "--progress", "none", "-q"]
                try:
                    measured = run(command, Path(folder), options.limit, accepted=(0, 7))
                except ProgramFailed as failure:
                    print(path.name, failure, file=sys.stderr, flush=True)
                    continue
                told = " (7)" if measured.exit_code == 7 else ""
                rows.append([path.name + told, str(level), *angles(Path(folder) / "mesh.vtu"), seconds(measured.cpu)])
                print(*rows[-1], file=sys.stderr, flush=True)
    print(f"{about}. collarmesh {Collarmesh(program, 0).version()}.\n")
    print(table(["input", "level", "tets", "thin", "smallest", "largest", "tets away from thin ones", "smallest",
                 "largest", "with a corner inside", "smallest", "largest", "CPU s"], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
