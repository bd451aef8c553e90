"""Makes meshes and tags of dolfinx, version 0.5 or later."""

import types
from typing import Any, Tuple

import numpy

from ._inputs import Array


def mesh_and_tags(
    comm: Any, points: Array, order: int, tets: Tuple[Array, Array], faces: Tuple[Array, Array]
) -> Tuple[Any, Any, Any]:
    """Returns the mesh and the tags of its cells and faces. tets, faces: (cells, tags), nodes in the order of
    dolfinx."""
    import dolfinx
    from mpi4py import MPI

    comm = MPI.COMM_WORLD if comm is None else comm
    here = slice(None) if comm.rank == 0 else slice(0)
    create = dolfinx.mesh.create_mesh
    element = _element(order)
    try:
        mesh = create(comm, tets[0][here], points[here], element)
    except TypeError:  # in version 0.10 and later
        mesh = create(comm, tets[0][here], element, points[here])
    return mesh, _tags(mesh, 3, *(part[here] for part in tets)), _tags(mesh, 2, *(part[here] for part in faces))


def _element(order: int) -> Any:
    import ufl

    try:
        from basix.ufl import element
    except ImportError:  # before version 0.7
        return ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell("tetrahedron", geometric_dimension=3), order))
    return ufl.Mesh(element("Lagrange", "tetrahedron", order, shape=(3,)))


def _tags(mesh: Any, dimension: int, cells: Array, tags: Array) -> Any:
    import dolfinx

    mesh.topology.create_entities(dimension)
    mesh.topology.create_connectivity(dimension, 0)
    mesh.topology.create_connectivity(dimension, 3)
    values = tags.astype(numpy.int32)
    distribute, of = dolfinx.io.distribute_entity_data, mesh
    if not isinstance(distribute, types.FunctionType):  # before version 0.9 it is a compiled function
        of = getattr(mesh, "_cpp_object", None) or mesh._mesh
    entities, local = distribute(of, dimension, numpy.ascontiguousarray(cells), values)
    if hasattr(dolfinx.graph, "adjacencylist"):
        adjacency = dolfinx.graph.adjacencylist(entities)
    else:
        adjacency = dolfinx.graph.create_adjacencylist(entities)
    found = dolfinx.mesh.meshtags_from_entities(mesh, dimension, adjacency, local)
    found.name = {3: "cell_tags", 2: "facet_tags"}[dimension]
    return found
