"""Meshes are adapted from Python: sizes of each kind, meshes of Gmsh, sizes from errors."""

import tempfile
import unittest

import collarmesh
import numpy

from module_test import MODELS, SANITIZED, box

CUBE = box((0, 0, 0), (1, 1, 1))


def lengths(mesh):
    """Returns the middle and the length of each edge, each edge once."""
    ends = numpy.unique(numpy.sort(numpy.vstack([mesh.tets[:, pair] for pair in
                        ([0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3])]), axis=1), axis=0)
    a, b = mesh.points[ends[:, 0]], mesh.points[ends[:, 1]]
    return (a + b) / 2, numpy.linalg.norm(a - b, axis=1)


def volumes(mesh):
    a, b, c, d = numpy.moveaxis(mesh.points[mesh.tets], 1, 0)
    of_tets = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6
    return {tag: of_tets[mesh.tet_tag == tag].sum() for tag in numpy.unique(mesh.tet_tag)}


class Sizes(unittest.TestCase):
    def setUp(self):
        self.mesh = collarmesh.mesh(CUBE, size=0.3)

    def check_lengths(self, made, size):
        middles, found = lengths(made)
        ratio = found / size(middles)
        self.assertTrue(made.passed, made.findings)
        self.assertLess(abs(numpy.median(ratio) - 1), 0.2)
        self.assertLess(numpy.quantile(ratio, 0.95), 1.6)

    def test_every_kind_of_size(self):
        def size(points):
            return 0.08 + 0.25 * points[:, 2]
        self.check_lengths(self.mesh.adapt(0.15), lambda points: 0.15)
        for given in (size(self.mesh.points), size(self.mesh.points[self.mesh.tets].mean(axis=1)),
                      (self.mesh, size(self.mesh.points)), lambda x, y, z: 0.08 + 0.25 * z):
            self.check_lengths(self.mesh.adapt(given), size)

    def test_wrong_sizes(self):
        for wrong, words in (([0.1, 0.2], "values"), (-1, "size"), (lambda x, y, z: 0, "positive")):
            with self.assertRaisesRegex(collarmesh.OptionError, words):
                self.mesh.adapt(wrong)
        with self.assertRaisesRegex(collarmesh.OptionError, "one of them"):
            self.mesh.adapt(lambda x, y, z: 1, size_field=lambda x, y, z: 1)

    def test_progress_and_cancelling(self):
        stages = []
        self.mesh.adapt(0.2, progress=lambda stage, fraction: stages.append(stage))
        self.assertIn("remesh", stages)
        with self.assertRaises(collarmesh.CancelledError):
            self.mesh.adapt(0.05, progress=lambda stage, fraction: False)

    def test_tags_and_names_stay(self):
        mesh = collarmesh.Mesh(self.mesh.points, self.mesh.tets, numpy.full(len(self.mesh.tets), 7),
                               faces=self.mesh.faces, face_tags=10 * self.mesh.face_tag,
                               names={2: {10: "inlet"}, 3: {7: "oil"}})
        made = mesh.adapt(0.2)
        self.assertEqual(set(made.face_tag), set(mesh.face_tag))
        self.assertEqual((made.name(2, 10), made.name(3, 7)), ("inlet", "oil"))
        self.assertEqual(set(made.tet_tag), {7})


def mesh_of_gmsh(size):
    """Makes a block with a hole and a ball of another material in it, tagged by Gmsh's entities; slivers are
    left."""
    import gmsh

    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        for name in ("Mesh.Optimize", "Mesh.OptimizeThreshold"):
            gmsh.option.setNumber(name, 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        block = gmsh.model.occ.addBox(0, 0, 0, 2, 1, 1)
        hole = gmsh.model.occ.addCylinder(0.5, 0.5, 0, 0, 0, 1, 0.25)
        gmsh.model.occ.cut([(3, block)], [(3, hole)])
        ball = gmsh.model.occ.addSphere(1.4, 0.5, 0.5, 0.3)
        gmsh.model.occ.fragment(gmsh.model.occ.getEntities(3)[:1], [(3, ball)])
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(3)
        numbers, points, _ = gmsh.model.mesh.getNodes()
        row = numpy.zeros(int(numbers.max()) + 1, dtype=numpy.int64)
        row[numbers.astype(numpy.int64)] = numpy.arange(len(numbers))

        def cells(dimension, kind, corners):
            found, tags = [], []
            for _, tag in gmsh.model.getEntities(dimension):
                nodes = gmsh.model.mesh.getElementsByType(kind, tag)[1].astype(numpy.int64)
                found.append(row[nodes].reshape(-1, corners))
                tags.append(numpy.full(len(found[-1]), tag))
            return numpy.vstack(found), numpy.concatenate(tags)
        tets, tags = cells(3, 4, 4)
        faces, face_tags = cells(2, 2, 3)
        edges, edge_tags = cells(1, 1, 2)
        return collarmesh.Mesh(points.reshape(-1, 3), tets, tags, faces=faces, face_tags=face_tags, edges=edges,
                               edge_tags=edge_tags)
    finally:
        gmsh.finalize()


class Gmsh(unittest.TestCase):
    def test_a_mesh_with_slivers_gets_better(self):
        try:
            mesh = mesh_of_gmsh(0.2)
        except ImportError:
            self.skipTest("there is no Gmsh")
        before = mesh.info()["mesh"]
        for size in (None, 0.12, 0.3):
            made = mesh.adapt(size)
            self.assertTrue(made.passed, made.findings)
            self.assertGreater(made.min_dihedral, max(8, min(15, before["min_dihedral"])))
            self.assertLess(made.max_dihedral, 151)
            self.assertEqual(set(made.face_tag), set(mesh.face_tag))
            self.assertEqual(set(made.edge_tag), set(mesh.edge_tag))
            for tag, volume in volumes(mesh).items():
                self.assertAlmostEqual(volumes(made)[tag] / volume, 1, delta=0.05)


class Errors(unittest.TestCase):
    def setUp(self):
        self.mesh = collarmesh.mesh(CUBE, size=0.15)

    @staticmethod
    def solution(points):
        return numpy.tanh(6 * (numpy.linalg.norm(points, axis=1) - 0.8))

    def test_estimates_are_those_of_a_linear_field(self):
        errors = collarmesh.estimated_errors(self.mesh, self.mesh.points @ [[1.0, 2], [2, 0], [3, 1]])
        self.assertEqual(errors.shape, (len(self.mesh.tets),))
        self.assertLess(errors.max(), 1e-12)

    def test_jumps_of_materials_are_no_error(self):
        mesh = collarmesh.mesh(CUBE, box((0, 0, 1), (1, 1, 2)), size=0.3)
        height = mesh.points[:, 2]
        field = numpy.where(height < 1, height, 1 + 10 * (height - 1))
        self.assertEqual(len(numpy.unique(mesh.tet_tag)), 2)
        self.assertLess(collarmesh.estimated_errors(mesh, field).max(), 1e-10)
        self.assertGreater(collarmesh.estimated_errors(mesh, field, across_regions=True).max(), 0.1)

    def test_flat_tetrahedra_are_named(self):
        mesh = collarmesh.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2, 3)])
        with self.assertRaisesRegex(collarmesh.OptionError, "tetrahedron 0 .* is flat"):
            collarmesh.estimated_errors(mesh, [1.0, 2, 3, 4])

    def test_mid_edge_nodes_have_sizes_between_those_of_corners(self):
        mesh = collarmesh.mesh(CUBE, size=0.4, order=2)
        sizes = collarmesh.sizes_from_errors(mesh, numpy.linspace(1, 2, len(mesh.tets)), elements=500)
        ends = sizes[mesh.tets[:, [1, 2]]].mean(axis=1)
        numpy.testing.assert_allclose(sizes[mesh.tet_mid_nodes[:, 1]], ends)

    def test_the_number_of_elements_is_met(self):
        mesh = self.mesh
        for elements in (2000,) if SANITIZED else (4000, 12000):
            for _ in range(3):
                errors = collarmesh.estimated_errors(mesh, self.solution(mesh.points))
                mesh = mesh.adapt(collarmesh.sizes_from_errors(mesh, errors, elements=elements))
            self.assertTrue(mesh.passed, mesh.findings)
            self.assertLess(abs(numpy.log(len(mesh.tets) / elements)), numpy.log(1.35))

    def test_an_error_is_met(self):
        mesh = self.mesh

        def total(mesh):
            return numpy.linalg.norm(collarmesh.estimated_errors(mesh, self.solution(mesh.points)))
        goal = total(mesh) / (1.5 if SANITIZED else 3)
        for _ in range(2 if SANITIZED else 4):
            errors = collarmesh.estimated_errors(mesh, self.solution(mesh.points))
            mesh = mesh.adapt(collarmesh.sizes_from_errors(mesh, errors, error=goal))
        self.assertLess(abs(numpy.log(total(mesh) / goal)), numpy.log(1.4))

    def test_wrong_arguments(self):
        errors = numpy.ones(len(self.mesh.tets))
        for arguments in ({}, {"elements": 100, "error": 1}, {"elements": -1}, {"elements": 10, "finest": 2}):
            with self.assertRaises(collarmesh.OptionError):
                collarmesh.sizes_from_errors(self.mesh, errors, **arguments)
        for wrong in (errors[1:], -errors, numpy.nan * errors):
            with self.assertRaises(collarmesh.OptionError):
                collarmesh.sizes_from_errors(self.mesh, wrong, elements=100)
        with self.assertRaises(collarmesh.OptionError):
            collarmesh.estimated_errors(self.mesh, [1, 2])


def block_with_wires():
    """Returns a block with two square wires, each a hundredth of it wide."""
    def ring(x, y, half):
        return [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)]
    outlines = [ring(0, 0, 1), ring(-0.2, 0, 0.01), ring(0.2, 0, 0.01)]
    points = [(x, y, z) for outline in outlines for z in (0, 0.5) for x, y in outline]
    sides = [tuple(first + i for i in ((k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) if first == 0 else
                                       (k + 4, (k + 1) % 4 + 4, (k + 1) % 4, k))) for first in (0, 8, 16)
             for k in range(4)]
    low = [(3, 2, 1, 0), (8, 9, 10, 11), (16, 17, 18, 19)]
    high = [(4, 5, 6, 7), (15, 14, 13, 12), (23, 22, 21, 20)]
    return collarmesh.Complex(points, [*sides, low, high])


class PoorMeshes(unittest.TestCase):
    def test_vertices_of_the_improvement_have_sizes(self):
        mesh = collarmesh.mesh(block_with_wires(), size=0.4)
        for size in (None,) if SANITIZED else (None, 0.3):
            made = [mesh.adapt(size) for _ in range(1 if SANITIZED else 2)]
            numpy.testing.assert_allclose(sorted(volumes(made[0]).values()), [0.0002, 0.0002, 1.9996])
            self.assertLess(len(made[0].tets), 2500)
            for again in made[1:]:
                numpy.testing.assert_array_equal(made[0].points, again.points)
                numpy.testing.assert_array_equal(made[0].tets, again.tets)


class AgainstTheInput(unittest.TestCase):
    def on_the_rim(self, mesh):
        """Returns how far the nodes on the flange's outer cylinder are off its radius of 20."""
        nodes = numpy.unique(mesh.faces[mesh.face_tag == 3])
        self.assertGreater(len(nodes), 20)
        return abs(numpy.hypot(*mesh.points[nodes, :2].T) - 20)

    def test_nodes_lie_on_the_faces_of_a_cad_shape(self):
        flange = MODELS / "flange.step"
        first = collarmesh.mesh(flange, size=9 if SANITIZED else 6)
        self.assertGreater(self.on_the_rim(first.adapt(7 if SANITIZED else 3)).max(), 1e-3)
        # The mesh of size 4, made from that of size 8, has edges farther from the shape than second order of
        # size 5 permits.
        for sizes in ((12, 8),) if SANITIZED else ((3, 8, 4), (8, 4)):
            mesh = first
            for size in sizes:
                mesh = mesh.adapt(size, against=flange)
                self.assertTrue(mesh.passed, mesh.findings)
                self.assertLess(numpy.quantile(self.on_the_rim(mesh), 0.98), 1e-9)
                self.assertEqual(set(mesh.face_tag), set(first.face_tag))
                self.assertEqual(set(mesh.edge_tag), set(first.edge_tag))
            self.assertTrue(collarmesh.check(mesh, flange)["passed"])
            curved = mesh.adapt(10 if SANITIZED else 5, against=[flange], order=2)
            self.assertTrue(curved.passed, curved.findings)
            self.assertEqual(curved.order, 2)

    def test_a_complex_and_sizes_by_place(self):
        mesh = collarmesh.mesh(CUBE, size=0.4)
        for _ in range(2):
            mesh = mesh.adapt(0.1 + 0.3 * mesh.points[:, 0], against=CUBE)
            self.assertTrue(mesh.passed, mesh.findings)
            self.assertAlmostEqual(sum(volumes(mesh).values()), 1, 12)

    def test_what_does_not_fit_is_told(self):
        mesh = collarmesh.mesh(CUBE, size=0.4)
        for wrong in (box((0, 0, 0), (1, 1, 1.2)), box((5, 5, 5), (6, 6, 6)), MODELS / "flange.step"):
            with self.assertRaisesRegex(collarmesh.ComplexError, "does not cover the shape"):
                mesh.adapt(0.3, against=wrong)
        with self.assertRaises(collarmesh.OptionError):
            mesh.adapt(0.3, against=[])


class ResultsOfCalculix(unittest.TestCase):
    HEAD = ("    1C\n    2C                             3                                     1\n"
            " -1         1 0.00000E+00 0.00000E+00\n -3\n")

    @staticmethod
    def block(name, rows, end=" -3\n"):
        """Returns the text of a field; rows: node and values, six to a line."""
        text = "  100CL  101 1.000000000           3                     0    1           1\n"
        text += f" -4  {name}        4    1\n"
        text += " -5  D1          1    2    1    0\n -5  ALL         1    2    0    0    1ALL\n"
        for node, *values in rows:
            lines = [values[i:i + 6] for i in range(0, len(values), 6)]
            for number, line in enumerate(lines):
                text += (f" -1{node:10}" if number == 0 else " -2" + 10 * " ") + \
                    "".join(f"{value:12.5E}" for value in line) + "\n"
        return text + end

    def read(self, text):
        with tempfile.NamedTemporaryFile("w", suffix=".frd") as file:
            file.write(text)
            file.flush()
            return collarmesh.read_frd(file.name)

    def test_the_last_step_of_each_field(self):
        wide = [float(i) for i in range(8)]
        fields = self.read(self.HEAD + self.block("DISP", [(1, 1, 2, 3), (2, 4, 5, 6)])
                           + self.block("OTHER", [(3, *wide)]) +
                           self.block("DISP", [(1, -1, 0.5, -3e-5), (3, -7, -8, -9e10)]) + " 9999\n")
        numpy.testing.assert_array_equal(fields["DISP"], [[-1, 0.5, -3e-5], 3 * [numpy.nan], [-7, -8, -9e10]])
        numpy.testing.assert_array_equal(fields["OTHER"][2], wide)

    def test_bad_files(self):
        whole = self.block("DISP", [(1, 1, 2, 3), (2, 4, 5, 6)])
        for text in ("", "solid cube\n", self.HEAD, self.block("DISP", [(1, 1, 2, 3)], end=""),
                     whole.replace("E+00", "E+xx", 1), whole.replace(" -1         2", " -1        -2"),
                     self.block("DISP", [(1, 1, 2, 3), (2, 4, 5)]), self.HEAD + " -4\n -3\n",
                     self.block("DISP", [(9999999999, 1, 2, 3)])):
            with self.assertRaises(collarmesh.ReadError):
                self.read(text)
        with self.assertRaises(collarmesh.ReadError):
            collarmesh.read_frd("missing.frd")


if __name__ == "__main__":
    unittest.main()
