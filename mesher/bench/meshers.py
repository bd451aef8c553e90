"""collarmesh and its peers behind one interface: a surface and a size as input, measures as result.
For all meshers the size is a target edge length. A mesher that bounds volumes, not edge lengths, gets the volume
of the regular tetrahedron with this edge length.
"""

from __future__ import annotations

import importlib.util
import json
import math
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from inputs import Surface
from processes import Measured, ProgramFailed, run


@dataclass
class MeshRun:
    tets: int
    cpu: float                 # seconds of the whole program
    refinement_cpu: float      # seconds of the stage that the mesher calls refinement
    peak_bytes: int            # peak memory of the whole program
    structure_bytes: int = 0   # memory of the data structures, as the mesher reports it; 0: unknown
    stages: dict | None = None
    guarantee_missed: bool = False
    cells: int = 0             # cells of the whole triangulation, also outside the regions; 0: unknown
    wall: float = 0            # seconds of the whole program
    volume_wall: float = 0     # seconds from a surface mesh (peers) or complex (ours) to improved tets; 0: unknown
    report: dict | None = None   # collarmesh's own measurements

    @property
    def meshing_cpu(self) -> float:
        """Returns the CPU seconds of the whole program without the certificate, which peers do not make."""
        return self.cpu - (self.stages or {}).get("check", 0)


def _number(pattern: str, text: str) -> float:
    match = re.search(pattern, text)
    if match is None:
        raise ProgramFailed(f"nothing like '{pattern}' in the output")
    return float(match.group(1))


class Collarmesh:
    mesh_file = "mesh.msh"
    guarantee_missed = 7   # exit code: the mesh was written but misses a guarantee

    def __init__(self, program: Path, time_limit: float, arguments: list[str] | None = None, improve: int = 0,
                 name: str = "collarmesh"):
        # Improvement is off by default, because most benchmarks compare the refinement.
        self.program, self.time_limit, self.name = program, time_limit, name
        self.arguments = ["--improve", str(improve), *(arguments or [])]

    def version(self) -> str:
        printed = subprocess.run([self.program, "--version"], capture_output=True, text=True)
        return printed.stdout.strip().replace("collarmesh ", "")

    def signature(self) -> str:
        """Returns a text that changes whenever the program or its arguments, and so perhaps its meshes, change."""
        state = self.program.stat()
        return f"{state.st_size}-{state.st_mtime_ns} {' '.join(self.arguments)}"

    def prepare(self, surface: Surface, folder: Path) -> None:
        surface.write(folder / "input")

    def mesh(self, surface: Surface, size: float, folder: Path) -> MeshRun:
        command = [str(self.program), *surface.files, "-o", self.mesh_file, "--size", f"{size:.17g}",
                   "--feature-angle", f"{surface.feature_angle:g}", "--report", "report.json",
                   "--progress", "none", "-q", *self.arguments]
        measured = run(command, folder, self.time_limit, accepted=(0, self.guarantee_missed))
        report = json.loads((folder / "report.json").read_text())
        # The report has wall seconds. Convert them by the CPU seconds per wall second of the whole program.
        share = min(1.0, measured.cpu / measured.wall)
        stages = {stage: seconds * share for stage, seconds in report["seconds"].items()}
        return MeshRun(report["mesh"]["tets"], measured.cpu, stages["refine"], measured.peak_bytes,
                       report["statistics"]["peak_bytes"], stages,
                       measured.exit_code == self.guarantee_missed, report["statistics"]["cells"],
                       measured.wall, sum(report["seconds"].get(stage, 0)
                                          for stage in ("refine", "coarsen", "improve")),
                       report)

    def describe(self, surface: Surface, folder: Path) -> dict:
        """Returns the program's description of the complex: diagonal, regions with their volumes and so on."""
        command = [str(self.program), "info", f"input{surface.suffix}", "--json"]
        return json.loads(run(command, folder, self.time_limit).output)["complex"]


class TetGen:
    name = "TetGen"
    mesh_file = "input.1.mesh"   # written with the switch g

    def __init__(self, time_limit: float, program: str = "tetgen", quality: str = "1.414", switches: str = ""):
        self.program, self.time_limit, self.quality, self.switches = program, time_limit, quality, switches

    def version(self) -> str:
        return debian_version("tetgen")

    def signature(self) -> str:
        return f"{self.version()} q{self.quality}{self.switches}"

    def prepare(self, surface: Surface, folder: Path) -> None:
        surface.write(folder / "input")

    def mesh(self, surface: Surface, size: float, folder: Path) -> MeshRun:
        limit = "" if math.isinf(size) else f"a{size ** 3 / (6 * math.sqrt(2)):.20f}"
        measured = run([self.program, f"-pq{self.quality}{limit}{self.switches}", f"input{surface.suffix}"],
                       folder, self.time_limit)
        return MeshRun(int(_number(r"Mesh tetrahedra: +(\d+)", measured.output)), measured.cpu,
                       _number(r"Refinement seconds: +([\d.e+-]+)", measured.output), measured.peak_bytes)


class Gmsh:
    mesh_file = "mesh.msh"

    def __init__(self, time_limit: float, algorithm: str = "hxt", program: str = "gmsh", switches: tuple[str, ...] = (),
                 threads: int = 1):
        self.program, self.time_limit, self.algorithm, self.switches = program, time_limit, algorithm, switches
        self.threads = threads
        self.name = {"hxt": "Gmsh HXT", "del3d": "Gmsh Delaunay"}[algorithm]

    def version(self) -> str:
        return debian_version("gmsh")

    signature = version

    def prepare(self, surface: Surface, folder: Path) -> None:
        surface.write_geo(folder / "model.geo")

    def mesh(self, surface: Surface, size: float, folder: Path) -> MeshRun:
        (folder / "input.geo").write_text('Include "model.geo";\n' f"Mesh.MeshSizeMin = {size:.17g};\n"
                                          f"Mesh.MeshSizeMax = {size:.17g};\n")
        measured = run([self.program, "-3", "-algo", self.algorithm, "-nt", str(self.threads), *self.switches,
                        "input.geo", "-bin", "-o", self.mesh_file], folder, self.time_limit)
        if "Error" in measured.output:
            raise ProgramFailed(re.search(r"Error +: (.*)", measured.output).group(1))
        return MeshRun(int(_number(self._count(measured.output), measured.output)),
                       measured.cpu, _number(r"Done meshing 3D \(.*CPU ([\d.e+-]+)s", measured.output),
                       measured.peak_bytes, wall=measured.wall,
                       volume_wall=_number(r"Done meshing 3D \(Wall ([\d.e+-]+)s", measured.output))

    @staticmethod
    def _count(output: str) -> str:
        """Returns the pattern that finds the number of tets. Only HXT prints this number; for other algorithms the
        pattern finds the number of elements of all dimensions."""
        hxt = r"Final tet. mesh contains (\d+) tetrahedra"
        return hxt if re.search(hxt, output) else r"\d+ nodes (\d+) elements"


class CgalMesh3:
    """CGAL's Mesh_3 with perturbation and exudation, run by the program cgal_mesh."""
    name = "CGAL Mesh_3"
    mesh_file = "mesh.mesh"

    def __init__(self, program: Path, time_limit: float):
        self.program, self.time_limit = program, time_limit

    def version(self) -> str:
        return debian_version("libcgal-dev")

    signature = version

    def prepare(self, surface: Surface, folder: Path) -> None:
        triangles = [list(triangle) for triangle in surface.triangles()]
        Surface(surface.name, surface.points, triangles).write_off(folder / "input.off")

    def mesh(self, surface: Surface, size: float, folder: Path) -> MeshRun:
        distance = min(size, surface.diagonal / 20) / 10   # our default for --distance
        measured = run([str(self.program), "input.off", f"{size:.17g}", f"{distance:.17g}", self.mesh_file], folder,
                       self.time_limit)
        return MeshRun(int(_number(r"(\d+) tets", measured.output)), measured.cpu, measured.cpu, measured.peak_bytes)


def gmsh_part_command(part: Path, out: str, order: int = 1) -> list[str]:
    """Returns the command that meshes a CAD file or a surface with Gmsh's Python module. Ends this program if the
    module is missing."""
    if importlib.util.find_spec("gmsh") is None:
        sys.exit("Gmsh's Python module is missing: install python3-gmsh, and run this with the Python that has it")
    return [sys.executable, str(Path(__file__).resolve().with_name("gmsh_part.py")), str(part), out, str(order)]


def debian_version(package: str) -> str:
    if shutil.which("dpkg-query") is None:
        return "unknown"
    query = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True)
    return query.stdout.strip() or "unknown"


def triangulation_seconds(program: Path, mesh: Path, time_limit: float) -> float:
    """Returns the CPU seconds of CGAL's Delaunay triangulation of a mesh's vertices."""
    measured: Measured = run([str(program), str(mesh)], mesh.parent, time_limit)
    return _number(r"([\d.e+-]+) s", measured.output)
