"""Actions of tests in FreeCAD's window: finding and clicking widgets, waiting, taking pictures. For scripts
run by run.py --gui.
A test is a coroutine. Everything that waits or clicks is awaited, so that control returns to Qt's main loop
meanwhile, as between the clicks of a user: only there does Qt delete what was closed."""

import os
import pathlib
import sys
import traceback
import warnings

import FreeCAD
import FreeCADGui
import Part
from PySide import QtCore, QtGui

PICTURES = os.environ.get("COLLARMESH_TEST_ARGUMENT", "")  # a folder for screenshots
EVERY = 20  # milliseconds between two checks of a condition
window = FreeCADGui.getMainWindow()
WIDE = (0, 0, 2600, 1000)  # wide enough for all buttons of FEM
PICTURE = (1400, 980)  # pixels
window.setGeometry(*WIDE)
if PICTURES:  # pictures have a white background
    view_settings = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/View")
    for name in ("Gradient", "RadialGradient"):
        view_settings.SetBool(name, False)
    view_settings.SetBool("Simple", True)
    view_settings.SetUnsigned("BackgroundColor", 0xFFFFFFFF)


class turn:
    """Awaiting a `turn()` continues from the main loop after some milliseconds."""

    def __init__(self, milliseconds=0):
        self.milliseconds = milliseconds

    def __await__(self):
        yield self.milliseconds


def follow(coroutine, ended):
    """Runs a coroutine from the main loop. `ended` gets the exception that it raised, or None."""

    def step():
        if any(document.Recomputing for document in FreeCAD.listDocuments().values()):  # timers run then, but no clicks
            QtCore.QTimer.singleShot(EVERY, step)
            return
        try:
            wait = coroutine.send(None)
        except StopIteration:
            ended(None)
        except BaseException as error:
            ended(error)
        else:
            QtCore.QTimer.singleShot(wait, step)

    step()


def require(condition, what):
    if not condition:
        raise AssertionError(what)


def find(name):
    """Returns a widget of ours, None if there is none."""
    return window.findChild(QtGui.QWidget, "collarmesh_" + name)


def child(name):
    require(find(name) is not None, f"no widget {name}")
    return find(name)


async def wait_until(condition, what, seconds=60):
    """Lets FreeCAD run until the condition holds."""
    clock = QtCore.QElapsedTimer()
    clock.start()
    while not condition():
        await turn(EVERY)
        require(clock.elapsed() < 1000 * seconds, f"waited too long for {what}")


async def pause(milliseconds):
    await turn(milliseconds)


async def click(button):
    """Clicks a button as a user can: only if it is visible and enabled."""
    await wait_until(lambda: button.isVisible() and button.isEnabled(), f"the button {button.objectName()}", 10)
    button.click()
    await turn()


async def click_at(widget, place):
    """Clicks the left mouse button at a QPoint of the widget."""
    for kind, buttons in ((QtCore.QEvent.MouseButtonPress, QtCore.Qt.LeftButton),
                          (QtCore.QEvent.MouseButtonRelease, QtCore.Qt.NoButton)):
        event = QtGui.QMouseEvent(kind, QtCore.QPointF(place), QtCore.Qt.LeftButton, buttons, QtCore.Qt.NoModifier)
        QtGui.QApplication.sendEvent(widget, event)
    await turn()


async def click_item(item):
    """Clicks a row of a tree."""
    tree = item.treeWidget()
    tree.scrollToItem(item)
    await turn()
    await click_at(tree.viewport(), tree.visualItemRect(item).center())


async def click_command(command):
    """Clicks the command's button in the toolbar, which appears a moment after its workbench."""
    await wait_until(lambda: buttons_of(command), f"the button of {command}")
    await click(buttons_of(command)[0])


def buttons_of(command, grey=False):
    """Returns the command's enabled buttons; with `grey`, all visible ones."""
    return [button for bar in window.findChildren(QtGui.QToolBar) for button in bar.findChildren(QtGui.QToolButton)
            if button.isVisible() and (grey or button.isEnabled()) and button.defaultAction() is not None
            and button.defaultAction().objectName() == command]


def rows(tree):
    """Returns all rows of a tree with one level of headings: {heading: [item]}."""
    tops = [tree.topLevelItem(i) for i in range(tree.topLevelItemCount())]
    return {top.text(0): [top.child(i) for i in range(top.childCount())] for top in tops}


def column_of(tree, column):
    """Returns the texts of the rows at the top level."""
    return [tree.topLevelItem(i).text(column) for i in range(tree.topLevelItemCount())]


def said():
    """Returns everything that the panel says about the last run."""
    names = ("out_of_date", "message", "counts", "guarantees_fold", "guarantees")
    shown = [child(name).text() for name in names if child(name).isVisible()]
    for heading, items in rows(child("places")).items():
        shown += [heading, *(item.text(0) for item in items)]
    return "\n".join(shown)


async def run_mesher(size):
    """Enters a size, clicks "Mesh" and waits for the end; returns the panel's text."""
    child("CharacteristicLengthMax").setText(size)
    await click(child("run"))
    await wait_until(lambda: child("run").isEnabled(), "the end of the run")
    return said()


async def open_panel(obj):
    FreeCADGui.getDocument(obj.Document.Name).setEdit(obj.Name)
    await wait_until(lambda: find("run") is not None and find("run").isVisible(), "the panel")


async def close_panel(button=QtGui.QDialogButtonBox.Ok):
    """Closes the panel by a button below or above it."""
    boxes = [box for box in window.findChildren(QtGui.QDialogButtonBox) if box.isVisible()]
    require(len(boxes) == 1, f"{len(boxes)} panels")
    await click(boxes[0].button(button))
    await wait_until(lambda: find("run") is None, "the panel's end")


async def screenshot(name, fit=True, size=PICTURE):
    """Saves a picture of the window, made small for it. `size` in pixels; `fit`: shows all of the document."""
    if not PICTURES:
        return
    if find("presets") is not None and child("run").isEnabled():
        await wait_until(lambda: "…" not in "".join(column_of(child("presets"), 2)), "the numbers of elements")
    await make_small(fit, size)
    save_screen(name, size)
    window.setGeometry(*WIDE)


async def make_small(fit=True, size=PICTURE):
    """Returns the window in the size of pictures."""
    for dock in window.findChildren(QtGui.QDockWidget):
        if "Report" in dock.objectName():
            dock.hide()
    ratio = QtGui.QApplication.primaryScreen().devicePixelRatio()
    window.setGeometry(0, 0, *(int(length / ratio) for length in size))
    for _ in range(2):
        await pause(400)
        if fit:
            FreeCADGui.SendMsgToActiveView("ViewFit")
    await pause(400)


def save_screen(name, size=PICTURE):
    """Saves everything visible in the area of the small window."""
    QtGui.QApplication.primaryScreen().grabWindow(0).copy(0, 0, *size).save(os.path.join(PICTURES, name))


def plate():
    return Part.makeBox(40, 30, 5).cut(Part.makeCylinder(6, 7, FreeCAD.Vector(20, 15, -1)))


def run_test(test):
    """Runs the test a moment after FreeCAD has started. Then ends FreeCAD as its button does. run.py reads
    the result, and notices if FreeCAD dies before or after that."""
    errors = []
    sys.excepthook = lambda *error: errors.append("".join(traceback.format_exception(*error)))  # in slots, too
    warnings.simplefilter("always", RuntimeWarning)
    warnings.showwarning = lambda message, *_: errors.append(str(message))  # reports coroutines that nobody awaits

    def ended(error):
        told = "".join(traceback.format_exception(type(error), error,
                       error.__traceback__)) if error else "\n".join(errors)
        pathlib.Path(os.environ["COLLARMESH_TEST_RESULT"]).write_text(told or "passed", encoding="utf-8")
        sys.stdout.flush()
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)
        QtCore.QTimer.singleShot(200, window.close)

    QtCore.QTimer.singleShot(1500, lambda: follow(test(), ended))
