#!/usr/bin/env python3
"""Compares collarmesh with TetGen and Gmsh, at the same size, on shapes whose features meet at acute angles. Prints a
Markdown table: whether each mesher ends, the number of tets, their angles, and the time."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

from acute_inputs import AcuteInput
from meshers import Collarmesh, Gmsh, TetGen
from processes import ProgramFailed, pin_to_core
from tables import machine, seconds, table, tets_text
from tuning import SizeCache

size = 0.3   # the shapes have sizes of about 1

members: list[tuple] = [
    ("wedge", 20, 1), ("wedge", 5, 1), ("wedge", 2, 1), ("wedge", 1, 1),
    ("fan", 8, 0), ("fan", 16, 0), ("fan", 36, 0), ("fan", 72, 0), ("fan", 14, 14), ("sectors", 20),
    ("pyramid", 4, 30), ("pyramid", 7, 5), ("pyramid", 7, 2), ("pyramid", 64, 5),
    ("star_prism", 9, 0.2), ("spiked_octahedron", 2), ("comb", 8, 10), ("comb", 20, 4),
    ("knife", 5), ("two_knives", 20, 20),
    ("wedges_touching_in_an_edge", 30, 5), ("cubes_touching_in_an_edge", 10),
    ("pyramids_tip_to_tip", 6, 5), ("pyramid_on_a_box", 20),
    ("facet_ending_inside", 3), ("segment_meeting_a_facet", 3), ("segments_from_a_point", 12, 12),
    ("segment_near_a_crease", 20, 0.03, 1), ("facet_near_a_crease", 20, 0.03),
    ("round_cone", 30), ("lens", 40), ("cut_torus", 0.3),
]
curved = ("round_cone", "lens", "cut_torus")


def measure_mesh(program: Path, mesh: Path) -> dict:
    told = subprocess.run([str(program), "info", str(mesh), "--json"], capture_output=True, text=True, check=True)
    return json.loads(told.stdout)["mesh"]


def cell(mesher, shape: AcuteInput, folder: Path, program: Path) -> str:
    """Returns the table entry of a mesher and a shape: measures of the mesh, or the reason for the failure."""
    folder.mkdir(parents=True, exist_ok=True)
    mesh = folder / mesher.mesh_file
    mesh.unlink(missing_ok=True)
    try:
        mesher.prepare(shape, folder)
        result = mesher.mesh(shape, size, folder)
        made = measure_mesh(program, mesh)
    except (ProgramFailed, subprocess.CalledProcessError) as failure:
        return "**" + str(failure).replace("|", " ").replace("\n", " ")[:60] + "**"
    result.tets = made["tets"]
    parts = [tets_text(result), f"{made['min_dihedral']:.2g}-{made['max_dihedral']:.4g}",
             f"{radius_edge(result, made):.2g}", f"{seconds(result.cpu)} s"]
    if result.report and result.report["check"]["collar_tets"]:
        parts.insert(2, f"({result.report['check']['max_collar_dihedral']:.0f})")
    return "; ".join(parts)


def radius_edge(result, made: dict) -> float:
    """Returns the largest radius-edge ratio: in our meshes, of the tets outside collars; in others, of all tets."""
    return (result.report["check"] if result.report else made)["max_radius_edge"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--families", nargs="*", help="only these")
    parser.add_argument("--time-limit", type=float, default=60)
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    programs = options.build / "bin"
    ours = Collarmesh(programs / "collarmesh", options.time_limit, improve=2)
    tetgen = [TetGen(options.time_limit, quality=quality, switches="g") for quality in ("2.0", "1.414")]
    gmsh = Gmsh(options.time_limit, "del3d")
    meshers = {"collarmesh": ours, "TetGen -q2.0": tetgen[0], "TetGen -q1.414": tetgen[1], gmsh.name: gmsh}
    rows = []
    for family, *parameters in members:
        if options.families and family not in options.families:
            continue
        shape = AcuteInput(programs / "acute_shape", family, tuple(parameters),
                           feature_angle=30 if family in curved else 0)
        rows.append([shape.name])
        for name, mesher in meshers.items():
            folder = SizeCache().folder / "acute" / name.replace(" ", "_")
            rows[-1].append(cell(mesher, shape, folder, programs / "collarmesh"))
        print(*rows[-1], sep="  ", file=sys.stderr)
    print(f"{about}. Target edge length {size}, {options.time_limit:g} s each. collarmesh {ours.version()}, "
          f"TetGen {tetgen[0].version()} -p -q -a, Gmsh {gmsh.version()}. Tets; smallest and largest dihedral "
          "angle (largest in collars); worst radius-edge ratio (ours outside collars); CPU seconds.\n")
    print(table(["shape", *meshers], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
