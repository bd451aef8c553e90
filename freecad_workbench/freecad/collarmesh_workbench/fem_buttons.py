"""The commands' places in FEM's toolbars and menus, beside FreeCAD's buttons for Gmsh."""

import FreeCADGui
from PySide import QtCore, QtGui

from . import compatibility
from .commands import COMMANDS, GROUP_COMMAND, MESH_COMMAND, REFINEMENT_COMMAND

BESIDE = {
    MESH_COMMAND: "FEM_MeshGmshFromShape",
    REFINEMENT_COMMAND: "FEM_MeshRegion",
    "Collarmesh_SizeSphere": REFINEMENT_COMMAND,
    "Collarmesh_SizeBox": "Collarmesh_SizeSphere",
    "Collarmesh_SizeCylinder": "Collarmesh_SizeBox",
    "Collarmesh_SizeDistance": "Collarmesh_SizeCylinder",
    "Collarmesh_Layers": "Collarmesh_SizeDistance",
    "Collarmesh_RefineByResult": "Collarmesh_Layers",
    GROUP_COMMAND: "FEM_MeshGroup",
    "Collarmesh_TakeOver": GROUP_COMMAND,
}
EVERY = 200  # milliseconds between checks


def freecads_place(command):
    """Returns the command of FreeCAD after which ours is put, directly or behind others of ours."""
    place = BESIDE[command]
    return freecads_place(place) if place in BESIDE else place


class Inserter(QtCore.QObject):
    """An object that puts our actions after FreeCAD's each time a workbench becomes active."""

    def __init__(self, window):
        super().__init__(window)
        self.window = window
        self.actions = [self._action(name, command) for name, command in COMMANDS.items()]
        window.workbenchActivated.connect(self.later)
        self._timer = QtCore.QTimer(self, interval=EVERY)
        self._timer.timeout.connect(self.grey)
        self._timer.start()
        self.later()

    def _action(self, name, command):
        action = QtGui.QAction(QtGui.QIcon(command.icon), command.text(), self)
        action.setObjectName(name)
        action.setToolTip(command.tip())
        action.triggered.connect(lambda: FreeCADGui.runCommand(name))
        return action

    def grey(self):
        """Disables commands that would do nothing now, as FreeCAD does with its own."""
        for action in self.actions:
            action.setEnabled(FreeCADGui.Command.get(action.objectName()).isActive())

    def later(self, _name=""):
        QtCore.QTimer.singleShot(0, self.insert)

    def insert(self):
        for bar in self.window.findChildren(QtGui.QToolBar) + self.window.findChildren(QtGui.QMenu):
            for action in self.actions:
                self._insert_into(bar, action)

    @staticmethod
    def _insert_into(bar, action):
        present = bar.actions()
        names = [each.objectName() for each in present]
        place = BESIDE[action.objectName()]
        if place not in names or action.objectName() in names:
            return
        after = names.index(place) + 1
        bar.insertAction(present[after] if after < len(present) else None, action)


def install():
    if not compatibility.add_to_bars({command: freecads_place(command) for command in BESIDE}):
        window = FreeCADGui.getMainWindow()
        window.collarmesh_inserter = Inserter(window)
