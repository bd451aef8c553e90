"""mpirun -n P python3 load.py MESH.h5: load a mesh of collarmesh-mpi and print each rank's part of it."""

import sys

import petsc4py

petsc4py.init(sys.argv[:1])
from petsc4py import PETSc  # noqa: E402


def load(path, comm=PETSc.COMM_WORLD):
    """Loads the DMPlex of a file, distributed, with its labels."""
    plex = PETSc.DMPlex().create(comm=comm)
    plex.setName("mesh")
    viewer = PETSc.ViewerHDF5().create(path, mode=PETSc.Viewer.Mode.READ, comm=comm)
    viewer.pushFormat(PETSc.Viewer.Format.HDF5_PETSC)
    order = plex.topologyLoad(viewer)
    plex.coordinatesLoad(viewer, order)
    plex.labelsLoad(viewer, order)
    viewer.popFormat()
    viewer.destroy()
    plex.distribute()
    return plex


if __name__ == "__main__":
    mesh = load(sys.argv[1])
    first, end = mesh.getHeightStratum(0)
    labels = {name: mesh.getLabelSize(name) for name in ("region", "patch", "curve")}
    print(f"rank {mesh.comm.rank}: {end - first} tets, {labels}", flush=True)
