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


__all__ = ["MesherError", "Settings", "find_program", "mesh"]
