#!/usr/bin/env python3
"""Tests whether a smooth part is more expensive to mesh if its surface is finely tessellated: meshes spheres of
1k to 90k triangles at one size. Prints CPU seconds, and their ratio to those for the coarsest sphere."""

from __future__ import annotations

import argparse
import statistics
import sys
from pathlib import Path

from inputs import sphere
from meshers import Collarmesh, MeshRun
from processes import ProgramFailed, pin_to_core
from tables import machine, seconds, si, table, tets_text
from tuning import SizeCache


header = ["triangles", "tets", "CPU s", "ratio", "refinement s", "ratio", "stages, s"]


def median(runs: list[MeshRun], member: str) -> float:
    return statistics.median(getattr(run, member) for run in runs)


def row(triangles: int, runs: list[MeshRun], first: list[MeshRun]) -> list[str]:
    stages = runs[-1].stages or {}
    return [si(triangles), tets_text(runs[-1]),
            seconds(median(runs, "cpu")), f"{median(runs, 'cpu') / median(first, 'cpu'):.2f}",
            seconds(median(runs, "refinement_cpu")),
            f"{median(runs, 'refinement_cpu') / median(first, 'refinement_cpu'):.2f}",
            ", ".join(f"{stage} {seconds(t)}" for stage, t in stages.items() if stage != "total")]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--frequencies", nargs="*", type=int, default=[7, 15, 30, 67],
                        help="spheres of 20 f^2 triangles")
    parser.add_argument("--sizes", nargs="*", type=float, default=[0.2, 0.05],
                        help="target edge lengths")
    parser.add_argument("--improve", type=int, default=0, help="level of improvement")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=600)
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    mesher = Collarmesh(options.build.resolve() / "bin" / "collarmesh", options.time_limit,
                        improve=options.improve)
    folder = SizeCache().folder / "tessellation"
    folder.mkdir(exist_ok=True)
    print(about + f". Medians of {options.rounds}.")
    for size in options.sizes:
        rows, first = [], None
        for frequency in options.frequencies:
            surface = sphere(frequency)
            mesher.prepare(surface, folder)
            try:
                runs = [mesher.mesh(surface, size, folder) for _ in range(options.rounds)]
            except ProgramFailed as failure:
                rows.append([si(len(surface.polygons)), str(failure), *[""] * 5])
                continue
            first = first or runs
            rows.append(row(len(surface.polygons), runs, first))
        print(f"\nUnit sphere, size {size:g}\n")
        print(table(header, rows), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
