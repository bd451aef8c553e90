"""CalculiX on meshes without tets against known answers: shells_test.py PROGRAM CASE. Exit code 77: no CalculiX.

roof: Scordelis-Lo, a cylindrical roof under its own weight; the middle of its free edge sinks by 0.3024. S6.
plate: a square plate, simply supported, under pressure; Timoshenko's 0.00406 q a^4 / D in the middle. S6.
cylinder: pinched by two forces of 1, its ends on diaphragms; 1.8248e-5 below each force. S6.
channel: a cantilever of a channel section, bent along its flanges; F l^3 / (3 E I). S6.
hole: a quarter of a wide plate with a small hole, pulled; Kirsch's stress of 3 beside the hole. CPS6.
patch: a square whose border is displaced by a linear field, which the stresses inside have to be those of. CPE3 and
CPE6.
beam: a cantilever bent by a force at its end; F l^3 / (3 E I). B31 and B32.
"""

import math
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile


def patch_text(point, columns, rows):
    """Returns an .off file of a patch: point(s, t), s and t from 0 to 1."""
    points = [point(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    quads = [[j * (columns + 1) + i, j * (columns + 1) + i + 1, (j + 1) * (columns + 1) + i + 1,
              (j + 1) * (columns + 1) + i] for j in range(rows) for i in range(columns)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    lines = ["OFF", f"{len(points)} {len(triangles)} 0"] + [" ".join(map(repr, p)) for p in points]
    return "\n".join(lines + [f"3 {a} {b} {c}" for a, b, c in triangles]) + "\n"


def patches_text(patches):
    """Returns a .mesh file of grids of quads, each with a tag of its own: (point(s, t), columns, rows)."""
    points, triangles = [], []
    for tag, (point, columns, rows) in enumerate(patches, 1):
        first = len(points)
        points += [point(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
        for j in range(rows):
            for i in range(columns):
                a = first + j * (columns + 1) + i + 1
                triangles += [(a, a + 1, a + columns + 2, tag), (a, a + columns + 2, a + columns + 1, tag)]
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += [f"{x!r} {y!r} {z!r} 0" for x, y, z in points] + ["Triangles", str(len(triangles))]
    return "\n".join(lines + [" ".join(map(str, each)) for each in triangles] + ["End", ""])


def nodes_of(text):
    block = re.search(r"\*NODE, NSET=NALL\n(.*?)\*", text, re.S).group(1)
    return {int(n): (float(x), float(y), float(z))
            for n, x, y, z in (line.split(",") for line in block.strip().splitlines())}


def mesh_file(program, folder, surface, size, *options, extension=".off"):
    """Meshes a surface; returns the text of the mesh file, which is in the folder."""
    (folder / f"in{extension}").write_text(surface)
    run = subprocess.run([program, f"in{extension}", "-o", "mesh.inp", "--size", str(size), "--distance",
                          str(size / 50), *options], cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return (folder / "mesh.inp").read_text()


def calculix(folder, deck):
    """Runs CalculiX; returns the last block of numbers that it prints, {node or element: values}."""
    (folder / "job.inp").write_text("*INCLUDE, INPUT=mesh.inp\n" + deck)
    run = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True, check=False)
    lines = [f for f in map(str.split, (folder / "job.dat").read_text().splitlines()) if f and f[0].isdigit()]
    assert lines, run.stdout[-2000:]
    return lines


def solve(program, folder, surface, size, deck_of, extension=".off"):
    """Returns the nodes and their displacements."""
    nodes = nodes_of(mesh_file(program, folder, surface, size, "--dimension", "2", "--order", "2", extension=extension))
    moved = {int(f[0]): tuple(map(float, f[1:4])) for f in calculix(folder, deck_of(nodes)) if len(f) == 4}
    return nodes, moved


def fixed(nodes, where, first, last):
    chosen = [n for n, p in nodes.items() if where(p)]
    assert chosen
    return "".join(f"{n},{first},{last}\n" for n in chosen)


def roof(program, folder, size):
    radius, length, angle = 25, 50, math.radians(40)

    def point(s, t):
        a = angle * (2 * s - 1)
        return radius * math.sin(a), length * t, radius * math.cos(a)

    def deck(nodes):
        middle = min(nodes, key=lambda n: math.dist(nodes[n], point(0.5, 0.5)))
        return ("*MATERIAL, NAME=M\n*ELASTIC\n4.32e8, 0\n*DENSITY\n360\n*SHELL SECTION, ELSET=EALL, MATERIAL=M\n0.25\n"
                "*BOUNDARY\n"
                + fixed(nodes, lambda p: abs(p[1]) < 1e-6 or abs(p[1] - length) < 1e-6, 1, 1)
                + fixed(nodes, lambda p: abs(p[1]) < 1e-6 or abs(p[1] - length) < 1e-6, 3, 3) + f"{middle},2,2\n"
                + "*STEP\n*STATIC\n*DLOAD\nEALL, GRAV, 1, 0, 0, -1\n*NODE PRINT, NSET=NALL\nU\n*END STEP\n")

    nodes, moved = solve(program, folder, patch_text(point, 120, 20), size, deck)
    edge = min(nodes, key=lambda n: math.dist(nodes[n], point(1, 0.5)))
    return -moved[edge][2] / 0.3024


def plate(program, folder, size):
    side, thickness, young, poisson = 10, 0.1, 2.1e5, 0.3

    def deck(nodes):
        on_border = lambda p: min(p[0], p[1], side - p[0], side - p[1]) < 1e-6
        corner = min(nodes, key=lambda n: math.dist(nodes[n], (0, 0, 0)))
        other = min(nodes, key=lambda n: math.dist(nodes[n], (side, 0, 0)))
        return (f"*MATERIAL, NAME=M\n*ELASTIC\n{young}, {poisson}\n*SHELL SECTION, ELSET=EALL, MATERIAL=M\n"
                f"{thickness}\n*BOUNDARY\n" + fixed(nodes, on_border, 3, 3) + f"{corner},1,2\n{other},2,2\n"
                + "*STEP\n*STATIC\n*DLOAD\nEALL, P, 0.01\n*NODE PRINT, NSET=NALL\nU\n*END STEP\n")

    nodes, moved = solve(program, folder, patch_text(lambda s, t: (side * s, side * t, 0.0), 1, 1), size, deck)
    middle = min(nodes, key=lambda n: math.dist(nodes[n], (side / 2, side / 2, 0)))
    stiffness = young * thickness**3 / 12 / (1 - poisson**2)
    near = math.dist(nodes[middle], (side / 2, side / 2, 0)) / side  # there the deflection is a cosine
    return abs(moved[middle][2]) / (0.00406 * 0.01 * side**4 / stiffness * math.cos(math.pi * near))


def cylinder(program, folder, size):
    """Eight patches, which have corners at the forces."""
    radius, half, thickness = 300, 300, 3
    corners = []

    def quarter(number, low):
        def point(s, t):
            a = math.pi / 2 * (number + s)
            return round(radius * math.cos(a), 9), round(radius * math.sin(a), 9), low + half * t
        return point, 45, 30

    surface = patches_text([quarter(number, low) for number in range(4) for low in (-half, 0)])

    def deck(nodes):
        corners.extend(min(nodes, key=lambda n: math.dist(nodes[n], (x, 0, 0))) for x in (radius, -radius))
        on_diaphragm = lambda p: abs(abs(p[2]) - half) < 1e-6
        side = min(nodes, key=lambda n: math.dist(nodes[n], (0, radius, 0)))
        return ("*MATERIAL, NAME=M\n*ELASTIC\n3e6, 0.3\n*SHELL SECTION, ELSET=EALL, MATERIAL=M\n"
                f"{thickness}\n*BOUNDARY\n" + fixed(nodes, on_diaphragm, 1, 2) + f"{side},3,3\n"
                + f"*STEP\n*STATIC\n*CLOAD\n{corners[0]},1,-1\n{corners[1]},1,1\n*NODE PRINT, NSET=NALL\nU\n"
                  "*END STEP\n")

    _, moved = solve(program, folder, surface, size, deck, ".mesh")
    return (moved[corners[1]][0] - moved[corners[0]][0]) / 2 / 1.8248e-5


def shares_along(nodes, chosen, along):
    """Returns the shares of a line load for nodes along a line, with edges of second order."""
    order = sorted(chosen, key=lambda n: along(nodes[n]))
    shares = dict.fromkeys(order, 0.0)
    for first, middle, last in zip(order[:-2:2], order[1:-1:2], order[2::2]):
        length = math.dist(nodes[first], nodes[last])
        for node, share in ((first, 1 / 6), (middle, 4 / 6), (last, 1 / 6)):
            shares[node] += share * length
    return shares


def channel(program, folder, size):
    length, web, flange, thickness, young, force = 1000, 100, 50, 4, 2.1e5, 100
    tip = []
    surface = patches_text([(lambda s, t: (length * s, 0.0, web * (t - 0.5)), 10, 2),
                            (lambda s, t: (length * s, flange * t, -web / 2), 10, 2),
                            (lambda s, t: (length * s, flange * t, web / 2), 10, 2)])

    def deck(nodes):
        ends = [n for n, p in nodes.items() if abs(p[0] - length) < 1e-6]
        tip.extend(ends)
        loads = dict.fromkeys(ends, 0.0)
        for chosen, along in ((lambda p: p[1] < 1e-6, lambda p: p[2]),
                              (lambda p: p[2] < 1e-6 - web / 2, lambda p: p[1]),
                              (lambda p: p[2] > web / 2 - 1e-6, lambda p: p[1])):
            for n, share in shares_along(nodes, [n for n in ends if chosen(nodes[n])], along).items():
                loads[n] += force * share / (web + 2 * flange)
        assert abs(sum(loads.values()) / force - 1) < 1e-9
        return (f"*MATERIAL, NAME=M\n*ELASTIC\n{young}, 0.3\n*SHELL SECTION, ELSET=EALL, MATERIAL=M\n{thickness}\n"
                "*BOUNDARY\n" + fixed(nodes, lambda p: p[0] < 1e-6, 1, 3) + "*STEP\n*STATIC\n*CLOAD\n"
                + "".join(f"{n},2,{load!r}\n" for n, load in loads.items()) + "*NODE PRINT, NSET=NALL\nU\n*END STEP\n")

    _, moved = solve(program, folder, surface, size, deck, ".mesh")
    area = thickness * (web + 2 * flange)
    centre = 2 * thickness * flange * flange / 2 / area
    moment = (2 * thickness * flange**3 / 12 + 2 * thickness * flange * (flange / 2 - centre)**2
              + web * thickness * centre**2 + web * thickness**3 / 12)
    known = force * length**3 / (3 * young * moment)
    return statistics.mean(moved[n][1] for n in tip) / known


def stresses(folder):
    """Returns the stresses of the result file's last step, {node: (sxx, syy, ...)}."""
    found, inside = {}, False
    for line in (folder / "job.frd").read_text().splitlines():
        if line.startswith(" -4"):
            inside = "STRESS" in line
        elif line.startswith(" -1") and inside:
            found[int(line[3:13])] = tuple(float(line[i:i + 12]) for i in range(13, len(line.rstrip()), 12))
    return found


def hole(program, folder, size):
    """Returns the ratio of the stress beside the hole to that far away: 3.03 in a long plate with the width
    of twenty radii (Howland)."""
    width, length = 10, 30

    def point(s, t):
        a = math.pi / 2 * s
        c, d = math.cos(a), math.sin(a)
        out = min(length / max(c, 1e-9), width / max(d, 1e-9))
        return round(c * (1 + t * (out - 1)), 12), round(d * (1 + t * (out - 1)), 12), 0.0

    text = mesh_file(program, folder, patch_text(point, 480, 6), size, "--dimension", "2", "--order", "2",
                     "--triangle-elements", "plane-stress", "--elements-per-circle", str(round(40 / size)))
    assert "TYPE=CPS6" in text
    nodes = nodes_of(text)
    loads = shares_along(nodes, [n for n, p in nodes.items() if p[0] > length - 1e-9], lambda p: p[1])
    calculix(folder, "*MATERIAL, NAME=M\n*ELASTIC\n2.1e5, 0.3\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1\n*BOUNDARY\n"
             + fixed(nodes, lambda p: p[0] < 1e-9, 1, 1) + fixed(nodes, lambda p: p[1] < 1e-9, 2, 2)
             + "*STEP\n*STATIC\n*CLOAD\n" + "".join(f"{n},1,{load!r}\n" for n, load in loads.items())
             + "*NODE PRINT, NSET=NALL\nU\n*EL FILE, OUTPUT=2D\nS\n*END STEP\n")
    beside = min(nodes, key=lambda n: math.dist(nodes[n], (0, 1, 0)))
    return stresses(folder)[beside][0] / 3.03


def patch(program, folder, size):
    """Returns 1 plus the largest difference of a stress from the field's, relative to the largest one."""
    young, poisson = 1000, 0.3
    gradient = ((1e-3, 2e-4), (5e-4, -4e-4))
    worst = 0
    for order in (1, 2):
        text = mesh_file(program, folder, patch_text(lambda s, t: (2 * s, t, 0.0), 1, 1), size, "--dimension", "2",
                         "--order", str(order), "--triangle-elements", "plane-strain")
        assert f"TYPE=CPE{3 * order}" in text
        nodes = nodes_of(text)
        border = {n: p for n, p in nodes.items() if min(p[0], 2 - p[0], p[1], 1 - p[1]) < 1e-9}
        held = "".join(f"{n},{axis + 1},{axis + 1},{gradient[axis][0] * p[0] + gradient[axis][1] * p[1]:.12f}\n"
                       for n, p in border.items() for axis in (0, 1))
        lines = calculix(folder,
                         f"*MATERIAL, NAME=M\n*ELASTIC\n{young}, {poisson}\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1\n"
                         "*STEP\n*STATIC\n*BOUNDARY\n" + held + "*EL PRINT, ELSET=EALL\nS\n*END STEP\n")
        lame = young * poisson / (1 + poisson) / (1 - 2 * poisson)
        shear = young / 2 / (1 + poisson)
        trace = gradient[0][0] + gradient[1][1]
        known = (lame * trace + 2 * shear * gradient[0][0], lame * trace + 2 * shear * gradient[1][1], lame * trace,
                 shear * (gradient[0][1] + gradient[1][0]))
        found = [tuple(map(float, f[2:6])) for f in lines if len(f) == 8]
        elements = text.split("*ELEMENT")[1].split("*")[0].count("\n") - 1
        assert len(found) >= elements > 0, "stresses of all elements"
        worst = max(worst, *(abs(a - b) / max(map(abs, known)) for each in found for a, b in zip(each, known)))
    return 1 + worst


def beam(program, folder, size):
    length, side, young, force = 100, 5, 2.1e5, 10
    wire = "3 3 0 0\n1 0 0 0\n2 30 0 0\n3 100 0 0\n2 0\n1 0 1\n2 1 2\n1 0 1\n2 2 3\n0\n0\n"
    known = force * length**3 / (3 * young * side**4 / 12)
    shares = []
    for order in (1, 2):
        text = mesh_file(program, folder, wire, size, "--dimension", "1", "--order", str(order), extension=".poly")
        assert f"TYPE=B3{order}, ELSET=CURVE_" in text, text[-2000:]
        nodes = nodes_of(text)
        end = min(nodes, key=lambda n: math.dist(nodes[n], (length, 0, 0)))
        start = min(nodes, key=lambda n: math.dist(nodes[n], (0, 0, 0)))
        lines = calculix(folder,
                         f"*MATERIAL, NAME=M\n*ELASTIC\n{young}, 0\n"
                         "*BEAM SECTION, ELSET=EALL, MATERIAL=M, SECTION=RECT\n"
                         f"{side}, {side}\n0, 1, 0\n*BOUNDARY\n{start},1,6\n*STEP\n*STATIC\n*CLOAD\n{end},3,{force}\n"
                         "*NODE PRINT, NSET=NALL\nU\n*END STEP\n")
        shares.append(next(float(f[3]) for f in lines if len(f) == 4 and int(f[0]) == end) / known)
    print("B31, B32:", *(f"{share:.4f}" for share in shares))
    return max(shares, key=lambda share: abs(share - 1))


CASES = {"roof": (roof, (12, 6, 3), 0.03), "plate": (plate, (3, 1.5, 0.75), 0.03),
         "cylinder": (cylinder, (60, 40, 25), 0.05), "channel": (channel, (40, 20, 10), 0.02),
         "hole": (hole, (2, 1, 0.5), 0.03), "patch": (patch, (0.4, 0.2), 1e-4),
         "beam": (beam, (20, 10, 5), 0.02)}


def main():
    program, case = sys.argv[1:]
    if shutil.which("ccx") is None:
        print("CalculiX is not there")
        return 77
    run, sizes, allowed = CASES[case]
    shares = []
    for size in sizes:
        with tempfile.TemporaryDirectory() as folder:
            shares.append(run(program, pathlib.Path(folder), size))
            print(f"{case}: size {size}: {shares[-1]:.4f} of the known displacement", flush=True)
    assert abs(shares[-1] - 1) < allowed, shares
    assert abs(shares[-1] - 1) <= abs(shares[0] - 1) + 0.005, "does not converge"
    return 0


if __name__ == "__main__":
    sys.exit(main())
