"""Loaded by FreeCAD when its GUI starts."""

from . import commands, fem_buttons

commands.register()
fem_buttons.install()
