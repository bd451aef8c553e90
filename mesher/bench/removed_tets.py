#!/usr/bin/env python3
"""Compares the cost of removing a tetrahedron with that of making one, for CAD parts with the defaults.

Coarsening's time per removed tetrahedron is divided by two times: by refinement's time per tetrahedron that it makes;
and, because coarsening also improves the mesh, by the time of refinement and improvement per tetrahedron in runs with
--coarsen off. Each time is the least wall time of some runs. Prints a Markdown table of quantiles over the parts; with
--each another table with a line for every part."""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from processes import ProgramFailed, run as run_program
from real_parts import cad_suffixes
from tables import machine, table


@dataclass
class Costs:
    part: str
    made: int             # tetrahedra before coarsening
    left: int             # tetrahedra after coarsening
    removing: float       # microseconds per removed tetrahedron
    making: float         # microseconds per tetrahedron made by refinement
    making_good: float    # microseconds per tetrahedron refined and improved, with --coarsen off

    @property
    def over_making(self) -> float:
        return self.removing / self.making

    @property
    def over_making_good(self) -> float:
        return self.removing / self.making_good


def report_of(program: Path, part: Path, threads: int, time_limit: float, more: list[str]) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        run_program([str(program), str(part), "-o", "mesh.msh", "--threads", str(threads), "--report", str(report),
                     "--progress", "none", *more], Path(folder), time_limit)
        return json.loads(report.read_text())


def measure(program: Path, part: Path, threads: int, runs: int, time_limit: float) -> Costs:
    coarse = [report_of(program, part, threads, time_limit, []) for _ in range(runs)]
    fine = [report_of(program, part, threads, time_limit, ["--coarsen", "off"]) for _ in range(runs)]
    made, left = coarse[0]["coarsening"]["tets_before"], coarse[0]["coarsening"]["tets_after"]
    if left >= made:
        raise ProgramFailed("nothing was removed")

    def least(reports: list[dict], stage: str) -> float:
        return 1e6 * min(r["seconds"][stage] for r in reports)

    return Costs(part.name, made, left, least(coarse, "coarsen") / (made - left), least(coarse, "refine") / made,
                 (least(fine, "refine") + least(fine, "improve")) / fine[0]["mesh"]["tets"])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("parts", type=Path, nargs="+", help="CAD files, or folders of such")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--runs", type=int, default=2, help="of which the least time counts")
    parser.add_argument("--time-limit", type=float, default=60, help="seconds for one run")
    parser.add_argument("--each", action="store_true")
    options = parser.parse_args()
    program = options.build.resolve() / "bin" / "collarmesh"
    parts = [file for path in options.parts for file in (sorted(path.iterdir()) if path.is_dir() else [path])
             if file.suffix.lower() in cad_suffixes]
    rows, each, missing = [], [], []
    for threads in options.threads:
        costs = []
        for part in parts:
            try:
                costs.append(measure(program, part.resolve(), threads, options.runs, options.time_limit))
            except ProgramFailed as failure:
                missing.append(f"{part.name}, {threads}: {failure}")
        if len(costs) < 2:
            continue
        for what, of in (("one made by refinement", [c.over_making for c in costs]),
                         ("one refined and improved, with --coarsen off", [c.over_making_good for c in costs])):
            tenths = statistics.quantiles(of, n=10, method="inclusive")
            rows.append([str(threads), str(len(costs)), what, *
                        (f"{q:.2f}" for q in (tenths[0], statistics.median(of), tenths[-1]))])
        each += [[str(threads), c.part, str(c.made), str(c.left), *
                  (f"{x:.1f}" for x in (c.removing, c.making, c.making_good))] for c in costs]
    print(machine(options.build).replace("pinned to one core; ", "") + ".\n")
    print(table(["threads", "parts", "a removed tet over", "10%", "median", "90%"], rows))
    if options.each:
        print("\n" + table(["threads", "part", "made", "left",
              "us removed", "us made", "us refined and improved"], each))
    for line in missing:
        print("not measured: " + line, file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
