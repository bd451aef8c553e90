"""CalculiX on meshes of shells (S6) against known answers: shells_test.py PROGRAM CASE. Exit code 77: no CalculiX.

roof: Scordelis-Lo, a cylindrical roof under its own weight; the middle of its free edge sinks by 0.3024.
plate: a square plate, simply supported, under pressure; Timoshenko's 0.00406 q a^4 / D in the middle.
"""

import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def patch_text(point, columns, rows):
    """An .off file of a patch: point(s, t), s and t from 0 to 1."""
    points = [point(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    quads = [[j * (columns + 1) + i, j * (columns + 1) + i + 1, (j + 1) * (columns + 1) + i + 1,
              (j + 1) * (columns + 1) + i] for j in range(rows) for i in range(columns)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    lines = ["OFF", f"{len(points)} {len(triangles)} 0"] + [" ".join(map(repr, p)) for p in points]
    return "\n".join(lines + [f"3 {a} {b} {c}" for a, b, c in triangles]) + "\n"


def nodes_of(text):
    block = re.search(r"\*NODE, NSET=NALL\n(.*?)\*", text, re.S).group(1)
    return {int(n): (float(x), float(y), float(z))
            for n, x, y, z in (line.split(",") for line in block.strip().splitlines())}


def solve(program, folder, surface, size, deck_of):
    """Returns the nodes and their displacements."""
    (folder / "in.off").write_text(surface)
    run = subprocess.run([program, "in.off", "-o", "mesh.inp", "--dimension", "2", "--order", "2", "--size", str(size),
                          "--distance", str(size / 50)], cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    nodes = nodes_of((folder / "mesh.inp").read_text())
    (folder / "job.inp").write_text("*INCLUDE, INPUT=mesh.inp\n" + deck_of(nodes))
    run = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True, check=False)
    data = (folder / "job.dat").read_text()
    moved = {int(f[0]): tuple(map(float, f[1:4])) for f in map(str.split, data.splitlines())
             if len(f) == 4 and f[0].isdigit()}
    assert moved, run.stdout[-2000:]
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
        return (f"*MATERIAL, NAME=M\n*ELASTIC\n{young}, {poisson}\n*SHELL SECTION, ELSET=EALL, MATERIAL=M\n{thickness}\n"
                "*BOUNDARY\n" + fixed(nodes, on_border, 3, 3) + f"{corner},1,2\n{other},2,2\n"
                + "*STEP\n*STATIC\n*DLOAD\nEALL, P, 0.01\n*NODE PRINT, NSET=NALL\nU\n*END STEP\n")

    nodes, moved = solve(program, folder, patch_text(lambda s, t: (side * s, side * t, 0.0), 1, 1), size, deck)
    middle = min(nodes, key=lambda n: math.dist(nodes[n], (side / 2, side / 2, 0)))
    stiffness = young * thickness**3 / 12 / (1 - poisson**2)
    near = math.dist(nodes[middle], (side / 2, side / 2, 0)) / side  # it sinks by a cosine there
    return abs(moved[middle][2]) / (0.00406 * 0.01 * side**4 / stiffness * math.cos(math.pi * near))


CASES = {"roof": (roof, (12, 6, 3), 0.03), "plate": (plate, (3, 1.5, 0.75), 0.03)}


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
