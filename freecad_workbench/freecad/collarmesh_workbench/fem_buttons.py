"""The command's place in FEM's toolbar and menu, beside FreeCAD's Gmsh button."""

import FreeCADGui
from PySide import QtCore, QtGui

from .commands import MESH_COMMAND
from .view_provider import ICON

BESIDE = "FEM_MeshGmshFromShape"


class Manipulator:
    """FreeCAD 1.0 and later ask it when a workbench builds its bars."""

    def modifyToolBars(self):
        return [{"insert": MESH_COMMAND, "toolItem": BESIDE}]

    def modifyMenuBar(self):
        return [{"insert": MESH_COMMAND, "menuItem": BESIDE, "after": ""}]


class Inserter(QtCore.QObject):
    """Earlier ones: each time a workbench has become active, look for the action and put ours after it."""

    def __init__(self, window):
        super().__init__(window)
        self.window = window
        self.action = QtGui.QAction(QtGui.QIcon(ICON), "FEM mesh from shape by collarmesh", self)
        self.action.setObjectName(MESH_COMMAND)
        self.action.triggered.connect(lambda: FreeCADGui.runCommand(MESH_COMMAND))
        window.workbenchActivated.connect(self.later)
        self.later()

    def later(self, _name=""):
        QtCore.QTimer.singleShot(0, self.insert)

    def insert(self):
        bars = self.window.findChildren(QtGui.QToolBar) + self.window.findChildren(QtGui.QMenu)
        for bar in bars:
            actions = bar.actions()
            names = [action.objectName() for action in actions]
            if BESIDE not in names or MESH_COMMAND in names:
                continue
            after = names.index(BESIDE) + 1
            bar.insertAction(actions[after] if after < len(actions) else None, self.action)


def install():
    if hasattr(FreeCADGui, "addWorkbenchManipulator"):
        FreeCADGui.addWorkbenchManipulator(Manipulator())
    else:
        window = FreeCADGui.getMainWindow()
        window.collarmesh_inserter = Inserter(window)
