#!/usr/bin/env python3
"""Compares two modes of placing the balls around creases: before the refinement (up-front), and during it (in-pass).
Prints a Markdown table of tets, inserted vertices and time, summed over some seeds, for the acute families and for
increasing numbers of wedges. Runs of the two modes alternate."""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

from acute_inputs import AcuteInput
from acute_peers import curved
from meshers import Collarmesh, MeshRun
from processes import pin_to_core
from tables import machine, seconds, si, table
from tuning import SizeCache

shapes: list[tuple] = [
    ("wedge", 40, 1), ("wedge", 20, 1), ("wedge", 5, 1), ("wedge", 1, 1), ("wedge_on_a_large_one", 20, 1e-4),
    ("fan", 8, 0), ("fan", 16, 0), ("fan", 24, 0), ("sectors", 12), ("pyramid", 4, 30), ("pyramid", 7, 5),
    ("star_prism", 9, 0.4), ("spiked_octahedron", 1), ("knife", 5), ("two_knives", 20, 20), ("comb", 8, 30),
    ("wedges_touching_in_an_edge", 30, 5), ("cubes_touching_in_an_edge", 10), ("pyramids_tip_to_tip", 6, 5),
    ("pyramid_on_a_box", 20), ("facet_ending_inside", 3), ("segment_meeting_a_facet", 3),
    ("segments_from_a_point", 12, 12), ("segment_near_a_crease", 20, 0.03, 1), ("facet_near_a_crease", 20, 0.03),
    ("round_cone", 30), ("lens", 40), ("cut_torus", 0.3)]
modes = ("up-front", "in-pass")
header = ["shape"] + [f"{what}, {mode}" for what in ("tets", "vertices inserted", "refine s") for mode in modes] + [
    "tets, share", "time, share"]


@dataclass
class Sums:
    tets: int = 0
    inserted: int = 0
    refine: float = 0
    missed: int = 0   # runs that missed a guarantee

    def add(self, run: MeshRun) -> None:
        self.tets += run.tets
        self.inserted += run.report["statistics"]["vertices_inserted"]
        self.refine += run.refinement_cpu
        self.missed += run.guarantee_missed


def measure(program: Path, shape: AcuteInput, size: float, seeds: int, folder: Path, time_limit: float) -> list[Sums]:
    sums = [Sums() for _ in modes]
    for seed in range(seeds):
        for mode, total in zip(modes, sums):
            mesher = Collarmesh(program, time_limit, ["--coarsen", "off",
                                "--threads", "1", "--collar-creation", mode, "--seed", str(seed)])
            if seed == 0 and mode == modes[0]:
                mesher.prepare(shape, folder)
            total.add(mesher.mesh(shape, size, folder))
    return sums


def row(name: str, sums: list[Sums]) -> list[str]:
    tets = [si(s.tets) + (f" (7: {s.missed})" if s.missed else "") for s in sums]
    return [name, *tets, *(si(s.inserted) for s in sums), *(seconds(s.refine) for s in sums),
            f"{sums[1].tets / sums[0].tets:.2f}", f"{sums[1].refine / sums[0].refine:.2f}"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--largest", type=int, default=10000, help="number of wedges")
    parser.add_argument("--time-limit", type=float, default=600)
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    program, generator = (options.build.resolve() / "bin" / name for name in ("collarmesh", "acute_shape"))
    folder = SizeCache().folder / "acute" / "creation"
    folder.mkdir(parents=True, exist_ok=True)
    rows, all_of_them = [], [Sums() for _ in modes]
    for family, *parameters in shapes:
        shape = AcuteInput(generator, family, tuple(parameters), feature_angle=30 if family in curved else 0)
        sums = measure(program, shape, 0.3, options.seeds, folder, options.time_limit)
        rows.append(row(shape.name, sums))
        print(" | ".join(rows[-1]), file=sys.stderr)
        for one, total in zip(sums, all_of_them):
            total.tets, total.inserted = total.tets + one.tets, total.inserted + one.inserted
            total.refine, total.missed = total.refine + one.refine, total.missed + one.missed
    rows.append(row("all", all_of_them))
    for copies in [n for n in (100, 1000, 10000) if n <= options.largest]:
        shape = AcuteInput(generator, "wedge", (40, 1), copies)
        rows.append(row(f"{copies} wedges of 40 degrees, 1 seed",
                        measure(program, shape, 1, 1, folder, options.time_limit)))
        print(" | ".join(rows[-1]), file=sys.stderr)
    print(f"{about}. {options.seeds} seeds.\n")
    print(table(header, rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
