"""Solves a problem with dolfinx on files of collarmesh-mpi: mpirun -n 2 python3 poisson.py part_0 part_1

Each name stands for a mesh: part_0.xdmf and part_0_faces.xdmf. Solves -div grad u = f, with u given on every patch.
The exact solution is known: each further level divides the error by four (by eight in second order).
"""

import sys

import dolfinx.fem
import dolfinx.io
import numpy
import ufl
from mpi4py import MPI
from petsc4py import PETSc


def read(name, comm=MPI.COMM_WORLD):
    """Reads the mesh and the tags of its patches."""
    with dolfinx.io.XDMFFile(comm, f"{name}.xdmf", "r") as file:
        mesh = file.read_mesh(name="mesh")
    mesh.topology.create_connectivity(2, 3)
    with dolfinx.io.XDMFFile(comm, f"{name}_faces.xdmf", "r") as file:
        patches = file.read_meshtags(mesh, name="faces")
    return mesh, patches


def solve(mesh, patches):
    """Returns the L2 norms of the error and of the solution."""
    comm = mesh.comm
    x = mesh.geometry.x
    greatest = comm.allreduce(x.max(axis=0), lambda a, b: numpy.maximum(a, b))
    least = comm.allreduce(x.min(axis=0), lambda a, b: numpy.minimum(a, b))
    scale = float(numpy.linalg.norm(greatest - least)) / 2
    order = mesh.geometry.cmap.degree
    space = dolfinx.fem.FunctionSpace(mesh, ("Lagrange", order))
    at = ufl.SpatialCoordinate(mesh)
    exact = ufl.sin(at[0] / scale) * ufl.cos(at[1] / scale) * ufl.exp(at[2] / scale)
    given = dolfinx.fem.Function(space)
    given.interpolate(lambda p: numpy.sin(p[0] / scale) * numpy.cos(p[1] / scale) * numpy.exp(p[2] / scale))
    boundary = dolfinx.fem.dirichletbc(given, dolfinx.fem.locate_dofs_topological(space, 2, patches.indices))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    a = dolfinx.fem.form(ufl.dot(ufl.grad(u), ufl.grad(v)) * ufl.dx)
    b = dolfinx.fem.form(exact / scale**2 * v * ufl.dx)
    matrix = dolfinx.fem.petsc.assemble_matrix(a, [boundary])
    matrix.assemble()
    load = dolfinx.fem.petsc.assemble_vector(b)
    dolfinx.fem.petsc.apply_lifting(load, [a], [[boundary]])
    load.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    dolfinx.fem.petsc.set_bc(load, [boundary])
    solver = PETSc.KSP().create(comm)
    solver.setType("cg")
    solver.getPC().setType("jacobi")
    solver.setTolerances(rtol=1e-12, max_it=10000)
    solver.setOperators(matrix)
    found = dolfinx.fem.Function(space)
    solver.solve(load, found.vector)
    found.x.scatter_forward()
    integrals = [(found - exact) ** 2 * ufl.dx, found**2 * ufl.dx]
    own = [dolfinx.fem.assemble_scalar(dolfinx.fem.form(integral)) for integral in integrals]
    return [numpy.sqrt(comm.allreduce(part, MPI.SUM)) for part in own]


if __name__ == "__main__":
    for path in sys.argv[1:]:
        error, norm = solve(*read(path))
        if MPI.COMM_WORLD.rank == 0:
            print(f"{path}: error {error:.6e}, norm {norm:.10e}", flush=True)
