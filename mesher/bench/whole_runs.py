#!/usr/bin/env python3
"""Compares whole runs of collarmesh and of Gmsh HXT with its optimization, with one thread and with two, at equal
numbers of tetrahedra.

The programs run in turn for some rounds, on as many cores as they may use threads; before each run memory is
made ready (processes.fetch_memory). Ours refines, coarsens, improves, checks and writes; HXT meshes the
surface, refines, optimizes and writes. "volume" is the time for our stages refine, coarsen and improve, and for
HXT's "meshing 3D", which starts from its surface mesh. Prints Markdown tables of medians of wall seconds.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
from pathlib import Path

from end_to_end import count, default_parts, work_folder
from inputs import Surface, box, read_surface
from meshers import Collarmesh, Gmsh, MeshRun
from processes import ProgramFailed, fetch_memory
from tables import machine, seconds, si, table, tets_text
from tuning import SizeCache, size_for


class Runs:
    """The runs of one mesher on one input at one number of tets, by the number of threads."""

    def __init__(self, threads: list[int]) -> None:
        self.by_threads: dict[int, list[MeshRun]] = {t: [] for t in threads}
        self.failure = ""

    def median(self, threads: int, member: str) -> float:
        return statistics.median(getattr(run, member) for run in self.by_threads[threads])

    def speed(self, threads: int, member: str) -> float:
        """Returns tets per second and thread."""
        return self.by_threads[threads][-1].tets / self.median(threads, member) / threads


def measure(options, makers, surface: Surface, target: int, cache: SizeCache) -> dict[str, Runs]:
    """Measures each mesher at a number of tets: searches the sizes, then runs the meshers in turn. Each of `makers`
    returns a mesher that uses the given number of threads."""
    results, sizes, folders = {}, {}, {}
    for make in makers:
        mesher = make(1)
        runs = results[mesher.name] = Runs(options.threads)
        folder = folders[mesher.name] = work_folder(cache, mesher, surface)
        try:
            mesher.prepare(surface, folder)
            sizes[mesher.name] = size_for(mesher, surface, target, folder, cache)
        except ProgramFailed as failure:
            runs.failure = str(failure)
    cores = sorted(os.sched_getaffinity(0))
    for _ in range(options.rounds):
        for threads in options.threads:
            os.sched_setaffinity(0, set(cores[-threads:]))
            for mesher in (make(threads) for make in makers):
                runs = results[mesher.name]
                if runs.failure:
                    continue
                try:
                    fetch_memory()
                    runs.by_threads[threads].append(mesher.mesh(surface, sizes[mesher.name], folders[mesher.name]))
                except ProgramFailed as failure:
                    runs.failure = str(failure)
    os.sched_setaffinity(0, set(cores))
    return results


def rows_of(surface: Surface, target: int, results: dict[str, Runs]) -> list[list[str]]:
    rows = []
    for name, runs in results.items():
        if runs.failure:
            rows.append([surface.name, si(target), name, runs.failure, *[""] * 5])
            continue
        for threads, made in runs.by_threads.items():
            rows.append([surface.name, si(target), name, tets_text(made[-1]), str(threads),
                         seconds(runs.median(threads, "volume_wall")), si(runs.speed(threads, "volume_wall")),
                         seconds(runs.median(threads, "wall")), si(runs.speed(threads, "wall"))])
    return rows


def ratio_rows(surface: Surface, target: int, results: dict[str, Runs]) -> list[list[str]]:
    ours, peer = results.values()
    rows = []
    for threads in ours.by_threads:
        if ours.failure or peer.failure:
            continue
        one, row = min(ours.by_threads), [surface.name, si(target), str(threads)]
        for member in ("volume_wall", "wall"):
            row.append(f"{ours.speed(threads, member) / peer.speed(threads, member):.2f}")
            row += [f"{runs.median(one, member) / runs.median(threads, member):.2f}" for runs in (ours, peer)]
        stages = ours.by_threads[threads][-1].report["seconds"]
        rows.append(row + [", ".join(f"{stage} {seconds(t)}" for stage, t in stages.items() if stage != "total")])
    return rows


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench",
                        help="build folder with bin/collarmesh (default: build/bench)")
    parser.add_argument("--corpus", type=Path, default=os.environ.get("COLLARMESH_CORPUS"),
                        help="folder of the parts (default: $COLLARMESH_CORPUS); without one, the box alone")
    parser.add_argument("--parts", nargs="*", default=default_parts)
    parser.add_argument("--targets", nargs="*", type=count, default=[100_000, 1_000_000],
                        help="numbers of tets, such as 100k 1M")
    parser.add_argument("--threads", nargs="*", type=int, default=[1, 2])
    parser.add_argument("--no-box", action="store_true")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=600, help="seconds for one run of one program")
    return parser.parse_args()


def main() -> int:
    options = parse()
    about = machine(options.build).replace("pinned to one core; ", "")

    def ours(threads: int) -> Collarmesh:
        return Collarmesh(options.build / "bin" / "collarmesh", options.time_limit, ["--threads", str(threads)],
                          improve=2, name="collarmesh, whole run")

    def peer(threads: int) -> Gmsh:
        return Gmsh(options.time_limit, threads=threads)

    surfaces = [] if options.no_box else [box()]
    if options.corpus:
        surfaces += [read_surface(Path(options.corpus) / part) for part in options.parts]
    cache = SizeCache()
    rows, ratios = [], []
    for surface in surfaces:
        for target in options.targets:
            print(f"{surface.name}, {si(target)} tets ...", file=sys.stderr, flush=True)
            results = measure(options, (ours, peer), surface, target, cache)
            rows += rows_of(surface, target, results)
            ratios += ratio_rows(surface, target, results)
    print(about + f". collarmesh {ours(1).version()}, Gmsh HXT {peer(1).version()}. Medians of {options.rounds}, wall "
          "seconds; tets/s are per core.\n")
    print(table(["input", "target", "mesher", "tets", "threads",
          "volume s", "tets/s", "whole run s", "tets/s"], rows) + "\n")
    print(table(["input", "target", "threads", "volume: speed / HXT's", "ours, gain by threads", "HXT's",
                 "whole run: speed / HXT's", "ours, gain by threads", "HXT's", "our stages, s"], ratios))
    return 0


if __name__ == "__main__":
    sys.exit(main())
