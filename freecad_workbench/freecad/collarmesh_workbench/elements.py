"""The elements of a mesh, those of its highest dimension: tetrahedra with the prisms of boundary layers, triangles, or
lines. Works without the GUI."""


def dimension(fem_mesh):
    """Returns the dimension of the elements, 3, 2 or 1; 0 for an empty mesh."""
    counts = (fem_mesh.VolumeCount, fem_mesh.FaceCount, fem_mesh.EdgeCount)
    return next((3 - i for i, count in enumerate(counts) if count > 0), 0)


def numbers(fem_mesh):
    """Returns the elements of highest dimension, which a solver gets."""
    return {0: (), 1: fem_mesh.Edges, 2: fem_mesh.Faces, 3: fem_mesh.Volumes}[dimension(fem_mesh)]


def is_there(fem_mesh):
    """Returns whether the mesh has nodes and elements."""
    return fem_mesh.NodeCount > 0 and dimension(fem_mesh) > 0


def order(fem_mesh):
    """Returns the order of the elements, 1 or 2; 1 for an empty mesh."""
    nodes = {3: (10, 15, 20), 2: (6, 8), 1: (3,)}  # a pyramid is a brick with equal nodes
    first = next(iter(numbers(fem_mesh)), None)
    return 2 if first is not None and len(fem_mesh.getElementNodes(first)) in nodes[dimension(fem_mesh)] else 1
