"""Meshes of arrays, fields at other points, meshes of dolfinx."""

import pathlib
import pickle
import sys
import tempfile
import unittest

import collarmesh
import numpy

from module_test import box, volumes

sys.path.append(str(pathlib.Path(__file__).parents[1] / "io"))
import periodic_test  # noqa: E402


def cube(order=1, size=0.4):
    return collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=size, order=order)


class OfArrays(unittest.TestCase):
    def test_a_mesh_of_another_program_is_checked(self):
        ours = cube()
        theirs = collarmesh.Mesh(ours.points, ours.tets)
        self.assertTrue(collarmesh.check(theirs, box((0, 0, 0), (1, 1, 1))[:2])["passed"])
        tagged = collarmesh.Mesh(ours.points, ours.tets, faces=ours.faces, face_tags=ours.face_tag)
        self.assertTrue(collarmesh.check(tagged, box((0, 0, 0), (1, 1, 1)))["passed"])
        moved = ours.points.copy()
        moved[numpy.argmin(moved.sum(axis=1))] += 0.01
        told = collarmesh.check(collarmesh.Mesh(moved, ours.tets), box((0, 0, 0), (1, 1, 1))[:2])
        self.assertFalse(told["passed"])

    def test_boundaries_are_found_where_none_are_given(self):
        points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]
        mesh = collarmesh.Mesh(points, [(0, 1, 2, 3), (1, 2, 3, 4)], [5, 9])
        self.assertEqual(mesh.tet_tag.tolist(), [5, 9])
        self.assertEqual(len(mesh.faces), 7)
        shared = [tag for tag, face in zip(mesh.face_tag, mesh.faces) if set(face) == {1, 2, 3}]
        self.assertEqual(len(shared), 1)
        self.assertEqual(sorted(numpy.bincount(mesh.face_tag)[1:].tolist()), [1, 3, 3])
        same = collarmesh.Mesh(points, [(0, 1, 2, 3), (1, 2, 3, 4)], [5, 5])
        self.assertEqual(len(same.faces), 6)

    def test_tets_of_the_other_orientation_are_turned(self):
        ours = cube()
        mesh = collarmesh.Mesh(ours.points, ours.tets[:, [0, 2, 1, 3]])
        self.assertTrue((volumes(mesh) > 0).all())
        a, b, c = (mesh.points[mesh.faces[:, i]] for i in range(3))
        outwards = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), a - 0.5)
        self.assertTrue((outwards > 0).all())

    def test_second_order_tags_and_names_go_into_files(self):
        ours = cube(order=2)
        nodes = numpy.hstack([ours.tets, ours.tet_mid_nodes])
        faces = numpy.hstack([ours.faces, ours.face_mid_nodes])
        for given in ({}, {"faces": faces, "face_tags": ours.face_tag, "names": {2: {3: "inlet"}}}):
            mesh = collarmesh.Mesh(ours.points, nodes, numpy.full(len(nodes), 7), **given)
            self.assertEqual((mesh.order, len(mesh.face_mid_nodes)), (2, len(ours.faces)))
            ends = mesh.points[mesh.faces]
            numpy.testing.assert_allclose(mesh.points[mesh.face_mid_nodes[:, 0]],
                                          (ends[:, 0] + ends[:, 1]) / 2, atol=1e-12)
            with tempfile.TemporaryDirectory() as folder:
                collarmesh.convert(mesh, pathlib.Path(folder) / "cube.msh")
                back = collarmesh.read(pathlib.Path(folder) / "cube.msh")
            self.assertEqual(set(back.tet_tag), {7})
            self.assertEqual(len(back.faces), len(ours.faces))
        self.assertEqual(back.names[2][3], "inlet")

    def test_maps_of_periodic_faces_are_kept(self):
        self.assertEqual(cube().periodic, [])
        for order in (1, 2):
            mesh = periodic_test.cube(2, order)
            mesh.face_patch = mesh.face_tag - 1  # as in a complex, whose numbers .msh stores
            mesh.feature_dimension = numpy.full(len(mesh.points), 3, dtype=numpy.uint8)
            mesh.feature = numpy.full(len(mesh.points), -1)
            self.same_maps(mesh, mesh.partitioned(2))
            self.same_maps(mesh, pickle.loads(pickle.dumps(mesh)))
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "cell.msh"
                mesh.write(path)
                self.same_maps(mesh, collarmesh.read(path))
                self.assertEqual(self.findings_on_maps(path), set())
                mesh.write(path, scale=0.5)
                self.same_maps(mesh, collarmesh.read(path), scale=0.5)
                mesh.write(pathlib.Path(folder) / "cell.inp")
                self.assertIn("*EQUATION", (pathlib.Path(folder) / "cell_periodic.inp").read_text())
                mesh.periodic[0]["nodes"][:2, 1] = mesh.periodic[0]["nodes"][1::-1, 1]
                mesh.write(path)
                self.assertLess({"periodic_places"}, self.findings_on_maps(path))
        mesh.periodic[0]["nodes"] = mesh.periodic[0]["nodes"] + len(mesh.points)
        with self.assertRaisesRegex(collarmesh.OptionError, "has the corner"):
            mesh.info()

    @staticmethod
    def findings_on_maps(path):
        told = collarmesh.check(collarmesh.read(path), box((0, 0, 0), (1, 1, 1)))["findings"]
        return {finding["guarantee"] for finding in told if finding["guarantee"].startswith("periodic")}

    def same_maps(self, mesh, other, scale=1):
        self.assertEqual(len(mesh.periodic), len(other.periodic))
        for faces, same in zip(mesh.periodic, other.periodic):
            for key in ("first", "second", "rotation", "nodes"):
                numpy.testing.assert_array_equal(faces[key], same[key])
            numpy.testing.assert_array_equal(scale * faces["shift"], same["shift"])

    def test_mistakes_are_told(self):
        ours = cube()
        for arguments, words in (((ours.points, ours.tets[:, :3]), r"tets.*\(n, 4\)"),
                                 ((ours.points, ours.tets.astype(float)), "integers"),
                                 ((ours.points, ours.tets, [1, 2]), "one entry for each tetrahedron"),
                                 ((ours.points[:5], ours.tets), "corner")):
            with self.assertRaisesRegex(collarmesh.OptionError, words):
                collarmesh.Mesh(*arguments)
        with self.assertRaisesRegex(collarmesh.OptionError, "first order"):
            collarmesh.Mesh(ours.points, ours.tets, faces=numpy.zeros((1, 6), dtype=int))


class Interpolation(unittest.TestCase):
    def setUp(self):
        self.points = numpy.random.default_rng(1).uniform(0.01, 0.99, (200, 3))

    def test_linear_and_quadratic_fields_are_exact(self):
        fields = (lambda x, y, z: 1 + 2 * x - y + 3 * z, lambda x, y, z: x * y - z**2 + 2 * x)
        for order in (1, 2):
            mesh = cube(order)
            field = fields[order - 1]
            found = mesh.interpolate(field(*mesh.points.T), self.points)
            numpy.testing.assert_allclose(found, field(*self.points.T), atol=1e-12)
            vectors = numpy.column_stack([field(*mesh.points.T), mesh.points[:, 0]])
            numpy.testing.assert_allclose(mesh.interpolate(vectors, self.points)[:, 1], self.points[:, 0], atol=1e-12)

    def test_values_of_cells_hold_in_all_of_them(self):
        mesh = cube()
        centres = mesh.points[mesh.tets].mean(axis=1)
        found = mesh.interpolate(numpy.arange(len(mesh.tets)), centres)
        numpy.testing.assert_array_equal(found, numpy.arange(len(mesh.tets)))

    def test_outside(self):
        mesh = cube()
        there = [(0.5, 0.5, 0.5), (2, 1, 1)]
        found = mesh.interpolate(mesh.points[:, 0], there)
        self.assertAlmostEqual(found[0], 0.5, places=12)
        self.assertTrue(numpy.isnan(found[1]))
        self.assertEqual(mesh.interpolate(mesh.points[:, 0], there, outside="nearest")[1], 1)
        with self.assertRaisesRegex(collarmesh.OptionError, "row for each"):
            mesh.interpolate([1, 2, 3], there)
        with self.assertRaisesRegex(collarmesh.OptionError, "nearest"):
            mesh.interpolate(numpy.zeros(len(mesh.tets)), there, outside="nearest")


class Dolfinx(unittest.TestCase):
    def test_volumes_areas_and_tags(self):
        try:
            import dolfinx
            import ufl
        except ImportError:
            self.skipTest("dolfinx is not installed")
        outer, inner = box((0, 0, 0), (2, 2, 2)), box((2, 0, 0), (3, 2, 2))
        for order in (1, 2):
            ours = collarmesh.mesh(outer[:2], inner[:2], size=0.8, order=order)
            mesh, cells, facets = ours.to_dolfinx()
            self.assertEqual(mesh.geometry.x.shape, ours.points.shape)

            def integral(measure):
                return dolfinx.fem.assemble_scalar(dolfinx.fem.form(dolfinx.fem.Constant(mesh, 1.0) * measure))

            dx = ufl.Measure("dx", mesh, subdomain_data=cells)
            self.assertAlmostEqual(integral(dx), 12, places=10)
            self.assertAlmostEqual(integral(dx(1)), 8, places=10)
            self.assertAlmostEqual(integral(dx(2)), 4, places=10)
            ds = ufl.Measure("ds", mesh, subdomain_data=facets)
            a, b, c = (ours.points[ours.faces[:, i]] for i in range(3))
            areas = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
            outside = ours.face_regions.min(axis=1) == 0
            for tag in numpy.unique(ours.face_tag[outside]):
                self.assertAlmostEqual(integral(ds(int(tag))), areas[outside & (ours.face_tag == tag)].sum(), places=10)

    def test_nodes_amid_edges_keep_their_places(self):
        try:
            import dolfinx
            import ufl
        except ImportError:
            self.skipTest("dolfinx is not installed")
        model = pathlib.Path(__file__).resolve().parents[2] / "resources/models/flange.step"
        try:
            ours = collarmesh.mesh(model, size=8, order=2)
        except collarmesh.ReadError as error:
            self.skipTest(str(error))
        mesh, _, _ = ours.to_dolfinx()
        form = dolfinx.fem.form(dolfinx.fem.Constant(mesh, 1.0) *
                                ufl.Measure("dx", mesh, metadata={"quadrature_degree": 6}))
        curved = sum(ours.info()["mesh"]["region_volumes"].values())
        self.assertAlmostEqual(dolfinx.fem.assemble_scalar(form) / curved, 1, places=9)


if __name__ == "__main__":
    unittest.main()
