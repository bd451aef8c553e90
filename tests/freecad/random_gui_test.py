"""Random sequences of clicks, closes, undos and changes of the document: FreeCAD stays, and nothing raises.
Run by run.py --gui.
The environment variables COLLARMESH_SEQUENCES (their number) and COLLARMESH_SEED (seed of the first one; each
further one adds 1) repeat a printed sequence. `.ci/run --long` runs 200."""

import os
import random
import sys
import tempfile

import FreeCAD
import FreeCADGui
import Mesh
import ObjectsFem
import Part
from PySide import QtCore, QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import (  # noqa: E402
    commands, constraint_faces, constraint_faces_view, elements, mesh_menu, mesh_properties, size_objects, take_over)

SEQUENCES = int(os.environ.get("COLLARMESH_SEQUENCES", 8))
SEED = int(os.environ.get("COLLARMESH_SEED", 1))
STEPS = 16
SIZES = ("4 mm", "2.5 mm", "7 mm", "0.4 mm", "0", "-1 mm", "", "3 mm + 1 mm", "nonsense")


class Sequence:
    """A sequence of steps. Methods whose names have no underscore are steps; each does nothing if it makes no
    sense."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.steps = [name for name in sorted(vars(Sequence)) if not name.startswith("_")]

    async def _run(self):
        await self.new_document()
        await self.mesh_button()
        for _ in range(STEPS):
            name = self.random.choice(self.steps)
            print("  ", name, flush=True)
            await getattr(self, name)()
            await w.pause(self.random.choice((0, 0, 20, 100, 500)))
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)
        await w.pause(50)
        for box in w.window.findChildren(QtGui.QMessageBox):
            box.close()
        await w.wait_until(lambda: w.find("panel") is None and w.find("size_panel") is None, "the panels' end", 5)

    def _any(self, condition):
        """Returns an object of the active document that meets the condition."""
        document = FreeCAD.ActiveDocument
        found = [each for each in document.Objects if condition(each)] if document else []
        return self.random.choice(found) if found else None

    def _part(self):
        return self._any(lambda each: each.TypeId in ("Part::Box", "Part::Cut", "Part::Feature", "Mesh::Feature"))

    async def triangles(self):
        if FreeCAD.ActiveDocument:
            part = FreeCAD.ActiveDocument.addObject("Mesh::Feature", "Triangles")
            part.Mesh = self.random.choice((Mesh.createBox(10, 8, 6), Mesh.createSphere(5, 20)))

    async def faces_for_constraints(self):
        """Makes faces for constraints by the panel or the menu, puts a constraint on some of them, or removes
        them."""
        await self._click("constraint_faces")
        obj = self._any(lambda each: mesh_properties.is_ours(each) and constraint_faces.can_be_made(each))
        if obj is None:
            return
        constraint_faces_view.show(obj)
        faces, document = constraint_faces.of(obj), obj.Document
        document.openTransaction("Constraint")
        if self.random.random() < 0.2:
            document.removeObject(faces.Name)
        else:
            names = [f"Face{self.random.randrange(len(faces.Groups)) + 1}" for _ in range(3)]
            ObjectsFem.makeConstraintFixed(document).References = [(faces, names)]
        document.commitTransaction()

    def _mesh(self):
        return self._any(mesh_properties.is_ours)

    async def _click(self, *names):
        """Clicks one of our buttons, if it is there and enabled."""
        buttons = [w.find(name) for name in names]
        buttons = [each for each in buttons if each is not None and each.isVisible() and each.isEnabled()]
        if buttons:
            await w.click(self.random.choice(buttons))

    async def new_document(self):
        document = FreeCAD.newDocument("random")
        document.UndoMode = 1
        box = document.addObject("Part::Box", "Box")
        box.Length, box.Width, box.Height = 40, 30, 5
        hole = document.addObject("Part::Cylinder", "Hole")
        hole.Radius, hole.Height = 6, 10
        hole.Placement.Base = FreeCAD.Vector(20, 15, -1)
        part = document.addObject("Part::Cut", "Plate")
        part.Base, part.Tool = box, hole
        document.recompute()
        if self.random.random() < 0.3:
            await self.another_part()

    async def another_part(self):
        """Makes solids that touch, or an open surface."""
        if FreeCAD.ActiveDocument:
            box = Part.makeBox(10, 10, 10)
            part = FreeCAD.ActiveDocument.addObject("Part::Feature", "Another")
            both = Part.makeCompound([box, Part.makeBox(10, 10, 10, FreeCAD.Vector(10, 0, 0))])
            part.Shape = self.random.choice((both, Part.makeShell(box.Faces[:5])))

    async def close_document(self):
        documents = list(FreeCAD.listDocuments())
        if documents:
            FreeCAD.closeDocument(self.random.choice(documents))

    async def save_document(self):
        if FreeCAD.ActiveDocument:
            with tempfile.TemporaryDirectory() as folder:
                FreeCAD.ActiveDocument.saveCopy(os.path.join(folder, "random.FCStd"))

    async def mesh_button(self):
        await self._command(commands.MESH_COMMAND, self._part())

    async def size_button(self):
        await self._command("Collarmesh_Size" + self.random.choice(list(size_objects.KINDS)), self._mesh())

    async def _command(self, command, target):
        FreeCADGui.Selection.clearSelection()
        if target is not None:
            FreeCADGui.Selection.addSelection(target)
        await w.pause(300)  # until buttons have become grey or not
        for button in w.buttons_of(command)[:1]:
            await w.click(button)

    async def open_by_double_click(self):
        obj = self._any(lambda each: mesh_properties.is_ours(each) or size_objects.kind_of(each))
        if obj is not None:
            obj.ViewObject.doubleClicked()

    async def edit_again(self):
        obj = self._mesh()
        if obj is not None:
            mesh_menu.edit(obj)

    async def mesh_again(self):
        obj = self._mesh()
        if obj is not None:
            mesh_menu.mesh_again(obj)

    async def reset_edit(self):
        if FreeCADGui.ActiveDocument:
            FreeCADGui.ActiveDocument.resetEdit()

    async def button_below_the_panel(self):
        boxes = [box for box in w.window.findChildren(QtGui.QDialogButtonBox) if box.isVisible()]
        if boxes:
            await w.click(self.random.choice(boxes[0].buttons()))

    async def button_of_the_panel(self):
        await self._click("run", "cancel", "report", "advanced", "size_add", "size_remove")

    async def keep_apart(self):
        await self._click("KeepApart")

    async def show_sizes(self):
        await self._click("show_sizes")

    async def run(self):
        await self._click("run")

    async def type_a_size(self):
        for name in ("CharacteristicLengthMax", "size_Size", "size_Radius"):
            if w.find(name) is not None and w.find(name).isVisible():
                w.find(name).setText(self.random.choice(SIZES))

    async def choose_a_row(self):
        for name in ("presets", "places"):
            tree = w.find(name)
            if tree is not None and tree.isVisible() and tree.topLevelItemCount():
                await w.click_item(tree.topLevelItem(self.random.randrange(tree.topLevelItemCount())))

    async def choose_an_order(self):
        box = w.find("ElementOrder")
        if box is not None:
            box.setCurrentIndex(self.random.randrange(box.count()))

    async def choose_a_dimension(self):
        box = w.find("ElementDimension")
        if box is not None:
            box.setCurrentIndex(self.random.randrange(box.count()))

    async def wait_for_the_run(self):
        button, clock = w.find("run"), QtCore.QElapsedTimer()
        clock.start()
        while button is not None and not button.isEnabled() and clock.elapsed() < 3000:
            await w.pause(50)
            button = w.find("run")

    async def change_the_part(self):
        hole = self._any(lambda each: each.TypeId == "Part::Cylinder")
        if hole is not None:
            hole.Radius = self.random.randrange(2, 9)
            hole.Document.recompute()

    async def delete_something(self):
        obj = self._any(lambda each: mesh_properties.is_ours(each) or size_objects.kind_of(each)
                        or each.TypeId == "Part::Cut" and self.random.random() < 0.3)
        if obj is not None:
            obj.Document.openTransaction("Delete")
            obj.Document.removeObject(obj.Name)
            FreeCAD.ActiveDocument.commitTransaction()

    async def undo(self):
        for _ in range(self.random.randrange(1, 4)):
            if FreeCAD.ActiveDocument:
                FreeCAD.ActiveDocument.undo()

    async def redo(self):
        if FreeCAD.ActiveDocument:
            FreeCAD.ActiveDocument.redo()

    async def hand_over_and_back(self):
        obj = self._any(lambda each: mesh_properties.is_ours(each) or take_over.can_be_taken_over(each))
        if obj is not None and FreeCADGui.ActiveDocument.getInEdit() is None:
            (mesh_menu.hand_over if mesh_properties.is_ours(obj) else mesh_menu.take)(obj)

    async def statistics(self):
        obj = self._mesh()
        if obj is not None and elements.is_there(obj.FemMesh):
            mesh_menu.statistics(obj)
        dialog = w.find("statistics")
        if dialog is not None and self.random.random() < 0.5:
            dialog.close()


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    await w.wait_until(lambda: w.buttons_of(commands.MESH_COMMAND, grey=True), "the buttons")
    for seed in range(SEED, SEED + SEQUENCES):
        print("sequence", seed, flush=True)
        await Sequence(seed)._run()


w.run_test(test)
