#!/usr/bin/env python3
"""Measures how the number of tets depends on the angle at creases, for wedges, fans, pyramids and needles, at a
target edge length as large as the shapes. Compares the numbers with those of the feasibility study from which this
project's collars come. The study called angles below 80 degrees acute, so the shapes that it has are also meshed with
`--crease-angle 80`. Prints a Markdown table."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

from acute_inputs import AcuteInput
from meshers import Collarmesh, MeshRun
from processes import pin_to_core
from tables import machine, seconds, si, table
from tuning import SizeCache

size = 1.0   # the shapes have sizes of about 1

# A pyramid as high as it is wide: family, number of sides, and apex angle (degrees) of the cone around it.
square_pyramid = ("pyramid", 4, 2 * math.degrees(math.atan(math.sqrt(0.5))))

# The study's numbers of tets for each shape: outside collars, in stars, in books. The study's program, which no longer
# exists, ran on similar shapes.
study = {("wedge", 60, 1): (379, 109, 21), ("wedge", 40, 1): (437, 127, 26), ("wedge", 20, 1): (180, 33, 5),
         ("wedge", 5, 1): (2376, 132, 5), square_pyramid: (425, 148, 40), ("fan", 8, 0): (1755, 288, 56),
         ("fan", 16, 0): (4754, 746, 112), ("fan", 36, 0): (39853, 3856, 252), ("fan", 72, 0): (293000, 15286, 504)}

shapes: list[tuple] = (
    [("wedge", angle, 1) for angle in (80, 60, 59, 40, 20, 10, 5, 2, 1)]
    + [("fan", sheets, 0) for sheets in (3, 6, 8, 12, 16, 24, 36, 72)]
    + [square_pyramid] + [("pyramid", 4, angle) for angle in (60, 40, 20, 10, 5, 2)]
    + [("pyramid", 7, angle) for angle in (60, 10, 2)])

header = ["shape", "angle", "outside collars", "in collars", "dihedral angle in collars", "refinement s",
          "with --crease-angle 80", "study's", "share of it"]


def crease_angle(family: str, first: float, second: float) -> float:
    """Returns the crease angle in degrees; for a pyramid, the apex angle of the cone around it."""
    return {"wedge": first, "fan": 360 / first, "pyramid": second}[family]


def mark(run: MeshRun) -> str:
    return " (7)" if run.guarantee_missed else ""


def row(meshers: list[Collarmesh], program: Path, folder: Path, family: str, *parameters: float) -> list[str]:
    shape = AcuteInput(program, family, parameters)
    meshers[0].prepare(shape, folder)
    run = meshers[0].mesh(shape, size, folder)
    check = run.report["check"]
    collar = check["collar_tets"]
    cells = [shape.name + mark(run), f"{crease_angle(family, *parameters):.3g}", si(run.tets - collar), si(collar),
             f"{check['max_collar_dihedral']:.0f}" if collar else "", seconds(run.refinement_cpu)]
    if (family, *parameters) not in study:
        return cells + [""] * 3
    wide, reference = meshers[1].mesh(shape, size, folder), sum(study[(family, *parameters)])
    return cells + [si(wide.tets) + mark(wide), si(reference), f"{wide.tets / reference:.2f}"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--time-limit", type=float, default=300)
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    meshers = [Collarmesh(options.build / "bin" / "collarmesh", options.time_limit, arguments)
               for arguments in ([], ["--crease-angle", "80"])]
    folder = SizeCache().folder / "acute" / "angles"
    folder.mkdir(parents=True, exist_ok=True)
    rows = [row(meshers, options.build / "bin" / "acute_shape", folder, *shape) for shape in shapes]
    print(f"{about}. collarmesh {meshers[0].version()}, target edge length {size:g}.\n")
    print(table(header, rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
