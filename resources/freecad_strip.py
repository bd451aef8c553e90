"""Takes six pictures of FreeCAD's window, from a part to its stresses. Run by freecad_pictures.py."""

import os
import pathlib
import sys
import tempfile

import FemGui
import FreeCAD
import FreeCADGui
import ObjectsFem
import Part
from femtools import ccxtools
from pivy import coin

from freecad.collarmesh_workbench.commands import MESH_COMMAND

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests" / "freecad"))
from window import (child, click, click_command, click_item, close_panel, find, require, rows, run_test,  # noqa: E402
                    screenshot, wait_until)

SIZE = (1040, 780)  # size of the window


def bracket():
    """Returns an L with a rounded inner corner and a hole in each leg."""
    corners = [(0, 0, 0), (50, 0, 0), (50, 0, 8), (8, 0, 8), (8, 0, 45), (0, 0, 45), (0, 0, 0)]
    shape = Part.Face(Part.makePolygon([FreeCAD.Vector(*p) for p in corners])).extrude(FreeCAD.Vector(0, 30, 0))
    inner = [e for e in shape.Edges if all(abs(v.X - 8) + abs(v.Z - 8) < 1e-9 for v in e.Vertexes)]
    shape = shape.makeFillet(6, inner)
    shape = shape.cut(Part.makeCylinder(6, 10, FreeCAD.Vector(34, 15, -1)))
    return shape.cut(Part.makeCylinder(6, 10, FreeCAD.Vector(-1, 15, 32), FreeCAD.Vector(1, 0, 0)))


def face_at(shape, *place):
    vertex = Part.Vertex(*place)
    distances = [face.distToShape(vertex)[0] for face in shape.Faces]
    return f"Face{distances.index(min(distances)) + 1}"


def numbers_are_there():
    return any(map(str.isdigit, child("presets").topLevelItem(2).text(2)))


def solve(analysis, solver):
    """Runs CalculiX; returns the object that shows the stresses."""
    with tempfile.TemporaryDirectory() as folder:
        tools = ccxtools.FemToolsCcx(analysis, solver)
        tools.update_objects()
        tools.setup_working_dir(folder)
        tools.setup_ccx()
        require(not tools.check_prerequisites(), tools.check_prerequisites())
        tools.purge_results()
        tools.write_inp_file()
        require(tools.ccx_run() == 0, "CalculiX failed")
        tools.load_results()
    result = next(each for each in analysis.Group if each.isDerivedFrom("Fem::FemResultObject"))
    return ObjectsFem.makePostVtkResult(analysis.Document, result)


def move_aside(view):
    """Makes the scene smaller and moves it to the left, because the scale of the colours is at the right."""
    camera = view.getCameraNode()
    height = 1.25 * camera.height.getValue()
    right = camera.orientation.getValue().multVec(coin.SbVec3f(1, 0, 0))
    camera.height.setValue(height)
    camera.position.setValue(camera.position.getValue() + right * (0.1 * height))


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    document = FreeCAD.newDocument("Bracket")
    part = document.addObject("Part::Feature", "Bracket")
    part.Shape = bracket()
    part.ViewObject.ShapeColor = (0.6, 0.72, 0.85)
    analysis = ObjectsFem.makeAnalysis(document, "Analysis")
    FemGui.setActiveAnalysis(analysis)
    solver = analysis.addObject(ObjectsFem.makeSolverCalculixCcxTools(document))[0]
    material = analysis.addObject(ObjectsFem.makeMaterialSolid(document, "Steel"))[0]
    material.Material = {"Name": "Steel", "YoungsModulus": "210000 MPa", "PoissonRatio": "0.3"}
    document.recompute()
    view = FreeCADGui.ActiveDocument.ActiveView
    view.viewIsometric()
    await screenshot("step1.png", size=SIZE)
    FreeCADGui.Selection.addSelection(part)
    await click_command(MESH_COMMAND)
    await wait_until(lambda: find("run") is not None and find("run").isVisible(), "the panel")
    await wait_until(numbers_are_there, "the numbers of elements")
    for number in (3, 2):  # fine, medium
        await click_item(child("presets").topLevelItem(number))
    child("ElementOrder").setCurrentIndex(1)
    await wait_until(numbers_are_there, "the numbers of elements")
    await screenshot("step2.png", size=SIZE)
    await click(child("run"))
    await wait_until(lambda: child("run").isEnabled(), "the mesh")
    part.ViewObject.Visibility = False
    await screenshot("step3.png", size=SIZE)
    worst = next(items for heading, items in rows(child("places")).items() if heading.startswith("Worst"))
    worst[0].parent().setExpanded(True)
    await click_item(worst[0])
    await screenshot("step4.png", fit=False, size=SIZE)
    await close_panel()
    fixed = analysis.addObject(ObjectsFem.makeConstraintFixed(document, "Fixed"))[0]
    fixed.References = [(part, face_at(part.Shape, 0, 15, 10))]
    force = analysis.addObject(ObjectsFem.makeConstraintForce(document, "Force"))[0]
    force.References = [(part, face_at(part.Shape, 50, 15, 4))]
    force.Force = 500
    force.Direction = (part, [face_at(part.Shape, 25, 1, 0)])
    document.recompute()
    await screenshot("step5.png", size=SIZE)
    stresses = solve(analysis, solver)
    for each in document.Objects:
        if hasattr(each, "ViewObject") and each is not stresses:
            each.ViewObject.Visibility = False
    stresses.ViewObject.Visibility = True
    stresses.ViewObject.DisplayMode = "Surface"
    stresses.ViewObject.Field = "von Mises Stress"
    settings = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/View")
    settings.SetBool("ShowNaviCube", False)  # it would cover the scale's numbers
    view.setCameraType("Orthographic")
    FreeCADGui.SendMsgToActiveView("ViewFit")
    move_aside(view)
    await screenshot("step6.png", fit=False, size=SIZE)


if os.environ.get("COLLARMESH_TEST_ARGUMENT"):
    run_test(test)
