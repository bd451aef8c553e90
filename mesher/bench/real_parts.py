#!/usr/bin/env python3
"""Meshes real files as they are: CAD files and surfaces of the given folders, by collarmesh with its defaults, by Gmsh
(HXT), by TetGen and by CGAL's Alpha_wrap_3 followed by Mesh_3 (wrap_mesh.cpp), all at a twentieth of the diagonal.
TetGen and the wrap get no CAD files. They get the triangles of surfaces without any repair, but with equal points
merged.

Outcomes: meshed (all tets have positive volume), guarantee missed (collarmesh's exit code 7), unusable mesh
(no error, but no tets or flat or inverted ones), refused (an error said so), past the limit (of CPU seconds
or memory), crashed. Prints Markdown tables of outcomes and of the meshes' measures. The file --out keeps the
results of all runs; a run that is in this file is not made again."""

from __future__ import annotations

import argparse
import csv
import math
import re
import signal
import statistics
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, fields
from fractions import Fraction
from pathlib import Path

import meshio
import numpy as np

from improve_peers import dihedral_angles
from inputs import Surface, read_surface
from meshers import Collarmesh, debian_version, gmsh_part_command
from processes import Measured, pin_to_core, run_limited
from tables import machine, seconds, table

cad_suffixes = (".step", ".stp", ".brep", ".iges", ".igs")
surface_suffixes = (".stl", ".obj", ".off", ".ply")
outcomes = ("meshed", "guarantee missed", "unusable mesh", "refused", "past the limit", "crashed")
size_share = 20   # the diagonal divided by the size


@dataclass
class Row:
    file: str
    kind: str                        # CAD or surface
    mesher: str
    outcome: str
    cpu: float = 0                   # seconds of the whole program
    tets: int = 0
    smallest: float = math.nan       # dihedral angle, degrees
    tenth: float = math.nan          # 10th percentile of the tets' smallest dihedral angles
    largest: float = math.nan
    volume: float = math.nan         # volume of the mesh
    input_volume: float = math.nan   # volume enclosed by a surface's triangles, or of a CAD file's solids
    told: str = ""                   # error message


class Part:
    """A file and, for surfaces, its triangles in the formats of the peers."""

    def __init__(self, path: Path, folder: Path, converter: Path):
        self.path, self.folder, self.converter = path.resolve(), folder, converter
        self.name = f"{path.parent.name}/{path.name}"
        self.kind = "CAD" if path.suffix.lower() in cad_suffixes else "surface"
        self.triangles: Surface | None = None

    def prepare(self) -> None:
        """Writes a surface as part.off and part.stl, without any repair; does nothing for CAD files. Raises OSError if
        the file cannot be read."""
        if self.kind == "CAD" or self.triangles is not None:
            return
        off = self.folder / "part.off"
        off.unlink(missing_ok=True)
        command = [str(self.converter), "convert", str(self.path), "-o", str(off), "--repair", "none", "-q"]
        subprocess.run(command, capture_output=True, timeout=60)
        if not off.exists():
            raise OSError("no triangles could be read")
        self.triangles = read_surface(off)
        self.triangles.write_stl(self.folder / "part.stl")

    @property
    def input_volume(self) -> float:
        return self.triangles.volume if self.triangles else math.nan


@dataclass
class OurProgram:
    program: Path
    name = "collarmesh"
    mesh_file = "ours.mesh"
    kinds = ("CAD", "surface")

    def version(self) -> str:
        return Collarmesh(self.program, 0).version()

    def command(self, part: Part) -> list[str]:
        return [str(self.program), str(part.path), "-o", self.mesh_file, "--threads", "1", "--progress", "none", "-q"]


class GmshProgram:
    name = "gmsh"
    mesh_file = "gmsh.mesh"
    kinds = ("CAD", "surface")

    def version(self) -> str:
        return debian_version("gmsh")

    def command(self, part: Part) -> list[str]:
        return gmsh_part_command(part.path if part.kind == "CAD" else Path("part.stl"), self.mesh_file)


class TetGenProgram:
    name = "tetgen"
    mesh_file = "part.1.mesh"
    kinds = ("surface",)

    def version(self) -> str:
        return debian_version("tetgen")

    def command(self, part: Part) -> list[str]:
        size = part.triangles.diagonal / size_share
        return ["tetgen", f"-pqzga{size ** 3 / (6 * math.sqrt(2)):.25f}", "part.off"]


@dataclass
class WrapProgram:
    program: Path
    name = "wrap"
    mesh_file = "wrap.mesh"
    kinds = ("surface",)

    def version(self) -> str:
        return debian_version("libcgal-dev")

    def command(self, part: Part) -> list[str]:
        return [str(self.program), "part.off", self.mesh_file]


def outcome_of(measured: Measured, cpu_limit: int) -> str:
    """Returns the outcome as far as exit code and output show it; `measure` may change it to "unusable mesh"."""
    ended_by = -measured.exit_code if measured.exit_code < 0 else 0
    out_of_memory = re.search(r"bad_alloc|out of memory|cannot allocate", measured.output, re.IGNORECASE)
    if ended_by == signal.SIGXCPU or out_of_memory or ended_by == signal.SIGKILL and measured.cpu >= 0.9 * cpu_limit:
        return "past the limit"
    # Debian's TetGen reports an error by throwing its number, which nothing catches: 3 if facets intersect, 4 if
    # features are too small for it.
    if ended_by == signal.SIGABRT and "throwing an instance of 'int'" in measured.output:
        return "refused"
    return "crashed" if ended_by else "refused" if measured.exit_code else "meshed"


def last_error(output: str) -> str:
    lines = [line for line in output.strip().splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower() or "throwing" in line]
    return " ".join((errors or lines or ["no output"])[-1].split())[:160]


def orientation(corners: np.ndarray) -> Fraction:
    """Returns six times the signed volume of a tet, computed exactly."""
    first, *others = ([Fraction(float(x)) for x in corner] for corner in corners)
    a, b, c = ([x - y for x, y in zip(corner, first)] for corner in others)
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))


def measure(row: Row, mesh_file: Path) -> None:
    """Fills in the measures of the mesh. The outcome becomes "unusable mesh" if there are no tets or if a tet's volume
    is not positive."""
    # Write version 2: of version 1, meshio reads coordinates in single precision, however many digits they have.
    mesh_file.write_text(re.sub(r"(MeshVersionFormatted\s+)1", r"\g<1>2", mesh_file.read_text(), count=1))
    cells = meshio.read(mesh_file)
    tets = np.concatenate([np.empty((0, 4), int), *(c.data for c in cells.cells if c.type == "tetra")])
    row.tets = len(tets)
    if row.tets == 0:
        row.outcome, row.told = "unusable mesh", "no tets"
        return
    corners = cells.points[:, :3][tets]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    turned = -1 if volumes.sum() < 0 else 1   # -1: all tets of this file have the opposite orientation
    row.volume = abs(volumes.sum())
    with np.errstate(all="ignore"):
        angles = dihedral_angles(cells.points[:, :3], tets)
    smallest = angles.min(axis=1)
    row.smallest, row.tenth, row.largest = smallest.min(), np.percentile(smallest, 10), angles.max()
    lengths = np.linalg.norm(corners[:, 1:] - corners[:, :1], axis=2).max(axis=1)
    doubtful = np.flatnonzero(turned * volumes <= 1e-12 * lengths ** 3)
    bad = sum(turned * orientation(corners[tet]) <= 0 for tet in doubtful)
    if bad:
        row.outcome, row.told = "unusable mesh", f"{bad} tets of {row.tets} without positive volume"


def run_part(part: Part, mesher, options) -> Row:
    row = Row(part.name, part.kind, mesher.name, "refused")
    try:
        part.prepare()
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        row.told = str(error)
        if mesher.name != "collarmesh":
            return row
    row.input_volume = part.input_volume
    (part.folder / mesher.mesh_file).unlink(missing_ok=True)
    measured = run_limited(mesher.command(part), part.folder, options.limit, int(options.memory * 1e9))
    row.cpu = measured.cpu
    row.outcome = outcome_of(measured, options.limit)
    if mesher.name == "collarmesh":
        row.outcome = {7: "guarantee missed", 5: "past the limit"}.get(measured.exit_code, row.outcome)
    solids = re.search(r"volume of the solids ([\d.e+-]+)", measured.output)
    if solids:
        row.input_volume = float(solids.group(1))
    if row.outcome not in ("meshed", "guarantee missed"):
        row.told = last_error(measured.output)
    elif (part.folder / mesher.mesh_file).exists():
        measure(row, part.folder / mesher.mesh_file)
    else:
        row.outcome, row.told = "unusable mesh", "no mesh written"
    return row


def read_rows(out: Path | None) -> list[Row]:
    if out is None or not out.exists():
        return []
    with open(out, newline="") as lines:
        found = [Row(**line) for line in csv.DictReader(lines, delimiter="\t")]
    for row in found:
        row.tets = int(row.tets)
        for number in ("cpu", "smallest", "tenth", "largest", "volume", "input_volume"):
            setattr(row, number, float(getattr(row, number)))
    return found


def append_row(out: Path | None, row: Row) -> None:
    if out is None:
        return
    new = not out.exists()
    with open(out, "a", newline="") as lines:
        writer = csv.DictWriter(lines, [f.name for f in fields(Row)], delimiter="\t", lineterminator="\n")
        if new:
            writer.writeheader()
        values = asdict(row)
        writer.writerow({name: f"{value:.9g}" if isinstance(value, float) else value
                         for name, value in values.items()})


def parts(folders: list[Path]) -> list[Path]:
    return [path for folder in folders for path in sorted(folder.iterdir())
            if path.suffix.lower() in cad_suffixes + surface_suffixes]


def outcome_table(rows: list[Row], kind: str, names: list[str]) -> str:
    lines = []
    for name in names:
        mine = [row for row in rows if (row.kind, row.mesher) == (kind, name)]
        if mine:
            lines.append([name, str(len(mine)), *(str(sum(row.outcome == o for row in mine)) for o in outcomes)])
    return table([kind, "files", *outcomes], lines)


def wrong_volume(row: Row, expected: float) -> bool:
    return abs(row.volume - expected) > 0.05 * abs(expected)


def comparison_table(rows: list[Row], kind: str, names: list[str]) -> str:
    """Returns a table that compares each peer with collarmesh: medians over the files that both have meshed."""
    def meshed(name: str) -> dict[str, Row]:
        return {row.file: row for row in rows if (row.kind, row.mesher, row.outcome) == (kind, name, "meshed")}

    ours, lines = meshed("collarmesh"), []
    for name in names:
        peer = meshed(name)
        if name == "collarmesh" or not peer:
            continue
        files = [file for file in peer if file in ours] if ours else list(peer)
        if not files:
            continue

        def median(member: str, of: dict[str, Row]) -> str:
            return f"{statistics.median(getattr(of[file], member) for file in files):.3g}" if of else ""

        def both(member: str) -> list[str]:
            return [median(member, peer), median(member, ours)]

        ratio = f"{statistics.median(peer[f].tets / ours[f].tets for f in files):.2f}" if ours else ""
        smallest = [f"{np.percentile([of[f].smallest for f in files], 10):.2g}" if of else "" for of in (peer, ours)]
        off = str(sum(wrong_volume(peer[f], ours[f].volume) for f in files)) if ours else ""
        lines.append([name, str(len(files)), *both("cpu"), ratio, *smallest, *both("smallest"), *both("tenth"), off])
    header = [f"{kind}: peer", "files both meshed", "CPU s", "ours", "tets / ours",
              "smallest angle, 10th percentile of files", "ours", "smallest angle", "ours",
              "10th percentile of the tets' smallest angles", "ours", "volume over 5% from ours"]
    return table(header, lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("folders", type=Path, nargs="*", metavar="FOLDER")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--program", type=Path, help="collarmesh (default: of the build)")
    parser.add_argument("--wrap-program", type=Path, help="wrap_mesh (default: of the build)")
    parser.add_argument("--only", default="collarmesh,gmsh,tetgen,wrap", help="run these, in this order")
    parser.add_argument("--limit", type=int, default=60, help="CPU seconds for one run of one program")
    parser.add_argument("--memory", type=float, default=12, help="GB of address space for one run")
    parser.add_argument("--out", type=Path, help="TSV of all runs, continued when it exists")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    programs = options.build.resolve() / "bin"
    program = (options.program or programs / "collarmesh").resolve()
    meshers = {m.name: m for m in (OurProgram(program), GmshProgram(), TetGenProgram(),
                                   WrapProgram((options.wrap_program or programs / "wrap_mesh").resolve()))}
    rows = read_rows(options.out)
    done = {(row.file, row.mesher) for row in rows}
    with tempfile.TemporaryDirectory() as scratch:
        for name in options.only.split(","):
            for path in parts(options.folders):
                part = Part(path, Path(scratch), program)
                if (part.name, name) in done or part.kind not in meshers[name].kinds:
                    continue
                rows.append(run_part(part, meshers[name], options))
                append_row(options.out, rows[-1])
                print(name, part.name, rows[-1].outcome, seconds(rows[-1].cpu), rows[-1].told, file=sys.stderr,
                      flush=True)
    names = [name for name in meshers if any(row.mesher == name for row in rows)]
    versions = ", ".join(f"{name} {meshers[name].version()}" for name in names)
    print(f"{about}. {versions}. Limits: {options.limit} s of CPU time, {options.memory:g} GB.\n")
    for kind in ("CAD", "surface"):
        if any(row.kind == kind for row in rows):
            print(outcome_table(rows, kind, names), comparison_table(rows, kind, names), sep="\n\n", end="\n\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
