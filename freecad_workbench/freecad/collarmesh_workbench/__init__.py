"""Meshes of the collarmesh program in FreeCAD's FEM workbench.

For macros, with or without the GUI:

    from freecad import collarmesh_workbench
    mesh_object = collarmesh_workbench.mesh(doc.Body, size=2.5)

The GUI part is `init_gui`, which FreeCAD loads by itself.
"""

from .program import MesherError, Settings, find_program


def mesh(shape_or_object, document=None, analysis=None, name="FEMMeshCollarmesh", **options):
    """Mesh a shape, or an object that has one, and return the mesh object; blocks until it is there.

    A shape without an object becomes a `Part::Feature`. `document` defaults to the object's or the active
    one, else a new one is made; the mesh object is added to `analysis` if one is given.
    `options` are the fields of `Settings`: `size` (target edge length, mm), `size_min`, `radius_edge`, ...
    Raises MesherError, with what is wrong and where, and adds nothing then.
    """
    from . import mesh_object

    return mesh_object.mesh(shape_or_object, document, analysis, name, Settings(**options))


def add_size(mesh_object, kind, size=0):
    """Ask for another size in a part of a mesh, and return the object for it, whose properties say where.

    `kind`: Sphere, Box, Cylinder (in the middle of the part at first) or Distance (from the faces and edges in its
    `References`, up to `Within`). `size`: target edge length, mm; 0: a quarter of the mesh's own. It takes effect
    when the mesh is made again."""
    from . import size_objects

    return size_objects.make(mesh_object, kind, size)


def add_layers(mesh_object, *faces):
    """Ask for boundary layers on these faces of a mesh, "Face1", ..., or on all outer faces, and return the object for
    them, whose properties say how high they are. They are made when the mesh is made again."""
    from . import compatibility, layer_objects

    layers = layer_objects.make(mesh_object)
    layers.References = [(compatibility.meshed_object(mesh_object), (face,)) for face in faces]
    return layers


def remesh(mesh_object):
    """Make the mesh of a mesh object anew and wait; returns the program's report. Raises MesherError, with what is
    wrong and where; the object keeps its mesh then."""
    from . import mesh_object as objects

    return objects.remesh(mesh_object)


def refine_by_result(mesh_object, elements=None, error=None):
    """Adapt the mesh to the error of the stresses in its analysis' result, finer where the error is large and coarser
    where it is small, and wait; returns the program's report.

    `elements`: the number of elements to aim for; or `error`: the error of the next result, relative to the energy norm
    (0 to 1). Edges become 0.25 to 2 times as long, so large changes take several steps, each with a result of its own.
    Raises MesherError if there is no result of this mesh, and as `remesh`."""
    from . import result_refinement

    return result_refinement.refine(mesh_object, elements, error)


def meshed_object(mesh_object):
    """Return the meshed object of a mesh object; FreeCAD's versions differ in the name of its property."""
    from . import compatibility

    return compatibility.meshed_object(mesh_object)


def references_to_groups(mesh_object, *names):
    """Return the `References` of constraints on groups of faces of a triangle mesh's mesh; the names are those of the
    groups, as in "patch_2" and "Segment1"."""
    from . import constraint_faces

    return constraint_faces.references(mesh_object, names)


__all__ = ["MesherError", "Settings", "add_layers", "add_size", "find_program",
           "mesh", "meshed_object", "refine_by_result", "references_to_groups", "remesh"]
