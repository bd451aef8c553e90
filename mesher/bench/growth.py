#!/usr/bin/env python3
"""Measures how time grows with the number of acute features (creases), with the ratio of their sizes (spread), and with
the shortness of mesh edges along curves (curves). creases: increasing numbers of wedges and fans in grids, and of teeth
of a comb. spread: a large wedge and above it a small one, ever smaller from input to input. curves: a cube with ever
shorter mesh edges along its own edges or along a segment across it, but long ones elsewhere. Prints Markdown tables;
with --plot FOLDER also draws the first two (matplotlib)."""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

from acute_inputs import AcuteInput
from meshers import Collarmesh, MeshRun
from processes import ProgramFailed, pin_to_core
from tables import exponent, machine, seconds, si, table, tets_text
from tuning import SizeCache

size = 1.0   # the shapes have sizes of about 1


@dataclass
class Series:
    """Inputs that differ in one number, and their results."""
    title: str
    inputs: dict[float, AcuteInput]
    runs: dict[float, MeshRun]

    def measure(self, mesher: Collarmesh, folder: Path, size: float) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        for at, shape in self.inputs.items():
            try:
                mesher.prepare(shape, folder)
                self.runs[at] = mesher.mesh(shape, size, folder)
                print(f"{self.title} {at:g}: {self.runs[at].cpu:.3g} s", file=sys.stderr)
            except ProgramFailed as failure:
                print(f"{self.title} {at:g}: {failure}", file=sys.stderr)


def crease_series(program: Path, largest: int) -> list[Series]:
    """Returns series with increasing numbers of crease segments. Wedges of 40 degrees, fans of 4 sheets (the sides of
    two such wedges, 40 degrees apart) and fans of 8 sheets have one crease segment each; grids of rotated copies have
    many. A comb has one at the tip of each tooth; the two facets at its ends extend over all its teeth."""
    counts = [n for k in range(1, 6) for n in (10 ** k, 3 * 10 ** k) if n <= min(largest, 100000)]
    copies = [Series(title, {n: AcuteInput(program, family, parameters, n) for n in counts if n <= most}, {})
              for title, family, parameters, most in (("wedges of 40 degrees", "wedge", (40, 1), 100000),
                                                      ("fans of 4 sheets", "wedges_touching_in_an_edge",
                                                       (40, 40), 100000),
                                                      ("fans of 8 sheets", "fan", (8, 0), 3000))]
    teeth = [n for n in counts if n <= 300]
    return [*copies, Series("comb, teeth of 30 degrees",
                            {n: AcuteInput(program, "comb", (n, 30)) for n in teeth}, {})]


def spread_series(program: Path) -> list[Series]:
    ratios = [10 ** (k / 2) for k in range(2, 13)]
    return [Series(f"wedges of {angle} degrees",
                   {r: AcuteInput(program, "wedge_on_a_large_one", (angle, 1 / r)) for r in ratios}, {})
            for angle in (90, 20)]


@dataclass
class Cube:
    """The unit cube. If `segment` is true, it contains a segment that is oblique to its sides."""
    title: str
    segment: bool
    suffix = ".poly"
    files = ("input.poly",)
    feature_angle = 0

    def curves(self) -> range:
        return range(13, 14) if self.segment else range(1, 13)

    def write(self, stem: Path) -> None:
        corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        facets = [(1, 2, 3, 4), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]
        if self.segment:
            corners += [(0.21, 0.32, 0.17), (0.83, 0.71, 0.76)]
            facets += [(9, 10)]
        lines = [f"{len(corners)} 3 0 0", *(f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(corners, 1)),
                 f"{len(facets)} 0", *(f"1\n{len(f)} {' '.join(map(str, f))}" for f in facets), "0", "0", ""]
        stem.with_suffix(self.suffix).write_text("\n".join(lines))


def curve_table(program: Path, time_limit: float, folder: Path) -> str:
    """Measures time and memory for cubes with fine curves, and for a cube meshed with one size everywhere. Returns a
    table. It has the memory per tet and the memory per cell of the triangulation (also outside the regions)."""
    rows = []
    folder.mkdir(parents=True, exist_ok=True)
    fine = [2.0 ** -k for k in range(6, 13)]
    cubes = [(Cube("the cube's edges", False), False, fine), (Cube("a segment across it", True), False, fine),
             (Cube("none, size as given", False), True, [0.042, 0.026, 0.0195])]
    for cube, uniform, lengths in cubes:
        before = None
        for length in lengths:
            sizes = [] if uniform else [f"{curve}={length}" for curve in cube.curves()]
            mesher = Collarmesh(program, time_limit, ["--coarsen", "off", *
                                (w for one in sizes for w in ("--curve-size", one))])
            mesher.prepare(cube, folder)
            run = mesher.mesh(cube, length if uniform else size, folder)
            refine = run.stages["refine"]
            growth = "" if before is None else f"{exponent(before.tets, before.stages['refine'], run.tets, refine):.2f}"
            rows.append([cube.title, f"{length:g}" if uniform else f"1/{1 / length:.0f}", tets_text(run),
                         seconds(refine), growth, f"{1e6 * refine / run.tets:.2f}",
                         f"{run.structure_bytes / run.tets:.0f}",
                         f"{run.cells / run.tets:.2f}", f"{run.structure_bytes / run.cells:.0f}"])
            before = run
    return table(["fine curves", "their edges", "tets", "refine s", "exponent", "us/tet", "bytes/tet", "cells/tet",
                  "bytes/cell"], rows)


def crease_table(series: list[Series]) -> str:
    rows = []
    for one in series:
        before = None
        for n, run in one.runs.items():
            growth = "" if before is None else f"{exponent(before, one.runs[before].cpu, n, run.cpu):.2f}"
            stages = run.stages
            rows.append([one.title, si(n), tets_text(run),
                         *(seconds(stages[stage]) for stage in ("read", "complex", "refine", "check")),
                         seconds(run.cpu), growth, f"{1e6 * stages['refine'] / run.tets:.2f}"])
            before = n
    return table(["shape", "crease segments", "tets", "read s", "complex s", "refine s", "check s", "CPU s",
                  "exponent", "refine us/tet"], rows)


def spread_table(series: list[Series]) -> str:
    rows = []
    for one in series:
        before = None
        for ratio, run in one.runs.items():
            if not math.log10(ratio).is_integer():
                continue
            rows.append([one.title, si(ratio), tets_text(run),
                         si(run.cells), "" if before is None else f"{run.cells - before.cells:+d}", seconds(run.cpu)])
            before = run
    return table(["shape", "large / small", "tets", "cells, outside too", "more", "CPU s"], rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("what", nargs="*", default=["creases", "spread", "curves"], help="creases, spread, curves")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--largest", type=int, default=100000, help="number of crease segments")
    parser.add_argument("--time-limit", type=float, default=3600)
    parser.add_argument("--plot", type=Path, help="folder for creases.svg and spread.svg")
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    # The default limit is half of the machine's memory. The largest numbers of creases take more.
    mesher = Collarmesh(options.build / "bin" / "collarmesh", options.time_limit, ["--max-memory", "0"])
    program = options.build / "bin" / "acute_shape"
    folder = SizeCache().folder / "acute"
    print(f"{about}. collarmesh {mesher.version()}.\n")
    if "creases" in options.what:
        series = crease_series(program, options.largest)
        for one in series:
            one.measure(mesher, folder / "creases", size)
        print(crease_table(series))
        if options.plot:
            plot_creases(series, options.plot / "creases.svg")
    if "spread" in options.what:
        series = spread_series(program)
        for one in series:
            one.measure(mesher, folder / "spread", 10 * size)
        print(spread_table(series))
        if options.plot:
            plot_spread(series, options.plot / "spread.svg")
    if "curves" in options.what:
        print(curve_table(mesher.program, options.time_limit, folder / "curves"))
    return 0


def axes_of_a_plot(title: str, horizontal: str, vertical: str):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plot
    plot.rcParams.update({"svg.hashsalt": "collarmesh", "svg.fonttype": "path", "font.size": 10})
    figure, axes = plot.subplots(figsize=(6, 4), layout="constrained")
    axes.set(title=title, xlabel=horizontal, ylabel=vertical)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def save(figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None})


def plot_creases(series: list[Series], path: Path) -> None:
    figure, axes = axes_of_a_plot("Growth with the number of creases", "crease segments", "CPU seconds")
    axes.set(xscale="log", yscale="log")
    for one in series:
        axes.plot(list(one.runs), [run.cpu for run in one.runs.values()], marker="o", label=one.title)
    counts = [n for n in series[0].runs]
    last = series[0].runs[counts[-1]].cpu
    axes.plot(counts, [last * n * math.log(n) / (counts[-1] * math.log(counts[-1])) for n in counts],
              color="0.5", linestyle="--", linewidth=1, label="n log n")
    axes.legend(frameon=False)
    save(figure, path)


def plot_spread(series: list[Series], path: Path) -> None:
    figure, axes = axes_of_a_plot("A small wedge beside a large one", "large / small", "cells, outside too")
    axes.set(xscale="log")
    for one in series:
        axes.plot(list(one.runs), [run.cells for run in one.runs.values()], marker="o", label=one.title)
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False)
    save(figure, path)


if __name__ == "__main__":
    sys.exit(main())
