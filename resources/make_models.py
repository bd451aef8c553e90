#!/usr/bin/python3
"""Makes the sample models in resources/models/ (always the same bytes).

    make_models.py [FOLDER]   (freecad-python3 makes the CAD shape)
"""

import math
import os
import re
import sys

SEGMENTS = 48  # segments of a full circle


class Surface:
    """A triangulated surface whose triangles have their solid behind them."""

    def __init__(self):
        self.points, self.triangles, self._index = [], [], {}

    def point(self, p):
        key = tuple(round(c, 9) + 0.0 for c in p)
        if key not in self._index:
            self._index[key] = len(self.points)
            self.points.append(key)
        return self._index[key]

    def triangle(self, a, b, c):
        self.triangles.append((self.point(a), self.point(b), self.point(c)))

    def quad(self, a, b, c, d):
        self.triangle(a, b, c)
        self.triangle(a, c, d)

    def wall(self, bottom, top):
        """Adds the strip between two closed polylines; seen from outside, `bottom` runs to the right."""
        for k in range(len(bottom)):
            n = (k + 1) % len(bottom)
            self.quad(bottom[k], bottom[n], top[n], top[k])

    def check(self):
        """Checks that every edge is used once in each direction, and that the volume is positive."""
        edges = [(t[i], t[(i + 1) % 3]) for t in self.triangles for i in range(3)]
        assert len(set(edges)) == len(edges), "an edge is used twice in one direction"
        directed = set(edges)
        assert all((b, a) in directed for a, b in edges), "the surface is open"
        assert self.volume() > 0, "the surface is inside out"

    def volume(self):
        total = 0.0
        for a, b, c in ([self.points[i] for i in t] for t in self.triangles):
            total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                      + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
        return total

    def write_off(self, path, closed=True):
        if closed:
            self.check()
        with open(path, "w") as out:
            out.write(f"OFF\n{len(self.points)} {len(self.triangles)} 0\n")
            for p in self.points:
                out.write("%.12g %.12g %.12g\n" % p)
            for t in self.triangles:
                out.write("3 %d %d %d\n" % t)


# ------------------------------------------------------------------ polygons with holes, in a plane
def orientation(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def cross_properly(a, b, c, d):
    return (orientation(a, b, c) * orientation(a, b, d) < 0
            and orientation(c, d, a) * orientation(c, d, b) < 0)


def joined(outline, holes):
    """Returns one polygon from an outline (counterclockwise) and holes (clockwise). The shortest bridge that
    crosses nothing joins each hole."""
    loop, holes = list(outline), [list(h) for h in holes]
    while holes:
        edges = [(r[k - 1], r[k]) for r in [loop] + holes for k in range(len(r))]
        bridges = sorted((math.dist(p, q), i, h, j) for i, p in enumerate(loop)
                         for h, hole in enumerate(holes) for j, q in enumerate(hole))
        _, i, h, j = next(b for b in bridges
                          if not any(cross_properly(loop[b[1]], holes[b[2]][b[3]], *e) for e in edges))
        hole = holes.pop(h)
        loop = loop[:i + 1] + hole[j:] + hole[:j + 1] + loop[i:]
    return loop


def smallest_angle(a, b, c):
    sides = [math.dist(b, c), math.dist(c, a), math.dist(a, b)]
    area = orientation(a, b, c) / 2
    longest = sorted(sides)
    return math.asin(min(1.0, 2 * area / (longest[1] * longest[2])))


def ears(outline, holes=()):
    """Returns triangles of a polygon with holes, by cutting off the ear with the best angle first."""
    loop, triangles = joined(outline, holes), []

    def ear_quality(k):
        a, b, c = loop[k - 1], loop[k], loop[(k + 1) % len(loop)]
        if orientation(a, b, c) <= 1e-12:
            return -1.0
        for p in loop:
            if p not in (a, b, c) and min(orientation(a, b, p), orientation(b, c, p), orientation(c, a, p)) >= 0:
                return -1.0
        return smallest_angle(a, b, c)

    while len(loop) > 3:
        k = max(range(len(loop)), key=ear_quality)
        assert ear_quality(k) > 0, "no ear left"
        triangles.append((loop[k - 1], loop[k], loop[(k + 1) % len(loop)]))
        del loop[k]
    return triangles + [tuple(loop)]


def arc(centre, radius, begin, end, segments):
    """Returns points on a circle from one angle to another (degrees), both ends included."""
    angles = [math.radians(begin + (end - begin) * k / segments) for k in range(segments + 1)]
    return [(centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t)) for t in angles]


def circle(centre, radius):
    return arc(centre, radius, 0, 360, SEGMENTS)[:-1]


# ------------------------------------------------------------------ solids
def add_plate(surface, outline, holes, place, thickness, open_edges=()):
    """Adds a plate with holes: `place(u, v, w)` puts it into space, w across the plate; (u, v, w) is a
    right-handed frame. The walls over `open_edges` (numbers of outline edges) are left out."""
    rounded = [[tuple(round(c, 9) for c in p) for p in ring] for ring in [outline] + list(holes)]
    outline, holes = rounded[0], rounded[1:]
    for a, b, c in ears(outline, [ring[::-1] for ring in holes]):
        surface.triangle(*(place(*p, thickness) for p in (a, b, c)))
        surface.triangle(*(place(*p, 0) for p in (c, b, a)))
    for k in range(len(outline)):
        if k not in open_edges:
            a, b = outline[k], outline[(k + 1) % len(outline)]
            surface.quad(place(*a, 0), place(*b, 0), place(*b, thickness), place(*a, thickness))
    for ring in holes:
        backwards = ring[::-1]
        surface.wall([place(*p, 0) for p in backwards], [place(*p, thickness) for p in backwards])


def chamfered_leg(length, width, chamfer):
    """Returns the outline of a leg: straight at u = 0 (its last edge), with cut corners at u = length."""
    return [(0, 0), (length - chamfer, 0), (length, chamfer), (length, width - chamfer),
            (length - chamfer, width), (0, width)]


def bracket():
    """Returns a bent bracket of 80 x 50 x 60 with two bolt holes in each leg; bend radii 8 and 18."""
    surface, width, thickness, inner, hole = Surface(), 50, 10, 8, 5.5
    outer = inner + thickness
    base = chamfered_leg(80 - outer, width, 10)
    upright = chamfered_leg(60 - outer, width, 10)
    # The upright's (u, v, w) is (z, y, x) mirrored in y, so that it stays right-handed.
    add_plate(surface, base, [circle((38, 13), hole), circle((38, 37), hole)],
              lambda u, v, w: (outer + u, v, w), thickness, open_edges={len(base) - 1})
    add_plate(surface, upright, [circle((22, 13), hole), circle((22, 37), hole)],
              lambda u, v, w: (w, width - v, outer + u), thickness, open_edges={len(upright) - 1})
    inside = [tuple(round(c, 9) for c in p) for p in arc((outer, outer), inner, 180, 270, SEGMENTS // 4)]
    outside = [tuple(round(c, 9) for c in p) for p in arc((outer, outer), outer, 180, 270, SEGMENTS // 4)]
    for k in range(len(inside) - 1):
        (ax, az), (bx, bz) = inside[k], inside[k + 1]
        (cx, cz), (dx, dz) = outside[k], outside[k + 1]
        surface.quad((ax, 0, az), (bx, 0, bz), (bx, width, bz), (ax, width, az))
        surface.quad((cx, 0, cz), (cx, width, cz), (dx, width, dz), (dx, 0, dz))
        surface.quad((ax, 0, az), (cx, 0, cz), (dx, 0, dz), (bx, 0, bz))
        surface.quad((ax, width, az), (bx, width, bz), (dx, width, dz), (cx, width, cz))
    return surface


def box():
    surface = Surface()
    add_plate(surface, [(0, 0), (3, 0), (3, 2), (0, 2)], [], lambda u, v, w: (u, v, w), 1)
    return surface


def open_box():
    """Returns a box that lacks one triangle."""
    surface = box()
    del surface.triangles[-1]
    return surface


def plate_with_hole():
    surface = Surface()
    add_plate(surface, [(0, 0), (40, 0), (40, 40), (0, 40)], [circle((20, 20), 10)], lambda u, v, w: (u, v, w), 4)
    return surface


def sphere():
    """Returns the unit sphere: an icosahedron subdivided three times."""
    surface = Surface()
    g = (1 + math.sqrt(5)) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
               (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
             (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5),
             (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]

    def unit(p):
        return tuple(c / math.hypot(*p) for c in p)

    triangles = [tuple(unit(corners[i]) for i in f) for f in faces]
    for _ in range(3):
        finer = []
        for a, b, c in triangles:
            ab, bc, ca = (unit(tuple(x + y for x, y in zip(p, q))) for p, q in ((a, b), (b, c), (c, a)))
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    for t in triangles:
        surface.triangle(*t)
    return surface


TWO_BOXES = """# Two boxes that share a face: regions 1 (2 x 1 x 1) and 2 (1 x 1 x 1).
# points
12 3 0 0
""" + "".join(f"{4 * i + k + 1} {x} {y} {z}\n" for i, x in enumerate((0, 2, 3))
              for k, (y, z) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1)))) + """# facets, the marker is the tag
11 1
""" + "".join(f"1 0 {tag}\n4 {corners}\n" for tag, corners in (
                  (1, "1 2 3 4"), (2, "5 6 7 8"), (3, "9 10 11 12"),
                  (4, "1 2 6 5"), (5, "2 3 7 6"), (6, "3 4 8 7"), (7, "4 1 5 8"),
                  (8, "5 6 10 9"), (9, "6 7 11 10"), (10, "7 8 12 11"), (11, "8 5 9 12"))) + """# hole points
0
# region points: number, x, y, z, tag
2
1 1 0.5 0.5 1
2 2.5 0.5 0.5 2
"""


CRACKED_BOX = """# A unit cube with a square sheet (tag 7), a segment (tag 20) and a point inside.
# points
15 3 0 0
""" + "".join(f"{k} {x} {y} {z}\n" for k, (x, y, z) in enumerate(
    [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    + [(0.3, 0.3, 0.5), (0.7, 0.3, 0.5), (0.7, 0.7, 0.5), (0.3, 0.7, 0.5), (0.2, 0.2, 0.2), (0.8, 0.2, 0.2),
       (0.5, 0.5, 0.8)])) + """# facets, the marker is the tag; a polygon of two corners is a segment
8 1
""" + "".join(f"1 0 {tag}\n{corners}\n" for tag, corners in (
           (1, "4 0 2 3 1"), (2, "4 4 5 7 6"), (3, "4 0 1 5 4"), (4, "4 2 6 7 3"), (5, "4 0 4 6 2"), (6, "4 1 3 7 5"),
           (7, "4 8 9 10 11"), (20, "2 12 13"))) + """# hole points
0
# region points
0
"""


FREECAD = "/usr/lib/freecad/lib"


def write_flange(path):
    """Writes a CAD shape by FreeCAD: a flange with four holes and a fillet, in millimetres."""
    sys.path.append(FREECAD)
    import FreeCAD
    import Part

    def cylinder(radius, height, x=0, y=0):
        return Part.makeCylinder(radius, height, FreeCAD.Vector(x, y, 0))

    shape = cylinder(20, 8).fuse(cylinder(9, 26)).cut(cylinder(5, 26))
    for x, y in ((14, 0), (-14, 0), (0, 14), (0, -14)):
        shape = shape.cut(cylinder(2.5, 8, x, y))
    inner = [e for e in shape.Edges if abs(e.Length - 18 * math.pi) < 1e-6 and abs(e.CenterOfMass.z - 8) < 1e-6]
    shape.makeFillet(2, inner).exportStep(path)
    with open(path) as file:
        text = re.sub(r"FILE_NAME\(.*?\);", "FILE_NAME('flange.step','',(''),(''),'','','');", file.read(), flags=re.S)
    with open(path, "w") as file:
        file.write(text)


def write_wires_in_box(path):
    """Writes a CAD shape by FreeCAD: a box with a circle inside, a needle that sticks out of its top, and a point
    inside; none of the three belongs to a face."""
    sys.path.append(FREECAD)
    import FreeCAD
    import Part

    loop = Part.makeCircle(6, FreeCAD.Vector(10, 10, 10))
    needle = Part.makeLine(FreeCAD.Vector(10, 10, 12), FreeCAD.Vector(10, 10, 24))
    Part.makeCompound([Part.makeBox(20, 20, 20), loop, needle, Part.Vertex(4, 10, 14)]).exportBrep(path)


def write_coil_in_box(path):
    """Writes a CAD shape by FreeCAD: a box with a wire of five turns inside, whose straight ends reach a side."""
    sys.path.append(FREECAD)
    import FreeCAD
    import Part

    helix = Part.makeHelix(3, 15, 6)
    helix.translate(FreeCAD.Vector(0, 0, -7.5))
    ends = [Part.makeLine(FreeCAD.Vector(6, 0, side * 7.5), FreeCAD.Vector(20, 0, side * 7.5)) for side in (-1, 1)]
    box = Part.makeBox(40, 40, 40, FreeCAD.Vector(-20, -20, -20))
    Part.makeCompound([box, *helix.Edges, *ends]).exportBrep(path)


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "models")
    os.makedirs(folder, exist_ok=True)
    for make in (bracket, box, plate_with_hole, sphere):
        make().write_off(os.path.join(folder, make.__name__ + ".off"))
    open_box().write_off(os.path.join(folder, "open_box.off"), closed=False)
    for name, text in (("two_boxes", TWO_BOXES), ("cracked_box", CRACKED_BOX)):
        with open(os.path.join(folder, name + ".poly"), "w") as out:
            out.write(text)
    write_flange(os.path.join(folder, "flange.step"))
    write_wires_in_box(os.path.join(folder, "wires_in_box.brep"))
    write_coil_in_box(os.path.join(folder, "coil_in_box.brep"))


if __name__ == "__main__":
    main()
