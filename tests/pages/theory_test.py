"""The inequalities that the proofs on the page about theory rest on, on random examples.

Each test also counts examples that violate the hypothesis and the conclusion, so that it cannot pass for want of any.
"""

import itertools
import math
import unittest

import numpy


def distances(points, place):
    return numpy.linalg.norm(points - place, axis=-1)


def gap_balls(points, combinations):
    """Returns where the dual edges of these triples cross the plane z = 0, with the radii of the balls that
    are empty."""
    u, v, w = (points[combinations[:, i]] for i in range(3))
    matrix = numpy.stack([(v - u)[:, :2], (w - u)[:, :2]], axis=1)
    right = numpy.stack([(v * v - u * u).sum(1), (w * w - u * u).sum(1)], axis=1) / 2
    good = abs(numpy.linalg.det(matrix)) > 1e-9
    places = numpy.zeros((good.sum(), 3))
    places[:, :2] = numpy.linalg.solve(matrix[good], right[good][:, :, None])[:, :, 0]
    radii = numpy.linalg.norm(places - u[good], axis=1)
    nearest = numpy.linalg.norm(places[:, None] - points[None], axis=2).min(1)
    empty = nearest > radii * (1 - 1e-9)
    return places[empty], radii[empty]


class Square:
    """The unit square as a patch, with vertices on its border. Vertices are added that encroach no piece of
    the border and no gap ball."""

    def __init__(self, random):
        self.random = random
        self.points = numpy.zeros((0, 3))
        self.pieces = []
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        for (a, b) in zip(corners, corners[1:] + corners[:1]):
            at = [0, *sorted(random.uniform(0.15, 0.85, random.integers(0, 3))), 1]
            ends = [numpy.array([*(numpy.array(a) * (1 - t) + numpy.array(b) * t), 0]) for t in at]
            self.pieces += list(zip(ends, ends[1:]))
            self.points = numpy.vstack([self.points, ends[:-1]])

    def encroaches_a_piece(self, c):
        return any(numpy.linalg.norm(c - (a + b) / 2) < numpy.linalg.norm(a - b) / 2 for a, b in self.pieces)

    def balls(self):
        triples = numpy.array(list(itertools.combinations(range(len(self.points)), 3)))
        places, radii = gap_balls(self.points, triples)
        inside = (places[:, :2] > 0).all(1) & (places[:, :2] < 1).all(1)
        return places[inside], radii[inside]

    def encroaches_a_gap_ball(self, c):
        places, radii = self.balls()
        return bool((distances(places, c) < radii).any())

    def owns_a_point(self, c, samples):
        nearest = numpy.linalg.norm(samples[:, None] - self.points[None], axis=2).min(1)
        return bool((distances(samples, c) < nearest - 1e-9).any())

    def add(self, c):
        self.points = numpy.vstack([self.points, c])


def samples_of_the_square():
    line = numpy.linspace(0, 1, 25)
    return numpy.array([(x, y, 0) for x in line for y in line])


class OneMesh(unittest.TestCase):
    def test_what_encroaches_nothing_owns_no_point_of_the_patch(self):
        random, samples = numpy.random.default_rng(1), samples_of_the_square()
        admitted = refused = owners = 0
        for _ in range(12):
            square = Square(random)
            for _ in range(3):  # vertices of the patch
                c = numpy.array([*random.uniform(0, 1, 2), 0])
                if not square.encroaches_a_piece(c):
                    square.add(c)
            for _ in range(30):
                c = random.uniform([-0.3, -0.3, -0.6], [1.3, 1.3, 0.6])
                if square.encroaches_a_piece(c) or square.encroaches_a_gap_ball(c):
                    refused += 1
                    owners += square.owns_a_point(c, samples)
                    continue
                admitted += 1
                self.assertFalse(square.owns_a_point(c, samples))
                if len(square.points) < 18:
                    square.add(c)
        self.assertGreater(admitted, 50)
        self.assertGreater(owners, 0.5 * refused)  # enough that the test would notice a fault

    def test_beside_the_patch_only_pieces_need_to_be_asked(self):
        random = numpy.random.default_rng(2)
        beside = above = 0
        for _ in range(12):
            square = Square(random)
            for _ in range(40):
                c = random.uniform([-0.5, -0.5, -0.5], [1.5, 1.5, 0.5])
                if square.encroaches_a_piece(c):
                    continue
                if (c[:2] < 0).any() or (c[:2] > 1).any():
                    beside += 1
                    self.assertFalse(square.encroaches_a_gap_ball(c))
                else:
                    above += square.encroaches_a_gap_ball(c)
        self.assertGreater(beside, 100)
        self.assertGreater(above, 20)


class BoundTwo(unittest.TestCase):
    offsets = 0.05, 0.1, 0.1  # offsets of cells, triangles, subsegments
    theta = 0.3

    def test_the_deepest_ball_holds_the_projection_and_is_not_small(self):
        random, looked, tight = numpy.random.default_rng(3), 0, 0
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        for _ in range(40):
            plane = numpy.vstack([corners, random.uniform(0, 1, (6, 2))])
            points = numpy.column_stack([plane, numpy.zeros(len(plane))])
            places, radii = gap_balls(points, numpy.array(list(itertools.combinations(range(len(points)), 3))))
            for _ in range(30):
                c = numpy.array([*random.uniform(0, 1, 2), random.uniform(0, 0.4)])
                power = distances(places, c) ** 2 - radii ** 2
                deepest = power.argmin()
                if power[deepest] >= 0:
                    continue
                looked += 1
                ratio = distances(points, c).min() / radii[deepest]
                self.assertLessEqual(ratio, math.sqrt(2) + 1e-9)
                tight += ratio > 1.2
        self.assertGreater(looked, 300)
        self.assertGreater(tight, 0)

    def test_the_ball_of_a_subsegment_is_not_small_either(self):
        """The ball of a subsegment from -1 to 1, with radius 1 around its middle."""
        random, largest = numpy.random.default_rng(6), 0
        ends = numpy.array([(-1.0, 0, 0), (1.0, 0, 0)])
        for c in random.uniform(-1.5, 1.5, (20000, 3)):
            if numpy.linalg.norm(c) < 1:
                largest = max(largest, distances(ends, c).min())
        self.assertLess(largest, math.sqrt(2))
        self.assertGreater(largest, 1.3)

    def test_radii_grow_above_the_bound(self):
        kept = math.prod(1 - d for d in self.offsets)
        gain = lambda rho: rho * kept / 2
        self.assertLess(gain(2.59), 1)
        self.assertGreater(gain(2.60), 1)

    def test_what_did_not_warp_to_a_point_is_not_much_nearer_to_it_than_to_others(self):
        random, smallest = numpy.random.default_rng(4), math.inf
        for offset in set(self.offsets):
            for _ in range(2000):
                others = random.normal(size=(4, 3))
                others /= numpy.linalg.norm(others, axis=1)[:, None]  # on the ball's sphere
                way = random.normal(size=3)
                q = offset * way / numpy.linalg.norm(way) * random.uniform(0, 1)
                p = random.normal(size=3)
                p *= random.uniform(self.theta, 1) / numpy.linalg.norm(p)
                bound = (self.theta - offset) / (1 + offset) * distances(others, q).min()
                smallest = min(smallest, numpy.linalg.norm(p - q) / bound)
        self.assertGreaterEqual(smallest, 1)
        self.assertLess(smallest, 1.6)  # the bound is nearly reached


class DirectInsertion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Makes a grid whose points were moved, with its Delaunay balls, by testing all of them."""
        cls.random = numpy.random.default_rng(5)
        grid = numpy.array(list(itertools.product(range(4), repeat=3)), dtype=float)
        cls.points = grid + cls.random.uniform(-0.3, 0.3, grid.shape)
        cells = numpy.array(list(itertools.combinations(range(len(grid)), 4)))
        cells = cells[(numpy.ptp(grid[cells], axis=1) <= 2).all(1)]
        a = cls.points[cells]
        matrix = a[:, 1:] - a[:, :1]
        good = abs(numpy.linalg.det(matrix)) > 1e-6
        a, cells, matrix = a[good], cells[good], matrix[good]
        right = ((a[:, 1:] ** 2).sum(2) - (a[:, :1] ** 2).sum(2)) / 2
        centres = numpy.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        radii = numpy.linalg.norm(centres - a[:, 0], axis=1)
        keep = numpy.ones(len(cells), bool)
        for p in cls.points:
            keep &= distances(centres, p) > radii * (1 - 1e-9)
        cls.cells, cls.centres, cls.radii = cells[keep], centres[keep], radii[keep]
        cls.inner = [i for i, p in enumerate(grid) if (p > 0).all() and (p < 3).all()]

    def cell(self, q):
        """Returns R_q, the radius of the largest ball at q, and r_q, half the distance of q from the nearest
        point."""
        apart = distances(self.points, self.points[q])
        return self.radii[(self.cells == q).any(1)].max(), numpy.partition(apart, 1)[1] / 2

    def balls_with(self, p):
        return self.radii[distances(self.centres, p) < self.radii]

    def test_a_point_near_a_vertex_meets_no_ball_larger_than_twice_its_cell(self):
        largest = 0
        for q in self.inner:
            outer, inner = self.cell(q)
            for _ in range(60):
                way = self.random.normal(size=3)
                apart = inner ** 2 / outer * self.random.uniform(0, 1)
                balls = self.balls_with(self.points[q] + apart * way / numpy.linalg.norm(way))
                self.assertGreater(len(balls), 0)
                self.assertLessEqual(balls.max(), 2 * outer + apart)
                largest = max(largest, balls.max() / outer)
        self.assertGreater(largest, 0.9)

    def test_no_point_of_a_cell_meets_much_larger_balls(self):
        looked = 0
        tau = max(outer / inner for outer, inner in map(self.cell, self.inner))
        for _ in range(1500):
            p = self.random.uniform(1, 2, 3)
            q = int(distances(self.points, p).argmin())
            if q not in self.inner:
                continue
            outer = self.cell(q)[0]
            looked += 1
            self.assertLessEqual(self.balls_with(p).max(), (9 * tau ** 2 + 1) * outer)
        self.assertGreater(looked, 500)

    def test_the_ball_of_a_point_holds_one_vertex_at_most(self):
        holding, smallest = 0, math.inf
        for p in self.random.uniform(1, 2, (3000, 3)):
            apart = numpy.sort(distances(self.points, p))
            inner = self.cell(int(distances(self.points, p).argmin()))[1]
            self.assertGreaterEqual(apart[1], inner * (1 - 1e-12))
            holding += apart[0] < inner
            smallest = min(smallest, apart[1] / inner)
        self.assertGreater(holding, 100)
        self.assertLess(smallest, 1.3)  # with a much larger value it would fail

    def test_balls_with_one_earlier_centre_pack_twice_as_many(self):
        """Centres in a ball of a quarter of the radius: at most two, if no ball of an event contains two
        earlier centres."""
        most = 0
        for _ in range(30):
            events = numpy.zeros((0, 3))
            for c in self.random.uniform(-1, 1, (300, 3)):
                if (distances(events, c) < 1).sum() <= 1:
                    events = numpy.vstack([events, c])
            for place in self.random.uniform(-1, 1, (10, 3)):
                most = max(most, int((distances(events, place) < 0.25).sum()))
            for place in events:
                most = max(most, int((distances(events, place) < 0.25).sum()))
            self.assertLessEqual(most, 2)
        self.assertEqual(most, 2)


if __name__ == "__main__":
    unittest.main()
