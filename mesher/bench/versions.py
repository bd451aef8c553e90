#!/usr/bin/env python3
"""Compares the refinement of this version with that of an older one (program `refine`, which makes no certificate and
no output), at equal numbers of tetrahedra, on the box and on parts of a corpus. The two programs run in turn, pinned to
one core; the first round does not count. Prints a Markdown table of medians of CPU time per tet."""

from __future__ import annotations

import argparse
import os
import re
import statistics
import sys
from dataclasses import dataclass
from pathlib import Path

from end_to_end import count, default_parts, work_folder
from inputs import Surface, box, read_surface
from processes import pin_to_core, run
from tables import machine, si, table
from tuning import SizeCache, size_for


@dataclass
class Refined:
    tets: int
    cpu: float   # seconds


class RefineProgram:
    """The program `refine` of a build folder."""

    def __init__(self, build: Path, name: str) -> None:
        self.program, self.name = (build / "bin" / "refine").resolve(), name

    def signature(self) -> str:
        state = self.program.stat()
        return f"{state.st_size}-{state.st_mtime_ns}"

    def prepare(self, surface: Surface, folder: Path) -> None:
        surface.write(folder / "input")

    def mesh(self, surface: Surface, size: float, folder: Path) -> Refined:
        output = run([str(self.program), *surface.files, f"{size:.17g}"], folder, 600).output
        found = re.search(r"refinement ([\d.]+) s, (\d+) tets", output)
        if not found:
            sys.exit(f"{self.program}: {output}")
        return Refined(int(found[2]), float(found[1]))


def row(surface: Surface, target: int, programs, rounds: int, cache: SizeCache) -> list[str]:
    folders = [work_folder(cache, program, surface) for program in programs]
    sizes = []
    for program, folder in zip(programs, folders):
        program.prepare(surface, folder)
        sizes.append(size_for(program, surface, target, folder, cache))
    runs = [[program.mesh(surface, size, folder) for program, size, folder in zip(programs, sizes, folders)]
            for _ in range(rounds + 1)][1:]
    per_tet = [[1e6 * run.cpu / run.tets for run in of_program] for of_program in zip(*runs)]
    return [surface.name, si(target), *[si(of_program[0].tets) for of_program in zip(*runs)],
            *[f"{statistics.median(times):.3f}" for times in per_tet],
            f"{statistics.median(before / now for now, before in zip(*per_tet)):.2f}"]


def main() -> int:
    root = Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=Path, help="build folder of the older version, configured with COLLARMESH_BENCH")
    parser.add_argument("--build", type=Path, default=root / "build" /
                        "bench", help="of this one (default: build/bench)")
    parser.add_argument("--corpus", type=Path, default=os.environ.get("COLLARMESH_CORPUS"),
                        help="folder of the parts (default: $COLLARMESH_CORPUS); without one, the box alone")
    parser.add_argument("--parts", nargs="*", default=default_parts)
    parser.add_argument("--targets", nargs="*", type=count, default=[10_000, 100_000, 1_000_000, 5_000_000],
                        help="numbers of tets, such as 10k 1M")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    programs = [RefineProgram(options.build, "refine"), RefineProgram(options.before, "refine before")]
    surfaces = [box()] + [read_surface(Path(options.corpus) / part) for part in options.parts if options.corpus]
    cache = SizeCache()
    rows = []
    for surface in surfaces:
        for target in options.targets:
            print(f"{surface.name}, {si(target)} tets ...", file=sys.stderr, flush=True)
            rows.append(row(surface, target, programs, options.rounds, cache))
    print(f"{about}. Medians of {options.rounds}.\n")
    print(table(["input", "target", "tets", "before", "us / tet", "before", "speed / before"], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
