#!/usr/bin/env python3
"""Compares how far meshes of thin parts bend under their own weight with the deflections by beam and shell theory.
CalculiX computes the deflections with elements of first and of second order, on our meshes (with default options) and
on Gmsh's (HXT) with the same target edge length. The parts are a tube and a strip clamped at one end, the roof of
Scordelis and Lo, and a spring. A wall's bending stiffness grows with the third power of its thickness, so a mesh with
too thin a wall bends too far. Prints a Markdown table."""

from __future__ import annotations

import argparse
import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import meshio
import numpy as np

from meshers import debian_version, gmsh_part_command
from processes import ProgramFailed, run
from tables import machine, table

Nodes = np.ndarray   # shape (n, 3)

make_shapes = """
import sys, math
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]
import FreeCAD, Part
V = FreeCAD.Vector
folder = sys.argv[1]
def tube(outer, inner, length, along):
    return Part.makeCylinder(outer, length, V(), along).cut(Part.makeCylinder(inner, length, V(), along))
tube(0.03, 0.027, 1, V(1, 0, 0)).exportStep(folder + "/tube.step")
Part.makeBox(1, 0.3, 0.01).exportStep(folder + "/strip.step")
sector = Part.Face(Part.makePolygon([V(0, 0, 0), \
V(0, -60 * math.sin(math.radians(40)), 60 * math.cos(math.radians(40))),
                                     V(0, 60 * math.sin(math.radians(40)), 60 * math.cos(math.radians(40))), \
V(0, 0, 0)]))
tube(25.125, 24.875, 50, V(1, 0, 0)).common(sector.extrude(V(50, 0, 0))).exportStep(folder + "/roof.step")
helix = Part.makeHelix(2, 10, 5)
wire = Part.Wire(Part.makeCircle(0.5, V(5, 0, 0), V(0, 1, 0)))
Part.Wire(helix.Edges).makePipeShell([wire], True, True).exportStep(folder + "/spring.step")
"""


@dataclass
class Part:
    name: str
    young: float            # Poisson's ratio is 0, so that a clamped end causes no disturbance
    weight: float           # weight per unit of volume, along -z
    expected: float         # expected deflection, by theory
    held: Callable[[Nodes], list[tuple[np.ndarray, int, int]]]   # (nodes, first, last direction in which they are held)
    looked_at: Callable[[Nodes], np.ndarray]                     # returns the nodes whose mean deflection is measured


def near(values: np.ndarray, value: float, scale: float) -> np.ndarray:
    return np.flatnonzero(np.abs(values - value) < 1e-6 * scale)


def bent_beam(young: float, weight: float, length: float, area: float, inertia: float, shear_share: float) -> float:
    """Returns the deflection, by bending and shear (Timoshenko), of the free end of a beam that is clamped at the other
    end, under its own weight."""
    load, shear_modulus = weight * area, young / 2
    return load * length**4 / (8 * young * inertia) + load * length**2 / (2 * shear_share * shear_modulus * area)


def sunk_spring(young: float, weight: float, radius: float, pitch: float, turns: float, wire: float) -> float:
    """Returns how far the upper end of a helix of round wire, clamped at its lower end, sinks under its own weight.
    Uses the unit load theorem. `wire`: the radius of the wire."""
    steps = 20000
    angle = np.linspace(0, 2 * math.pi * turns, steps + 1)
    angle = (angle[1:] + angle[:-1]) / 2
    rise = pitch / (2 * math.pi)
    centre = np.stack([radius * np.cos(angle), radius * np.sin(angle), rise * angle], 1)
    tangent = np.stack([-radius * np.sin(angle), radius * np.cos(angle), np.full_like(angle, rise)], 1)
    length = math.hypot(radius, rise)
    tangent /= length
    piece = length * (angle[1] - angle[0])
    area, inertia = math.pi * wire**2, math.pi * wire**4 / 4
    end = np.array([radius * math.cos(2 * math.pi * turns), radius * math.sin(2 * math.pi * turns), pitch * turns])
    down = np.array([0.0, 0.0, -1.0])
    # For each piece of the wire: the number of pieces from it to the free end, their centroid, and the moment of
    # their weight about the piece.
    beyond = np.cumsum(np.ones(steps)[::-1])[::-1]
    centroid = np.cumsum(centre[::-1], 0)[::-1] / beyond[:, None]
    moment = np.cross(centroid - centre, down) * (weight * area * piece * beyond)[:, None]
    unit = np.cross(end - centre, down)
    twist = (moment * tangent).sum(1) * (unit * tangent).sum(1)
    bend = (moment * unit).sum(1) - twist
    return float((twist / (young / 2 * 2 * inertia) + bend / (young * inertia)).sum() * piece)


def parts() -> list[Part]:
    def clamped(nodes: Nodes) -> list[tuple[np.ndarray, int, int]]:
        return [(near(nodes[:, 0], 0, 1), 1, 3)]

    def at_tip(nodes: Nodes) -> np.ndarray:
        return near(nodes[:, 0], 1, 1)

    def roof_held(nodes: Nodes) -> list[tuple[np.ndarray, int, int]]:
        ends = np.concatenate([near(nodes[:, 0], 0, 50), near(nodes[:, 0], 50, 50)])
        return [(ends, 2, 3), (ends[:1], 1, 1)]

    def amid_edges(nodes: Nodes) -> np.ndarray:
        edge = np.flatnonzero(np.abs(np.abs(np.arctan2(nodes[:, 1], nodes[:, 2])) - math.radians(40)) < 1e-6)
        off = np.abs(nodes[edge, 0] - 25)
        return edge[off == off.min()]

    def spring_held(nodes: Nodes) -> list[tuple[np.ndarray, int, int]]:
        lower = np.flatnonzero((np.abs(nodes[:, 1]) < 1e-6) & (nodes[:, 2] < 0.75) & (nodes[:, 0] > 0))
        return [(lower, 1, 3)]

    def spring_end(nodes: Nodes) -> np.ndarray:
        return np.flatnonzero((np.abs(nodes[:, 1]) < 1e-6) & (nodes[:, 2] > 9.25) & (nodes[:, 0] > 0))

    outer, inner = 0.03, 0.027
    ring, ring_inertia = math.pi * (outer**2 - inner**2), math.pi / 4 * (outer**4 - inner**4)
    return [
        Part("tube", 1e9, 1e4, bent_beam(1e9, 1e4, 1, ring, ring_inertia, 0.5), clamped, at_tip),
        Part("strip", 1e9, 1e2, bent_beam(1e9, 1e2, 1, 0.3 * 0.01, 0.3 * 0.01**3 / 12, 5 / 6), clamped, at_tip),
        Part("roof", 4.32e8, 360, 0.3024, roof_held, amid_edges),
        Part("spring", 1e9, 1e4, sunk_spring(1e9, 1e4, 5, 2, 5, 0.5), spring_held, spring_end),
    ]


def deflection(part: Part, mesh: meshio.Mesh, order: int, folder: Path, limit: float) -> float:
    kind, element = {1: ("tetra", "C3D4"), 2: ("tetra10", "C3D10")}[order]
    blocks = [block.data for block in mesh.cells if block.type == kind]
    if not blocks:
        raise ProgramFailed("no tets")
    tets = np.concatenate(blocks)
    used, tets = np.unique(tets, return_inverse=True)
    tets, nodes = tets.reshape(-1, 4 if order == 1 else 10) + 1, mesh.points[used]
    held, looked_at = part.held(nodes), part.looked_at(nodes)
    if any(len(h[0]) == 0 for h in held) or len(looked_at) == 0:
        raise ProgramFailed("no nodes where it is held or looked at")
    with open(folder / "job.inp", "w") as out:
        out.write("*NODE, NSET=all\n")   # CalculiX reads at most 20 characters of a number
        out.writelines("%d, %.12g, %.12g, %.12g\n" % (i + 1, *p) for i, p in enumerate(nodes))
        out.write(f"*ELEMENT, TYPE={element}, ELSET=body\n")
        out.writelines(", ".join(map(str, [i + 1, *t])) + "\n" for i, t in enumerate(tets))
        out.write("*NSET, NSET=looked\n" + "".join(f"{i + 1},\n" for i in looked_at))
        out.write(
            f"*MATERIAL, NAME=m\n*ELASTIC\n{part.young:g}, 0\n*DENSITY\n1\n*SOLID SECTION, ELSET=body, MATERIAL=m\n")
        out.write("*STEP\n*STATIC\n*BOUNDARY\n")
        for where, first, last in held:
            out.writelines(f"{i + 1}, {first}, {last}\n" for i in where)
        out.write(f"*DLOAD\nbody, GRAV, {part.weight:g}, 0, 0, -1\n*NODE PRINT, NSET=looked\nU\n*END STEP\n")
    run(["ccx", "-i", "job"], folder, limit)
    if not (folder / "job.dat").exists():
        raise ProgramFailed("no deflections")
    rows = [line.split() for line in (folder / "job.dat").read_text().splitlines()]
    moved = [float(r[3]) for r in rows if len(r) == 4 and r[0].isdigit()]
    if not moved:
        raise ProgramFailed("no deflections")
    return -sum(moved) / len(moved)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(Path(__file__).parents[2] / "collarmesh"))
    parser.add_argument("--parts", nargs="+", default=["tube", "strip", "roof", "spring"])
    parser.add_argument("--limit", type=float, default=300, help="seconds for a mesh or a computation")
    options = parser.parse_args()
    lines = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run(["/usr/bin/python3", "-c", make_shapes, name], check=True, stdout=subprocess.DEVNULL)
        for part in (p for p in parts() if p.name in options.parts):
            for order in (1, 2):
                line = [part.name, str(order)]
                for mesher in ("collarmesh", "Gmsh"):
                    shape = str(folder / f"{part.name}.step")
                    command = ([options.program, shape, "-o", "mesh.vtu", "--order", str(order), "--progress", "none",
                                "-q"]
                               if mesher == "collarmesh" else gmsh_part_command(Path(shape), "mesh.msh", order))
                    try:
                        run(command, folder, options.limit)
                        mesh = meshio.read(folder / ("mesh.vtu" if mesher == "collarmesh" else "mesh.msh"))
                        tets = sum(len(block.data) for block in mesh.cells if block.type in ("tetra", "tetra10"))
                        bent = deflection(part, mesh, order, folder, options.limit)
                        line += [str(tets), f"{100 * (bent / part.expected - 1):+.1f}%"]
                    except ProgramFailed as failure:
                        line += ["", str(failure)]
                lines.append(line)
                print(*line, file=sys.stderr)
    print(machine(Path(options.program).parent),
          f"Gmsh {debian_version('gmsh')}, CalculiX {debian_version('calculix-ccx')}.\n")
    print(table(["part", "order", "tets", "deflection", "Gmsh's tets", "its deflection"], lines))


if __name__ == "__main__":
    sys.exit(main())
