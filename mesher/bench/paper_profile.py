#!/usr/bin/env python3
"""Compares --profile paper (which does all that the proofs assume, and nothing else) with the defaults and with
--coarsen off, on acute families and on shapes without acute angles. The size is so large that it has no effect.
Prints a Markdown table of tets, vertices, angles, CPU seconds, and the counts that the paper's lemmas bound."""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

from acute_inputs import AcuteInput
from inputs import box
from meshers import Collarmesh, MeshRun
from processes import ProgramFailed, pin_to_core
from tables import machine, seconds, si, table, tets_text
from tuning import SizeCache

size = 10   # the shapes have sizes of about 1
acute: list[tuple] = [
    ("wedge", 80, 1), ("wedge", 40, 1), ("wedge", 20, 1), ("wedge",
                                                           5, 1), ("wedge", 2, 1), ("wedge_on_a_large_one", 20, 1e-4),
    ("fan", 4, 0), ("fan", 8, 0), ("fan", 16, 0), ("sectors", 12), ("pyramid", 4, 30), ("pyramid", 7, 5),
    ("star_prism", 9, 0.4), ("spiked_octahedron", 1), ("knife", 5), ("two_knives", 20, 20), ("comb", 8, 30),
    ("wedges_touching_in_an_edge", 30, 5), ("cubes_touching_in_an_edge", 10), ("pyramids_tip_to_tip", 6, 5),
    ("pyramid_on_a_box", 20), ("facet_ending_inside", 3), ("segment_meeting_a_facet", 3),
    ("segments_from_a_point", 12, 12), ("facet_near_a_crease", 20, 0.03)]
clean: list[tuple] = [("wedge", 90, 1), ("fan", 3, 0), ("skew_zigzags",
                                                        200, 135), ("helices", 200), ("torus_knot", 200)]
ways = {"default": (2, []), "--coarsen off": (2, ["--coarsen", "off"]), "--profile paper": (0, ["--profile", "paper"])}
counted = ("--coarsen off", "--profile paper")   # the defaults refine like --coarsen off, except in narrow places


@dataclass
class Total:
    tets: int = 0
    vertices: int = 0
    cpu: float = 0


def mesh_text(run: MeshRun) -> str:
    """Returns the text "tets; vertices; dihedral angles outside collars; (in collars); largest radius-edge ratio
    outside collars; CPU seconds"."""
    check = run.report["check"]
    parts = [tets_text(run), si(check["points"])]
    if check["collar_tets"] < check["tets"]:
        parts.append(f"{check['min_dihedral']:.2g}-{check['max_dihedral']:.4g}")
    if check["collar_tets"] > 0:
        parts.append(f"({check['min_collar_dihedral']:.2g}-{check['max_collar_dihedral']:.4g})")
    if ratio := max(check["max_radius_edge"], check["max_thin_radius_edge"]):
        parts.append(f"{ratio:.2f}")
    return "; ".join([*parts, f"{seconds(run.cpu)} s"])


def counts_text(run: MeshRun) -> str:
    """Returns the text "peak cells per vertex; largest cavity outside hubs; largest R_v / r_v; inspections per located
    point or ball; cells per gap query; vertices inserted while a skinny cell waited". See WorkCounts in mesher.h."""
    counts = run.report["statistics"]["counts"]
    aspect, queries = counts["largest_aspect"], counts["gap_queries"]
    return "; ".join([f"{counts['peak_cells_per_vertex']:.1f}", si(counts["largest_cavity_outside_hubs"]),
                      f"{aspect:.1f}" if aspect else "-", f"{counts['looks'] / counts['located']:.0f}",
                      f"{counts['gap_cells'] / queries:.1f}" if queries else "-", si(counts["before_quality"])])


def row(meshers: dict[str, Collarmesh], shape, folder: Path, totals: dict[str, Total]) -> list[str]:
    meshes, counts = [], []
    for way, mesher in meshers.items():
        mesher.prepare(shape, folder)
        try:
            run = mesher.mesh(shape, size, folder)
        except ProgramFailed as failure:
            meshes.append(f"**{failure}**")
            counts += [""] * (way in counted)
            continue
        meshes.append(mesh_text(run))
        counts += [counts_text(run)] * (way in counted)
        totals[way].tets += run.tets
        totals[way].vertices += run.report["check"]["points"]
        totals[way].cpu += run.cpu
    return [shape.name, *meshes, *counts]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--time-limit", type=float, default=120)
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    program, generator = (options.build / "bin" / name for name in ("collarmesh", "acute_shape"))
    meshers = {way: Collarmesh(program, options.time_limit, ["--threads", "1", *arguments], improve)
               for way, (improve, arguments) in ways.items()}
    shapes = [AcuteInput(generator, family, tuple(parameters)) for family, *parameters in acute + clean]
    folder = SizeCache().folder / "profile"
    folder.mkdir(parents=True, exist_ok=True)
    totals = {way: Total() for way in ways}
    rows = []
    for shape in [*shapes, box()]:
        rows.append(row(meshers, shape, folder, totals))
        print(*rows[-1], sep="  ", file=sys.stderr, flush=True)
    rows.append(["all", *(f"{si(t.tets)}; {si(t.vertices)}; {seconds(t.cpu)} s" for t in totals.values()),
                 *[""] * len(counted)])
    print(f"{about}. collarmesh {meshers['default'].version()}.\n")
    print(table(["shape", *ways, *(f"counts, {way}" for way in counted)], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
