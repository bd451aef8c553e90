"""The commands behind the buttons."""

import os

import FreeCAD
import FreeCADGui

from . import compatibility, mesh_object
from .view_provider import ICON

MESH_COMMAND = "Collarmesh_MeshFromShape"
REFINEMENT_COMMAND = "Collarmesh_Refinement"
GROUP_COMMAND = "Collarmesh_Group"


def selected(condition):
    """The one selected object that the condition holds for, else None."""
    found = [each for each in FreeCADGui.Selection.getSelection() if condition(each)]
    return found[0] if len(found) == 1 else None


def selected_part():
    # From FreeCAD 1.0 on mesh objects have a `Shape`, too: a link.
    return selected(lambda each: hasattr(getattr(each, "Shape", None), "exportBrep"))


class Command:
    """A button; `create` makes an object for what is selected, which is then edited in its panel."""

    icon, menu_text, tool_tip = "", "", ""

    def GetResources(self):
        return {"Pixmap": self.icon, "MenuText": self.menu_text, "ToolTip": self.tool_tip}

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and self.target() is not None

    def Activated(self):
        target = self.target()
        document = target.Document
        document.openTransaction(self.menu_text)
        obj = self.create(document, target)
        document.commitTransaction()
        document.recompute()
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.getDocument(document.Name).setEdit(obj.Name)


class MeshFromShape(Command):
    icon = ICON
    menu_text = "FEM mesh from shape by collarmesh"
    tool_tip = "Make a tetrahedral mesh of the selected solid, certified, with groups for its faces"

    def target(self):
        return selected_part()

    def create(self, document, part):
        import FemGui

        obj = mesh_object.make(document, part)
        analysis = FemGui.getActiveAnalysis()
        if analysis is not None and analysis.Document is document:
            analysis.addObject(obj)
        return obj


class Refinement(Command):
    icon = os.path.join(os.path.dirname(ICON), "refinement.svg")
    menu_text = "Refinement of a collarmesh mesh"
    tool_tip = "Ask for a smaller size on faces, edges or solids in the selected collarmesh mesh"

    def target(self):
        return selected(mesh_object.is_ours)

    def create(self, document, obj):
        return compatibility.make_refinement(document, obj)


class Group(Refinement):
    icon = os.path.join(os.path.dirname(ICON), "group.svg")
    menu_text = "Group of a collarmesh mesh"
    tool_tip = "Name the elements on faces, edges or solids in the selected collarmesh mesh"

    def create(self, document, obj):
        return compatibility.make_group(document, obj)


COMMANDS = {MESH_COMMAND: MeshFromShape, REFINEMENT_COMMAND: Refinement, GROUP_COMMAND: Group}


def register():
    for name, command in COMMANDS.items():
        FreeCADGui.addCommand(name, command())
