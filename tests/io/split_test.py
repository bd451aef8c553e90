#!/usr/bin/python3
"""Patches that were split, computed by CalculiX: a crack in a plate against the known opening, two blocks with friction
against Coulomb's law, and blocks tied at their split faces against the same mesh unsplit.

    split_test.py COLLARMESH CASE

CASE is one of crack, contact, tie. Exit code 0: as they should be; 1: they are not; 77: CalculiX is not installed.
"""
import math
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

BOX = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]  # -z +z -y +x +y -x
STIFFNESS = 1000.0
failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def corners(low, high):
    return [(x, y, z) for z in (low[2], high[2])
            for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))]


def write_poly(path, points, facets):
    """Writes a .poly file. facets: (corners, tag)."""
    lines = [f"{len(points)} 3 0 0", *(f"{k} {p[0]} {p[1]} {p[2]}" for k, p in enumerate(points)), f"{len(facets)} 1"]
    lines += [f"1 0 {tag}\n{len(facet)} " + " ".join(map(str, facet)) for facet, tag in facets]
    path.write_text("\n".join([*lines, "0", "0"]) + "\n")
    return path


def mesh(folder, name, *arguments):
    path = folder / f"{name}.inp"
    run = subprocess.run([sys.argv[1], *map(str, arguments), "-o", path], capture_output=True, text=True)
    expect(run.returncode == 0, f"{name}: exit code {run.returncode} {run.stderr}")
    return path.read_text()


def nodes_of(text):
    rows = text.split("*NODE, NSET=NALL\n", 1)[1].split("*", 1)[0].splitlines()
    return {int(row.split(",")[0]): np.array([float(x) for x in row.split(",")[1:]]) for row in rows}


def node_set(text, name):
    rows = text.split(f"*NSET, NSET={name}\n", 1)[1].split("*", 1)[0]
    return {int(word) for word in re.findall(r"\d+", rows)}


def solve(folder, name, before, material, steps):
    """Returns displacements and forces of all nodes at the end."""
    job = folder / f"{name}_job"
    job.with_suffix(".inp").write_text(
        f"{before}*INCLUDE, INPUT={name}.inp\n{material}*SOLID SECTION, ELSET=EALL, MATERIAL=BODY\n{steps}")
    run = subprocess.run(["ccx", "-i", job.name], cwd=folder, capture_output=True, text=True)
    expect(run.returncode == 0 and "Job finished" in run.stdout and "*ERROR" not in run.stdout,
           f"{name}: CalculiX says {run.stdout[-2000:]}")
    tables = re.split(r"\n (displacements|forces)[^\n]*\n", "\n" + job.with_suffix(".dat").read_text())
    result = {}
    for kind, text in zip(tables[1::2], tables[2::2]):  # later steps replace earlier ones
        rows = [line.split() for line in text.splitlines()]
        result[kind] = {int(row[0]): np.array(row[1:4], float) for row in rows if len(row) == 4 and row[0].isdigit()}
    return result


def elastic(poisson):
    return f"*MATERIAL, NAME=BODY\n*ELASTIC\n{STIFFNESS}, {poisson}\n"


def crack(folder):
    """A crack of half length 1 through a plate of half width 4 under unit tension. Without lateral
    contraction plane stress equals plane strain. The expected opening is by H. Tada (The Stress Analysis of
    Cracks Handbook)."""
    half, width, height = 1.0, 4.0, 8.0
    points = corners((-width, -height, 0), (width, height, 0.5))
    points += [(-half, 0, 0), (half, 0, 0), (half, 0, 0.5), (-half, 0, 0.5)]
    facets = [(facet, tag) for tag, facet in enumerate(BOX, 1)] + [((8, 9, 10, 11), 7)]
    poly = write_poly(folder / "plate.poly", points, facets)
    text = mesh(folder, "plate", poly, "--size", "0.8", "--patch-size", "7=0.06", "--gradation", "0.3", "--order", "2",
                "--split", "7", "--name", "crack=7")
    nodes = nodes_of(text)
    minus, plus = node_set(text, "CRACK_MINUS_NODES"), node_set(text, "CRACK_PLUS_NODES")
    at = {tuple(nodes[n]): n for n in minus}
    pairs = [(at[tuple(nodes[n])], n) for n in plus]
    expect(len(pairs) == len(minus) == len(plus), "the sides have other nodes")
    closed = [nodes[n] for m, n in pairs if m == n]
    expect(closed and all(abs(abs(p[0]) - half) < 1e-9 for p in closed), "the front alone is closed")
    mouths = [n for m, n in pairs if m != n and nodes[n][2] in (0, 0.5)]
    expect(len(mouths) > 10, "the mouths on the faces of the plate are open")
    held = min(nodes, key=lambda n: np.linalg.norm(nodes[n] - (0, -height, 0)))
    moved = solve(folder, "plate", "", elastic(0),
                  f"*BOUNDARY\nPATCH_3_NODES, 2, 2\nNALL, 3, 3\n{held}, 1, 1\n*STEP\n*STATIC\n*DSLOAD\nPATCH_5, P, -1\n"
                  "*NODE PRINT, NSET=NALL\nU\n*END STEP\n").get("displacements", {})
    if failures:
        return
    share = half / width
    form = (-0.071 - 0.535 * share + 0.169 * share**2 + 0.020 * share**3 - 1.071 / share * math.log(1 - share))
    known = 4 * half / STIFFNESS * form
    opening = max(abs(moved[n][1] - moved[m][1]) for m, n in pairs)
    print(f"opening {opening:.6g}, known {known:.6g}")
    expect(abs(opening / known - 1) < 0.02, f"the crack opens by {opening}, not by {known}")


def blocks(folder, name, *arguments):
    parts = [write_poly(folder / f"{name}{k}.poly", corners((0, 0, k), (1, 1, k + 1)),
                        [(facet, tag) for tag, facet in enumerate(BOX, 1 + 10 * k)]) for k in range(2)]
    return mesh(folder, name, *parts, "--size", "0.5", *arguments)


def contact(folder):
    """The upper block is pressed down and pushed sideways. It slides; the friction force is the coefficient
    times the normal force."""
    friction, down = 0.2, 0.001
    for order in ("1", "2"):
        name = f"blocks{order}"
        blocks(folder, name, "--keep-apart", "--interaction", "contact", "--order", order)
        interaction = ("*SURFACE INTERACTION, NAME=CONTACT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e5\n"
                       f"*FRICTION\n{friction}, 1e4\n")
        found = solve(folder, name, interaction, elastic(0),
                      "*BOUNDARY\nPATCH_1_NODES, 1, 3\nPATCH_12_NODES, 2, 2\n*STEP, NLGEOM, INC=100\n*STATIC\n0.2, 1\n"
                      f"*BOUNDARY\nPATCH_12_NODES, 3, 3, {-down}\nPATCH_12_NODES, 1, 1, 0.002\n"
                      "*NODE PRINT, NSET=PATCH_12_NODES\nRF\n*NODE PRINT, NSET=PATCH_12_NODES\nU\n*END STEP\n")
        if failures:
            return
        force = sum(found["forces"].values())
        print(f"order {order}: forces {force}")
        expect(abs(-force[2] / (STIFFNESS * down / 2) - 1) < 0.03, f"order {order}: pressed with {force[2]}")
        expect(abs(abs(force[0] / force[2]) - friction) < 0.03 * friction,
               f"order {order}: the force aside is {abs(force[0] / force[2])} of that down")


def tie(folder):
    """Tied blocks bend as one."""
    load = ("*BOUNDARY\nPATCH_1_NODES, 1, 3\n*STEP\n*STATIC\n*BOUNDARY\nPATCH_12_NODES, 1, 1, 0.1\n"
            "*NODE PRINT, NSET=NALL\nU\n*END STEP\n")
    for order in ("1", "2"):
        whole = blocks(folder, f"whole{order}", "--order", order)
        tied = blocks(folder, f"tied{order}", "--order", order, "--keep-apart", "--interaction", "tie")
        nodes, of_tied = nodes_of(whole), nodes_of(tied)
        expect(len(of_tied) > len(nodes), "nothing was split")
        at = {tuple(p): n for n, p in nodes.items()}
        one = solve(folder, f"whole{order}", "", elastic(0.3), load).get("displacements", {})
        two = solve(folder, f"tied{order}", "", elastic(0.3), load).get("displacements", {})
        if failures:
            return
        off = max(np.linalg.norm(two[n] - one[at[tuple(p)]]) for n, p in of_tied.items())
        print(f"order {order}: {len(of_tied) - len(nodes)} nodes tied, displacements off by {off:.3g} of 0.1")
        expect(off < 1e-4 * 0.1, f"order {order}: displacements are off by {off}")


def main():
    if shutil.which("ccx") is None:
        print("calculix-ccx is not installed: nothing tested")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        {"crack": crack, "contact": contact, "tie": tie}[sys.argv[2]](Path(folder))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
