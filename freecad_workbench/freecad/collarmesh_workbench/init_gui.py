"""FreeCAD loads this when its GUI starts."""

import FreeCADGui

from . import (commands, constraint_faces_view, fem_buttons, layers_view, mesh_menu, meshing_process, preferences,
               size_view, translations, view_provider)

translations.load()  # must come before any text is used
commands.register()
view_provider.register()
size_view.register()
layers_view.register()
constraint_faces_view.register()
meshing_process.observe()
fem_buttons.install()
mesh_menu.install()
FreeCADGui.addPreferencePage(preferences.Page, "FEM")
