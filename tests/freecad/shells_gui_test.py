"""Shells and beams by clicks: the panel chooses triangles and lines from the shape and says so, FEM's thickness and
beam section, CalculiX, and its result in the window. Run by run.py --gui."""

import os
import sys

import FemGui
import FreeCADGui
import ObjectsFem
import Part
from FreeCAD import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import analysis  # noqa: E402
import window as w  # noqa: E402
from freecad.collarmesh_workbench import elements, mesh_object  # noqa: E402

FORCE, YOUNG = 20, 210000


def angle_sheet():
    upright, foot = Part.makePlane(40, 60), Part.makePlane(40, 30)
    upright.rotate(Vector(0, 0, 0), Vector(1, 0, 0), 90)
    return Part.makeShell([upright, foot])


class Study:
    def __init__(self, shape, poisson_ratio=0.3):
        self.analysis = analysis.Analysis(shape, poisson_ratio=poisson_ratio)
        FemGui.setActiveAnalysis(self.analysis.analysis)
        self.mesh = mesh_object.make(self.analysis.document, self.analysis.part)
        self.analysis.mesh_object = self.analysis.add(self.mesh)
        FreeCADGui.ActiveDocument.ActiveView.viewIsometric()

    async def mesh_by_panel(self, size, expected, word, picture):
        """Checks the panel's texts before and after the run."""
        await w.open_panel(self.mesh)
        note = w.child("dimension_note")
        w.require(note.isVisible() and word in note.text(), note.text())
        said = await w.run_mesher(size)
        w.require("Every guarantee holds" in said and word in said, said)
        w.require(elements.dimension(self.mesh.FemMesh) == expected, "another dimension")
        w.require(not w.child("report").isVisible(), "the page is about tetrahedra")
        await w.screenshot(picture)
        await w.close_panel()

    async def solve(self, picture):
        result = self.analysis.solve()
        shown = next(each for each in self.analysis.analysis.Group if each.isDerivedFrom("Fem::FemResultObject")).Mesh
        shown.ViewObject.Visibility = True
        self.mesh.ViewObject.Visibility = False
        shown.ViewObject.setNodeDisplacementByVectors(*displacements(self.analysis.analysis))
        shown.ViewObject.setNodeColorByScalars(*lengths(self.analysis.analysis))
        await w.screenshot(picture)
        return result


def result_of(group):
    return next(each for each in group.Group if each.isDerivedFrom("Fem::FemResultObject"))


def displacements(group):
    result = result_of(group)
    return list(result.NodeNumbers), list(result.DisplacementVectors)


def lengths(group):
    result = result_of(group)
    return list(result.NodeNumbers), list(result.DisplacementLengths)


async def a_face_as_cantilever():
    study = Study(Part.makePlane(100, 20), poisson_ratio=0)
    study.analysis.clamp("Edge", (0, 10, 0))
    study.analysis.pull_at("Edge", (100, 10, 0), FORCE / 2, (0, 0, 1))
    await w.open_panel(study.mesh)
    w.require("needs a thickness" in w.child("dimension_note").text(), w.child("dimension_note").text())
    w.require("6 nodes" in w.child("ElementOrder").currentText(), w.child("ElementOrder").currentText())
    await w.screenshot("shell_panel_before.png")
    await w.close_panel()
    study.analysis.add(ObjectsFem.makeElementGeometry2D(study.analysis.document, 2))
    await study.mesh_by_panel("5 mm", 2, "encloses no volume: it is meshed with triangles", "shell_of_face.png")
    result = await study.solve("shell_of_face_result.png")
    known = FORCE / 2 * 100**3 / (3 * YOUNG * 20 * 2**3 / 12)
    w.require(abs(result["displacement"] / known - 1) < 0.01, f"displacement {result['displacement']}, known {known}")


async def an_open_shell():
    study = Study(Part.makeCylinder(20, 100, Vector(), Vector(0, 0, 1), 180).Faces[0])
    study.analysis.add(ObjectsFem.makeElementGeometry2D(study.analysis.document, 2))
    study.analysis.clamp("Edge", (0, 20, 0))
    study.analysis.pull_at("Edge", (0, 20, 100), FORCE, (1, 0, 0))
    await study.mesh_by_panel("6 mm", 2, "encloses no volume", "shell_open.png")
    w.require((await study.solve("shell_open_result.png"))["displacement"] > 0, "a displacement")


async def bent_sheet():
    study = Study(angle_sheet())
    study.analysis.add(ObjectsFem.makeElementGeometry2D(study.analysis.document, 2))
    study.analysis.clamp("Edge", (20, 30, 0))
    study.analysis.pull_at("Edge", (20, 0, 60), FORCE, (0, 1, 0))
    await study.mesh_by_panel("4 mm", 2, "encloses no volume", "freecad_shell.png")
    result = await study.solve("shell_sheet_result.png")
    w.require(abs(abs(result["reactions"][1]) / FORCE - 1) < 1e-3, f"reactions {result['reactions']}")


async def beams_of_a_wire():
    study = Study(Part.makePolygon([Vector(0, 0, 0), Vector(50, 0, 0), Vector(200, 0, 0)]), poisson_ratio=0)
    study.analysis.add(ObjectsFem.makeElementGeometry1D(study.analysis.document, "Rectangular", 10, 10))
    study.analysis.clamp("Vertex", (0, 0, 0))
    study.analysis.pull_at("Vertex", (200, 0, 0), FORCE, (0, 0, 1))
    await study.mesh_by_panel("20 mm", 1, "has edges only: it is meshed with lines", "beams.png")
    result = await study.solve("beams_result.png")
    known = FORCE * 200**3 / (3 * YOUNG * 10**4 / 12)
    w.require(abs(result["displacement"] / known - 1) < 0.01, f"displacement {result['displacement']}, known {known}")


async def faces_of_a_solid_on_request():
    study = Study(w.plate())
    await w.open_panel(study.mesh)
    w.require(not w.child("dimension_note").isVisible(), w.child("dimension_note").text())
    w.child("ElementDimension").setCurrentIndex(2)
    said = await w.run_mesher("4 mm")
    w.require("triangles" in said and elements.dimension(study.mesh.FemMesh) == 2, said)
    await w.close_panel()
    w.require(study.mesh.ElementDimension == "2D", study.mesh.ElementDimension)


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    await a_face_as_cantilever()
    await an_open_shell()
    await bent_sheet()
    await beams_of_a_wire()
    await faces_of_a_solid_on_request()


w.run_test(test)
