#!/usr/bin/env python3
"""Solves Poisson problems with known solutions, always by the same solver (`poisson`), on thin domains, in which one
layer of tetrahedra spans the thickness: a plate (10 by 10 by 0.2), a shell (a tube of radius 5, 10 high and 0.2 thick)
and a wedge of 5 degrees. collarmesh and Gmsh (HXT) mesh these CAD shapes at the same sizes, with elements of first and
of second order. Values are given only at the ends of a domain; the solution is constant across the thickness. The
error of the gradient is proportional to unknowns^(-order / 2), as on a surface. The column "per unknown" has the error
divided by this power, so that meshes with different numbers of tets can be compared. Prints a Markdown table."""

from __future__ import annotations

import argparse
import math
import re
import sys
import tempfile
from pathlib import Path

import gmsh

from meshers import Collarmesh, debian_version
from processes import ProgramFailed, pin_to_core, run
from tables import machine, si, table

sizes = {"plate": (1, 0.5, 0.25), "shell": (1, 0.5, 0.25), "wedge": (1, 0.5, 0.25)}
header = ["domain", "size", "order", "mesher", "tets", "unknowns", "error in L2", "of the gradient",
          "per unknown / Gmsh's", "condition number"]


def write_shapes(folder: Path) -> None:
    """Writes plate.brep, shell.brep and wedge.brep."""
    cad = gmsh.model.occ
    for name in sizes:
        gmsh.model.add(name)
        if name == "plate":
            cad.addBox(0, 0, 0, 10, 10, 0.2)
        elif name == "shell":
            cad.cut([(3, cad.addCylinder(0, 0, 0, 0, 0, 10, 5.1))], [(3, cad.addCylinder(0, 0, 0, 0, 0, 10, 4.9))])
        else:
            half = 10 * math.tan(math.radians(2.5))
            corners = [cad.addPoint(*p, 0) for p in ((0, 0), (10, -half), (10, half))]
            sides = [cad.addLine(corners[i], corners[(i + 1) % 3]) for i in range(3)]
            cad.extrude([(2, cad.addPlaneSurface([cad.addCurveLoop(sides)]))], 0, 0, 4)
        cad.synchronize()
        gmsh.write(str(folder / f"{name}.brep"))
        gmsh.model.remove()


def mesh_by_gmsh(shape: Path, size: float, order: int, out: Path) -> None:
    gmsh.model.add("part")
    try:
        gmsh.model.occ.importShapes(str(shape))
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.option.setNumber("Mesh.Algorithm3D", 10)   # HXT
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(out))
    except Exception as error:   # Gmsh's module has no exception type of its own
        raise ProgramFailed(str(error)) from error
    finally:
        gmsh.model.remove()


def mesh_by_us(program: Path, shape: Path, size: float, order: int, out: Path, limit: float) -> None:
    run([str(program), str(shape), "-o", str(out), "--size", str(size), "--order", str(order), "--threads", "1",
         "--progress", "none", "-q"], out.parent, limit)


def solve(program: Path, mesh: Path, domain: str, limit: float) -> dict[str, float]:
    said = run([str(program), str(mesh), domain], mesh.parent, limit).output
    found = re.search(r"L2 (\S+) H1 (\S+) condition (\S+) unknowns (\d+) tets (\d+)", said)
    return dict(zip(("value", "gradient", "condition", "unknowns", "tets"), map(float, found.groups())))


def lines_of(domain: str, size: float, order: int, folder: Path, programs: Path, limit: float) -> list[list[str]]:
    shape, mesh = folder / f"{domain}.brep", folder / "mesh.msh"
    lines, gmsh_per_unknown = [], math.nan
    for mesher in ("Gmsh", "collarmesh"):
        label = [domain, f"{size:g}", str(order), mesher]
        try:
            if mesher == "Gmsh":
                mesh_by_gmsh(shape, size, order, mesh)
            else:
                mesh_by_us(programs / "collarmesh", shape, size, order, mesh, limit)
            found = solve(programs / "poisson", mesh, domain, limit)
        except ProgramFailed as failure:
            lines.append([*label, str(failure), *[""] * 5])
            continue
        per_unknown = found["gradient"] * found["unknowns"] ** (order / 2)
        if mesher == "Gmsh":
            gmsh_per_unknown = per_unknown
        lines.append([*label, si(found["tets"]), si(found["unknowns"]), f"{found['value']:.3g}",
                      f"{found['gradient']:.3g}", f"{per_unknown / gmsh_per_unknown:.2f}", f"{found['condition']:.3g}"])
        print(*lines[-1], file=sys.stderr, flush=True)
    return lines


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--time-limit", type=float, default=300, help="seconds for one run of one program")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    programs = options.build.resolve() / "bin"
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    lines = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        write_shapes(folder)
        for domain, steps in sizes.items():
            for size in steps:
                for order in (1, 2):
                    lines += lines_of(domain, size, order, folder, programs, options.time_limit)
    gmsh.finalize()
    print(f"{about}. collarmesh {Collarmesh(programs / 'collarmesh', 0).version()}, Gmsh {debian_version('gmsh')}.\n")
    print(table(header, lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
