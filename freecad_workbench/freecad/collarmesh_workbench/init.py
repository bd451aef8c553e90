"""Loaded by FreeCAD when it starts, with and without its window."""

from . import groups, mesh_undo

groups.observe()
mesh_undo.observe()
