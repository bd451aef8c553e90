"""The command behind the button."""

import FreeCAD
import FreeCADGui

from . import mesh_object
from .view_provider import ICON

MESH_COMMAND = "Collarmesh_MeshFromShape"


def selected_part():
    """The one object with a shape that is selected, else None."""
    parts = [each for each in FreeCADGui.Selection.getSelection() if hasattr(each, "Shape")]
    return parts[0] if len(parts) == 1 else None


class MeshFromShape:
    def GetResources(self):
        return {
            "Pixmap": ICON,
            "MenuText": "FEM mesh from shape by collarmesh",
            "ToolTip": "Make a tetrahedral mesh of the selected solid, certified, with groups for its faces",
        }

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and selected_part() is not None

    def Activated(self):
        import FemGui

        part = selected_part()
        document = part.Document
        document.openTransaction("Mesh by collarmesh")
        obj = mesh_object.make(document, part)
        analysis = FemGui.getActiveAnalysis()
        if analysis is not None and analysis.Document is document:
            analysis.addObject(obj)
        document.commitTransaction()
        document.recompute()
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.getDocument(document.Name).setEdit(obj.Name)


def register():
    FreeCADGui.addCommand(MESH_COMMAND, MeshFromShape())
