"""FreeCAD loads this when it starts, with and without its window."""

from . import compatibility, constraint_faces, contact_groups, groups, mesh_undo

constraint_faces.observe()
compatibility.write_constraints_on(constraint_faces.elements_of, contact_groups.elements_of)
groups.observe()
mesh_undo.observe()
