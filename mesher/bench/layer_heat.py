#!/usr/bin/python3
"""Computes a thermal boundary layer in dolfinx, on meshes with and without layers of cells. Prints a Markdown table of
the error against the number of unknowns.

    layer_heat.py PROGRAM MODELS [--depth 0.02]

The equation is -depth² Δu + u = 0 in a box of 3 x 2 x 1, with u = 1 on the floor and no flux through the other sides:
u falls to 1/e within the depth. The energy of the exact solution is 6 depth tanh(1 / depth). The energy of the
finite element solution exceeds it by the square of the error in the energy norm. Meshes without layers are of
two kinds: of one size everywhere, and with a smaller size at the floor."""

import argparse
import json
import math
import pathlib
import subprocess
import tempfile

import dolfinx
import dolfinx.fem.petsc
import dolfinx.io
import ufl
from mpi4py import MPI

from tables import table


def solve(path, depth):
    """Returns the number of unknowns and the energy of the finite element solution."""
    with dolfinx.io.XDMFFile(MPI.COMM_WORLD, str(path), "r") as file:
        domain = file.read_mesh(name="mesh")
    space = dolfinx.fem.FunctionSpace(domain, ("CG", 1))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    floor = dolfinx.fem.locate_dofs_geometrical(space, lambda x: abs(x[2]) < 1e-9)
    hot = dolfinx.fem.dirichletbc(1.0, floor, space)

    def form(a, b):
        return (depth**2 * ufl.dot(ufl.grad(a), ufl.grad(b)) + a * b) * ufl.dx

    problem = dolfinx.fem.petsc.LinearProblem(
        form(u, v), dolfinx.fem.Constant(domain, 0.0) * v * ufl.dx, [hot],
        petsc_options={"ksp_type": "cg", "pc_type": "jacobi", "ksp_rtol": 1e-10})
    heat = problem.solve()
    energy = dolfinx.fem.assemble_scalar(dolfinx.fem.form(form(heat, heat)))
    return space.dofmap.index_map.size_global, energy


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("--depth", type=float, default=0.02)
    arguments = parser.parse_args()
    depth = arguments.depth
    exact = 6 * depth * math.tanh(1 / depth)
    layers = f"2:first={0.25 * depth},growth=1.4,count=8"
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder) / "mesh.xdmf"
        for title, sizes, options in (
                ("one size", (0.3, 0.2, 0.13, 0.09), lambda size: ()),
                ("small at the floor", (0.1, 0.07, 0.05, 0.035), lambda size: ("--patch-size", f"2={size}")),
                ("layers", (0.5, 0.35, 0.25, 0.17), lambda size: ("--layers", layers, "--layers-tets"))):
            for size in sizes:
                general = 0.3 if title.startswith("small") else size
                subprocess.run([arguments.program, str(arguments.models / "box.off"), "-o", str(mesh), "--size",
                                str(general), "-q", *options(size)], check=True)
                unknowns, energy = solve(mesh, depth)
                error = math.sqrt(max(energy - exact, 0) / exact)
                rows.append([title, str(size), str(unknowns),
                            f"{100 * error:.1f}", f"{100 * (energy / exact - 1):+.1f}"])
                print(json.dumps(rows[-1]), flush=True)
    print(table(["mesh", "size", "unknowns", "error in the energy norm %", "heat flux off %"], rows))


if __name__ == "__main__":
    main()
