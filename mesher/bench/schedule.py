#!/usr/bin/env python3
"""Estimates, with a simulated schedule, how much faster whole runs are with more threads than this machine has cores.
With COLLARMESH_RECORD_COSTS collarmesh runs on one core, divides its work as for several threads (--threads), and
records the CPU seconds of each piece of each parallel part, and of the serial work between these parts. It also
simulates workers, each of which takes the next piece as soon as it is free. This script sums up these times: serial
work runs on one worker, and each parallel part costs a barrier. The estimate ignores that workers share caches, memory
and the system. Prints Markdown tables."""

from __future__ import annotations

import argparse
import csv
import os
import tempfile
from collections import defaultdict
from pathlib import Path

from processes import run as run_program
from tables import machine, seconds, table

workers = (2, 4, 8, 16, 32, 64)


def record(program: Path, inputs: list[Path], size: str, threads: int, suffix: str, time_limit: float) -> list[dict]:
    """Returns the rows of the table that collarmesh writes: one for each place in the code, in each stage."""
    os.environ |= {"COLLARMESH_CORES": str(threads), "COLLARMESH_RECORD_COSTS": "costs.tsv"}
    with tempfile.TemporaryDirectory() as folder:
        run_program([str(program), *map(str, inputs), "--size", size, "--threads", str(threads), "-o", f"mesh{suffix}",
                     "--progress", "none", "-q"], Path(folder), time_limit)
        with open(Path(folder) / "costs.tsv", newline="") as file:
            return [{name: text if name in ("stage", "place") else float(text) for name, text in row.items()}
                    for row in csv.DictReader(file, delimiter="\t")]


def by_stage(rows: list[dict]) -> dict[str, dict[str, float]]:
    """Returns, for each stage, the sums of the columns over its rows. The stages are in their order in a run; "all",
    the total, is the last."""
    sums: dict[str, dict[str, float]] = defaultdict(lambda: defaultdict(float))
    order = ["start", "read", "complex", "refine", "coarsen", "improve", "project", "second order", "check", "write"]
    for row in sorted(rows, key=lambda row: order.index(row["stage"]) if row["stage"] in order else len(order)):
        for name, value in row.items():
            if name not in ("stage", "place"):
                sums[row["stage"]][name] += value
    for stage in list(sums):
        for name, value in sums[stage].items():
            sums["all"][name] += value
    return sums


def time_with(of: dict[str, float], count: int, barrier: float) -> float:
    return of["serial"] + (of["work"] if count == 1 else of[f"span_{count}"] + barrier * of["parts"])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("surface", type=Path)
    parser.add_argument("size")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--threads", type=int, default=16, help="number of threads for which the work is divided")
    parser.add_argument("--workers", type=int, nargs="+", default=[2, 16, 64], choices=workers)
    parser.add_argument("--barrier", type=float, default=5e-6, help="seconds for each parallel part")
    parser.add_argument("--places", type=int, default=12,
                        help="how many places to show, those that cost 16 workers the most")
    parser.add_argument("--suffix", default=".msh", help="of the mesh that is written")
    parser.add_argument("--time-limit", type=float, default=600)
    options = parser.parse_args()
    print(machine(options.build) + f". {options.surface.name}, --size {options.size}, {options.suffix}, divided for "
          f"{options.threads} threads.\n")
    rows = record(options.build.resolve() / "bin" / "collarmesh", [options.surface.resolve()], options.size,
                  options.threads, options.suffix, options.time_limit)
    shown = []
    for stage, of in by_stage(rows).items():
        alone = time_with(of, 1, options.barrier)
        if alone < 1e-4:
            continue
        shown.append([stage, seconds(alone), f"{100 * of['serial'] / alone:.1f}%", f"{of['parts']:.0f}",
                      *(f"{alone / time_with(of, count, options.barrier):.2f}" for count in options.workers)])
    print(table(["stage", "one worker, s", "serial", "parallel parts",
                 *(f"{count} workers: times" for count in options.workers)],
                shown) + "\n")
    rows.sort(key=lambda row: -time_with(row, 16, options.barrier))
    print(table(["stage", "up to", "serial, ms", "parallel, ms", "by 16 workers, ms", "parts"],
                [[row["stage"], f"`{row['place'].removeprefix('mesher/src/')}`", f"{1e3 * row['serial']:.1f}",
                  f"{1e3 * row['work']:.1f}", f"{1e3 * row['span_16']:.1f}", f"{row['parts']:.0f}"]
                 for row in rows[:options.places]]))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
