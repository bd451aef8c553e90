"""Random complexes with their known properties: the volumes of regions, computed in another way, and the ways
in which a run may end.
Coordinates are on coarse grids, so that degeneracies are frequent: facets that touch, overlap, or lie in one
plane.
"""

import itertools
import math
import random

BOX_FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def box(low, high):
    return [(x, y, z) for z in (low[2], high[2])
            for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))], BOX_FACES


def prism(corners, low, high):
    """Returns the prism over a polygon in the plane."""
    n = len(corners)
    points = [(x, y, low) for x, y in corners] + [(x, y, high) for x, y in corners]
    return points, [tuple(reversed(range(n))), tuple(range(n, 2 * n)),
                    *[(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]]


def tet(random_):
    while True:
        points = [tuple(random_.randint(0, 6) for _ in range(3)) for _ in range(4)]
        if (volume := volume_of(points, faces := [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])) != 0:
            return points, faces if volume > 0 else [tuple(reversed(f)) for f in faces]


def volume_of(points, faces):
    six = 0
    for face in faces:
        for i in range(1, len(face) - 1):
            a, b, c = (points[face[k]] for k in (0, i, i + 1))
            six += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return six / 6


def area_of(points, faces):
    """Returns an upper bound on the area."""
    return sum(math.dist(points[f[0]], points[f[i]]) * math.dist(points[f[i]], points[f[i + 1]])
               for f in faces for i in range(1, len(f) - 1)) / 2


class Complex:
    """Points, facets and, if known, the sorted volumes of the regions. `rounding` bounds the change of a
    volume by rounding of the points."""

    def __init__(self, points, faces, volumes, name, rounding=0.0):
        self.points, self.faces, self.volumes, self.name = list(points), list(faces), volumes, name
        self.rounding = rounding

    def changed(self, points, faces=None):
        return Complex(points, self.faces if faces is None else faces, self.volumes, self.name, self.rounding)

    def off(self):
        lines = ["OFF", f"{len(self.points)} {len(self.faces)} 0"]
        lines += [" ".join(repr(float(x)) for x in p) for p in self.points]
        lines += [" ".join(map(str, (len(f), *f))) for f in self.faces]
        return "\n".join(lines) + "\n"


def joined(bodies):
    points, faces = [], []
    for body_points, body_faces in bodies:
        first = len(points)
        points += body_points
        faces += [tuple(first + i for i in face) for face in body_faces]
    return points, faces


def separate_bodies(random_):
    """Boxes, prisms and tets in cells of a grid, apart from each other."""
    cells = random_.sample(list(itertools.product(range(3), repeat=3)), random_.randint(1, 4))
    bodies = []
    for cell in cells:
        kind = random_.choice(["box", "prism", "tet"])
        if kind == "box":
            high = [random_.randint(1, 6) for _ in range(3)]
            points, faces = box((0, 0, 0), high)
        elif kind == "prism":
            n = random_.randint(3, 7)
            points, faces = prism([(3 + 3 * math.cos(2 * math.pi * i / n), 3 + 3 * math.sin(2 * math.pi * i / n))
                                   for i in range(n)], 0, random_.randint(1, 6))
        else:
            points, faces = tet(random_)
        bodies.append(([tuple(8.0 * c + x for c, x in zip(cell, p)) for p in points], faces))
    return Complex(*joined(bodies), sorted(volume_of(*b) for b in bodies), "separate")


def grid_of_boxes(random_):
    """Neighbouring cells of a grid. Each facet occurs once; cells with a common facet are regions with an
    interface."""
    steps = [[0.0, *itertools.accumulate(random_.choice([0.25, 1.0, 2.0]) for _ in range(n))]
             for n in (random_.randint(1, 3), random_.randint(1, 3), random_.randint(1, 2))]
    cells = [c for c in itertools.product(*(range(len(s) - 1) for s in steps))]
    chosen = set(random_.sample(cells, random_.randint(1, len(cells))))
    numbers, points, faces, known, volumes = {}, [], [], set(), []

    def number(p):
        if p not in numbers:
            numbers[p] = len(points)
            points.append(p)
        return numbers[p]

    for cell in sorted(chosen):
        low, high = ([s[c + d] for s, c in zip(steps, cell)] for d in (0, 1))
        volumes.append(math.prod(h - l for l, h in zip(low, high)))
        corners, sides = box(low, high)
        for side in sides:
            face = tuple(number(corners[i]) for i in side)
            if frozenset(face) not in known:
                known.add(frozenset(face))
                faces.append(face)
    return Complex(points, faces, None if touches_in_an_edge(chosen) else sorted(volumes), "grid")


def touches_in_an_edge(chosen):
    """Returns whether chosen cells enclose other cells, or share only an edge or corner: then the regions'
    volumes do not follow from the cells' volumes."""
    return any(c not in chosen for c in itertools.product(*(range(min(v), max(v) + 1) for v in zip(*chosen))))


def nested(random_):
    """A box in a box: a cavity if it is reversed, else a region."""
    size = random_.randint(3, 8)
    low = [random_.randint(1, size - 2) for _ in range(3)]
    high = [random_.randint(l + 1, size - 1) for l in low]
    turned = random_.random() < 0.5
    outer, inner = box((0, 0, 0), (size,) * 3), box(low, high)
    small = volume_of(*inner)
    if turned:
        inner = inner[0], [tuple(reversed(f)) for f in inner[1]]
    rest = size**3 - small
    return Complex(*joined([outer, inner]), sorted([rest] if turned else [rest, small]), "nested")


def soup(random_):
    """Bodies that overlap or touch, with some facets missing or doubled. No volume is known, but the run must
    end properly."""
    bodies = []
    for _ in range(random_.randint(2, 4)):
        offset = [random_.choice([0, 0.5, 1, 2, 3]) for _ in range(3)]
        points, faces = random_.choice([lambda: box((0, 0, 0), [random_.randint(1, 4) for _ in range(3)]),
                                        lambda: tet(random_)])()
        bodies.append(([tuple(x + o for x, o in zip(p, offset)) for p in points], faces))
    points, faces = joined(bodies)
    if random_.random() < 0.3:
        faces.pop(random_.randrange(len(faces)))
    if random_.random() < 0.3:
        faces.append(random_.choice(faces))
    if random_.random() < 0.3:
        i = random_.randrange(len(points))
        points[i] = tuple(x + random_.choice([0, 1e-3, -1e-7, 1e-12]) for x in points[i])
    return Complex(points, faces, None, "soup")


def slivers(random_):
    """A body with a flap or a wedge of almost no angle."""
    height = 10.0 ** -random_.randint(0, 12) * random_.choice([0, 1, 1, 1])
    points, faces = box((0, 0, 0), (1, 1, 1))
    points = [*points, (0.5, height, random_.choice([0.0, 0.5, -height]))]
    return Complex(points, [*faces, (0, 1, 8)], None, "sliver")


def random_complex(seed):
    random_ = random.Random(seed)
    made = random_.choice([separate_bodies, separate_bodies, grid_of_boxes,
                          grid_of_boxes, nested, soup, soup, slivers])(random_)
    return made, random_


def rotated(made, random_):
    a, b = random_.uniform(0, 6), random_.uniform(0, 6)
    ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)

    def turn(p):
        x, y, z = p[0] * ca - p[1] * sa, p[0] * sa + p[1] * ca, p[2]
        return x, y * cb - z * sb, y * sb + z * cb
    return made.changed([turn(p) for p in made.points])


def moved(made, random_):
    d = [random_.choice([-64.0, 0.0, 1024.0]) for _ in range(3)]
    return made.changed([tuple(x + y for x, y in zip(p, d)) for p in made.points])


def permuted(made, random_):
    order = list(range(len(made.points)))
    random_.shuffle(order)
    place = {old: new for new, old in enumerate(order)}
    faces = [tuple(place[i] for i in f) for f in made.faces]
    faces = [f[k:] + f[:k] for f in faces for k in [random_.randrange(len(f))]]
    random_.shuffle(faces)
    return made.changed([made.points[i] for i in order], faces)


def rounded(made, _):
    import struct
    single = lambda x: struct.unpack("f", struct.pack("f", x))[0]
    rounded_points = [tuple(single(x) for x in p) for p in made.points]
    changed = made.changed(rounded_points)
    moved_by = max(math.dist(p, q) for p, q in zip(made.points, rounded_points))
    changed.rounding += moved_by * area_of(rounded_points, made.faces)
    return changed


def some_turned(made, random_):
    """Reverses some facets, except of nested bodies, whose meaning depends on their orientation; otherwise
    neighbours tell the right one."""
    if made.name not in ("separate", "grid"):
        return made
    faces = list(made.faces)
    for i in random_.sample(range(len(faces)), min(2, len(faces) // 4)):
        faces[i] = tuple(reversed(faces[i]))
    return made.changed(made.points, faces)


CHANGES = [rotated, moved, permuted, rounded, some_turned]
