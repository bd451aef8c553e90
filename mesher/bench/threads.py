#!/usr/bin/env python3
"""Measures the speedup by several threads, for each stage of whole runs. Runs with one thread use each of the cores in
turn, because cores are not equally fast; a run with several threads uses as many cores as threads. Each of some rounds
has one run of every kind, and memory is made ready before each run (processes.fetch_memory). Prints a Markdown table of
medians of wall seconds and of speedups."""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
import tempfile
from pathlib import Path

from processes import fetch_memory, run as run_program
from tables import machine, seconds, table

stages = ("read", "complex", "refine", "coarsen", "improve", "check", "write", "total")


def run(program: Path, surface: Path, size: str, threads: int, cores: set[int], suffix: str,
        time_limit: float) -> dict[str, float]:
    fetch_memory()
    os.sched_setaffinity(0, cores)
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        run_program([str(program), str(surface), "--size", size, "--threads", str(threads), "-o", f"mesh{suffix}",
                     "--report", str(report), "--progress", "none"], Path(folder), time_limit)
        found = json.loads(report.read_text())["seconds"]
    return {stage: found.get(stage, 0.0) for stage in stages}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("surface", type=Path)
    parser.add_argument("size")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--threads", type=int, nargs="+", default=[2])
    parser.add_argument("--rounds", type=int, default=8)
    parser.add_argument("--suffix", default=".vtu", help="of the mesh that is written")
    parser.add_argument("--time-limit", type=float, default=600, help="seconds for one run")
    options = parser.parse_args()
    about = machine(options.build).replace("pinned to one core; ", "")
    print(f"{about}. {options.surface.name}, --size {options.size}, {options.suffix}, {options.rounds} rounds.\n")
    program, cores = options.build.resolve() / "bin" / "collarmesh", sorted(os.sched_getaffinity(0))
    ways = [("one thread, core " + str(core), 1, {core}) for core in cores]
    ways += [(f"{n} threads", n, set(cores[-n:])) for n in options.threads]
    runs: dict[str, list[dict[str, float]]] = {name: [] for name, _, _ in ways}
    for _ in range(options.rounds):
        for name, threads, where in ways:
            runs[name].append(run(program, options.surface.resolve(), options.size, threads, where, options.suffix,
                                  options.time_limit))
    medians = {name: {s: statistics.median(r[s] for r in of) for s in stages} for name, of in runs.items()}
    rows = [[name, *(seconds(of[s]) for s in stages)] for name, of in medians.items()]
    alone = [medians[name] for name, threads, _ in ways if threads == 1]
    for name, threads, _ in ways:
        if threads == 1:
            continue
        for what, pick in (("mean of the cores", statistics.mean), ("fastest core", min)):
            rows.append([f"{what} / {name}", *(f"{pick([of[s] for of in alone]) / medians[name][s]:.2f}"
                                               if medians[name][s] > 1e-3 else "" for s in stages)])
    print(table(["", *stages], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
