#!/usr/bin/python3
"""A Poisson problem in dolfinx on what the program writes as .xdmf, on 1 and 2 processes, order 1 and 2.

    dolfinx_test.py PROGRAM MODELS   (Debian's python3-dolfinx)
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

# Laplace's equation on a box, with u = 1 + 2 x + 3 y given on tagged sides: elements represent this solution
# exactly. Errors, volumes and areas are summed over the processes.
SOLVER = """
import sys
import numpy
import ufl
import dolfinx.fem.petsc
from dolfinx import fem
from dolfinx.io import XDMFFile
from mpi4py import MPI
from petsc4py.PETSc import ScalarType

name = sys.argv[1]
with XDMFFile(MPI.COMM_WORLD, f"{name}.xdmf", "r") as file:
    domain = file.read_mesh(name="mesh")
    regions = file.read_meshtags(domain, name="mesh")
domain.topology.create_connectivity(2, 3)
with XDMFFile(MPI.COMM_WORLD, f"{name}_faces.xdmf", "r") as file:
    sides = file.read_meshtags(domain, name="faces")

def total(form):
    return domain.comm.allreduce(fem.assemble_scalar(fem.form(form)), MPI.SUM)

dx = ufl.Measure("dx", domain, subdomain_data=regions)
ds = ufl.Measure("ds", domain, subdomain_data=sides)
one = fem.Constant(domain, ScalarType(1))
V = fem.FunctionSpace(domain, ("CG", 1))
exact = fem.Function(V)
exact.interpolate(lambda x: 1 + 2 * x[0] + 3 * x[1])
tags = numpy.array([1, 2, 3, 4, 5, 6])
bc = fem.dirichletbc(exact, fem.locate_dofs_topological(V, 2, sides.indices[numpy.isin(sides.values, tags)]))
u, v = ufl.TrialFunction(V), ufl.TestFunction(V)
problem = fem.petsc.LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * dx, \
fem.Constant(domain, ScalarType(0)) * v * dx,
                                  bcs=[bc], petsc_options={"ksp_type": "preonly", "pc_type": "lu"})
error = total((problem.solve() - exact) ** 2 * dx) ** 0.5
volume, areas = total(one * dx(1)), [total(one * ds(int(tag))) for tag in tags]
if domain.comm.rank == 0:
    assert error < 1e-10, error
    assert abs(volume - 6) < 1e-11, volume
    assert numpy.allclose(sorted(areas), [2, 2, 3, 3, 6, 6], atol=1e-11), areas
    print("solved", volume, areas)
"""


def main():
    program, models = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if subprocess.run([sys.executable, "-c", "import dolfinx"], capture_output=True).returncode:
        print("python3-dolfinx is not installed")
        return 77
    mpirun = shutil.which("mpirun")
    # The tags are still the first attribute, which dolfinx reads.
    divided = ["--partitions", "3"] if (program.parents[1] / "lib/collarmesh/collarmesh_scotch.so").exists() else []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "solve.py").write_text(SOLVER)
        for order in (1, 2):
            subprocess.run([program, models / "box.off", "-o", folder / f"box{order}.xdmf", "--size", "0.3", "--order",
                            str(order), "--quiet", *(divided if order == 1 else [])], check=True)
            for processes in (1, 2):
                run = subprocess.run([mpirun, "--allow-run-as-root", "--oversubscribe", "-n", str(processes),
                                      sys.executable, "solve.py", f"box{order}"], cwd=folder, capture_output=True,
                                     text=True)
                if run.returncode != 0 or "solved" not in run.stdout:
                    raise SystemExit(f"order {order}, {processes} processes:\n{run.stdout}\n{run.stderr}")
                print(f"order {order}, {processes} processes: {run.stdout.strip()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
