"""An analysis by CalculiX in FreeCAD: for the tests and the benchmark."""

import os
import re
import tempfile

import FreeCAD
import numpy
import ObjectsFem
import Part
from femmesh import gmshtools
from femtools import ccxtools
from freecad import collarmesh_workbench


class Analysis:
    """A static analysis of one part: add constraints, `mesh`, then `solve`."""

    def __init__(self, shape, youngs_moduli=(210000,), poisson_ratio=0.3):
        """`youngs_moduli`: a modulus (MPa) for each solid, or one for all of them."""
        self.document = FreeCAD.newDocument("analysis")
        self.part = self.document.addObject("Part::Feature", "Part")
        self.part.Shape = shape
        self.held = {}  # held axes by constraint
        self.analysis = ObjectsFem.makeAnalysis(self.document, "Analysis")
        self.solver = self.add(ObjectsFem.makeSolverCalculixCcxTools(self.document, "Solver"))
        self.solver.AnalysisType = "static"
        self.solver.MatrixSolverType = "default"
        for number, modulus in enumerate(youngs_moduli, 1):
            material = self.add(ObjectsFem.makeMaterialSolid(self.document, f"Material{number}"))
            material.Material = {"Name": "Test", "YoungsModulus": f"{modulus} MPa", "PoissonRatio": f"{poisson_ratio}"}
            if len(youngs_moduli) > 1:
                material.References = [(self.part, f"Solid{number}")]

    def add(self, obj):
        self.analysis.addObject(obj)
        return obj

    def close(self):
        FreeCAD.closeDocument(self.document.Name)

    def faces(self, *places):
        """Returns the faces that contain these points, as FreeCAD's references to them."""
        return [(self.part, [self.nearest("Face", place) for place in places])]

    def nearest(self, kind, place):
        """Returns the face, edge or vertex that contains a point."""
        vertex = Part.Vertex(*place)
        distances = [each.distToShape(vertex)[0] for each in getattr(
            self.part.Shape, "Vertexes" if kind == "Vertex" else kind + "s")]
        return f"{kind}{distances.index(min(distances)) + 1}"

    def clamp(self, kind, place):
        """Holds an edge or a vertex: neither displacement nor rotation."""
        held = self.add(ObjectsFem.makeConstraintFixed(self.document, "Fixed"))
        held.References = [(self.part, [self.nearest(kind, place)])]
        self.held[held.Name.upper()] = "xyz"

    def pull_at(self, kind, place, force, direction):
        """Puts a force (N) on an edge or a vertex, along any direction."""
        guide = self.document.addObject("Part::Feature", "Guide")
        guide.Shape = Part.makeLine(FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(*direction))
        load = self.add(ObjectsFem.makeConstraintForce(self.document, "Force"))
        load.References = [(self.part, [self.nearest(kind, place)])]
        load.Force = force
        load.Direction = (guide, ["Edge1"])

    def hold(self, axes, *places):
        """Holds the faces at these places along these axes ("x", "xyz")."""
        if axes == "xyz":
            held = self.add(ObjectsFem.makeConstraintFixed(self.document, "Fixed"))
        else:
            held = self.add(ObjectsFem.makeConstraintDisplacement(self.document, "Held"))
            for axis in axes:
                setattr(held, axis + "Free", False)
                setattr(held, axis + "Fix", True)
        held.References = self.faces(*places)
        self.held[held.Name.upper()] = axes

    def pull(self, place, force, direction):
        """Puts a force (N) on the face at a place, along an axis that some straight edge of the part has."""
        load = self.add(ObjectsFem.makeConstraintForce(self.document, "Force"))
        load.References = self.faces(place)
        load.Force = force
        load.Direction = self.edge_along(direction)
        self.document.recompute()
        load.Reversed = load.DirectionVector.dot(FreeCAD.Vector(*direction)) < 0

    def edge_along(self, direction, owner=None):
        """Returns FreeCAD's reference to an edge along a direction. `owner`: the object that has it; by
        default that of the faces."""
        owner = owner or self.faces((0, 0, 0))[0][0]
        number = next(
            i
            for i, edge in enumerate(owner.Shape.Edges, 1)
            if isinstance(edge.Curve, Part.Line)
            for tangent in [edge.tangentAt(edge.FirstParameter)]
            if abs(abs(tangent.dot(FreeCAD.Vector(*direction))) - 1) < 1e-9
        )
        return owner, [f"Edge{number}"]

    def press(self, place, pressure):
        """Puts a pressure (MPa) on the face at a place."""
        load = self.add(ObjectsFem.makeConstraintPressure(self.document, "Pressure"))
        load.References = self.faces(place)
        load.Pressure = pressure

    def mesh(self, order, size, fine_size=0, place=None, **options):
        """Meshes with collarmesh, finer on the face at a place; curved faces are followed more closely than
        by default, for the stresses there."""
        finer = {int(name[4:]): fine_size for _, names in self.faces(place) for name in names} if place else {}
        self.mesh_object = collarmesh_workbench.mesh(
            self.part, analysis=self.analysis, size=size, order=order, distance=size / 20, face_sizes=finer, **options
        )

    def mesh_by_gmsh(self, order, size, fine_size=0, place=None):
        """Makes a similar mesh with Gmsh."""
        self.mesh_object = self.add(ObjectsFem.makeMeshGmsh(self.document, "Gmsh"))
        self.mesh_object.Part = self.part
        self.mesh_object.CharacteristicLengthMax = size
        self.mesh_object.ElementOrder = ("1st", "2nd")[order - 1]
        self.mesh_object.SecondOrderLinear = False
        region = ObjectsFem.makeMeshRegion(self.document, self.mesh_object, fine_size) if place else None
        if region:
            region.References = self.faces(place)
        error = gmshtools.GmshTools(self.mesh_object).create_mesh()
        if region:
            self.document.removeObject(region.Name)
        if self.mesh_object.FemMesh.NodeCount == 0:
            raise RuntimeError(f"Gmsh made no mesh: {error}")

    def remove_mesh(self):
        self.document.removeObject(self.mesh_object.Name)

    def solve(self, peak_radius=0):
        """Runs CalculiX. Returns the largest displacement (mm), the peak of the von Mises stress (MPa; its
        largest mean over a ball of this radius, mm), the sum of the reactions (N, by axis) over everything
        held, and the numbers of nodes and elements that the solver got."""
        self.document.recompute()
        with tempfile.TemporaryDirectory() as folder:
            tools = ccxtools.FemToolsCcx(self.analysis, self.solver, test_mode=False)
            tools.update_objects()
            tools.setup_working_dir(folder)
            tools.setup_ccx()
            missing = tools.check_prerequisites()
            if missing:
                raise RuntimeError(missing)
            tools.purge_results()
            tools.write_inp_file()
            if tools.ccx_run() != 0:
                raise RuntimeError("CalculiX failed")
            reactions = self.reactions_in(os.path.splitext(tools.inp_file_name)[0] + ".dat")
            tools.load_results()
        result = next(each for each in self.analysis.Group if each.isDerivedFrom("Fem::FemResultObject"))
        return {
            "displacement": max(result.DisplacementLengths),
            "stress": peak(result, peak_radius),
            "reactions": reactions,
            "tets": self.mesh_object.FemMesh.VolumeCount,
            "nodes": self.mesh_object.FemMesh.NodeCount,
        }

    def reactions_in(self, path):
        """Returns the sum of the reactions that CalculiX wrote. Each set counts only along the axes that it
        holds, because sets share nodes."""
        with open(path, encoding="utf-8") as file:
            text = file.read()
        number = r"\s+([-+.\dEe]+)"
        totals = re.findall(r"total force \(fx,fy,fz\) for set (\S+) and time .*\s+" + number * 3, text)
        if len(totals) != len(self.held):
            raise RuntimeError(f"CalculiX wrote reactions for {len(totals)} of {len(self.held)} constraints")
        return [sum(float(total[1 + i]) for total in totals if axis in self.held[total[0]])
                for i, axis in enumerate("xyz")]


def peak(result, radius):
    """Returns the largest mean of the von Mises stress over the nodes within a radius of a node. (On linear
    elements the value jumps from node to node, so the largest one does not converge.) Looks only around the
    nodes with the largest values, which suffices."""
    centres = 200
    nodes = result.Mesh.FemMesh.Nodes
    points = numpy.array([tuple(nodes[number]) for number in result.NodeNumbers])
    stresses = numpy.array(result.vonMises)
    return max(
        stresses[numpy.linalg.norm(points - points[i], axis=1) <= radius].mean()
        for i in numpy.argsort(-stresses)[:centres]
    )
