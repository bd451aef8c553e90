"""Loaded by FreeCAD when it starts, with and without its window."""

from . import constraint_faces, groups, mesh_undo

constraint_faces.observe()
groups.observe()
mesh_undo.observe()
