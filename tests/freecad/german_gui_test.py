"""FreeCAD in German: menus, panels, messages and properties of the add-on are German. Run by run.py --gui with LC_ALL
set to de_DE."""

import os
import sys

import FreeCAD
import FreeCADGui
from PySide import QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import mesh_object, size_objects  # noqa: E402
from freecad.collarmesh_workbench.program import MesherError  # noqa: E402


def texts_of(widget):
    """Returns all texts that a widget shows."""
    found = [
        each.text() for kind in (QtGui.QLabel, QtGui.QAbstractButton) for each in widget.findChildren(kind)
    ]
    found += [each.title() for each in widget.findChildren(QtGui.QGroupBox)]
    return found + [
        each.itemText(i) for each in widget.findChildren(QtGui.QComboBox) for i in range(each.count())
    ]


def actions():
    """Returns our commands in the toolbars: {command: (text, tool tip)}."""
    return {action.objectName(): (action.text(), action.toolTip()) for bar in w.window.findChildren(QtGui.QToolBar)
            for action in bar.actions() if action.objectName().startswith("Collarmesh")}


async def german_numbers(obj):
    """Numbers are typed and shown with a decimal comma, alone and in sums, in all fields."""
    table = w.child("presets")
    sizes = [table.topLevelItem(i).text(1) for i in range(table.topLevelItemCount())]
    w.require(any("," in size for size in sizes) and not any("." in size for size in sizes), f"{sizes}")
    await w.click(w.child("advanced"))
    for name, text, value in (("CharacteristicLengthMax", "3,5 mm", 3.5),
                              ("CharacteristicLengthMax", "3 mm + 1,25 mm", 4.25),
                              ("CharacteristicLengthMin", "0,5", 0.5), ("RadiusEdgeRatio", "1,8", 1.8),
                              ("Gradation", "0,4", 0.4), ("CreaseAngle", "55,5 °", 55.5)):
        w.child(name).setText(text)
        await w.click(w.child("run"))
        await w.wait_until(lambda: w.child("run").isEnabled(), "the end of the run")
        stored = getattr(obj, name)
        w.require(abs(getattr(stored, "Value", stored) - value) < 1e-9, f"{name}: {text} is {stored}; {w.said()}")
    w.require("Tetraeder" in w.said() and "," in w.child("counts").text(), w.said())
    await w.click(w.child("advanced"))


async def test():
    document = FreeCAD.newDocument("german")
    part = document.addObject("Part::Feature", "Platte")
    part.Shape = w.plate()
    document.recompute()
    FreeCADGui.activateWorkbench("FemWorkbench")
    await w.wait_until(lambda: "Collarmesh_SizeSphere" in actions(), "the buttons")
    w.require(actions()["Collarmesh_SizeSphere"][0] == "Größe in einer Kugel", f"{actions()}")
    w.require("Kugel verlangen" in actions()["Collarmesh_SizeSphere"][1], f"{actions()}")
    obj = mesh_object.make(document, part)
    await w.open_panel(obj)
    texts = texts_of(w.child("panel"))
    for word in ("Vernetzen", "Anhalten", "zweite (gekrümmt, 10 Knoten)", "Elementordnung"):
        w.require(word in texts, f"{word} is not in {texts}")
    await w.screenshot("freecad_german.png")
    await german_numbers(obj)
    said = await w.run_mesher("4 mm")
    w.require("Alle Zusagen sind eingehalten" in said and "Tetraeder" in said, said)
    await w.close_panel()
    size = size_objects.make(obj, "Distance", 1)
    try:
        mesh_object.remesh(obj)
        w.require(False, "a size without faces is refused")
    except MesherError as error:
        w.require(
            str(error) == "SizeDistance hat keine Flächen und Kanten; wählen Sie welche oder löschen Sie es.",
            str(error),
        )
    document.removeObject(size.Name)
    sphere = size_objects.make(obj, "Sphere", 1)
    document.recompute()
    sphere.ViewObject.doubleClicked()
    await w.wait_until(lambda: w.find("size_panel") is not None, "the panel of the sphere")
    w.require("Wachstum davon weg" in texts_of(w.child("size_panel")), f"{texts_of(w.child('size_panel'))}")
    w.require(w.child("size_Radius").toolTip() == "Radius der Kugel", w.child("size_Radius").toolTip())
    w.child("size_Radius").setText("3,5 mm")
    await w.pause(50)
    w.require(sphere.Radius.Value == 3.5, f"a German number: {sphere.Radius}")


w.run_test(test)
