"""A steel pin in an aluminium block: one mesh that conforms at the interface, with a group for each material."""

import FreeCAD
import ObjectsFem
import Part
from freecad import collarmesh_workbench

document = FreeCAD.newDocument("two_materials")
pin = Part.makeCylinder(4, 30, FreeCAD.Vector(10, 10, 0))
block = Part.makeBox(20, 20, 15).cut(pin)
part = document.addObject("Part::Feature", "PinInBlock")
part.Shape = Part.Compound([block, pin])

analysis = ObjectsFem.makeAnalysis(document, "Analysis")
aluminium = ObjectsFem.makeMaterialSolid(document, "Aluminium")
aluminium.Material = {"Name": "Aluminium", "YoungsModulus": "70000 MPa", "PoissonRatio": "0.33"}
aluminium.References = [(part, "Solid1")]
steel = ObjectsFem.makeMaterialSolid(document, "Steel")
steel.Material = {"Name": "Steel", "YoungsModulus": "210000 MPa", "PoissonRatio": "0.3"}
steel.References = [(part, "Solid2")]
analysis.addObjects([aluminium, steel])

mesh_object = collarmesh_workbench.mesh(part, analysis=analysis, size=3, solid_sizes={2: 1.5})
fem_mesh = mesh_object.FemMesh
elements = {fem_mesh.getGroupName(group): len(fem_mesh.getGroupElements(group)) for group in fem_mesh.Groups}
FreeCAD.Console.PrintMessage(
    f"aluminium: {elements['Aluminium_Volumes']} elements, steel: {elements['Steel_Volumes']}\n"
)
