"""A plate with a hole under tension: mesh, analysis by CalculiX, stress concentration. Run it as a macro or by
`freecadcmd plate_with_hole.py`."""

import FreeCAD
import ObjectsFem
import Part
from femtools import ccxtools
from freecad import collarmesh_workbench

WIDTH, RADIUS, THICKNESS, FORCE = 40, 4, 3, 6000  # millimetres, newtons

document = FreeCAD.newDocument("plate_with_hole")
plate = document.addObject("Part::Feature", "Plate")
hole = Part.makeCylinder(RADIUS, THICKNESS, FreeCAD.Vector(40, WIDTH / 2, 0))
plate.Shape = Part.makeBox(80, WIDTH, THICKNESS).cut(hole)


def face_at(x):
    """Returns the name of the face that lies in the plane with this x (mm)."""
    return next(f"Face{i}" for i, face in enumerate(plate.Shape.Faces, 1)
                if face.BoundBox.XLength < 1e-9 and abs(face.BoundBox.XMin - x) < 1e-9)


def face_of_hole():
    return next(i for i, face in enumerate(plate.Shape.Faces, 1) if isinstance(face.Surface, Part.Cylinder))


analysis = ObjectsFem.makeAnalysis(document, "Analysis")
solver = ObjectsFem.makeSolverCalculixCcxTools(document, "Solver")
material = ObjectsFem.makeMaterialSolid(document, "Steel")
material.Material = {"Name": "Steel", "YoungsModulus": "210000 MPa", "PoissonRatio": "0.3"}
fixed = ObjectsFem.makeConstraintFixed(document, "Fixed")
fixed.References = [(plate, face_at(0))]
force = ObjectsFem.makeConstraintForce(document, "Force")
force.References = [(plate, face_at(80))]
force.Force = FORCE
analysis.addObjects([solver, material, fixed, force])

mesh_object = collarmesh_workbench.mesh(plate, analysis=analysis, size=3, face_sizes={face_of_hole(): 0.6}, order=2)
document.recompute()

tools = ccxtools.FemToolsCcx(analysis, solver)
tools.update_objects()
tools.setup_working_dir()
tools.setup_ccx()
tools.purge_results()
tools.write_inp_file()
tools.ccx_run()
tools.load_results()
result = next(each for each in analysis.Group if each.isDerivedFrom("Fem::FemResultObject"))

near_hole = set(mesh_object.FemMesh.getNodesByFace(plate.Shape.Faces[face_of_hole() - 1]))
peak = max(stress for node, stress in zip(result.NodeNumbers, result.vonMises) if node in near_hole)
nominal = FORCE / ((WIDTH - 2 * RADIUS) * THICKNESS)
concentration = peak / nominal
FreeCAD.Console.PrintMessage(f"{mesh_object.FemMesh.VolumeCount} elements, stress concentration {concentration:.2f}\n")
