"""The panel of a mesh, as a user sees and clicks it, one function for each behaviour. Run by run.py --gui.
The argument may be a folder for screenshots."""

import contextlib
import dataclasses
import json
import os
import pathlib
import re
import stat
import sys
import tempfile
from unittest import mock

import FreeCAD
import FreeCADGui
import numpy
import Part
from PySide import QtCore, QtGui

from freecad.collarmesh_workbench import (angle_chart, colours, cost, guarantees, mesh_object, meshing_process,
                                          objects, places, prediction, processes, program, size_objects, view_marks,
                                          work_folder, worst_elements)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from window import (child, click, click_at, click_command, click_item, close_panel, find, open_panel,  # noqa: E402
                    pause, plate, require, rows, run_mesher, run_test, said, screenshot, turn, wait_until)

PROGRAM = os.environ["COLLARMESH_PROGRAM"]
LONG = "0.25 mm"  # a size with which meshing the plate takes much longer than any test


def new_part(shape, label="Plate"):
    """Makes a document with a part and its empty mesh object, for which no prediction is known."""
    prediction._answers.clear()
    document = FreeCAD.newDocument(label)
    part = document.addObject("Part::Feature", label)
    part.Shape = shape
    obj = mesh_object.make(document, part)
    document.recompute()
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    return document, part, obj


async def close(document):
    if find("run") is not None:
        await close_panel(QtGui.QDialogButtonBox.Cancel)
    FreeCAD.closeDocument(document.Name)


def table():
    """Returns the rows of the presets, as texts."""
    presets = child("presets")
    return [[presets.topLevelItem(i).text(column) for column in range(4)] for i in range(presets.topLevelItemCount())]


def panel_of(obj):
    return obj.ViewObject.Proxy.panel


def number_in(text):
    """Returns the number in a text, 0 if there is none yet."""
    return int("".join(filter(str.isdigit, text)) or 0)


def marks_of(obj):
    return obj.ViewObject.RootNode.getByName(view_marks.NAME)


def collarmesh_folders():
    return set(pathlib.Path(tempfile.gettempdir()).glob("collarmesh-????????"))


def is_running(process_id):
    """Returns whether a process runs; False for one that has ended but whose exit status was not collected."""
    try:
        state = pathlib.Path(f"/proc/{process_id}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state != "Z"


def stand_in(folder, text):
    """Makes a program that runs these lines of Python and then becomes the mesher."""
    path = pathlib.Path(folder, "program")
    become = f"os.execv({PROGRAM!r}, [{PROGRAM!r}] + sys.argv[1:])"
    path.write_text(f"#!/usr/bin/python3\nimport os, sys\n{text}\n{become}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


@contextlib.contextmanager
def held_program():
    """Lets the mesher's runs wait until the file exists whose path this yields; predictions do not wait."""
    with tempfile.TemporaryDirectory() as folder:
        go = pathlib.Path(folder, "go")
        wait = (f"import time\nwhile '--predict' not in sys.argv and not os.path.exists({str(go)!r}):\n"
                "    time.sleep(0.05)")
        os.environ["COLLARMESH_PROGRAM"] = stand_in(folder, wait)
        try:
            yield go
        finally:
            os.environ["COLLARMESH_PROGRAM"] = PROGRAM


async def elements_are_told_before_meshing():
    """The predicted numbers are shown beside the presets, follow other settings, and are near those of the
    mesh."""
    document, part, obj = new_part(plate())
    await open_panel(obj)
    await wait_until(lambda: number_in(table()[4][2]), "the numbers of elements")
    counts = [number_in(row[2]) for row in table()[:5]]
    require(counts == sorted(counts) and counts[0] < counts[-1], f"finer has more: {table()}")
    require(all(row[3] for row in table()[:5]), f"times: {table()}")
    require(child("presets").currentItem().text(0) == "Medium", "a new mesh is medium")
    require(table()[2][1] == "2.5 mm", f"{table()}")
    require(table()[5] == ["Custom", "", "", ""], f"{table()[5]}")
    await screenshot("freecad_presets.png")
    await click_item(child("presets").topLevelItem(1))
    require(child("CharacteristicLengthMax").text() == "5.00 mm", "a preset sets the size")
    child("CharacteristicLengthMax").setText("3 mm")
    require(child("presets").currentItem().text(0) == "Custom", "another size is a custom one")
    await wait_until(lambda: number_in(table()[5][2]), "the number for the custom size")
    require(table()[5][1] == "3 mm" and counts[1] < number_in(table()[5][2]) < counts[2], f"{table()}")
    child("MeshSizeFromCurvature").setValue(60)
    await wait_until(lambda: number_in(table()[1][2]) > counts[1], "more elements on circles")
    child("MeshSizeFromCurvature").setValue(0)
    await wait_until(lambda: number_in(table()[1][2]) == counts[1], "the numbers from before")
    part.Shape = Part.makeBox(40, 30, 10)
    await wait_until(lambda: number_in(table()[2][2]) > 1.3 * counts[2], "the numbers of another shape")
    await close(document)


async def predictions_take_one_process():
    """Predicts for all sizes; for none if they are known, or if a mesh is only looked at."""
    document, part, obj = new_part(plate())
    started = []
    prediction._answers.clear()
    with mock.patch.object(processes, "new", side_effect=lambda new=processes.new: started.append(0) or new()):
        await open_panel(obj)
        await wait_until(lambda: all(number_in(row[2]) for row in table()[:5]), "the numbers of elements")
        require(len(started) == 1, f"{table()}, {len(started)} runs")
        await close_panel()
        other = mesh_object.make(document, part)
        await open_panel(other)
        require(all(number_in(row[2]) for row in table()[:5]), f"known already: {table()}")
        child("CharacteristicLengthMin").setText("1.5 mm")
        await wait_until(lambda: [bool(number_in(row[2])) or row[2] for row in table()[:5]] == 3 * [True] + 2 * [""],
                         "what is not smaller than that")
        child("CharacteristicLengthMin").setText("")
        await run_mesher("5 mm")
        await close_panel()
        prediction._answers.clear()
        started.clear()
        await open_panel(other)
        await pause(1000)
        require(not started and not any(row[2] for row in table()), f"a mesh is looked at: {table()}, {len(started)}")
        await click_item(child("presets").topLevelItem(2))
        await wait_until(lambda: all(number_in(row[2]) for row in table()[:5]), "the numbers for another one")
        require(len(started) == 1, f"{len(started)} runs")
    await close(document)


async def the_chosen_size_is_predicted_first():
    """The chosen size's row is filled while the program still works on the other sizes."""
    document, _, obj = new_part(plate())
    prediction._answers.clear()
    with tempfile.TemporaryDirectory() as folder:
        others = pathlib.Path(folder, "others")
        os.environ["COLLARMESH_PROGRAM"] = stand_in(folder, f"""
if '--predict' in sys.argv:
    import subprocess, time
    run = subprocess.Popen([{PROGRAM!r}] + sys.argv[1:], stderr=subprocess.PIPE)
    sys.stderr.buffer.write(run.stderr.readline())
    sys.stderr.flush()
    while not os.path.exists({str(others)!r}):
        time.sleep(0.05)
    sys.stderr.buffer.write(run.stderr.read())
    sys.exit(run.wait())""")
        await open_panel(obj)
        await wait_until(lambda: number_in(table()[2][2]), "the chosen size's number of elements")
        require([row[2] for row in table() if not number_in(row[2])] == 4 * ["…"] + [""], f"{table()}")
        others.touch()
        await wait_until(lambda: all(number_in(row[2]) for row in table()[:5]), "the other numbers of elements")
        os.environ["COLLARMESH_PROGRAM"] = PROGRAM
    await close(document)


async def what_is_not_predicted_is_not_told():
    """The program predicts only meshes that are coarsened."""
    document, _, obj = new_part(plate())
    await open_panel(obj)
    await wait_until(lambda: number_in(table()[4][2]), "the numbers of elements")
    child("Coarsen").setChecked(False)
    require([row[2:] for row in table()] == 6 * [["", ""]], f"{table()}")
    await pause(1500)
    require([row[2:] for row in table()] == 6 * [["", ""]], f"and nothing comes later: {table()}")
    child("Coarsen").setChecked(True)
    require(number_in(table()[4][2]), f"known already: {table()}")
    await close(document)


async def sizes_by_place_count():
    """Predictions made without a sphere are not shown when there is one."""
    document, _, obj = new_part(plate())
    await open_panel(obj)
    await wait_until(lambda: number_in(table()[2][2]), "the number of elements")
    count = number_in(table()[2][2])
    sphere = size_objects.make(obj, "Sphere", 0.5)
    sphere.Radius = 8
    document.recompute()
    child("MeshSizeFromCurvature").setValue(1)  # any change asks again
    child("MeshSizeFromCurvature").setValue(0)
    await wait_until(lambda: number_in(table()[2][2]) > 2 * count, "more elements in the sphere")
    await close(document)


async def predictions_wait_for_the_mesher():
    """During a run no predictions are made, and the time left is that of the size it runs with."""
    document, _, obj = new_part(plate())
    await open_panel(obj)
    await wait_until(lambda: number_in(table()[4][2]), "the numbers of elements")
    child("CharacteristicLengthMax").setText("0.3 mm")
    await wait_until(lambda: number_in(table()[5][2]), "the number for the custom size")
    await click(child("run"))
    run = meshing_process.run_of(obj)
    elements, seconds = panel_of(obj).known[0.3]
    expected = seconds, cost.loading_seconds(elements, 2)
    require((run.time_left._predicted, run.time_left._afterwards) == expected, f"{expected}")
    child("CharacteristicLengthMax").setText("7 mm")
    await pause(1500)
    require(panel_of(obj).predictions._process is None and not number_in(table()[5][2]), f"{table()}")
    require(meshing_process.run_of(obj) in (run, None), "as it began")
    require((run.time_left._predicted, run.time_left._afterwards) == expected, "and as long")
    await click(child("cancel"))
    await wait_until(lambda: child("run").isEnabled(), "the end")
    await wait_until(lambda: number_in(table()[5][2]), "the number for the size that was typed")
    await close(document)


async def the_folder_forgets_processes_that_ended():
    """Process numbers may be reused by other programs, which removing the folder must not kill."""
    told = {}
    program_is = work_folder.WorkFolder.program_is

    def remember(folder, process_id):
        told.setdefault(folder.name, []).append(process_id)
        program_is(folder, process_id)

    document, _, obj = new_part(plate())
    with tempfile.TemporaryDirectory() as folder, mock.patch.object(work_folder.WorkFolder, "program_is", remember):
        os.environ["COLLARMESH_PROGRAM"] = stand_in(folder, "import time; time.sleep(30)")
        await open_panel(obj)
        await wait_until(lambda: told, "a prediction")
        child("CharacteristicLengthMax").setText("7 mm")  # this ends it
        ((process_id, after),) = told.values()
        require(process_id and after is None and not is_running(process_id), f"{told}")
        told.clear()
        await click(child("run"))
        await click(child("cancel"))
        await wait_until(lambda: child("run").isEnabled(), "the end")
        await click(child("run"))
        document.removeObject(obj.Name)
        require(len(told) == 2 and all(each[-1] is None for each in told.values()), f"{told}")
        os.environ["COLLARMESH_PROGRAM"] = PROGRAM
    FreeCAD.closeDocument(document.Name)


async def an_older_program_tells_no_numbers():
    document, _, obj = new_part(plate())
    with tempfile.TemporaryDirectory() as folder:
        os.environ["COLLARMESH_PROGRAM"] = stand_in(folder, "if '--predict' in sys.argv: sys.exit(2)")
        await open_panel(obj)
        await pause(1500)
        await wait_until(lambda: [row[2:] for row in table()] == 6 * [["", ""]], "a table without numbers")
        require("Every guarantee holds" in await run_mesher("4 mm"), "and meshes")
        os.environ["COLLARMESH_PROGRAM"] = PROGRAM
    await close(document)


async def advanced_settings_reach_the_program():
    """The program gets what was clicked and typed, with units."""
    document, _, obj = new_part(plate())
    await open_panel(obj)
    require(not child("MeshSizeFromCurvature").isVisible(), "folded at first")
    await click(child("advanced"))
    require(child("MeshSizeFromCurvature").isVisible(), "unfolded")
    for name in ("CharacteristicLengthMax", "ElementOrder", "presets", *obj.PropertiesList):
        if find(name) is not None:
            require(find(name).toolTip(), f"{name} has a tool tip")
    child("MeshSizeFromCurvature").setValue(24)
    child("SurfaceDistance").setText("0.002 in")
    child("ImproveLevel").setCurrentIndex(child("ImproveLevel").findText("best"))
    child("Repair").setCurrentIndex(child("Repair").findText("wrap where it fails"))
    child("ElementOrder").setCurrentIndex(1)
    await screenshot("freecad_advanced.png")
    child("Coarsen").setChecked(False)
    await run_mesher("4 mm")
    options = meshing_process.outcome_of(obj).report["options"]
    wanted = {"size": 4, "elements_per_circle": 24, "distance": 0.0508, "improve": 3, "coarsen": False,
              "repair": "wrap", "order": 2, "crease_angle": 60, "radius_edge": 2}
    require({name: options[name] for name in wanted} == wanted, f"{options}")
    require((obj.ImproveLevel, obj.Repair, obj.ElementOrder) == (3, "Wrap", "2nd"), "the object has them")
    require(len(obj.FemMesh.getElementNodes(obj.FemMesh.Volumes[0])) == 10, "second order")
    require(f"{obj.FemMesh.NodeCount:,}".replace(",", "\u202f") in child("counts").text(), child("counts").text())
    child("CharacteristicLengthMin").setText("3 kg")
    told = await run_mesher("4 mm")
    require("Smallest size" in told and "3 kg" in told, told)
    await close(document)


async def second_order_is_the_default():
    """A note beside the choice says what first order is for."""
    document, _, obj = new_part(plate())
    await open_panel(obj)
    order, note = child("ElementOrder"), child("order_note")
    require(order.currentIndex() == 1 and not note.isVisible(), "a new mesh is of second order")
    await wait_until(lambda: number_in(table()[2][2]), "the numbers of elements")
    order.setCurrentIndex(0)
    await turn()
    require(note.isVisible() and "too stiff" in note.text(), "what first order is for")
    await screenshot("freecad_first_order.png")
    await run_mesher("5 mm")
    require(obj.ElementOrder == "1st" and len(obj.FemMesh.getElementNodes(obj.FemMesh.Volumes[0])) == 4, "it is made")
    order.setCurrentIndex(1)
    await turn()
    require(not note.isVisible(), "the note goes")
    await run_mesher("5 mm")
    require(obj.ElementOrder == "2nd" and len(
        obj.FemMesh.getElementNodes(obj.FemMesh.Volumes[0])) == 10, "second order")
    await close(document)


async def sizes_are_checked_before_a_run():
    document, _, obj = new_part(plate())
    await open_panel(obj)
    size, ratio = child("CharacteristicLengthMax"), child("RadiusEdgeRatio")
    for text, words in (("", "no value"), ("0 mm", "more than 0"), ("-3 mm", "negative"), ("1e400 mm", "too large"),
                        ("3 kg", "not in mm"), ("some", "no value"), ("1e-6 mm", "hundred thousandth")):
        size.setText(text)
        await click(child("run"))
        require(meshing_process.run_of(obj) is None, f"{text} does not run")
        if child("question").isVisible():  # a question about something else
            await click(child("run"))
        require(f"Size of the elements: " in said() and words in said(), f"{text}: {said()}")
    size.setText("4 mm")
    for name, field, text, words in (("RadiusEdgeRatio", "Circumradius / shortest edge", "", "no value"),
                                     ("Gradation", "Growth of the size", "-1", "negative"),
                                     ("CharacteristicLengthMin", "Smallest size", "-1 mm", "negative")):
        before = child(name).text()
        child(name).setText(text)
        await click(child("run"))
        require(f"{field}: " in said() and words in said() and child(name).isVisible(), f"{name}: {said()}")
        child(name).setText(before)
    require(ratio.text() == "2" and child("CharacteristicLengthMin").text() == "", "what is empty by default")
    await run_mesher("3 mm + 1 mm")
    require(obj.CharacteristicLengthMax.Value == 4 and obj.FemMesh.VolumeCount, "a sum is a size")
    obj.CharacteristicLengthMax = 4e-5
    try:
        mesh_object.start(obj)
        require(False, "macros are told, too")
    except program.MesherError as error:
        require("Size of the elements: 4e-05 mm" in str(error), str(error))
    await close(document)


async def very_many_elements_are_asked_about():
    """The estimate comes from the prediction or, before that is known, from the volume."""
    document, _, obj = new_part(plate())
    await open_panel(obj)
    size, question = child("CharacteristicLengthMax"), child("question")
    require(child("run").text() == "Mesh" and not question.isVisible(), "nothing is asked at first")
    for wait in (False, True):
        size.setText("0.05 mm")
        if wait:
            await wait_until(lambda: number_in(table()[5][2]), "the number of elements")
        await click(child("run"))
        require(meshing_process.run_of(obj) is None, "it does not start")
        require("elements" in question.text() and "GB" in question.text() and question.isVisible(), question.text())
        require(wait == ("That takes about" in question.text()), question.text())
        require(child("run").text() == "Mesh all the same", child("run").text())
        if wait:
            await screenshot("freecad_question.png")
        else:
            size.setText("4 mm")
            require(not question.isVisible() and child("run").text() == "Mesh", "another size needs no question")
    await click(child("run"))
    run = meshing_process.run_of(obj)
    require(run is not None and not question.isVisible(), "a second click is the answer")
    await click(child("cancel"))
    await wait_until(lambda: child("run").isEnabled(), "the end")
    with mock.patch.object(cost, "free_memory", lambda: 1e6):
        size.setText("2 mm")
        await click(child("run"))
    require("but 0.0 GB are free" in question.text(), question.text())
    await close(document)


async def tiny_sizes_are_shown():
    """FreeCAD shows two decimals."""
    document, _, obj = new_part(Part.makeBox(0.01, 0.01, 0.01))
    obj.CharacteristicLengthMax = 0.00123456789
    await open_panel(obj)
    require(child("CharacteristicLengthMax").text() == "0.00123457 mm", child("CharacteristicLengthMax").text())
    await click(child("run"))
    await wait_until(lambda: child("run").isEnabled(), "the end of the run")
    require(obj.CharacteristicLengthMax.Value == 0.00123456789, "what nobody has edited stays as it is")
    await close(document)


async def the_result_is_told():
    """The counts are those of the mesh, the chart has all elements, and a missed guarantee is red."""
    document, part, obj = new_part(plate())
    await open_panel(obj)
    await run_mesher("2 mm")
    report, fem_mesh = meshing_process.outcome_of(obj).report, obj.FemMesh
    for count in (fem_mesh.VolumeCount, fem_mesh.NodeCount, fem_mesh.FaceCount):
        require(f"{count:,}".replace(",", "\u202f") in child("counts").text(), f"{count}: {child('counts').text()}")
    chart = child("chart")
    require(all(sum(counts) == fem_mesh.VolumeCount for _, _, counts in chart.series), "all elements are in the chart")
    require(child("guarantees_fold").text() == "Every guarantee holds", child("guarantees_fold").text())
    require(not child("guarantees").isVisible(), "one line is enough when all hold")
    await click(child("guarantees_fold"))
    lines = child("guarantees").text()
    require("✗" not in lines and lines.count("✓") == 7 and child("guarantees").isVisible(), lines)
    await click(child("guarantees_fold"))
    await screenshot("freecad_panel.png")
    x, y = int(chart._x(chart.extremes[0])), int(chart._frame().bottom())
    picture = chart.grab().toImage()
    colours = {picture.pixelColor(x + i, y - j).name() for i in range(-3, 4) for j in range(2, 12)}
    require(angle_chart.WORST in colours, f"the worst element is marked: {colours}")
    report = json.loads(json.dumps(report))
    report["guarantees_hold"] = False
    finding = {"guarantee": "radius_edge", "message": "Tetrahedron 7 is bad.", "where": [1, 2, 3], "ids": []}
    report["check"]["findings"] = [finding]
    broken = [text for text, messages in guarantees.guarantees(report) if messages]
    require(broken == ["Circumradius / shortest edge is bounded"], f"{broken}")
    key = objects.key_of(obj)
    meshing_process._outcomes[key] = dataclasses.replace(meshing_process._outcomes[key], report=report)
    await close_panel()
    await open_panel(obj)
    told = said()
    require("A guarantee is missed" in told and told.count("✗") == 1 and "Tetrahedron 7 is bad." in told, told)
    await close(document)


async def a_mesh_that_is_out_of_date_says_so():
    """The panel says so while it is open and when it is opened, and shows the results in grey, until a new
    run or until the shape is restored."""
    document, part, obj = new_part(plate())
    document.UndoMode = 1
    await open_panel(obj)
    require(not child("out_of_date").isVisible(), "there is no mesh yet")
    await run_mesher("4 mm")
    count = obj.FemMesh.VolumeCount
    require(not child("out_of_date").isVisible() and "holds" in child("guarantees_fold").text(), said())
    document.openTransaction("Larger")
    part.Shape = Part.makeBox(40, 30, 10)
    document.recompute()
    document.commitTransaction()
    for again in (False, True):
        await wait_until(lambda: child("out_of_date").isVisible(), "the words")
        require("out of date" in said() and "held when the mesh was made" in said() and "holds" not in said(), said())
        grey, _ = colours.of(colours.FAINT)
        require(grey in child("guarantees").text() and grey in child("guarantees_fold").styleSheet(), "it is grey")
        if again:
            await screenshot("freecad_out_of_date_panel.png")
        else:
            await close_panel()
            await open_panel(obj)
    document.undo()
    await wait_until(lambda: not child("out_of_date").isVisible(), "the shape from before")
    require("Every guarantee holds" in said(), said())
    obj.ElementOrder = "1st"
    document.recompute()
    await wait_until(lambda: child("out_of_date").isVisible(), "another setting")
    await run_mesher("3 mm")
    require(not child("out_of_date").isVisible() and "holds" in said(), said())
    made = child("counts").text()
    document.undo()
    require(obj.FemMesh.VolumeCount == count, "undo brings the mesh from before")
    await turn(50)
    require(not child("counts").isVisible(), f"of which the last run tells nothing: {said()}")
    document.redo()
    await wait_until(lambda: child("counts").isVisible(), "the last run's mesh")
    require(child("counts").text() == made, said())
    await close(document)


async def the_part_hides_when_its_mesh_appears():
    """The part is shown again when the mesh is gone."""
    document, part, obj = new_part(plate())
    document.UndoMode = 1
    obj.ViewObject.Visibility = False
    obj.ElementDimension = "3D"
    await open_panel(obj)
    part.Shape = Part.Shell(part.Shape.Faces[:1])
    await run_mesher("4 mm")
    require(part.ViewObject.Visibility, "without a mesh it stays")
    part.Shape = plate()
    await run_mesher("4 mm")
    require(obj.ViewObject.Visibility and not part.ViewObject.Visibility, "the mesh shows in its place")
    document.undo()
    require(obj.FemMesh.VolumeCount == 0 and part.ViewObject.Visibility, "undo shows the part")
    await run_mesher("4 mm")
    require(not part.ViewObject.Visibility, "it hides again")
    await close_panel()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(obj)
    FreeCADGui.runCommand("Std_Delete")
    await turn()
    require(part.ViewObject.Visibility and len(document.Objects) == 1, "without the mesh object the part shows")
    await close(document)


async def the_worst_elements_show():
    """Clicks on the chart's mark, on a row and on the heading."""
    document, part, obj = new_part(plate())
    await open_panel(obj)
    await run_mesher("2 mm")
    require(marks_of(obj) is None, "nothing is marked at first")
    view = FreeCADGui.ActiveDocument.ActiveView
    before = view.getCamera()
    chart = child("chart")
    await click_at(chart, QtCore.QPoint(int(chart._x(chart.extremes[0])), int(chart._frame().bottom()) - 8))
    require(marks_of(obj) is not None and view.getCamera() != before, "the worst element is marked and looked at")
    require(obj.ViewObject.Transparency > 50 and not part.ViewObject.Visibility, "it can be seen")
    await screenshot("freecad_worst_elements.png", fit=False)
    report = meshing_process.outcome_of(obj).report
    worst = next(items for heading, items in rows(child("places")).items() if heading.startswith("Worst elements"))
    smallest, rest = worst[0].text(0).split("° to ")
    number = int(rest.split()[-1])
    require(abs(float(smallest) - report["mesh"]["min_dihedral"]) < 0.1, worst[0].text(0))
    corners = numpy.array([[obj.FemMesh.getNodeById(n) for n in obj.FemMesh.getElementNodes(number)[:4]]], dtype=float)
    (angle,) = worst_elements.smallest_dihedral_angles(corners)
    require(abs(angle - report["mesh"]["min_dihedral"]) < 1e-6, f"element {number} has {angle} degrees")
    picked = []
    child("places").picked.connect(picked.append)
    for row in (worst[1], worst[1], worst[2]):
        await click_item(row)
    require([len(places_of) for places_of in picked] == [1, 1, 1], f"each click shows its place once: {picked}")
    await click_item(worst[0].parent())
    faces = marks_of(obj).getChild(1).getChild(2)
    require(faces.coordIndex.getNum() == len(worst) * 16 and len(worst) >= 10, "all are marked")
    await close_panel()
    require(marks_of(obj) is None and obj.ViewObject.Transparency == 0 and not part.ViewObject.Visibility, "as before")
    await open_panel(obj)
    child("places").pick_first(places.WORST)
    require(marks_of(obj) is not None, "what the last run found is still there")
    FreeCADGui.ActiveDocument.resetEdit()  # as happens when another object is edited
    await wait_until(lambda: marks_of(obj) is None and find("run") is None, "the end of panel and marks")
    await close(document)


def rows_show_all_of_their_texts(tree):
    """Checks that each row is as high as its text, as wide as Qt draws it."""
    margin = tree.style().pixelMetric(QtGui.QStyle.PM_FocusFrameHMargin, None, tree) + 1
    for item in (item for items in rows(tree).values() for item in items):
        option = QtCore.QRect(0, 0, tree.visualItemRect(item).width() - 2 * margin, 10000)
        wanted = tree.fontMetrics().boundingRect(option, QtCore.Qt.TextWordWrap, item.text(0)).height()
        shown = tree.visualItemRect(item).height()
        require(wanted <= shown < wanted + 3 * tree.fontMetrics().lineSpacing(), f"{shown} of {wanted}: {item.text(0)}")


async def problems_select_their_places():
    """A click on a message selects the edges and faces that it names, and shows them."""
    document, part, obj = new_part(Part.Shell(Part.makeBox(10, 10, 10).Faces[:3]), "Sheet")
    obj.FillHoles = True
    await open_panel(obj)
    told = await run_mesher("2 mm")
    require("No mesh is made" in told and "Edge" in told, told)
    require("“Tolerance of repair”" in told and "--" not in told, f"the panel's names: {told}")
    require("of the shape. The shape holds" in told, f"sentences begin with capitals: {told}")
    rows_show_all_of_their_texts(child("places"))
    problem = next(item for items in rows(child("places")).values() for item in items if "Edge" in item.text(0))
    before = FreeCADGui.ActiveDocument.ActiveView.getCamera()
    await click_item(problem)
    selected = {name for each in FreeCADGui.Selection.getSelectionEx() for name in each.SubElementNames}
    named = set(places.told(places.PROBLEM, problem.text(0)).subshapes)
    require(selected == named and any(name.startswith("Edge") for name in named), f"{selected} of {named}")
    require(FreeCADGui.ActiveDocument.ActiveView.getCamera() != before, "the camera moves")
    await screenshot("freecad_message.png", fit=False)
    await close_panel()
    require(not FreeCADGui.Selection.getSelectionEx(), "nothing stays selected")
    await close(document)


async def notes_and_repairs_are_told_once():
    box = Part.makeBox(10, 10, 10)
    overlapping = Part.makeCompound([box, Part.makeBox(10, 10, 10, FreeCAD.Vector(6, 0, 0))])
    document, part, obj = new_part(overlapping, "Blocks")
    await open_panel(obj)
    told = await run_mesher("3 mm")
    require(told.count("Solid1 and Solid2 overlap around (8, 5, 5)") == 1, told)
    require("Every guarantee holds" in told and "Warnings (1)" in told and "changed while" not in told, told)
    part.Shape = Part.Shell(box.Faces[:5])
    child("FillHoles").setChecked(True)
    told = await run_mesher("3 mm")
    require(told.count("a hole of 4 edges around (5, 5, 10)") == 1 and "Repaired (" in told, told)
    require("changed while" not in told, told)
    hole = rows(child("places"))[next(text for text in rows(child("places")) if text.startswith("Repaired"))][0]
    await click_item(hole)
    point = marks_of(obj).getChild(1).getChild(0).point.getValues()[0].getValue()
    require(tuple(point) == (5, 5, 10), f"the hole is marked: {point}")
    await screenshot("freecad_repair.png", fit=False)
    await close(document)


async def nodes_off_their_faces_are_listed():
    """The list shows such nodes as the program reports them: with their faces, which a click selects."""
    document, part, obj = new_part(Part.makeTorus(10, 3), "Ring")
    obj.CharacteristicLengthMax, obj.ElementOrder = 2.7, "2nd"
    await open_panel(obj)
    await run_mesher("2.7 mm")
    outcome = meshing_process.outcome_of(obj)
    off = len(outcome.report["second_order"]["straightened"])
    require((f"Nodes off their face ({off})" in said()) == bool(off), said())
    outcome.report["second_order"]["straightened"] = [{"dimension": 2, "tag": 1, "where": [13, 0, 0], "distance": 0.01}]
    await close_panel()
    await open_panel(obj)
    (node,) = rows(child("places"))["Nodes off their face (1)"]
    require(node.text(0) == "Face1: 0.01 mm", node.text(0))
    await click_item(node)
    selected = [each.SubElementNames for each in FreeCADGui.Selection.getSelectionEx()]
    require(selected == [("Face1",)], f"the face is selected: {selected}")
    await close(document)


async def cancel_tells_and_time_left_shows():
    document, _, obj = new_part(plate())
    await open_panel(obj)
    await run_mesher("3 mm")
    count, left = obj.FemMesh.VolumeCount, child("left")
    child("CharacteristicLengthMax").setText(LONG)
    await click(child("run"))
    require(not child("run").isEnabled() and child("progress").isVisible(), "a run is under way")
    await wait_until(lambda: "left" in left.text() and "elements so far" in left.text(), "the time left")
    await screenshot("freecad_progress.png")
    await click(child("cancel"))
    await wait_until(lambda: child("run").isEnabled(), "the end")
    require("Cancelled" in said() and obj.FemMesh.VolumeCount == count, said())
    await close(document)


async def a_closed_panel_lets_the_run_go_on():
    """Two documents with two runs at once; a panel that is opened again shows its run."""
    first, _, one = new_part(plate(), "First")
    second, _, other = new_part(plate(), "Second")
    with held_program() as go:
        await open_panel(one)
        child("CharacteristicLengthMax").setText("1.5 mm")
        await click(child("run"))
        await close_panel()
        await open_panel(other)
        child("CharacteristicLengthMax").setText("2 mm")
        await click(child("run"))
        require(len(meshing_process._runs) == 2, "two runs")
        await close_panel()
        await open_panel(one)
        require(meshing_process.run_of(one) is not None and not child("run").isEnabled(), "the panel shows its run")
        go.touch()
        await wait_until(lambda: not meshing_process._runs, "both runs", 120)
    require("Every guarantee holds" in said(), said())
    require(one.FemMesh.VolumeCount > other.FemMesh.VolumeCount > 1000, "both meshes are there")
    await close(first)
    await close(second)


async def a_part_changed_while_meshing_is_told():
    document, part, obj = new_part(plate())
    await open_panel(obj)
    for change, words in ((lambda: setattr(part, "Shape", Part.makeBox(40, 30, 5)), "changed while it was meshed"),
                          (lambda: document.removeObject(part.Name), "deleted while it was meshed")):
        with held_program() as go:
            child("CharacteristicLengthMax").setText("2 mm")
            await click(child("run"))
            change()
            go.touch()
            await wait_until(lambda: child("run").isEnabled(), "the end of the run")
            require(words in said(), said())
        if "changed" in words:
            require("changed while" not in await run_mesher("3 mm"), said())
            count = obj.FemMesh.VolumeCount
    require(obj.FemMesh.VolumeCount == count, "the mesh from before")
    told = await run_mesher("3 mm")
    require("no object is chosen" in told, told)
    await close(document)


async def a_link_changed_while_meshing_is_told():
    """Nothing in the link itself changes. The numbers in the table follow, too."""
    document, part, obj = new_part(plate())
    link = document.addObject("App::Link", "Link")
    link.LinkedObject = part
    obj.Part = link
    document.recompute()
    await open_panel(obj)
    await wait_until(lambda: number_in(table()[2][2]), "the number of elements")
    count = number_in(table()[2][2])
    with held_program() as go:
        child("CharacteristicLengthMax").setText("2 mm")
        await click(child("run"))
        part.Shape = Part.makeBox(40, 30, 10)
        document.recompute()
        go.touch()
        await wait_until(lambda: child("run").isEnabled(), "the end of the run")
        require("changed while it was meshed" in said(), said())
    await wait_until(lambda: number_in(table()[2][2]) > 1.3 * count, "the numbers of the other shape")
    await close(document)


async def another_panel_keeps_its_cancel():
    """A run that ends while a size is being edited puts its mesh in place afterwards; "Cancel" undoes the
    size."""
    for button in (QtGui.QDialogButtonBox.Cancel, QtGui.QDialogButtonBox.Ok):
        document, _, obj = new_part(plate())
        document.UndoMode = 1
        await open_panel(obj)
        child("CharacteristicLengthMax").setText("2 mm")
        with held_program() as go:
            await click(child("run"))
            run = meshing_process.run_of(obj)
            await close_panel()
            FreeCADGui.Selection.clearSelection()
            FreeCADGui.Selection.addSelection(obj)
            await click_command("Collarmesh_SizeSphere")
            await wait_until(lambda: find("size_panel") is not None, "the panel of the sphere")
            go.touch()
            await wait_until(lambda: run.progress is not None and run.progress.phase == "load", "the end of the mesher")
        await pause(1000)
        require(meshing_process.run_of(obj) is run and obj.FemMesh.VolumeCount == 0, "the mesh waits")
        child("size_Radius").setText("3 mm")
        boxes = [box for box in FreeCADGui.getMainWindow().findChildren(QtGui.QDialogButtonBox) if box.isVisible()]
        await click(boxes[0].button(button))
        await wait_until(lambda: meshing_process.run_of(obj) is None, "the mesh")
        require(obj.FemMesh.VolumeCount > 100, "it is there")
        kept = button == QtGui.QDialogButtonBox.Ok
        require(bool(obj.MeshSizeList) == kept == (document.getObject("SizeSphere") is not None), "the sphere")
        document.undo()
        require(obj.FemMesh.VolumeCount == 0 and bool(obj.MeshSizeList) == kept, "undo of the meshing alone")
        await close(document)


def dismiss_message():
    """Closes a message; returns its text."""
    boxes = [box for box in FreeCADGui.getMainWindow().findChildren(QtGui.QMessageBox) if box.isVisible()]
    require(len(boxes) == 1, f"{len(boxes)} messages")
    boxes[0].close()
    return boxes[0].text()


async def another_panel_stays():
    """FreeCAD shows one panel at a time. If a panel is open that FreeCAD does not close by itself, our
    command says so."""

    class Other:
        def __init__(self):
            self.form = QtGui.QWidget()

    document, part, obj = new_part(plate())
    FreeCADGui.Control.showDialog(Other())
    names = [each.Name for each in document.Objects]
    require(not FreeCADGui.getDocument(document.Name).setEdit(obj.Name), "the panel does not open")
    require("Another panel" in dismiss_message(), "and says why")
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(part)
    await click_command("Collarmesh_MeshFromShape")
    require([each.Name for each in document.Objects] == names, "nothing is made")
    require(find("panel") is None and not document.HasPendingTransaction, "nothing stays")
    require("Another panel" in dismiss_message(), "it says why, too")
    FreeCADGui.Control.closeDialog()
    await pause(300)
    await open_panel(obj)
    await close(document)


async def a_part_deleted_while_marked():
    document, part, obj = new_part(plate())
    await open_panel(obj)
    await run_mesher("4 mm")
    child("places").pick_first(places.WORST)
    require(marks_of(obj) is not None, "an element is marked")
    document.removeObject(part.Name)
    await click(child("run"))
    require("no object is chosen" in said() and marks_of(obj) is None, said())
    require(obj.ViewObject.Transparency == 0, "the mesh looks as before")
    await close(document)


async def files_have_no_marks():
    document, part, obj = new_part(plate())
    await open_panel(obj)
    await run_mesher("4 mm")
    name, label = obj.Name, part.Name
    child("places").pick_first(places.WORST)
    require(obj.ViewObject.Transparency > 0 and not part.ViewObject.Visibility, "an element is marked")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plate.FCStd")
        document.saveAs(path)
        await close(document)
        document = FreeCAD.openDocument(path)
    part, obj = document.getObject(label), document.getObject(name)
    require(obj.ViewObject.Transparency == 0 and not part.ViewObject.Visibility,
            "what is opened looks as it did before")
    await close(document)


async def numbers_have_the_unit_that_is_shown():
    document, _, obj = new_part(plate())
    FreeCAD.Units.setSchema(3)  # inches
    obj.CharacteristicLengthMax = 5.08
    await open_panel(obj)
    field = child("CharacteristicLengthMax")
    require(field.text() == "0.20 in", field.text())
    for text, millimetres in (("0.1", 2.54), ("4 mm", 4), ("0.25 in", 6.35)):
        await run_mesher(text)
        require(abs(obj.CharacteristicLengthMax.Value - millimetres) < 1e-9, f"{text}: {obj.CharacteristicLengthMax}")
    FreeCAD.Units.setSchema(0)
    await close(document)


async def what_fails_after_the_mesh_takes_nothing_back():
    """The panel shows data on the existing mesh, even without its page."""
    document, _, obj = new_part(plate())
    await open_panel(obj)
    with mock.patch.object(program.Job, "move_page", side_effect=ValueError("of the page")):
        told = await run_mesher("4 mm")
    require("Every guarantee holds" in told and obj.FemMesh.VolumeCount > 0, told)
    require(not child("report").isVisible(), "there is no page")
    await close(document)


async def documents_and_objects_go_while_meshing():
    """The program is killed and its folder removed, and FreeCAD continues; with the panel open and closed."""
    for panel_open in (True, False):
        for what in ("document", "object"):
            document, _, obj = new_part(plate())
            before = collarmesh_folders()
            await open_panel(obj)
            child("CharacteristicLengthMax").setText(LONG)
            await click(child("run"))
            run = meshing_process.run_of(obj)
            await wait_until(lambda: run.progress is not None, "the first progress")
            process_id, folder = run._process.processId(), pathlib.Path(run.job.folder.name)
            require(is_running(process_id) and folder.exists(), "it runs")
            if not panel_open:
                await close_panel()
            if what == "document":
                FreeCAD.closeDocument(document.Name)
            else:
                document.removeObject(obj.Name)
            await wait_until(lambda: not is_running(process_id) and not folder.exists(), f"the end with the {what}")
            await wait_until(lambda: find("run") is None, "the panel's end")
            require(not meshing_process._runs, "no run")
            if what == "object":
                FreeCAD.closeDocument(document.Name)
            await wait_until(lambda: not collarmesh_folders() - before,
                             f"no folder stays: {collarmesh_folders() - before}")


async def the_report_opens():
    """The button opens a page that still exists and names the part instead of temporary files."""
    opened = []

    class Opener(QtCore.QObject):
        @QtCore.Slot(QtCore.QUrl)
        def open(self, url):
            opened.append(url.toLocalFile())

    opener = Opener()
    QtGui.QDesktopServices.setUrlHandler("file", opener, "open")
    document, part, obj = new_part(plate(), "Bracket")
    part.Label = '3/4" <b>\\ </script>'  # a possible label, and worse
    await open_panel(obj)
    require(not child("report").isVisible(), "there is no report yet")
    await run_mesher("3 mm")
    await click(child("report"))
    QtGui.QDesktopServices.unsetUrlHandler("file")
    require(len(opened) == 1, f"{opened}")
    page = pathlib.Path(opened[0]).read_text(encoding="utf-8")
    require("<html" in page and "/collarmesh-" not in page, "the page is for people")
    (report,) = re.findall(r'<script[^>]*id="report"[^>]*>(.*?)</script>', page, re.DOTALL)
    require(json.loads(report)["inputs"] == [part.Label], f"the part's name: {json.loads(report)['inputs']}")
    await close(document)
    require(not pathlib.Path(opened[0]).exists(), "it goes with the document")


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    only = os.environ.get("COLLARMESH_TEST_ONLY", "")
    for each in (
        elements_are_told_before_meshing,
        predictions_take_one_process,
        the_chosen_size_is_predicted_first,
        what_is_not_predicted_is_not_told,
        sizes_by_place_count,
        predictions_wait_for_the_mesher,
        the_folder_forgets_processes_that_ended,
        an_older_program_tells_no_numbers,
        advanced_settings_reach_the_program,
        second_order_is_the_default,
        sizes_are_checked_before_a_run,
        very_many_elements_are_asked_about,
        tiny_sizes_are_shown,
        the_result_is_told,
        a_mesh_that_is_out_of_date_says_so,
        the_part_hides_when_its_mesh_appears,
        the_worst_elements_show,
        problems_select_their_places,
        notes_and_repairs_are_told_once,
        nodes_off_their_faces_are_listed,
        cancel_tells_and_time_left_shows,
        a_closed_panel_lets_the_run_go_on,
        a_part_changed_while_meshing_is_told,
        a_link_changed_while_meshing_is_told,
        another_panel_keeps_its_cancel,
        another_panel_stays,
        a_part_deleted_while_marked,
        files_have_no_marks,
        numbers_have_the_unit_that_is_shown,
        what_fails_after_the_mesh_takes_nothing_back,
        documents_and_objects_go_while_meshing,
        the_report_opens,
    ):
        if only in each.__name__:
            print(each.__name__, flush=True)
            await each()


run_test(test)
