"""The Python module: arrays in and out, guarantees, errors. Run by CTest with the module on PYTHONPATH."""

import gc
import os
import tempfile
import unittest

import collarmesh
import numpy


def box(low, high):
    """Points and outward triangles, two for each face, tagged 1 to 6 as -x +x -y +y -z +z."""
    corners = numpy.array([[(low, high)[(i >> axis) & 1][axis] for axis in range(3)] for i in range(8)], dtype=float)
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    triangles = [corner for a, b, c, d in quads for corner in ((a, b, c), (a, c, d))]
    return corners, numpy.array(triangles), numpy.repeat(numpy.arange(1, 7), 2)


def volumes(mesh):
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


class Module(unittest.TestCase):
    def test_a_box_is_filled(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 2, 3)), size=0.3)
        self.assertTrue(mesh.passed, mesh.findings)
        self.assertEqual(mesh.tets.shape, (len(mesh.tet_region), 4))
        self.assertTrue((volumes(mesh) > 0).all())
        self.assertAlmostEqual(volumes(mesh).sum(), 6, places=12)
        self.assertEqual(mesh.points.dtype, numpy.float64)
        a, b, c = (mesh.points[mesh.faces[:, i]] for i in range(3))
        areas = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
        for tag, area in zip(range(1, 7), (6, 6, 3, 3, 2, 2)):
            self.assertAlmostEqual(areas[mesh.face_tag == tag].sum(), area, places=12)

    def test_two_surfaces_share_their_interface(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1))[:2], box((1, 0, 0), (2, 1, 1))[:2], size=0.4)
        self.assertTrue(mesh.passed, mesh.findings)
        for region in (1, 2):
            self.assertAlmostEqual(volumes(mesh)[mesh.tet_region == region].sum(), 1, places=12)
        self.assertGreater((mesh.face_regions.min(axis=1) > 0).sum(), 0)

    def test_sizes_by_tag_refine(self):
        surface = box((0, 0, 0), (1, 1, 1))
        coarse, fine = (collarmesh.mesh(surface, size=0.5, patch_size=sizes) for sizes in ({}, {3: 0.1}))
        self.assertGreater((fine.face_tag == 3).sum(), 4 * (coarse.face_tag == 3).sum())

    def test_second_order(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.5, order=2)
        self.assertEqual(mesh.order, 2)
        a, b = (mesh.points[mesh.tets[:, i]] for i in (0, 1))
        numpy.testing.assert_allclose(mesh.points[mesh.tet_mid_nodes[:, 0]], (a + b) / 2, atol=1e-12)
        self.assertEqual(collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.5).tet_mid_nodes.shape, (0, 6))

    def test_same_input_same_mesh(self):
        first, second = (collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.2) for _ in range(2))
        numpy.testing.assert_array_equal(first.tets, second.tets)
        numpy.testing.assert_array_equal(first.points, second.points)

    def test_arrays_outlive_the_mesh_and_are_read_only(self):
        points = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.3).points
        gc.collect()
        self.assertEqual(points.max(), 1)
        with self.assertRaises(ValueError):
            points[0] = 0

    def test_progress_and_cancelling(self):
        seen = []
        collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.03, progress=lambda phase, part: seen.append(part) or True)
        self.assertEqual(seen, sorted(seen))
        self.assertGreater(len(seen), 1)
        with self.assertRaisesRegex(collarmesh.Error, "stopped at"):
            collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.03, progress=lambda phase, part: False)

    def test_mistakes_are_told(self):
        points, triangles, tags = box((0, 0, 0), (1, 1, 1))
        for surface, words in (
            ((points, triangles[:2]), r"open|border"),
            ((points, triangles + 1), "corner 8"),
            ((points[:, :2], triangles), r"\(n, 3\)"),
            ((points, triangles, tags[1:]), "tags"),
            ((points * numpy.nan, triangles), "finite"),
        ):
            with self.assertRaisesRegex(collarmesh.Error, words):
                collarmesh.mesh(surface)
        with self.assertRaises(collarmesh.Error):
            collarmesh.mesh()
        with self.assertRaises(collarmesh.Error):
            collarmesh.mesh((points, triangles), order=3)

    def test_invalid_surfaces_are_repaired_and_told(self):
        points, triangles, tags = box((0, 0, 0), (1, 1, 1))
        self.assertEqual(collarmesh.mesh((points, triangles), size=0.5).repairs, [])
        mesh = collarmesh.mesh((points, triangles[:-1], tags[:-1]), size=0.5)
        self.assertTrue(mesh.passed, mesh.findings)
        self.assertAlmostEqual(volumes(mesh).sum(), 1, places=12)
        self.assertEqual(len(mesh.repairs), 2)
        self.assertRegex(mesh.repairs[0], "hole of 3 edges")
        self.assertRegex(mesh.repairs[1], "within 0 of the input")
        with self.assertRaisesRegex(collarmesh.Error, "open"):
            collarmesh.mesh((points, triangles[:-1]), repair="none")
        with self.assertRaisesRegex(collarmesh.Error, "repair must be"):
            collarmesh.mesh((points, triangles), repair="maybe")
        wrapped = collarmesh.mesh((points, triangles[:2]), size=0.5, repair="wrap")
        self.assertGreater(volumes(wrapped).sum(), 0)
        self.assertRegex(wrapped.repairs[-1], "wrapped around everything")

    def test_files(self):
        mesh = collarmesh.mesh(box((0, 0, 0), (1, 1, 1)), size=0.5)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "box.vtu")
            mesh.write(path)
            import meshio

            self.assertEqual(len(meshio.read(path).points), len(mesh.points))
        with self.assertRaises(collarmesh.Error):
            mesh.write("/no/such/folder/box.vtu")


if __name__ == "__main__":
    unittest.main()
