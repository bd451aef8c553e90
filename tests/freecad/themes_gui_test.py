"""The panel with FreeCAD's dark and light themes: nothing is cut off, and coloured words are readable. Run by
run.py --gui with LC_ALL set to de_DE, whose words are longer."""

import os
import pathlib
import sys

import FreeCAD
import FreeCADGui
import Part
from PySide import QtCore, QtGui

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import colours, mesh_object  # noqa: E402

THEMES = ("Behave-dark", "Dark-blue", "Darker-orange", "ProDark", "Light-green")
READABLE = 4.5  # the contrast that accessibility guidelines require of text


def folder():
    """Returns the folder of FreeCAD's style sheets."""
    return pathlib.Path(FreeCAD.getResourceDir()) / "Gui" / "Stylesheets"


def luminance(colour):
    """Returns the luminance as accessibility guidelines define it."""
    parts = [each / 12.92 if each <= 0.03928 else ((each + 0.055) / 1.055) ** 2.4 for each in colour.getRgbF()[:3]]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def contrast(one, other):
    darker, lighter = sorted((luminance(one), luminance(other)))
    return (lighter + 0.05) / (darker + 0.05)


def background(widget):
    """Returns the colour of most of a widget's pixels."""
    image = widget.grab().toImage()
    seen = [image.pixel(x, y) for x in range(0, image.width(), 3) for y in range(0, image.height(), 3)]
    return QtGui.QColor(max(set(seen), key=seen.count))


def require_whole_table(table, theme):
    w.require(table.verticalScrollBar().maximum() == 0, f"{theme}: {table.objectName()} is too low")
    last = table.topLevelItem(table.topLevelItemCount() - 1)
    w.require(table.visualItemRect(last).bottom() > table.viewport().height() -
              12, f"{theme}: {table.objectName()} is too high")
    header = table.header()
    for column in range(header.count()):
        needed = max(header.sectionSizeFromContents(column).width(), table.sizeHintForColumn(column))
        w.require(header.sectionSize(column) >= needed, f"{theme}: column {column} of {table.objectName()} is cut")
    w.require(header.length() <= table.viewport().width(), f"{theme}: {table.objectName()} is too narrow")


def require_whole_texts(panel, theme):
    for button in panel.findChildren(QtGui.QPushButton):
        width = button.fontMetrics().boundingRect(button.text()).width()
        w.require(not button.isVisible() or button.width() >= width, f"{theme}: {button.text()} is cut")
    order = w.child("ElementOrder")
    widest = max(order.fontMetrics().boundingRect(order.itemText(i)).width() for i in range(order.count()))
    option = QtGui.QStyleOptionComboBox()
    order.initStyleOption(option)
    field = order.style().subControlRect(QtGui.QStyle.CC_ComboBox, option, QtGui.QStyle.SC_ComboBoxEditField, order)
    w.require(field.width() >= widest, f"{theme}: the orders are cut: {widest} pixels of text in {field.width()}")
    for label in panel.findChildren(QtGui.QLabel):
        if label.isVisible() and label.text():
            w.require(label.height() >= label.heightForWidth(label.width()), f"{theme}: {label.text()} is cut")


def require_readable(theme):
    place = background(w.child("guarantees_fold"))
    _, paper = colours.of(colours.GOOD)
    w.require(not paper or place.name() == paper, f"{theme}: good news are on {place.name()}")
    for kind in (colours.GOOD, colours.BAD, colours.CARE, colours.FAINT):
        ink, paper = (QtGui.QColor(each) for each in colours.of(kind))
        on = paper if paper.isValid() else place
        w.require(contrast(ink, on) >= READABLE, f"{theme}: {ink.name()} on {on.name()}: {contrast(ink, on):.2f}")


async def the_panel(obj, theme):
    await w.open_panel(obj)
    await w.run_mesher("3 mm")
    await w.wait_until(lambda: w.child("regions").isVisible(), "the result")
    await w.pause(300)
    require_whole_table(w.child("presets"), theme)
    require_whole_table(w.child("regions"), theme)
    require_whole_texts(w.child("panel"), theme)
    require_readable(theme)
    await w.screenshot(f"theme_{theme}.png")
    await w.close_panel()


async def test():
    document = FreeCAD.newDocument("themes")
    part = document.addObject("Part::Feature", "Part")
    plate = Part.makeBox(40, 40, 10).cut(Part.makeCylinder(8, 10, FreeCAD.Vector(20, 20, 0)))
    part.Shape = Part.makeCompound([plate, Part.makeCylinder(8, 20, FreeCAD.Vector(20, 20, -5))])
    document.recompute()
    FreeCADGui.activateWorkbench("FemWorkbench")
    obj = mesh_object.make(document, part)
    obj.ElementOrder = "1st"
    QtCore.QDir.setSearchPaths("qss", [str(folder())])
    themes = [each for each in THEMES if (folder() / f"{each}.qss").exists()]
    w.require(len(themes) > 1, "FreeCAD's style sheets are there")
    for theme in ("", *themes):
        sheet = (folder() / f"{theme}.qss").read_text(encoding="utf-8") if theme else ""
        QtGui.QApplication.instance().setStyleSheet(sheet)
        await w.pause(300)
        await the_panel(obj, theme or "none")


w.run_test(test)
