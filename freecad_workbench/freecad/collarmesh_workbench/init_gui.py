"""Loaded by FreeCAD when its GUI starts."""

import FreeCADGui

from . import commands, fem_buttons, preferences

commands.register()
fem_buttons.install()
FreeCADGui.addPreferencePage(preferences.Page, "FEM")
