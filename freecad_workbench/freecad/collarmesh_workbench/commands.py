"""The commands behind the buttons."""

import os

import FreeCAD
import FreeCADGui
import ObjectsFem

from . import (compatibility, inputs, layer_objects, layers_panel, layers_view, mesh_menu, mesh_object, mesh_properties,
               new_mesh, other_panel, result_refinement, size_objects, take_over)
from .later import later
from .size_view import icon_of
from .translations import mark, translate
from .view_provider import ICON

MESH_COMMAND = "Collarmesh_MeshFromShape"
REFINEMENT_COMMAND = "Collarmesh_Refinement"
GROUP_COMMAND = "Collarmesh_Group"


def selected(condition):
    """Returns the selected object if exactly one is selected and it meets the condition, else None."""
    found = [each for each in FreeCADGui.Selection.getSelection() if condition(each)]
    return found[0] if len(found) == 1 else None


def selected_part():
    return selected(lambda each: inputs.can_be_meshed(each) and size_objects.kind_of(each) is None)


class Command:
    """The command of a button. `create` makes an object for the selection, which is then edited in its panel."""

    icon, menu_text, tool_tip = "", "", ""
    # Whether creation and first edit are a single undo step, which "Cancel" in the panel undoes.
    panel_commits = False

    def GetResources(self):
        return {"Pixmap": self.icon, "MenuText": self.text(), "ToolTip": self.tip()}

    def text(self):
        return translate("collarmesh", self.menu_text)

    def tip(self):
        return translate("collarmesh", self.tool_tip)

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and self.target() is not None

    def Activated(self):
        target = self.target()
        if target is None or other_panel.is_in_the_way():  # it may have been deleted since
            return
        document = target.Document
        document.openTransaction(self.text())
        try:
            obj = self.create(document, target)
        except BaseException:
            document.abortTransaction()
            raise
        if not self.panel_commits:
            document.commitTransaction()
        document.recompute()
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.getDocument(document.Name).setEdit(obj.Name)


class MeshFromShape(Command):
    icon = ICON
    menu_text = new_mesh.CREATION
    tool_tip = mark(
        "collarmesh",
        "Make a mesh of the selected solid, surface or wire, certified, with groups for its faces, or open "
        "the one that is there"
    )

    def target(self):
        return selected_part()

    def Activated(self):
        part = self.target()
        there = None if part is None else mesh_of(part)
        if there is None:
            super().Activated()
        else:
            FreeCADGui.Selection.clearSelection()
            mesh_menu.edit(there)

    def create(self, document, part):
        import FemGui

        obj = mesh_object.make(document, part)
        analysis = FemGui.getActiveAnalysis()
        if analysis is not None and analysis.Document is document:
            analysis.addObject(obj)
        if obj.ViewObject is not None:
            obj.ViewObject.Proxy.is_new = True
        return obj


def mesh_of(part):
    """Returns our mesh object for a part, from the active analysis or, if no analysis is active, from the part's
    document; None if there is none."""
    import FemGui

    analysis = FemGui.getActiveAnalysis()
    among = analysis.Group if analysis is not None else compatibility.mesh_objects(part.Document)
    return next((each for each in among if mesh_properties.is_ours(each)
                 and compatibility.meshed_object(each) is part), None)


class Refinement(Command):
    icon = os.path.join(os.path.dirname(ICON), "refinement.svg")
    menu_text = mark("collarmesh", "Refinement of a collarmesh mesh")
    tool_tip = mark(
        "collarmesh", "Ask for a smaller size on faces, edges or solids in the selected collarmesh mesh"
    )

    def target(self):
        return selected(mesh_properties.is_ours)

    def create(self, document, obj):
        return compatibility.make_refinement(document, obj)


class Group(Refinement):
    icon = os.path.join(os.path.dirname(ICON), "group.svg")
    menu_text = mark("collarmesh", "Group of a collarmesh mesh")
    tool_tip = mark(
        "collarmesh", "Name the elements on faces, edges or solids in the selected collarmesh mesh"
    )

    def create(self, document, obj):
        return ObjectsFem.makeMeshGroup(document, obj)


class Addition(Command):
    """A command that adds an object to the selected mesh, to the mesh of the selected part or, if nothing is selected,
    to the only mesh in the document."""

    panel_commits = True

    def Activated(self):
        # FreeCAD closes the transaction of a command when the command ends, so wait until then.
        later(super().Activated)

    def target(self):
        ours = [each for each in compatibility.mesh_objects(FreeCAD.ActiveDocument) if mesh_properties.is_ours(each)]
        chosen = FreeCADGui.Selection.getSelection()
        found = [each for each in ours if each in chosen or compatibility.meshed_object(each) in chosen]
        found = found or ([] if chosen else ours)
        return found[0] if len(found) == 1 else None


class Size(Addition):
    """A command that adds an object asking for a size in a sphere, a box or a cylinder, or near faces and edges."""

    def __init__(self, kind, menu_text, tool_tip):
        self.kind, self.icon, self.menu_text, self.tool_tip = kind, icon_of(kind), menu_text, tool_tip

    def create(self, _document, obj):
        picked = [
            (each.Object, (name,))
            for each in FreeCADGui.Selection.getSelectionEx()
            for name in each.SubElementNames
            if each.Object is compatibility.meshed_object(obj) and name.startswith(("Face", "Edge"))
        ]
        size = size_objects.make(obj, self.kind)
        if picked and self.kind == "Distance":
            size.References = picked
        elif picked:
            elements = [inputs.shape_of(part).getElement(name) for part, (name,) in picked]
            size.Placement.Base = middle_of(elements) - size.Proxy.middle(size)
        return size


def middle_of(elements):
    """Returns the middle of faces and edges: the mean of their centres of mass. For a hole it is a place on its axis.
    (The middle of a box would not do, because boxes around curved faces are larger than the faces.)"""
    extents = [each.Area if each.ShapeType == "Face" else each.Length for each in elements]
    total = sum(extents)
    middle = FreeCAD.Vector()
    for each, extent in zip(elements, extents):
        middle += each.CenterOfMass * (extent / total if total else 1 / len(elements))
    return middle


class Layers(Addition):
    """A command that adds boundary layers on the selected faces or, without any, on all outer faces."""

    icon = layers_view.ICON
    menu_text = mark("collarmesh", "Boundary layers")
    tool_tip = mark(
        "collarmesh", "Ask for thin layers of prisms along the selected faces, for flow, heat and currents at walls"
    )

    def create(self, _document, obj):
        layers = layer_objects.make(obj)
        part = compatibility.meshed_object(obj)
        layers.References = [(part, (name,)) for name in layers_panel.selected_names(part)]
        return layers


class TakeOver(Command):
    """A command that takes over mesh objects of other meshers. Netgen's objects need it, because they have no context
    menu of their own before FreeCAD 1.0."""

    icon = os.path.join(os.path.dirname(ICON), "take_over.svg")
    menu_text = mark("collarmesh", "Take over by collarmesh")
    tool_tip = mark(
        "collarmesh", "Make the selected mesh of Gmsh or Netgen one of collarmesh, with its sizes and groups"
    )

    def target(self):
        return selected(take_over.can_be_taken_over)

    def Activated(self):
        target = self.target()
        later(lambda: mesh_menu.take(target))  # see `Addition`


class RefineByResult(Command):
    """A command that opens the panel of a mesh at the fields that refine it by the result of its analysis. The mesh or
    the result may be selected; if only one mesh can be refined, nothing needs to be selected."""

    icon = os.path.join(os.path.dirname(ICON), "refine_by_result.svg")
    menu_text = mark("collarmesh", "Refine by result")
    tool_tip = mark(
        "collarmesh",
        "Make the mesh finer where the error of the stresses in a result is large, and coarser where it is small"
    )

    def target(self):
        found = [each for each in compatibility.mesh_objects(FreeCAD.ActiveDocument)
                 if mesh_properties.is_ours(each) and result_refinement.is_possible(each)]
        chosen = FreeCADGui.Selection.getSelection()
        if chosen:
            found = [each for each in found if each in chosen or result_refinement.result_of(each) in chosen]
        return found[0] if len(found) == 1 else None

    def Activated(self):
        target = self.target()
        if target is not None and not other_panel.is_in_the_way():
            FreeCADGui.Selection.clearSelection()
            mesh_menu.refine_by_result(target)


COMMANDS = {
    MESH_COMMAND: MeshFromShape(),
    REFINEMENT_COMMAND: Refinement(),
    "Collarmesh_SizeSphere": Size(
        "Sphere", mark("collarmesh", "Size in a sphere"),
        mark("collarmesh",
             "Ask for a smaller size in a sphere, which can be dragged in the 3D view; select faces to put it there")),
    "Collarmesh_SizeBox": Size(
        "Box", mark("collarmesh", "Size in a box"),
        mark("collarmesh", "Ask for a smaller size in a box, which can be dragged and turned in the 3D view")),
    "Collarmesh_SizeCylinder": Size(
        "Cylinder", mark("collarmesh", "Size in a cylinder"),
        mark("collarmesh", "Ask for a smaller size in a cylinder, which can be dragged and turned in the 3D view")),
    "Collarmesh_SizeDistance": Size(
        "Distance", mark("collarmesh", "Size near faces and edges"),
        mark("collarmesh", "Ask for a smaller size within a distance from the selected faces and edges")),
    "Collarmesh_Layers": Layers(),
    "Collarmesh_RefineByResult": RefineByResult(),
    GROUP_COMMAND: Group(),
    "Collarmesh_TakeOver": TakeOver(),
}


def register():
    for name, command in COMMANDS.items():
        FreeCADGui.addCommand(name, command)
