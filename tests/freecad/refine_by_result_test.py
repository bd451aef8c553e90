"""Refinement by the result of an analysis: the estimated error, the next mesh, its groups and constraints, refusals.
Run by run.py."""

import math
import os
import sys
import tempfile
import unittest

import FreeCAD
import numpy
import Part
from FreeCAD import Vector
from freecad import collarmesh_workbench
from freecad.collarmesh_workbench import elements, groups, result_errors, result_refinement, up_to_date
from freecad.collarmesh_workbench.program import Cancelled, MesherError, Settings

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import run_in_freecad  # noqa: E402
from analysis import Analysis  # noqa: E402

FORCE = 4500
# largest von Mises stress of the plate (MPa) on meshes of 6000 and 18,000 elements of second order
CONVERGED_STRESS = 370


def plate_with_hole():
    """A quarter of a plate with a hole, pulled along x; stresses are largest at the top of the hole."""
    analysis = Analysis(Part.makeBox(20, 15, 3).cut(Part.makeCylinder(5, 3)))
    analysis.hold("x", (0, 10, 1.5))
    analysis.hold("y", (12, 0, 1.5))
    analysis.hold("z", (12, 8, 0))
    analysis.pull((20, 7, 1.5), FORCE, (1, 0, 0))
    return analysis


def two_blocks(youngs_moduli=(210000, 70000)):
    """Two blocks that touch, pulled apart."""
    analysis = Analysis(Part.makeCompound(
        [Part.makeBox(10, 10, 10), Part.makeBox(10, 10, 10, Vector(10, 0, 0))]), youngs_moduli)
    analysis.hold("xyz", (0, 5, 5))
    analysis.pull((20, 5, 5), FORCE, (1, 0, 0))
    return analysis


def solution_of(fem_mesh, displacement):
    """Returns the Solution with `displacement(points)` at the nodes of a mesh."""
    nodes = numpy.array([fem_mesh.getElementNodes(number) for number in fem_mesh.Volumes])
    points = numpy.array([tuple(fem_mesh.Nodes[number]) for number in range(1, fem_mesh.NodeCount + 1)])
    return result_errors.Solution(points, nodes - 1, displacement(points), numpy.zeros(len(nodes), int),
                                  numpy.array([(210000.0, 0.3)]))


class Estimate(unittest.TestCase):
    """The error of known displacements on a block of 10 by 10 by 10."""

    @classmethod
    def setUpClass(cls):
        cls.meshes = {}
        for order in (1, 2):
            obj = collarmesh_workbench.mesh(Part.makeBox(10, 10, 10), size=4, order=order)
            cls.meshes[order] = obj.FemMesh.copy()
            FreeCAD.closeDocument(obj.Document.Name)

    def test_constant_strain_has_no_error(self):
        stretch = numpy.array([[1e-3, 2e-4, 0], [2e-4, -5e-4, 1e-4], [3e-4, 0, 7e-4]])
        symmetric = (stretch + stretch.T) / 2
        twice_energy = 1000 * (2 * 210000 / 2.6 * (symmetric**2).sum() + 210000 *
                               0.3 / (1.3 * 0.4) * numpy.trace(symmetric) ** 2)
        for order, mesh in self.meshes.items():
            errors = result_errors.estimate(solution_of(mesh, lambda points: points @ stretch.T))
            self.assertLess(errors.relative, 1e-9, order)
            self.assertAlmostEqual(errors.energy_norm**2 / twice_energy, 1, places=9)

    def test_second_order_has_linear_strains(self):
        def bent(points):
            x, y, z = points.T
            return 1e-4 * numpy.stack([x * y, -x * x / 2 + z * z, y * z - x * z], axis=1)

        self.assertLess(result_errors.estimate(solution_of(self.meshes[2], bent)).relative, 1e-9)
        self.assertGreater(result_errors.estimate(solution_of(self.meshes[1], bent)).relative, 0.05)

    def test_estimate_is_near_the_error(self):
        """With first order, the true error of an interpolated quadratic field is known from its strains."""
        solution = solution_of(self.meshes[1], lambda points: 1e-4 * points[:, [0, 1, 2]] ** 2)
        strain = result_errors.strains(solution)
        exact = numpy.zeros_like(strain)
        for axis in range(3):
            exact[:, :, axis, axis] = 2e-4 * solution.points[solution.corners][:, :, axis]
        true = math.sqrt(result_errors.energies(solution, exact - strain, result_errors.volumes(solution)).sum())
        estimated = math.sqrt((result_errors.estimate(solution).of_tets ** 2).sum())
        self.assertTrue(0.6 < estimated / true < 1.3, estimated / true)

    def test_stiffness_jumps_are_no_error(self):
        """Strains are averaged within each material only."""
        solution = solution_of(self.meshes[1], lambda points: numpy.zeros_like(points))
        middles = solution.points[solution.corners].mean(axis=1)
        solution.materials = (middles[:, 0] > 5).astype(int)
        solution.moduli = numpy.array([(210000.0, 0.3), (70000.0, 0.3)])
        strain = numpy.zeros((len(middles), 4, 3, 3))
        strain[:, :, 0, 0] = numpy.where(solution.materials == 1, 3e-3, 1e-3)[:, None]
        recovered = result_errors.recovered(solution, strain, result_errors.volumes(solution))
        self.assertLess(abs(recovered - strain).max(), 1e-15)

    def test_sizes_meet_the_goal(self):
        solution = solution_of(self.meshes[1], lambda points: 1e-4 * points[:, [0, 0, 0]] ** 3)
        sizes = result_errors.Sizes(solution, result_errors.estimate(solution))
        count = len(solution.tets)
        for goal in (0.5 * count, 4 * count):
            self.assertAlmostEqual(sizes.count(sizes.for_elements(goal)) / goal, 1, places=3)
        half = sizes.error(numpy.ones(count)) / 2
        self.assertAlmostEqual(sizes.error(sizes.for_error(half)) / half, 1, places=3)
        lengths = sizes.at_points(sizes.for_elements(4 * count))
        self.assertLess(lengths[solution.points[:, 0] > 9].mean(), lengths[solution.points[:, 0] < 1].mean())


class Settled(unittest.TestCase):
    def test_settings_of_an_adapted_mesh(self):
        self.assertEqual(Settings(size=3, seed=5, face_sizes={1: 2},
                         min_dihedral=20).for_adapting(), Settings(min_dihedral=20))
        for other in (Settings(keep_apart=True), Settings(split=["Face1"]), Settings(repair="wrap"),
                      Settings(coarsen=False)):
            self.assertIsNone(other.for_adapting())


class Refinement(unittest.TestCase):
    def tearDown(self):
        for name in list(FreeCAD.listDocuments()):
            FreeCAD.closeDocument(name)

    def check_mesh(self, analysis, report):
        """Groups and constraints are those of a new mesh."""
        mesh, shape = analysis.mesh_object.FemMesh, analysis.part.Shape
        self.assertTrue(report["guarantees_hold"])
        self.assertFalse(up_to_date.is_out_of_date(analysis.mesh_object))
        named = groups.named(mesh)
        for number, face in enumerate(shape.Faces, 1):
            self.assertEqual(sorted(mesh.getGroupElements(named[f"Face{number}"])), sorted(mesh.getFacesByFace(face)))
        for number in range(1, len(shape.Solids) + 1):
            self.assertGreater(len(mesh.getGroupElements(named[f"Solid{number}"])), 0)

    def test_loops(self):
        for order, difference in ((1, 0.1), (2, 0.02)):
            analysis = plate_with_hole()
            analysis.mesh(order, 3)
            errors, stresses, count = [], [], analysis.mesh_object.FemMesh.VolumeCount
            for _ in range(4):
                result = analysis.solve()
                self.assertAlmostEqual(result["reactions"][0] / -FORCE, 1, places=4)
                errors.append(result_refinement.plan(analysis.mesh_object).errors.relative)
                stresses.append(result["stress"])
                count *= 2
                self.check_mesh(analysis, collarmesh_workbench.refine_by_result(analysis.mesh_object, elements=count))
                self.assertEqual(elements.order(analysis.mesh_object.FemMesh), order)
                self.assertTrue(0.7 < analysis.mesh_object.FemMesh.VolumeCount / count < 1.4)
            self.assertLess(errors[-1], 0.65 * errors[0])
            self.assertLess(abs(stresses[-1] / CONVERGED_STRESS - 1), difference, f"{stresses}")

    def test_goal_is_an_error(self):
        analysis = plate_with_hole()
        analysis.mesh(1, 3)
        analysis.solve()
        goal = result_refinement.plan(analysis.mesh_object).errors.relative / 2
        for _ in range(3):  # the first steps promise too much: estimates on coarse meshes are too small
            collarmesh_workbench.refine_by_result(analysis.mesh_object, error=goal)
            analysis.solve()
        self.assertTrue(0.7 < result_refinement.plan(analysis.mesh_object).errors.relative / goal < 1.2)

    def test_two_materials(self):
        analysis = two_blocks()
        analysis.mesh(2, 4)
        analysis.solve()
        solution = result_refinement.plan(analysis.mesh_object).solution
        self.assertEqual(sorted(set(solution.moduli[solution.materials][:, 0])), [70000, 210000])
        report = collarmesh_workbench.refine_by_result(analysis.mesh_object, elements=1500)
        self.assertTrue(report["guarantees_hold"])
        named = groups.named(analysis.mesh_object.FemMesh)
        self.assertTrue({"Material1_Volumes", "Material2_Volumes"} <= named.keys())
        self.assertAlmostEqual(analysis.solve()["reactions"][0] / -FORCE, 1, places=4)

    def test_solids_apart_are_meshed_anew(self):
        analysis = two_blocks((210000,))
        analysis.mesh(1, 4)
        analysis.solve()
        analysis.mesh_object.KeepApart = True  # with the result of the glued mesh: held apart, one block would be loose
        report = collarmesh_workbench.refine_by_result(analysis.mesh_object, elements=2000)
        self.assertTrue(report["guarantees_hold"])
        self.assertTrue(report["options"]["keep_apart"])
        self.assertTrue(0.5 < report["mesh"]["tets"] / 2000 < 2, report["mesh"]["tets"])

    def test_result_in_a_file(self):
        analysis = plate_with_hole()
        analysis.mesh(2, 4)
        with tempfile.TemporaryDirectory() as folder:
            keep = tempfile.TemporaryDirectory
            try:  # `solve` works in a folder that it removes
                tempfile.TemporaryDirectory = lambda: _Kept(folder)
                analysis.solve()
            finally:
                tempfile.TemporaryDirectory = keep
            by_object = result_refinement.plan(analysis.mesh_object)
            analysis.document.removeObject(result_refinement.result_of(analysis.mesh_object).Name)
            self.assertFalse(result_refinement.is_possible(analysis.mesh_object))
            analysis.solver.WorkingDir = folder
            self.assertTrue(result_refinement.is_possible(analysis.mesh_object))
            by_file = result_refinement.plan(analysis.mesh_object)
            self.assertTrue(by_file.label.endswith(".frd"))
            self.assertAlmostEqual(by_file.errors.relative / by_object.errors.relative, 1, places=6)

    def test_refusals(self):
        analysis = plate_with_hole()
        analysis.mesh(1, 4)
        self.refuses(analysis, "has no result with displacements", elements=1000)
        analysis.solve()
        self.refuses(analysis, "either a number of elements or an error")
        self.refuses(analysis, "either a number of elements or an error", elements=1000, error=0.1)
        collarmesh_workbench.remesh(analysis.mesh_object)
        analysis.mesh_object.CharacteristicLengthMax = 3
        collarmesh_workbench.remesh(analysis.mesh_object)
        self.refuses(analysis, "the result of another mesh", elements=1000)
        analysis.solve()
        analysis.part.Shape = Part.makeBox(20, 15, 4)
        self.refuses(analysis, "The part has changed", elements=1000)

    def refuses(self, analysis, words, **goal):
        before = analysis.mesh_object.FemMesh.NodeCount
        with self.assertRaisesRegex(MesherError, words):
            collarmesh_workbench.refine_by_result(analysis.mesh_object, **goal)
        self.assertEqual(analysis.mesh_object.FemMesh.NodeCount, before)

    def test_cancel_keeps_the_mesh(self):
        analysis = plate_with_hole()
        analysis.mesh(1, 3)
        analysis.solve()
        before = analysis.mesh_object.FemMesh.NodeCount
        with self.assertRaises(Cancelled):
            result_refinement.refine(analysis.mesh_object, elements=20000, progress=lambda _step: False)
        self.assertEqual(analysis.mesh_object.FemMesh.NodeCount, before)


class _Kept:
    """A folder that its context manager does not remove."""

    def __init__(self, folder):
        self.folder = folder

    def __enter__(self):
        return self.folder

    def __exit__(self, *_):
        pass


run_in_freecad.run(Estimate, Settled, Refinement)
