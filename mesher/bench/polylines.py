#!/usr/bin/env python3
"""Measures time and counts of work, with this version and, on request, with an older one: against the number of
segments of loose polylines, and against their spread (largest size / smallest size). The counts are the largest number
of cells per vertex at any time, the largest number of cells that one insertion destroyed (except where very many
features meet), the vertices inserted while skinny cells waited ("too early"), and the inspections per located point or
ball (`looks`). Prints Markdown tables."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from acute_inputs import AcuteInput
from meshers import Collarmesh, MeshRun
from processes import ProgramFailed, pin_to_core
from tables import exponent, machine, seconds, si, table
from tuning import SizeCache

size = 2.0   # the box is a unit cube, so only the features determine the mesh
# Each family has a name, a function that returns its further parameters from the number n of segments, and a factor by
# which --smallest is multiplied. Factors are small where n segments give n^2 vertices.
families: list[tuple] = [
    ("skew_zigzags", lambda n: (135,), 1), ("skew_zigzags", lambda n: (45,), 1), ("skew_combs", lambda n: (), 0.1),
    ("helices", lambda n: (), 0.3), ("torus_knot", lambda n: (), 1), ("random_walk", lambda n: (1,), 1),
    ("box_frames", lambda n: (1,), 1), ("graph", lambda n: (1,), 1), ("welded_mesh", lambda n: (), 1),
    ("crossed_wires", lambda n: (1,), 0.05), ("crossed_wires", lambda n: (n / 4,), 0.05),
    ("crossed_strips", lambda n: (1,), 0.02), ("outlines", lambda n: (), 1), ("star", lambda n: (1,), 0.1)]
squared = ("crossed_wires", "crossed_strips")   # they make n^2 vertices, so n grows by the square root of --factors
names = {("skew_zigzags", (45,)): "skew zigzags, creases", ("crossed_wires", (1,)): "crossed wires, near"}


def name_of(family: str, parameters: tuple) -> str:
    return names.get((family, parameters), family.replace("_", " "))


def number_of_segments(family: str, smallest: float, factor: float) -> int:
    return round(max(16, smallest) * (factor ** 0.5 if family in squared else factor))


def measure(mesher: Collarmesh, shape: AcuteInput, folder: Path) -> MeshRun | str:
    try:
        mesher.prepare(shape, folder)
        return mesher.mesh(shape, size, folder)
    except ProgramFailed as failure:
        return str(failure)


def counts_of(run: MeshRun) -> list[str]:
    """Returns the counts of a run. An older version has fewer counts: it lacks the peak of cells per vertex, and its
    largest cavity includes places where very many features meet."""
    counts = run.report["statistics"]["counts"]
    peak, early = counts.get("peak_cells_per_vertex"), counts.get("before_quality")
    looks = counts.get("looks")
    return ["" if peak is None else f"{peak:.1f}",
            si(counts.get("largest_cavity_outside_hubs", counts["largest_cavity"])),
            "" if early is None else si(early),
            "" if looks is None else f"{looks / counts['located']:.0f}"]


def cells_of(run: MeshRun | str, before: MeshRun | str | None) -> list[str]:
    """Returns table entries: inserted vertices, seconds, exponent with which the seconds have grown with the vertices
    since the run `before`, and the counts."""
    if isinstance(run, str):
        return ["", run, "", "", "", "", ""]
    vertices = run.report["statistics"]["vertices_inserted"]
    growth = ""
    if isinstance(before, MeshRun):
        earlier = before.report["statistics"]["vertices_inserted"]
        if vertices > 1.2 * earlier:
            growth = f"{exponent(earlier, before.refinement_cpu, vertices, run.refinement_cpu):.2f}"
    return [si(vertices), seconds(run.refinement_cpu), growth, *counts_of(run)]


def rows_of(meshers: list[Collarmesh], title: str, series: dict[str, AcuteInput], folder: Path) -> list[list[str]]:
    rows, last = [], [None] * len(meshers)
    for at, shape in series.items():
        runs = [measure(mesher, shape, folder) for mesher in meshers]
        rows.append([title, at, *(cell for run, before in zip(runs, last) for cell in cells_of(run, before))])
        print(" ".join(rows[-1]), file=sys.stderr)
        last = runs
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("what", nargs="*", default=["number", "spread"], help="number, spread")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--before", type=Path, help="an older version's program")
    parser.add_argument("--paper", action="store_true", help="beside --profile paper")
    parser.add_argument("--smallest", type=int, default=400,
                        help="number of segments, less where these make n^2 vertices")
    parser.add_argument("--factors", type=int, nargs="*", default=[1, 10, 100])
    parser.add_argument("--families", nargs="*", help="only these")
    parser.add_argument("--tens", type=int, nargs="*", default=[0, 2, 4],
                        help="powers of ten by which the small copy is smaller; above 4 nothing is repaired")
    parser.add_argument("--time-limit", type=float, default=600)
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    program, arguments = options.build / "bin" / "collarmesh", ["--coarsen", "off", "--threads", "1"]
    if max(options.tens) > 4:
        arguments += ["--repair", "none", "--weld", "1e-12"]
    meshers = {"": Collarmesh(program, options.time_limit, arguments)}
    if options.before:
        meshers[", before"] = Collarmesh(options.before, options.time_limit, arguments)
    if options.paper:
        meshers[", paper"] = Collarmesh(program, options.time_limit, [*arguments, "--profile", "paper"])
    generator = options.build / "bin" / "acute_shape"
    folder = SizeCache().folder / "polylines"
    folder.mkdir(parents=True, exist_ok=True)
    columns = ["vertices", "refine s", "exponent", "peak cells/vertex", "largest cavity", "too early", "looks"]
    header = ["polylines"] + [column + suffix for suffix in meshers for column in columns]
    print(f"{about}. collarmesh {meshers[''].version()}.\n")
    if "number" in options.what:
        rows = []
        for family, further, scale in families:
            if options.families and family not in options.families:
                continue
            counts = [number_of_segments(family, options.smallest * scale, factor) for factor in options.factors]
            series = {si(n): AcuteInput(generator, family, (n, *further(n))) for n in counts}
            rows += rows_of(list(meshers.values()), name_of(family, further(400)), series, folder)
        print(table([header[0], "n", *header[1:]], rows) + "\n")
    if "spread" in options.what:
        rows = []
        smalls = [0.08 * 10.0 ** -k for k in options.tens]
        for family, further, scale in families:
            n = max(16, round(options.smallest * scale / 4))
            series = {f"{small:g}": AcuteInput(generator, family, (n, *further(n)), small_copy=small)
                      for small in smalls if family != "crossed_strips" and family in (options.families or [family])}
            rows += rows_of(list(meshers.values()), name_of(family, further(400)), series, folder)
        series = {f"{small:g}": AcuteInput(generator, "shrinking_spiral", (60, small)) for small in smalls
                  if "shrinking_spiral" in (options.families or ["shrinking_spiral"])}
        rows += rows_of(list(meshers.values()), "shrinking spiral", series, folder)
        print(table([header[0], "smallest", *header[1:]], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
