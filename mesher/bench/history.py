#!/usr/bin/env python3
"""Measures how fast this version is, appends the results to history.tsv beside this file, and draws all lines of this
file as images/history.svg.

Whole runs of collarmesh on a box, with one thread, alternate with CGAL's triangulation of our mesh's vertices (if the
build has `triangulate_points`) and with Gmsh HXT and its optimization (if python3-gmsh is installed). The lines have
medians of CPU seconds and of ratios of speeds. Compare ratios: they hardly depend on the machine."""

from __future__ import annotations

import argparse
import csv
import importlib.util
import platform
import re
import statistics
import subprocess
import sys
import tempfile
from datetime import date
from pathlib import Path

from inputs import box
from meshers import Collarmesh
from processes import ProgramFailed, fetch_memory, pin_to_core, run
from tables import seconds, si, table

columns = ["date", "commit", "machine", "target", "tets", "cpu_s", "tets_per_s", "over_triangulation", "over_hxt"]

hxt = """
import sys, time
import gmsh
size, surface = float(sys.argv[1]), sys.argv[2]
gmsh.initialize()
for name, value in {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.Algorithm3D": 10, "Mesh.Optimize": 1,
                    "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size}.items():
    gmsh.option.setNumber(name, value)
gmsh.open(surface)
begin = time.process_time()
gmsh.model.mesh.generate(3)
print("tets", len(gmsh.model.mesh.getElementsByType(4)[0]), "cpu", time.process_time() - begin)
"""


def processor() -> str:
    model = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    return model.group(1).strip() if model else platform.processor()


def commit(root: Path) -> str:
    """Returns the commit of this checkout, with a "+" if files differ from the commit."""
    told = subprocess.run(["git", "describe", "--always", "--dirty=+"], cwd=root, capture_output=True, text=True)
    return told.stdout.strip() or "unknown"


def speed_of_triangulation(program: Path, mesh: Path, folder: Path, time_limit: float) -> float:
    """Returns the speed of CGAL's triangulation of a mesh's vertices, in finite cells per CPU second."""
    told = re.search(r"(\d+) finite cells, ([\d.]+) s", run([str(program), str(mesh)], folder, time_limit).output)
    return int(told.group(1)) / float(told.group(2))


def speed_of_hxt(surface, size: float, folder: Path, time_limit: float) -> float:
    surface.write_geo(folder / "model.geo")
    told = run([sys.executable, "-c", hxt, f"{size:.17g}", "model.geo"], folder, time_limit).output
    tets, cpu = re.search(r"tets (\d+) cpu ([\d.e-]+)", told).groups()
    return int(tets) / float(cpu)


def measure(options, target: int, size: float) -> dict[str, str]:
    program, triangulate = options.build / "bin" / "collarmesh", options.build / "bin" / "triangulate_points"
    ours = Collarmesh(program, options.time_limit, ["--threads", "1"], improve=2)
    has_gmsh, surface = importlib.util.find_spec("gmsh") is not None, box()
    cpu, over_triangulation, over_hxt, tets = [], [], [], 0
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        ours.prepare(surface, folder)
        for _ in range(options.rounds):
            fetch_memory()
            mesh = ours.mesh(surface, size, folder)
            tets = mesh.tets
            cpu.append(mesh.cpu)
            if triangulate.exists():
                over_triangulation.append(tets / mesh.cpu / speed_of_triangulation(
                    triangulate, folder / ours.mesh_file, folder, options.time_limit))
            if has_gmsh:
                over_hxt.append(tets / mesh.cpu / speed_of_hxt(surface, size, folder, options.time_limit))
    ratio = {name: f"{statistics.median(found):.3f}" if found else ""
             for name, found in (("over_triangulation", over_triangulation), ("over_hxt", over_hxt))}
    taken = statistics.median(cpu)
    return {"target": si(target), "tets": str(tets), "cpu_s": f"{taken:.3f}", "tets_per_s": f"{tets / taken:.0f}",
            **ratio}


def draw(lines: list[dict[str, str]], path: Path) -> None:
    if importlib.util.find_spec("matplotlib") is None:
        print(f"{path.name} is as it was: matplotlib is not installed", file=sys.stderr)
        return
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plot
    plot.rcParams.update({"svg.hashsalt": "collarmesh", "svg.fonttype": "path", "font.size": 9})
    commits = list(dict.fromkeys(line["commit"] for line in lines))
    figure, axes = plot.subplots(figsize=(7, 4), layout="constrained")
    for target in dict.fromkeys(line["target"] for line in lines):
        for name, label in (("over_triangulation", "the bare triangulation"), ("over_hxt", "HXT")):
            points = [(commits.index(line["commit"]), float(line[name])) for line in lines
                      if line["target"] == target and line[name]]
            if points:
                axes.plot(*zip(*points), marker="o", label=f"{target} tets, over {label}")
    axes.set_xticks(range(len(commits)), commits, rotation=45, ha="right")
    axes.set_ylim(bottom=0)
    axes.set_ylabel("whole run's tets per second of CPU, ratio")
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(path, metadata={"Date": None})


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = Path(__file__).resolve().parent
    parser.add_argument("--build", type=Path, default=here.parents[1] / "build" / "bench")
    parser.add_argument("--file", type=Path, default=here / "history.tsv")
    parser.add_argument("--chart", type=Path, default=here / "images" / "history.svg")
    parser.add_argument("--commit",
                        help="commit that was built (default: that of this checkout, with + if files differ)")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--size", nargs="*", type=float, default=[0.0417, 0.01935],
                        help="target edge lengths in the unit box (default: those for 100k and 1M tets)")
    parser.add_argument("--only-draw", action="store_true", help="draw the existing lines; measure nothing")
    parser.add_argument("--time-limit", type=float, default=600)
    options = parser.parse_args()
    options.build = options.build.resolve()
    lines = list(csv.DictReader(open(options.file, newline=""), delimiter="\t")) if options.file.exists() else []
    if not options.only_draw:
        pin_to_core(None)
        same = {"date": date.today().isoformat(), "commit": options.commit or commit(here), "machine": processor()}
        try:
            lines += [{**same, **measure(options, target, size)}
                      for target, size in zip((100_000, 1_000_000), options.size)]
        except ProgramFailed as failure:
            print(f"history.py: {failure}", file=sys.stderr)
            return 1
        with open(options.file, "w", newline="") as file:
            writer = csv.DictWriter(file, columns, delimiter="\t", lineterminator="\n")
            writer.writeheader()
            writer.writerows(lines)
    print(table(columns, [[seconds(float(line[c])) if c == "cpu_s" else line[c] for c in columns] for line in lines]))
    draw(lines, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(main())
