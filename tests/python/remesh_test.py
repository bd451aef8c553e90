"""Meshes are adapted from Python: sizes of each kind, meshes of Gmsh, sizes from errors."""

import unittest

import collarmesh
import numpy

from module_test import box

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
                               faces=self.mesh.faces, face_tags=10 * self.mesh.face_tag, names={2: {10: "inlet"}, 3: {7: "oil"}})
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

    def test_the_number_of_elements_is_met(self):
        mesh = self.mesh
        for elements in (4000, 12000):
            for _ in range(3):
                errors = collarmesh.estimated_errors(mesh, self.solution(mesh.points))
                mesh = mesh.adapt(collarmesh.sizes_from_errors(mesh, errors, elements=elements))
            self.assertTrue(mesh.passed, mesh.findings)
            self.assertLess(abs(numpy.log(len(mesh.tets) / elements)), numpy.log(1.35))

    def test_an_error_is_met(self):
        mesh = self.mesh

        def total(mesh):
            return numpy.linalg.norm(collarmesh.estimated_errors(mesh, self.solution(mesh.points)))
        goal = total(mesh) / 3
        for _ in range(4):
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


if __name__ == "__main__":
    unittest.main()
