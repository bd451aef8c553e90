"""Meshes of the collarmesh program in FreeCAD's FEM workbench.

For macros, with or without the GUI:

    from freecad import collarmesh_workbench
    mesh_object = collarmesh_workbench.mesh(doc.Body, size=2.5)

The GUI part is `init_gui`, which FreeCAD loads by itself.
"""

from .program import MesherError, Settings, find_program


def mesh(shape_or_object, document=None, analysis=None, name="FEMMeshCollarmesh", **options):
    """Mesh a shape, or an object that has one, and return the mesh object; wait until the mesh is made.

    A shape without an object becomes a `Part::Feature`. `document` defaults to the object's document, else to
    the active one, else to a new one. The mesh object is added to `analysis` if one is given.
    `options` are the fields of `Settings`: `size` (target edge length, mm), `size_min`, `radius_edge`, ...
    If it fails, raises MesherError, which says what is wrong and where, and adds nothing to the document.
    """
    from . import mesh_object

    return mesh_object.mesh(shape_or_object, document, analysis, name, Settings(**options))


def add_size(mesh_object, kind, size=0):
    """Ask for another size in a region of a mesh. Return the size object, whose properties set this region.

    `kind`: Sphere, Box, Cylinder (in the middle of the part at first) or Distance (from the faces and edges in its
    `References`, up to `Within`). `size`: target edge length, mm; 0: a quarter of the mesh's own. The size takes
    effect when the mesh is made again."""
    from . import size_objects

    return size_objects.make(mesh_object, kind, size)


def add_layers(mesh_object, *faces):
    """Ask for boundary layers on these faces of a mesh ("Face1", ...) or, without any, on all outer faces. Return the
    object of the layers, whose properties set their heights. The layers are made when the mesh is made again."""
    from . import compatibility, layer_objects

    layers = layer_objects.make(mesh_object)
    layers.References = [(compatibility.meshed_object(mesh_object), (face,)) for face in faces]
    return layers


def remesh(mesh_object):
    """Make the mesh of a mesh object again, wait, and return the program's report. If it fails, raises MesherError,
    which says what is wrong and where, and the object keeps its mesh."""
    from . import mesh_object as objects

    return objects.remesh(mesh_object)


def refine_by_result(mesh_object, elements=None, error=None):
    """Adapt the mesh to the error of the stresses in its analysis' result, finer where the error is large and coarser
    where it is small. Wait, and return the program's report.

    `elements`: the number of elements to aim for; or `error`: the error of the next result, relative to the energy norm
    (0 to 1). Edges become 0.25 to 2 times as long, so large changes take several steps, each with a result of its own.
    Raises MesherError if there is no result of this mesh, and like `remesh`."""
    from . import result_refinement

    return result_refinement.refine(mesh_object, elements, error)


def meshed_object(mesh_object):
    """Return the meshed object of a mesh object; FreeCAD's versions differ in the name of its property."""
    from . import compatibility

    return compatibility.meshed_object(mesh_object)


def references_to_groups(mesh_object, *names):
    """Return the `References` of a constraint on groups of faces. The mesh must have been made from a triangle mesh.
    `names` are names of its groups, such as "patch_2" or "Segment1"."""
    from . import constraint_faces

    return constraint_faces.references(mesh_object, names)


__all__ = ["MesherError", "Settings", "add_layers", "add_size", "find_program",
           "mesh", "meshed_object", "refine_by_result", "references_to_groups", "remesh"]
