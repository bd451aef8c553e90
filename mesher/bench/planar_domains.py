#!/usr/bin/env python3
"""Meshes ten planar domains with collarmesh, with CGAL's version of Ruppert's refinement (Triangle's algorithm) and
with Gmsh, and prints a Markdown table of angles and numbers of triangles. The domains resemble those in papers and
collections on 2D meshing; this script computes their coordinates.

planar_domains.py collarmesh planar_cgal [SIZES_PER_DIAGONAL]

In the columns "angles alone", the only requirement is a smallest angle of 20.7 degrees, as with `triangle -pq`. This is
the largest bound for which Ruppert's refinement is proved to end. In the columns "size", the target edge length is 1/40
of the diagonal (or 1/SIZES_PER_DIAGONAL)."""

import math
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile

ANGLE = 20.7


class Domain:
    """A domain inside an outline and outside holes. The outline is a loop of points; a hole is a pair of a loop and a
    point inside the loop. `inside` are segments in the domain."""

    def __init__(self, name, source, outline, holes=(), inside=()):
        self.name, self.source, self.outline = name, source, outline
        self.holes, self.inside = list(holes), list(inside)

    def loops(self):
        return [self.outline, *(loop for loop, _ in self.holes)]

    def diagonal(self):
        xs, ys = zip(*self.outline)
        return math.hypot(max(xs) - min(xs), max(ys) - min(ys))

    def numbered(self):
        """Returns all points, with equal ones merged, and the segments as pairs of point numbers."""
        number, segments = {}, []
        for loop in self.loops():
            ids = [number.setdefault(p, len(number)) for p in loop]
            segments += zip(ids, ids[1:] + ids[:1])
        for a, b in self.inside:
            segments.append((number.setdefault(a, len(number)), number.setdefault(b, len(number))))
        return list(number), segments

    def poly(self):
        """Returns the text of a file in TetGen's format .poly with the domain as one facet."""
        points, _ = self.numbered()
        number = {p: i + 1 for i, p in enumerate(points)}
        polygons = [[number[p] for p in loop] for loop in self.loops()]
        polygons += [[number[a], number[b]] for a, b in self.inside] + [[i + 1]
                                                                        for i in range(len(points))]  # keeps points
        lines = [f"{len(points)} 3 0 0"] + [f"{i + 1} {x!r} {y!r} 0" for i, (x, y) in enumerate(points)]
        lines += ["1 0", f"{len(polygons)} {len(self.holes)}"] + \
            [f"{len(p)} " + " ".join(map(str, p)) for p in polygons]
        lines += [f"{i + 1} {x!r} {y!r} 0" for i, (_, (x, y)) in enumerate(self.holes)]
        return "\n".join(lines + ["0", "0", ""])

    def for_cgal(self):
        points, segments = self.numbered()
        lines = [str(len(points)), *(f"{x!r} {y!r}" for x, y in points),
                 str(len(segments)), *(f"{a} {b}" for a, b in segments)]
        return "\n".join(lines + [str(len(self.holes)), *(f"{x!r} {y!r}" for _, (x, y) in self.holes), ""])


def circle(x, y, radius, count, start=0.0):
    return [(x + radius * math.cos(start + 2 * math.pi * i / count),
             y + radius * math.sin(start + 2 * math.pi * i / count))
            for i in range(count)]


def round_hole(x, y, radius, count):
    return circle(x, y, radius, count), (x, y)


def letter():
    outline = [(0, 0), (14, 0), (22, 24), (58, 24), (66, 0), (80, 0), (48, 100), (32, 100)]
    return Domain("letter A", "Triangle's first example", [tuple(map(float, p)) for p in outline],
                  [([(27.0, 36.0), (53.0, 36.0), (40.0, 78.0)], (40.0, 50.0))])


def wavy(radius, waves, count):
    """Returns `count` points of a circle with waves added to its radius. Each of `waves` is (number of periods around
    the circle, amplitude relative to `radius`, phase)."""
    points = []
    for i in range(count):
        a = 2 * math.pi * i / count
        r = radius * (1 + sum(share * math.cos(n * a + phase) for n, share, phase in waves))
        points.append((r * math.cos(a), r * math.sin(a)))
    return points


def lake():
    outline = wavy(100, [(2, 0.25, 0.4), (3, 0.12, 1.0), (7, 0.07, 2.1),
                   (17, 0.03, 0.3), (41, 0.012, 1.7), (97, 0.005, 0.9)], 400)
    islands = []
    for x, y, radius in ((30, 10, 9), (-40, 15, 6), (-10, -30, 4), (60, -8, 3)):
        points = wavy(radius, [(2, 0.3, x), (5, 0.12, y), (11, 0.05, 1)], 60)
        islands.append(([(x + u, y + v) for u, v in points], (float(x), float(y))))
    return Domain("lake with islands", "as Shewchuk's Lake Superior", outline, islands)


def guitar():
    points = []
    for i in range(120):
        a = 2 * math.pi * i / 120
        r = 30 * (1 + 0.18 * math.cos(2 * a) + 0.1 * math.cos(3 * a) - 0.05 * math.cos(4 * a))
        points.append((r * math.cos(a), r * math.sin(a)))
    neck = [p for p in points if not (p[0] > 0 and abs(p[1]) < 4)]
    first = next(i for i, p in enumerate(neck) if p[0] > 0 and p[1] > 0)
    outline = [(110.0, -2.5), (122.0, -5.0), (124.0, 5.0), (110.0, 2.5)] + neck[first:] + neck[:first]
    return Domain("guitar", "as Shewchuk's electric guitar", outline,
                  [round_hole(0.0, 0.0, 8, 40), round_hole(-18.0, 0.0, 2, 12)])


def bolted_plate():
    holes = [round_hole(40 * math.cos(2 * math.pi * k / 6), 40 * math.sin(2 * math.pi * k / 6), 6, 32)
             for k in range(6)]
    return Domain("plate with seven holes", "finite element text books",
                  [(-70.0, -70.0), (70.0, -70.0), (70.0, 70.0), (-70.0, 70.0)],
                  [round_hole(0.0, 0.0, 18, 64), *holes])


def spiral():
    inner, outer = [], []
    for i in range(241):
        a = 6 * math.pi * i / 240
        for side, points in ((-1.2, inner), (1.2, outer)):
            r = 6 + 5 * a / math.pi + side
            points.append((r * math.cos(a), r * math.sin(a)))
    return Domain("spiral", "Triangle's page of examples", outer + inner[::-1])


def comb():
    outline = [(0.0, 0.0), (100.0, 0.0)]
    for tooth in range(20):
        x = 100.0 - 5 * tooth
        outline += [(x, 40.0), (x - 2, 40.0), (x - 2, 8.0), (x - 5, 8.0)]
    return Domain("comb", "polygons with narrow channels", outline[:-1] + [(0.0, 8.0)])


def gear():
    outline = []
    for tooth in range(24):
        a = 2 * math.pi * tooth / 24
        outline += [(r * math.cos(a + t), r * math.sin(a + t))
                    for r, t in ((44, -0.075), (50, -0.04), (50, 0.04), (44, 0.075))]
    bore = [p for p in circle(0.0, 0.0, 14, 64, math.pi / 64) if not (p[0] > 0 and abs(p[1]) < 3)]
    first = next(i for i, p in enumerate(bore) if p[0] > 0 and p[1] > 0)
    bore = bore[first:] + bore[:first] + [(math.sqrt(14**2 - 9), -3.0), (18.0, -3.0),
                                          (18.0, 3.0), (math.sqrt(14**2 - 9), 3.0)]
    return Domain("gear with a keyway", "machine parts", outline, [(bore, (0.0, 0.0))])


def airfoil():
    def half(x):
        return 0.6 * (0.2969 * math.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)

    xs = [(1 - math.cos(math.pi * i / 60)) / 2 for i in range(61)]
    foil = [(x, half(x)) for x in xs[::-1]] + [(x, -half(x)) for x in xs[1:-1]]
    return Domain("airfoil in a box", "NACA 0012, closed trailing edge",
                  [(-3.0, -3.0), (5.0, -3.0), (5.0, 3.0), (-3.0, 3.0)], [(foil, (0.3, 0.0))])


def snowflake():
    points = [(0.0, 0.0), (0.5, -math.sqrt(3) / 2), (1.0, 0.0)][::-1]
    points = [(p[0], p[1]) for p in ((0.0, 0.0), (1.0, 0.0), (0.5, math.sqrt(3) / 2))]
    for _ in range(3):
        finer = []
        for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1]):
            dx, dy = (bx - ax) / 3, (by - ay) / 3
            finer += [(ax, ay), (ax + dx, ay + dy),
                      (ax + 1.5 * dx + math.sqrt(3) / 2 * dy, ay + 1.5 * dy - math.sqrt(3) / 2 * dx),
                      (ax + 2 * dx, ay + 2 * dy)]
        points = finer
    return Domain("snowflake", "Koch's curve, three times", points)


def cracked_square():
    """Returns a square with segments inside, two of which meet at 9 degrees."""
    tip = (5.0, 5.0)
    return Domain("square with cracks", "segments inside, a small angle",
                  [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
                  inside=[(tip, (8.5, 5.0)), (tip, (8.5, 5.55)), (tip, (2.0, 7.5)), ((3.0, 2.0), (7.0, 2.2))])


DOMAINS = (letter, lake, guitar, bolted_plate, spiral, comb, gear, airfoil, snowflake, cracked_square)


def angles_of(path):
    """Reads a binary STL file. Returns the smallest and the largest angle, in degrees, and the number of triangles."""
    data = path.read_bytes()
    least, largest, count = 180.0, 0.0, struct.unpack_from("<I", data, 80)[0]
    for i in range(count):
        c = struct.unpack_from("<9f", data, 84 + 50 * i + 12)
        p = [c[0:3], c[3:6], c[6:9]]
        for k in range(3):
            u = [p[(k + 1) % 3][j] - p[k][j] for j in range(3)]
            v = [p[(k + 2) % 3][j] - p[k][j] for j in range(3)]
            angle = math.degrees(
                math.acos(max(-1.0, min(1.0, sum(map(float.__mul__, u, v)) / math.hypot(*u) / math.hypot(*v)))))
            least, largest = min(least, angle), max(largest, angle)
    return least, largest, count


def ours(program, domain, size, folder):
    (folder / "in.poly").write_text(domain.poly())
    run = subprocess.run([program, "in.poly", "-o", "out.stl", "--dimension", "2", "--size", repr(size), "--threads",
                          "1"],
                         cwd=folder, capture_output=True, text=True, check=False)
    if run.returncode not in (0, 7):
        raise SystemExit(f"{domain.name}: {run.stderr}")
    return *angles_of(folder / "out.stl"), run.returncode == 0


def cgals(program, domain, size):
    run = subprocess.run([program, str(ANGLE), repr(size)], input=domain.for_cgal(),
                         capture_output=True, text=True, check=True)
    least, largest, count, _ = run.stdout.split()
    return float(least), float(largest), int(count)


def gmshs(domain, size):
    import gmsh

    gmsh.initialize(["", "-v", "0"])
    points, segments = domain.numbered()
    tags = [gmsh.model.geo.addPoint(x, y, 0, size) for x, y in points]
    lines = {each: gmsh.model.geo.addLine(tags[each[0]], tags[each[1]]) for each in segments}
    loops, at = [], 0
    for loop in domain.loops():
        loops.append(gmsh.model.geo.addCurveLoop([lines[each] for each in segments[at:at + len(loop)]]))
        at += len(loop)
    face = gmsh.model.geo.addPlaneSurface(loops)
    gmsh.model.geo.synchronize()
    if domain.inside:
        gmsh.model.mesh.embed(1, [lines[each] for each in segments[at:]], 2, face)
    gmsh.option.setNumber("Mesh.Algorithm", 6)
    gmsh.model.mesh.generate(2)
    elements = gmsh.model.mesh.getElementsByType(2)[0]
    nodes = gmsh.model.mesh.getElementsByType(2)[1]
    coordinates = dict(zip(*(lambda n: (n[0], [n[1][3 * i:3 * i + 2]
                       for i in range(len(n[0]))]))(gmsh.model.mesh.getNodes())))
    least, largest = 180.0, 0.0
    for i in range(0, len(nodes), 3):
        p = [coordinates[n] for n in nodes[i:i + 3]]
        for k in range(3):
            u, v = p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]
            angle = math.degrees(math.atan2(abs(u[0] * v[1] - u[1] * v[0]), u @ v))
            least, largest = min(least, angle), max(largest, angle)
    gmsh.finalize()
    return least, largest, len(elements)


def main():
    program, cgal = (str(pathlib.Path(each).resolve()) for each in sys.argv[1:3])
    share = float(sys.argv[3]) if len(sys.argv) > 3 else 40
    print("| domain | kind | ours, angles alone | CGAL, angles alone | ours, size | CGAL, size | Gmsh, size |")
    print("|---|---|---|---|---|---|---|")
    ratios = [], []
    for make in DOMAINS:
        domain = make()
        size = domain.diagonal() / share
        with tempfile.TemporaryDirectory() as folder:
            alone = ours(program, domain, domain.diagonal(), pathlib.Path(folder))
            sized = ours(program, domain, size, pathlib.Path(folder))
        peers = cgals(cgal, domain, 0), cgals(cgal, domain, size), gmshs(domain, size)
        ratios[0].append(alone[2] / peers[0][2])
        ratios[1].append(sized[2] / peers[1][2])
        text = [f"{row[0]:.1f} to {row[1]:.1f}, {row[2]}" + ("" if row[3:] != (False,) else " (missed)")
                for row in (alone, peers[0], sized, *peers[1:])]
        print(f"| {domain.name} | {domain.source} | " + " | ".join(text) + " |", flush=True)
    print(
        f"\nTriangles over CGAL's, median: {statistics.median(ratios[0]):.2f} by angles alone, "
        f"{statistics.median(ratios[1]):.2f} with a size")


if __name__ == "__main__":
    main()
