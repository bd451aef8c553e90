"""Sizes by place: callables, meshes with values, sampled functions; and errors in them, which name the place."""

import math
import unittest

import collarmesh
import numpy

from module_test import SANITIZED, box

CUBE = box((0, 0, 0), (1, 1, 1))
FINEST = 0.1 if SANITIZED else 0.05


def median_lengths(mesh):
    """Returns the median lengths of edges in the lower and the upper third."""
    ends = mesh.points[mesh.tets[:, [0, 1]]]
    lengths, z = numpy.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), ends[:, :, 2].mean(axis=1)
    return numpy.median(lengths[z < 1 / 3]), numpy.median(lengths[z > 2 / 3])


class Callables(unittest.TestCase):
    def test_what_is_no_length_is_told_with_the_place(self):
        for wrong, words in ((0, "gave 0 at"), (-1.5, r"gave -1\.5 at"), (math.nan, "gave nan at"),
                             ("2", "gave '2' at"), (None, "gave None at")):
            field = lambda x, y, z: wrong if x > 0.5 else 0.4
            with self.assertRaisesRegex(collarmesh.OptionError, rf"size_field {words} \((0\.[5-9]\d*|1), \S+, \S+\)"):
                collarmesh.mesh(CUBE, size=0.5, size_field=field)

    def test_what_a_callable_raises_comes_out(self):
        with self.assertRaises(ZeroDivisionError):
            collarmesh.mesh(CUBE, size_field=lambda x, y, z: 1 / 0)

    def test_infinite_is_no_wish(self):
        free, bound = (collarmesh.mesh(CUBE, size=0.3, **more)
                       for more in ({}, {"size_field": lambda x, y, z: math.inf}))
        numpy.testing.assert_array_equal(free.points, bound.points)


class CallablesOfArrays(unittest.TestCase):
    """Callables with one argument, places of shape (n, 3)."""

    def sizes(self, places):
        self.calls.append(len(places))
        self.assertEqual(places.shape, (len(places), 3))
        self.assertTrue(((places >= 0) & (places <= 1)).all())  # in the part's box
        return FINEST + 0.3 * places[:, 2]

    def setUp(self):
        self.calls = []

    def test_it_is_called_seldom_and_is_linear_in_between(self):
        of_arrays = collarmesh.mesh(CUBE, size=1, size_field=self.sizes)
        one_by_one = []

        def size(x, y, z):
            one_by_one.append(z)
            return FINEST + 0.3 * z

        of_places = collarmesh.mesh(CUBE, size=1, size_field=size)
        self.assertTrue(of_arrays.passed)
        self.assertLess(len(self.calls), len(one_by_one) / 100)
        self.assertAlmostEqual(len(of_arrays.tets) / len(of_places.tets), 1, delta=0.02)
        below, above = median_lengths(of_arrays)
        self.assertLess(below, 0.7 * above)

    def test_it_is_sampled_as_finely_as_it_asks_for(self):
        """Sizes are far smaller only in a small ball, which lies within one of the coarsest cells."""
        middle = numpy.array([0.52, 0.53, 0.54])

        def near(places):
            self.calls.append(len(places))
            return numpy.maximum(0.004, 0.3 * numpy.linalg.norm(places - middle, axis=1))

        mesh = collarmesh.mesh(CUBE, size=1, size_field=near)
        self.assertGreater(len(self.calls), 1)
        ends = mesh.points[mesh.tets]
        centres = numpy.linalg.norm(ends.mean(axis=1) - middle, axis=1)
        lengths = numpy.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        self.assertLess(numpy.median(lengths[centres < 0.01]), 0.008)
        self.assertGreater(numpy.median(lengths[centres > 0.4]), 0.08)

    def test_threads_change_nothing(self):
        one, several = (collarmesh.mesh(CUBE, size=1, size_field=lambda p: 0.6 * FINEST + 0.1 * p[:, 0],
                                        threads=threads)
                        for threads in (1, 4))
        numpy.testing.assert_array_equal(one.points, several.points)
        numpy.testing.assert_array_equal(one.tets, several.tets)

    def test_objects_methods_and_defaults(self):
        class Field:
            def __call__(self, places, method=None, *, extra=None):
                return numpy.full(len(places), 6 * FINEST)

        def scaled(places, scale=6 * FINEST):
            return scale + 0 * places[:, 0]

        expected = collarmesh.mesh(CUBE, size_field=lambda x, y, z: 6 * FINEST)
        for field in (Field(), Field().__call__, scaled):
            numpy.testing.assert_array_equal(collarmesh.mesh(CUBE, size_field=field).points, expected.points)

    def test_infinite_is_no_wish(self):
        free, bound = (collarmesh.mesh(CUBE, size=0.3, **more)
                       for more in ({}, {"size_field": lambda p: numpy.full(len(p), math.inf)}))
        numpy.testing.assert_array_equal(free.points, bound.points)

    def test_mistakes_are_told_with_the_place(self):
        for wrong, words in ((0.0, "gave 0 at"), (-1.5, r"gave -1\.5 at"), (math.nan, "gave nan at")):
            with self.assertRaisesRegex(collarmesh.OptionError, rf"size_field {words} \((0\.[5-9]\d*|1), \S+, \S+\)"):
                collarmesh.mesh(CUBE, size=0.5, size_field=lambda p: numpy.where(p[:, 0] > 0.5, wrong, 0.4))
        for field, words in ((lambda p: p, r"shape \(n,\) for places of shape \(n, 3\), not one of shape"),
                             (lambda p: 0.3, "not one of shape"), (lambda p: None, "not one of shape|not None"),
                             (lambda p: "fine", "'fine'|not one of shape")):
            with self.assertRaisesRegex(collarmesh.OptionError, words):
                collarmesh.mesh(CUBE, size_field=field)
        with self.assertRaises(ZeroDivisionError):
            collarmesh.mesh(CUBE, size_field=lambda p: 1 / 0)

    def test_remesh_and_predict_take_it(self):
        mesh = collarmesh.mesh(CUBE, size=0.5)
        finer = collarmesh.remesh(mesh, size=lambda p: 0.08 + 0.3 * p[:, 2])
        below, above = median_lengths(finer)
        self.assertLess(below, 0.7 * above)
        coarse, fine = (collarmesh.predict(CUBE, sizes=[0.5], size_field=lambda p: numpy.full(len(p), size))[0]["tets"]
                        for size in (0.5, 0.1))
        self.assertGreater(fine, 10 * coarse)


class Fields(unittest.TestCase):
    def setUp(self):
        self.background = collarmesh.mesh(CUBE, size=0.3)

    def check_finer_below(self, field):
        below, above = median_lengths(collarmesh.mesh(CUBE, size=1, size_field=field))
        self.assertLess(below, 0.7 * above)

    def test_a_mesh_with_values_on_points_or_tets(self):
        on_points = 0.08 + 0.3 * self.background.points[:, 2]
        on_tets = 0.08 + 0.3 * self.background.points[self.background.tets].mean(axis=1)[:, 2]
        self.check_finer_below((self.background, on_points))
        self.check_finer_below((self.background, on_tets))
        self.check_finer_below((self.background.points, self.background.tets, on_tets))
        second = collarmesh.mesh(CUBE, size=0.3, order=2)
        self.check_finer_below((second, numpy.full(len(second.tets), 0.08)
                               + 0.3 * second.points[second.tets].mean(axis=1)[:, 2]))

    def test_a_tet_gets_no_larger_size_than_its_own(self):
        centres = self.background.points[self.background.tets].mean(axis=1)
        sizes = numpy.where(numpy.linalg.norm(centres, axis=1) < 0.5, 0.06, 1)
        mesh = collarmesh.mesh(CUBE, size=1, size_field=(self.background, sizes))
        near = numpy.linalg.norm(mesh.points[mesh.tets].mean(axis=1), axis=1) < 0.25
        corners = mesh.points[mesh.tets[near]]
        self.assertGreater(len(corners), 50)
        longest = numpy.linalg.norm(corners[:, :, None] - corners[:, None], axis=3).max()
        self.assertLess(longest, 0.2)

    def test_a_function_of_arrays_is_called_once(self):
        calls = []

        def lengths(x, y, z):
            calls.append(x.shape)
            return 0.08 + 0.3 * z

        field = collarmesh.sampled_sizes(lengths, (0, 0, 0), (1, 1, 1), 0.3)
        self.assertEqual(len(calls), 1)
        points, tets, values = field
        a, b, c, d = (points[tets[:, i]] for i in range(4))
        volume = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6
        self.assertTrue((volume > 0).all())
        self.assertAlmostEqual(volume.sum(), 1, places=12)
        numpy.testing.assert_allclose(values, 0.08 + 0.3 * points[:, 2])
        self.check_finer_below(field)
        linear = collarmesh.mesh(CUBE, size=1, size_field=lambda x, y, z: 0.08 + 0.3 * z)
        sampled = collarmesh.mesh(CUBE, size=1, size_field=field)
        self.assertAlmostEqual(len(sampled.tets) / len(linear.tets), 1, delta=0.1)
        constant = collarmesh.sampled_sizes(lambda x, y, z: 0.2, (0, 0, 0), (1, 2, 1), 1)
        self.assertEqual(set(constant[2].tolist()), {0.2})

    def test_mistakes_are_told(self):
        mesh = self.background
        for field, words in (((mesh, [1, 2]), "2 values, but"), ((mesh, -numpy.ones(len(mesh.tets))), "positive"),
                             ((mesh.points, mesh.tets + 10**6, numpy.ones(len(mesh.tets))), "corners"),
                             ((mesh,), "tuple")):
            with self.assertRaisesRegex(collarmesh.OptionError, words):
                collarmesh.mesh(CUBE, size_field=field)
        for function, words in ((lambda x, y, z: z - 0.5, r"gave -0\.5 at \(0\.0, 0\.0, 0\.0\)"),
                                (lambda x, y, z: numpy.full_like(x, numpy.nan), "gave nan at"),
                                (lambda x, y, z: z[:3], "shape")):
            with self.assertRaisesRegex(collarmesh.OptionError, words):
                collarmesh.sampled_sizes(function, (0, 0, 0), (1, 1, 1), 0.5)
        with self.assertRaisesRegex(collarmesh.OptionError, "spacing"):
            collarmesh.sampled_sizes(lambda x, y, z: 1, (0, 0, 0), (1, 1, 1), 0)


if __name__ == "__main__":
    unittest.main()
