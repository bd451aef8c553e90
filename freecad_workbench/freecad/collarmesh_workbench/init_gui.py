"""Loaded by FreeCAD when its GUI starts."""

import FreeCADGui

from . import commands, fem_buttons, mesh_menu, preferences, translations

translations.load()  # before there are texts
commands.register()
fem_buttons.install()
mesh_menu.install()
FreeCADGui.addPreferencePage(preferences.Page, "FEM")
