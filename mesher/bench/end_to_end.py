#!/usr/bin/env python3
"""Compares collarmesh with TetGen and Gmsh HXT at the same numbers of tetrahedra.

For the unit box and five parts of a corpus, this script first searches the size at which each mesher makes
nearly the wanted number of tets. Then the programs run in turn for some rounds, each pinned to one core; before
each run memory is made ready (processes.fetch_memory). Prints Markdown tables of medians. A file in the folder
for temporary files keeps the sizes.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
from dataclasses import dataclass, field
from pathlib import Path

from inputs import Surface, box, read_surface
from meshers import Collarmesh, Gmsh, MeshRun, TetGen, triangulation_seconds
from processes import ProgramFailed, fetch_memory, pin_to_core
from tables import exponent, machine, seconds, si, table, tets_text
from tuning import SizeCache, size_for, tolerance

# Closed parts, smooth or with sharp edges but without acute creases, which all three meshers can mesh.
default_parts = ["joint.off", "spool.off", "plate_holes.STL", "handle.off", "itemb.off"]


@dataclass
class Cell:
    """The runs of one mesher on one input at one number of tets, or the reason why there are none."""
    runs: list[MeshRun] = field(default_factory=list)
    triangulation: list[float] = field(default_factory=list)
    failure: str = ""

    def median(self, member: str) -> float:
        return statistics.median(getattr(r, member) for r in self.runs)

    @property
    def tets(self) -> int:
        return self.runs[-1].tets


def measure(meshers, surface: Surface, target: int, options, cache: SizeCache) -> dict[str, Cell]:
    """Measures each mesher at `target` tets: searches the sizes, then runs the programs in turn."""
    cells = {m.name: Cell() for m in meshers}
    sizes = {}
    for mesher in meshers:
        try:
            folder = work_folder(cache, mesher, surface)
            mesher.prepare(surface, folder)
            sizes[mesher.name] = size_for(mesher, surface, target, folder, cache)
        except ProgramFailed as failure:
            cells[mesher.name].failure = str(failure)
    for round_ in range(options.rounds):
        first = round_ % len(meshers)
        for mesher in (*meshers[first:], *meshers[:first]):
            cell = cells[mesher.name]
            if cell.failure:
                continue
            folder = work_folder(cache, mesher, surface)
            try:
                fetch_memory()
                cell.runs.append(mesher.mesh(surface, sizes[mesher.name], folder))
                if mesher.name == "collarmesh":
                    program = options.build / "bin" / "triangulate_points"
                    cell.triangulation.append(
                        triangulation_seconds(program, folder / "mesh.msh", options.time_limit))
            except ProgramFailed as failure:
                cell.failure = str(failure)
    return cells


def work_folder(cache: SizeCache, mesher, surface: Surface) -> Path:
    folder = cache.folder / f"{surface.name}_{mesher.name.replace(' ', '_')}"
    folder.mkdir(exist_ok=True)
    return folder


def main_rows(surface: Surface, target: int, cells: dict[str, Cell]) -> list[list[str]]:
    rows = []
    for name, cell in cells.items():
        if cell.failure:
            rows.append([surface.name, si(target), name, cell.failure, *[""] * 6])
            continue
        mark = "" if abs(cell.tets / target - 1) <= tolerance else " *"
        refinement = cell.median("refinement_cpu")
        structures = cell.median("structure_bytes") / cell.tets
        rows.append([surface.name, si(target), name, tets_text(cell.runs[-1]) + mark,
                     seconds(cell.median("cpu")), si(cell.tets / cell.median("cpu")),
                     seconds(refinement), si(cell.tets / refinement),
                     f"{cell.median('peak_bytes') / cell.tets:.0f}",
                     f"{structures:.0f}" if structures > 0 else ""])
    return rows


main_header = ["input", "target", "mesher", "tets", "CPU s", "tets/s", "refinement s", "refinement tets/s",
               "peak bytes/tet", "structure bytes/tet"]


def ratio_row(surface: Surface, target: int, cells: dict[str, Cell]) -> list[str]:
    """Returns a row for `ratio_header`: the speed of our refinement over the peers', its time over that of the bare
    triangulation, cells per tet, and the seconds of our stages."""
    def speed(name: str) -> float | None:
        cell = cells.get(name)
        return None if cell is None or cell.failure else cell.tets / cell.median("refinement_cpu")

    ours = speed("collarmesh")
    if ours is None:
        return [surface.name, si(target), *[""] * 5]
    text = [f"{ours / peer:.2f}" if peer else "" for peer in (speed("TetGen"), speed("Gmsh HXT"))]
    cell = cells["collarmesh"]
    triangulation = statistics.median(cell.triangulation)
    stages = cell.runs[-1].stages or {}
    rest = ", ".join(f"{stage} {seconds(t)}" for stage, t in stages.items() if stage != "total")
    return [surface.name, si(target), *text,
            f"{cell.median('refinement_cpu') / triangulation:.2f}",
            f"{cell.runs[-1].cells / cell.tets:.2f}", rest]


ratio_header = ["input", "target", "speed / TetGen's", "speed / HXT's", "time / bare triangulation", "cells / tets",
                "stages, s"]


def slope(small: Cell, large: Cell) -> float:
    return exponent(small.tets, small.median("refinement_cpu"), large.tets, large.median("refinement_cpu"))


def exponent_rows(surface: Surface, results: dict[int, dict[str, Cell]]) -> list[list[str]]:
    rows = []
    targets = sorted(results)
    for small, large in zip(targets, targets[1:]):
        row = [surface.name, f"{si(small)} to {si(large)}"]
        for name in results[small]:
            a, b = results[small][name], results[large][name]
            usable = not a.failure and not b.failure and b.tets > 2 * a.tets
            row.append(f"{slope(a, b):.2f}" if usable else "")
        rows.append(row)
    return rows


def count(text: str) -> int:
    return int(float(text.lower().replace("k", "e3").replace("m", "e6")))


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench",
                        help="build folder configured with COLLARMESH_BENCH (default: build/bench)")
    parser.add_argument("--corpus", type=Path, default=os.environ.get("COLLARMESH_CORPUS"),
                        help="folder of the parts (default: $COLLARMESH_CORPUS); without one, the box alone")
    parser.add_argument("--parts", nargs="*", default=default_parts)
    parser.add_argument("--targets", nargs="*", type=count, default=[10_000, 100_000, 1_000_000],
                        help="numbers of tets, such as 10k 1M")
    parser.add_argument("--large", action="store_true", help="also 5M tets")
    parser.add_argument("--no-box", action="store_true")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=600, help="seconds for one run of one program")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    if options.large:
        options.targets = sorted({*options.targets, 5_000_000})
    return options


def main() -> int:
    options = parse()
    about = machine(options.build)
    pin_to_core(options.core)
    arguments = ["--coarsen", "off", "--threads", "1"]
    meshers = [Collarmesh(options.build / "bin" / "collarmesh", options.time_limit, arguments),
               TetGen(options.time_limit), Gmsh(options.time_limit)]
    surfaces = [] if options.no_box else [box()]
    if options.corpus:
        surfaces += [read_surface(Path(options.corpus) / part) for part in options.parts]
    cache = SizeCache()
    rows, ratios, exponents = [], [], []
    for surface in surfaces:
        results = {}
        for target in options.targets:
            print(f"{surface.name}, {si(target)} tets ...", file=sys.stderr, flush=True)
            results[target] = measure(meshers, surface, target, options, cache)
            rows += main_rows(surface, target, results[target])
            ratios.append(ratio_row(surface, target, results[target]))
        exponents += exponent_rows(surface, results)
    print(about + ". " + ", ".join(f"{m.name} {m.version()}" for m in meshers)
          + f". Medians of {options.rounds}. * is further than {tolerance:.0%} from the target; "
          "(7) is exit code 7: meshed, but a guarantee is missed.\n")
    print(table(main_header, rows) + "\n")
    print(table(ratio_header, ratios) + "\n")
    print(table(["input", "exponent of refinement time in tets", *[m.name for m in meshers]], exponents))
    return 0


if __name__ == "__main__":
    sys.exit(main())
