#!/usr/bin/env python3
"""Meshes a box with n points on each of two skew lines. The Delaunay triangulation of these points has about n^2
tetrahedra, but a good mesh with these points needs only O(n). Prints CPU seconds of collarmesh and TetGen, and the
exponents with which the seconds grow with n."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from inputs import skew_lines
from meshers import Collarmesh, MeshRun, TetGen
from processes import ProgramFailed, pin_to_core
from tables import exponent, machine, seconds, si, table, tets_text
from tuning import SizeCache


def measure(mesher, points_per_line: int, folder: Path, rounds: int) -> MeshRun | str:
    """Returns the run with the median CPU time, or the error message of the mesher."""
    surface = skew_lines(points_per_line)
    mesher.prepare(surface, folder)
    runs = []
    try:
        for _ in range(rounds):
            runs.append(mesher.mesh(surface, size(mesher, surface.diagonal), folder))
    except ProgramFailed as failure:
        return str(failure)
    return sorted(runs, key=lambda run: run.cpu)[len(runs) // 2]


def size(mesher, diagonal: float) -> float:
    """Returns a size that is too large to have an effect, so that the points alone determine the mesh."""
    return float("inf") if isinstance(mesher, TetGen) else diagonal


def rows_of(mesher, results: dict[int, MeshRun | str]) -> list[list[str]]:
    rows = []
    before = None
    for n, result in results.items():
        if isinstance(result, str):
            rows.append([mesher.name, si(n), result, "", "", "", ""])
            before = None
            continue
        growth = "" if before is None else f"{exponent(before[0], before[1].cpu, n, result.cpu):.2f}"
        rows.append([mesher.name, si(n), seconds(result.cpu), seconds(result.refinement_cpu), growth,
                     tets_text(result), f"{result.peak_bytes / 1e6:.0f}"])
        before = (n, result)
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--points", nargs="*", type=int, default=[1000, 4000, 16000], help="per line")
    parser.add_argument("--tetgen-points", nargs="*", type=int, default=[1000, 2000, 4000])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=120)
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    folder = SizeCache().folder / "skew_lines"
    folder.mkdir(exist_ok=True)
    rows = []
    ours = Collarmesh(options.build / "bin" / "collarmesh", options.time_limit)
    tetgen = TetGen(options.time_limit, quality="2.0")
    for mesher, points in ((ours, options.points), (tetgen, options.tetgen_points)):
        rows += rows_of(mesher, {n: measure(mesher, n, folder, options.rounds) for n in points})
    print(about + f". TetGen {tetgen.version()} -pq2.0. Medians of {options.rounds}.\n")
    print(table(["mesher", "points per line", "CPU s", "refinement s", "exponent", "tets", "peak MB"], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
