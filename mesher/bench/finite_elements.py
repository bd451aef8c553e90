#!/usr/bin/env python3
"""Solves a Poisson problem with a known solution, always by the same solver (`poisson`), on meshes by collarmesh,
TetGen and Gmsh with equal numbers of tets. The domains are the box, parts of a corpus and two shapes with acute angles.
Prints a Markdown table of the errors and of the condition number of the stiffness matrix."""

from __future__ import annotations

import re
import sys

from acute_inputs import AcuteInput
from comparison import comparison_options, surfaces
from meshers import Collarmesh, Gmsh, TetGen
from processes import ProgramFailed, pin_to_core, run
from tables import machine, si, table
from tuning import SizeCache, size_for

default_parts = ["cross.off", "joint.off", "spool.off"]
acute = [("wedge", (20, 1)), ("fan", (8, 0))]   # acute families of the tests, with their parameters
header = ["input", "mesher", "tets", "error in L2", "of the gradient", "condition number"]


def main() -> int:
    options = comparison_options(__doc__, default_parts)
    about = machine(options.build)
    pin_to_core(options.core)
    programs = options.build.resolve() / "bin"
    limit = options.time_limit
    meshers = [Collarmesh(programs / "collarmesh", limit, improve=0),
               Collarmesh(programs / "collarmesh", limit, improve=2), TetGen(limit, switches="g"), Gmsh(limit)]
    labels = ["collarmesh --improve 0", "collarmesh --improve 2", "TetGen", "Gmsh HXT"]
    cache = SizeCache()
    lines = []
    domains = surfaces(options) + [AcuteInput(programs / "acute_shape", *shape) for shape in acute]
    for surface in domains:
        for mesher, label in zip(meshers, labels):
            mesher.name = label   # the cache of sizes uses this name
            folder = cache.folder / f"{surface.name}_solved_{label.replace(' ', '_')}"
            folder.mkdir(exist_ok=True)
            try:
                mesher.prepare(surface, folder)
                mesh = mesher.mesh(surface, size_for(mesher, surface, options.tets, folder, cache), folder)
                solved = run([str(programs / "poisson"), mesher.mesh_file], folder, limit).output
            except ProgramFailed as failure:
                lines.append([surface.name, label, str(failure).splitlines()[0], "", "", ""])
                continue
            found = re.search(r"L2 (\S+) H1 (\S+) condition (\S+)", solved)
            lines.append([surface.name, label, si(mesh.tets), *(f"{float(x):.3g}" for x in found.groups())])
            print(*lines[-1], file=sys.stderr, flush=True)
    print(f"{about}. collarmesh {meshers[0].version()}, TetGen {meshers[2].version()}, Gmsh {meshers[3].version()}.\n")
    print(table(header, lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
