#!/usr/bin/env python3
"""Measures how the error of a solution falls with the number of unknowns, on meshes that are adapted to it
(`Mesh.adapt` with `estimated_errors` and `sizes_from_errors`) and on meshes of uniform size: the edge of an L-shaped
domain, Fichera's corner, and wires in a block with dolfinx; a plate with a hole and a notched bar with CalculiX.
Then adapts meshes many times, so that they get finer and coarser in turn, and measures how much volumes, curves and
names change, and how well edge lengths fit the requested sizes.

Errors are relative errors in the energy norm. With linear elements they fall at best like the number of unknowns
to the power of -1/3. Elements of second order on the last adapted mesh approximate the exact energies. Prints
Markdown tables."""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional

import numpy as np

from processes import ProgramFailed, run
from tables import machine, table

Array = np.ndarray


# Domains

def extruded(outline: list[tuple[float, float]], low: float, high: float) -> tuple[list, list]:
    """Returns points and facets of a prism over a polygon given counterclockwise."""
    n = len(outline)
    points = [(x, y, z) for z in (low, high) for x, y in outline]
    sides = [(i, (i + 1) % n, (i + 1) % n + n, i + n) for i in range(n)]
    return points, [tuple(reversed(range(n))), tuple(range(n, 2 * n)), *sides]


def l_shape(collarmesh):
    return collarmesh.Complex(*extruded([(1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1), (0, 0)], 0, 0.5))


def fichera(collarmesh):
    """Returns the cube (-1, 1)^3 without its octant of positive coordinates."""
    points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    index = {p: i for i, p in enumerate(points)}
    for p in [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1) if (x, y, z) != (1, 1, 1)]:
        index[p] = len(points)
        points.append(p)
    facets = [[(-1, -1, -1), (-1, -1, 1), (-1, 1, 1), (-1, 1, -1)]]
    whole = [[(1, -1, -1), (1, 1, -1), (1, 1, 0), (1, 0, 0), (1, 0, 1), (1, -1, 1)],
             [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)]]
    turned = lambda facet, k: [tuple(p[(i + k) % 3] for i in range(3)) for p in facet]
    all_facets = [turned(facet, k) for facet in facets + whole for k in range(3)]
    return collarmesh.Complex(points, [tuple(index[p] for p in facet) for facet in all_facets])


def wires_in_block(collarmesh):
    """Returns a block with two square holes through it, where two wires (electrodes) would be."""
    points, facets = extruded([(-1, -1), (1, -1), (1, 1), (-1, 1)], 0, 0.5)
    del facets[:2]
    rims = []
    for x in (-0.2, 0.2):
        outline = [(x - 0.01, -0.01), (x + 0.01, -0.01), (x + 0.01, 0.01), (x - 0.01, 0.01)]
        wire, sides = extruded(outline, 0, 0.5)
        first = len(points)
        points += wire
        facets += [tuple(first + i for i in reversed(side)) for side in sides[2:]]
        rims.append(first)
    holes = [[tuple(first + i + at for i in range(4)) for first in rims] for at in (0, 4)]
    ends = [[(3, 2, 1, 0), *holes[0]], [(4, 5, 6, 7), *[tuple(reversed(hole)) for hole in holes[1]]]]
    return collarmesh.Complex(points, [*facets, *ends])


def quarter_plate(collarmesh):
    """Returns a quarter of a plate with a hole of 12 sides; the quarter is 4 by 4 by 0.4. With a round hole, coarse and
    fine meshes would have different domains."""
    arc = [(math.cos(a), math.sin(a)) for a in np.linspace(math.pi / 2, 0, 4)]
    arc[0], arc[-1] = (0, 1), (1, 0)
    return collarmesh.Complex(*extruded([(4, 0), (4, 4), (0, 4), *arc], 0, 0.4))


def notched_bar(collarmesh):
    """Returns a bar, 4 by 2 by 0.5, with a notch of 60 degrees and depth 0.8 in the middle of a side."""
    half = 0.8 * math.tan(math.radians(30))
    return collarmesh.Complex(*extruded([(-2, 0), (-half, 0), (0, 0.8), (half, 0), (2, 0), (2, 2), (-2, 2)], 0, 0.5))


# Solvers

@dataclass
class Solution:
    values: Array    # values at the mesh's nodes (n or n x k); empty for order 2 in dolfinx
    unknowns: int
    energy: float
    squared_error: Optional[float] = None    # energy of the error, where the solution is known


class Poisson:
    """Poisson's equation in dolfinx with a constant load, and values on the part `where` of the boundary (None: 0)."""

    def __init__(self, load: float, values: Optional[Callable[[Array], Array]], where: Callable[[Array], Array],
                 gradient: Optional[Callable] = None) -> None:
        self.load, self.values, self.where, self.gradient = load, values, where, gradient

    # Returns the energy of the error. With a load it is the exact energy minus the energy of the finite elements;
    # without a load, when values on the boundary drive the solution, it is the reverse difference.
    def squared_error(self, energy: float, exact: float) -> float:
        return exact - energy if self.load else energy - exact

    def solve(self, mesh, order: int = 1) -> Solution:
        import dolfinx
        import ufl
        from dolfinx.fem.petsc import LinearProblem
        domain, _, _ = mesh.to_dolfinx()
        space = dolfinx.fem.FunctionSpace(domain, ("CG", order))
        held = dolfinx.fem.Function(space)
        if self.values:
            held.interpolate(self.values)
        fixed = dolfinx.fem.dirichletbc(held, dolfinx.fem.locate_dofs_geometrical(space, self.where))
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        load = dolfinx.fem.Constant(domain, float(self.load))
        options = {"ksp_type": "cg", "pc_type": "gamg", "ksp_rtol": 1e-10}
        found = LinearProblem(ufl.dot(ufl.grad(u), ufl.grad(v)) * ufl.dx, load * v * ufl.dx, [fixed],
                              petsc_options=options).solve()
        energy = dolfinx.fem.assemble_scalar(dolfinx.fem.form(ufl.dot(ufl.grad(found), ufl.grad(found)) * ufl.dx))
        values = np.empty((0, 1))
        if order == 1:
            values = np.empty(len(mesh.points))   # dolfinx has the nodes in another order
            given = np.take(domain.geometry.input_global_indices, domain.geometry.dofmap.array)
            values[given] = found.x.array[space.dofmap.list.array]
        squared = None
        if self.gradient:
            off = ufl.grad(found) - self.gradient(ufl, ufl.SpatialCoordinate(domain))
            measure = ufl.dx(metadata={"quadrature_degree": 5})   # this rule has no points on edges of tets
            squared = dolfinx.fem.assemble_scalar(dolfinx.fem.form(ufl.dot(off, off) * measure))
        return Solution(values, space.dofmap.index_map.size_global, energy, squared)


class Elasticity:
    """A body in CalculiX under traction along x: at both ends, or at one end if a plane of symmetry replaces the
    other."""

    young, poisson = 1.0, 0.3

    def __init__(self, pulled: list[tuple[float, float]], held: Callable[[Array], list[tuple[Array, int]]],
                 folder: Path, limit: float) -> None:
        self.pulled, self.held, self.folder, self.limit = pulled, held, folder, limit

    def squared_error(self, energy: float, exact: float) -> float:
        return exact - energy

    def forces(self, mesh, points: Array, order: int) -> Array:
        """Returns the force along x on each node from the tractions on the planes `pulled`."""
        forces = np.zeros(len(points))
        for place, traction in self.pulled:
            at = np.flatnonzero((np.abs(points[mesh.faces][:, :, 0] - place) < 1e-9).all(1))
            corners = points[mesh.faces[at]]
            areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
            nodes = mesh.faces[at] if order == 1 else mesh.face_mid_nodes[at]   # mid-edge nodes carry the load
            np.add.at(forces, nodes, (traction * areas / 3)[:, None])
        return forces

    def solve(self, mesh, order: int = 1) -> Solution:
        points = mesh.points
        tets = mesh.tets if order == 1 else np.hstack([mesh.tets, mesh.tet_mid_nodes])
        forces = self.forces(mesh, points, order)
        with open(self.folder / "job.inp", "w") as out:
            out.write("*NODE, NSET=all\n")
            out.writelines("%d, %.12g, %.12g, %.12g\n" % (i + 1, *p) for i, p in enumerate(points))
            out.write(f"*ELEMENT, TYPE={'C3D4' if order == 1 else 'C3D10'}, ELSET=body\n")
            out.writelines(", ".join(map(str, [i + 1, *t])) + "\n" for i, t in enumerate(tets + 1))
            out.write(
                f"*MATERIAL, NAME=m\n*ELASTIC\n{self.young}, {self.poisson}\n*SOLID SECTION, ELSET=body, MATERIAL=m\n")
            out.write("*STEP\n*STATIC\n*BOUNDARY\n")
            for nodes, direction in self.held(points):
                out.writelines(f"{i + 1}, {direction}\n" for i in nodes)
            out.write("*CLOAD\n")
            out.writelines(f"{i + 1}, 1, {forces[i]:.15g}\n" for i in np.flatnonzero(forces))
            out.write("*NODE PRINT, NSET=all\nU\n*END STEP\n")
        run(["ccx", "-i", "job"], self.folder, self.limit)
        moved = np.full((len(points), 3), np.nan)
        for line in (self.folder / "job.dat").read_text().splitlines():
            row = line.split()
            if len(row) == 4 and row[0].isdigit():
                moved[int(row[0]) - 1] = [float(number) for number in row[1:]]
        if np.isnan(moved).any():
            raise ProgramFailed("CalculiX printed no displacements")
        return Solution(moved, 3 * len(points), float(forces @ moved[:, 0]))


@dataclass
class Problem:
    name: str
    solver: str
    domain: Callable
    size: float                   # target size of the first mesh
    equation: Poisson | Elasticity
    expected_even: str            # rate at which errors fall on meshes of uniform size, by theory


def near(a: Array, b: float) -> Array:
    return np.abs(a - b) < 1e-9


def problems(folder: Path, limit: float) -> list[Problem]:
    def corner(x: Array) -> Array:
        angle = np.arctan2(x[1], x[0])
        return np.hypot(x[0], x[1]) ** (2 / 3) * np.sin(2 / 3 * np.where(angle < -1, angle + 2 * np.pi, angle))

    def corner_gradient(ufl, x):
        angle = ufl.atan_2(x[1], x[0])
        angle = ufl.conditional(ufl.lt(angle, -1), angle + 2 * math.pi, angle)
        along = 2 / 3 * (x[0] ** 2 + x[1] ** 2) ** (-1 / 6)
        return ufl.as_vector((-along * ufl.sin(angle / 3), along * ufl.cos(angle / 3), 0))

    def l_walls(x: Array) -> Array:
        return (near(abs(x[0]), 1) | near(abs(x[1]), 1)
                | near(x[0], 0) & (x[1] < 1e-9) | near(x[1], 0) & (x[0] > -1e-9))

    def fichera_walls(x: Array) -> Array:
        inner = (x > -1e-9).all(axis=0) & near(x, 0).any(axis=0)
        return near(np.abs(x), 1).any(axis=0) | inner

    def wire_walls(x: Array) -> Array:
        return (np.abs(np.abs(x[0]) - 0.2) < 0.01 + 1e-9) & (np.abs(x[1]) < 0.01 + 1e-9)

    def quarter_held(points: Array) -> list[tuple[Array, int]]:
        return [(np.flatnonzero(near(points[:, k], 0)), k + 1) for k in range(3)]

    def bar_held(points: Array) -> list[tuple[Array, int]]:
        at = lambda *p: np.flatnonzero(near(points, np.asarray(p)).all(axis=1))
        return [(at(-2, 2, 0), 1), (at(-2, 2, 0), 2), (at(-2, 2, 0), 3), (at(2, 2, 0), 2), (at(2, 2, 0), 3),
                (at(-2, 2, 0.5), 2)]

    plate = Elasticity([(4, 1)], quarter_held, folder, limit)
    bar = Elasticity([(-2, -1), (2, 1)], bar_held, folder, limit)
    return [
        Problem("edge of an L", "dolfinx", l_shape, 0.4, Poisson(0, corner, l_walls, corner_gradient), "0.22"),
        Problem("Fichera's corner", "dolfinx", fichera, 0.5, Poisson(1, None, fichera_walls), "0.22"),
        Problem("two wires", "dolfinx", wires_in_block, 0.4, Poisson(
            0, lambda x: np.sign(x[0]), wire_walls), "0.33, late"),
        Problem("plate with a hole", "CalculiX", quarter_plate, 0.5, plate, "0.25"),
        Problem("notched bar", "CalculiX", notched_bar, 0.4, bar, "0.17"),
    ]


# Loops

def rate(unknowns: list[float], errors: list[float]) -> float:
    """Returns the exponent r in errors ~ unknowns^-r, fitted by least squares."""
    return -float(np.polyfit(np.log(unknowns), np.log(errors), 1)[0])


def with_second_order(collarmesh, mesh):
    return mesh.adapt(order=2)


def study(collarmesh, problem: Problem, loops: int, first: int, growth: float, log) -> list[str]:
    equation = problem.equation
    domain = problem.domain(collarmesh)
    mesh = collarmesh.mesh(domain, size=problem.size, feature_angle=20)
    adapted, seconds, made = [], 0.0, 0
    for loop in range(loops + 1):
        solution = equation.solve(mesh)
        adapted.append(solution)
        log(f"{problem.name}: loop {loop}, {len(mesh.tets)} tets, {solution.unknowns} unknowns, energy "
            f"{solution.energy:.8g}")
        if loop == loops:
            break
        errors = collarmesh.estimated_errors(mesh, solution.values)
        sizes = collarmesh.sizes_from_errors(mesh, errors, elements=first * growth**loop)
        begin = time.process_time()
        mesh = mesh.adapt(sizes, threads=1)
        seconds += time.process_time() - begin
        made += len(mesh.tets)
    passed = mesh.passed
    fine = mesh if isinstance(equation, Poisson) else with_second_order(collarmesh, mesh)
    exact = equation.solve(fine, order=2).energy
    # This energy serves as the exact one: its error is only some percent of the error of first order on this mesh.
    log(f"{problem.name}: energy of second order {exact:.8g}")
    even = []
    for share in (1, 0.7, 0.5, 0.35, 0.25, 0.18):
        same = collarmesh.mesh(domain, size=problem.size * share, feature_angle=20)
        even.append(equation.solve(same))
        log(f"{problem.name}: equal sizes, {len(same.tets)} tets, energy {even[-1].energy:.8g}")
        if even[-1].unknowns > adapted[-1].unknowns:
            break

    def error(s: Solution) -> float:
        squared = equation.squared_error(s.energy, exact) if s.squared_error is None else s.squared_error
        return math.sqrt(max(squared, 0) / exact)

    by_size = ([s.unknowns for s in even], [error(s) for s in even])
    # Estimate how many unknowns a mesh of uniform size needs to reach the error of the last adapted mesh:
    # extrapolate from the finest mesh of uniform size by the rate of these meshes.
    last, slope = adapted[-1], rate(*by_size)
    needed = by_size[0][-1] * (by_size[1][-1] / error(last)) ** (1 / slope)
    low, high = extreme_angles(mesh)
    return [problem.name, problem.solver, f"{adapted[1].unknowns} to {last.unknowns}",
            f"{100 * error(adapted[1]):.2f} to {100 * error(last):.2f}%",
            f"{rate([s.unknowns for s in adapted[1:]], [error(s) for s in adapted[1:]]):.2f}",
            f"{slope:.2f} ({problem.expected_even})", f"{needed / last.unknowns:.1f}",
            f"{low:.1f} to {high:.1f}", f"{1e6 * seconds / made:.0f}", "yes" if passed else "no"]


def extreme_angles(mesh) -> tuple[float, float]:
    """Returns the smallest and the largest dihedral angle of the mesh, in degrees."""
    angles = dihedral_angles(mesh.points[mesh.tets])
    return float(angles[:, 0].min()), float(angles[:, 1].max())


def dihedral_angles(p: Array) -> Array:
    """Returns the smallest and the largest dihedral angle of each tet, in degrees; `p`: the corners, (n, 4, 3)."""
    normals = [np.cross(p[:, b] - p[:, a], p[:, c] - p[:, a])
               for a, b, c in ((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2))]
    normals = [n / np.linalg.norm(n, axis=1)[:, None] for n in normals]
    cosines = [-(normals[i] * normals[j]).sum(1) for i in range(4) for j in range(i)]
    angles = np.degrees(np.arccos(np.clip(np.column_stack(cosines), -1, 1)))
    return np.column_stack([angles.min(axis=1), angles.max(axis=1)])


# Up and down

def volumes_by_region(mesh) -> dict[int, float]:
    p = mesh.points[mesh.tets]
    volumes = np.abs(np.einsum("ij,ij->i", p[:, 1] - p[:, 0], np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 0]))) / 6
    return {int(tag): float(volumes[mesh.tet_region == tag].sum()) for tag in np.unique(mesh.tet_region)}


def lengths_by_curve(mesh) -> dict[int, float]:
    lengths = np.linalg.norm(mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]], axis=1)
    return {int(tag): float(lengths[mesh.edge_tag == tag].sum()) for tag in np.unique(mesh.edge_tag)}


def change(now: dict, before: dict) -> float:
    """Returns the largest relative change of a value; infinity if the keys differ."""
    if now.keys() != before.keys():
        return math.inf
    return max((abs(now[key] / before[key] - 1) for key in before), default=0.0)


def up_and_down(collarmesh, path: Path, loops: int, log) -> list[str]:
    """Adapts a mesh in each loop to sizes that grow with the distance from a place. The place moves from loop to loop,
    and the sizes near it are small in every other loop. Compares volumes, curves and names with those of the first
    mesh."""
    first = mesh = collarmesh.mesh(str(path))
    low, high = first.points.min(0), first.points.max(0)
    size = np.linalg.norm(high - low) / 20
    volumes, curves = volumes_by_region(first), lengths_by_curve(first)
    medians, percentiles, smallest, largest, passed = [], [], 180.0, 0.0, True
    for loop in range(loops):
        turn = 2 * math.pi * loop / 5
        centre = (low + high) / 2 + (high - low) / 3 * [math.cos(turn), math.sin(turn), 0]
        factor = (0.35, 1.0)[loop % 2]

        def wanted(points: Array) -> Array:
            return np.minimum(size * factor + 0.3 * np.linalg.norm(np.asarray(points) - centre, axis=-1), 1.4 * size)

        mesh = mesh.adapt(wanted(mesh.points))
        passed &= mesh.passed
        pairs = np.unique(np.sort(np.concatenate([mesh.tets[:, [i, j]]
                          for i in range(4) for j in range(i)]), axis=1), axis=0)
        ends = mesh.points[pairs]
        ratio = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / wanted(ends.mean(1))
        medians.append(float(np.median(ratio)))
        percentiles.append(float(np.percentile(ratio, 95)))
        angles = extreme_angles(mesh)
        smallest, largest = min(smallest, angles[0]), max(largest, angles[1])
        log(f"{path.name}: loop {loop}, {len(mesh.tets)} tets, lengths {medians[-1]:.2f}, {percentiles[-1]:.2f}, "
            f"angles {angles[0]:.1f} to {angles[1]:.1f}, volumes {change(volumes_by_region(mesh), volumes):.2g}")
    return [path.name, f"{len(first.tets)}", f"{len(mesh.tets)}",
            f"{100 * change(volumes_by_region(mesh), volumes):.2g}%",
            f"{100 * change(lengths_by_curve(mesh), curves):.2g}%", "yes" if mesh.names == first.names else "no",
            f"{min(medians):.2f} to {max(medians):.2f}", f"{max(percentiles):.2f}", f"{smallest:.1f} to {largest:.1f}",
            "yes" if passed else "no"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--module", default=str(Path(__file__).parents[2] / "build/release/python"),
        help="folder of the Python package")
    parser.add_argument("--problems", nargs="*", help="names of problems (default: all)")
    parser.add_argument("--loops", type=int, default=6)
    parser.add_argument("--first", type=int, default=3000, help="tets that the first loop asks for")
    parser.add_argument("--growth", type=float, default=1.8,
                        help="factor from the tets of one loop to those of the next")
    parser.add_argument("--up-and-down", type=int, default=12, help="loops of the second table")
    parser.add_argument("--models", nargs="*", type=Path, help="inputs of the second table")
    parser.add_argument("--limit", type=float, default=600, help="seconds for a computation by CalculiX")
    options = parser.parse_args()
    sys.path.insert(0, options.module)
    import collarmesh
    log = lambda text: print(text, file=sys.stderr, flush=True)
    print(machine(Path(options.module).parent))
    with tempfile.TemporaryDirectory() as name:
        rows = [study(collarmesh, problem, options.loops, options.first, options.growth, log)
                for problem in problems(Path(name), options.limit)
                if not options.problems or problem.name in options.problems]
    if rows:
        print(table(["problem", "solver", "unknowns", "error", "rate", "rate of equal sizes (theory)",
                     "times the unknowns at equal sizes", "angles", "µs a tet", "certified"], rows), "\n")
    models = Path(__file__).parents[2] / "resources/models"
    paths = options.models if options.models is not None else [models / "two_boxes.poly", models / "bracket.off",
                                                               models / "flange.step", models / "wires_in_box.brep"]
    rows = [up_and_down(collarmesh, path, options.up_and_down, log) for path in paths] if options.up_and_down else []
    if rows:
        print(table(["model", "tets", "in the end", "volumes", "curves", "names kept", "length to size, medians",
                     "largest 95th percentile", "angles", "certified"], rows))


if __name__ == "__main__":
    sys.exit(main())
