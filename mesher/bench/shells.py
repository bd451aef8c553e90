"""Surface meshes of CAD files beside Gmsh's: shells.py PROGRAM FOLDER [--shares 20 60] [--only PATTERN].

Each file of the folder (STEP, IGES, BREP) is meshed with triangles of 1/20 and 1/60 of its diagonal, by
`collarmesh --dimension 2` and by Gmsh (its Python module; default algorithm, sizes between corners alone). Both
run in a process of their own with one thread, so that the CPU seconds are those of everything from reading to
writing. Angles, counts and the largest distance of the mesh's vertices and triangle centres from the exact
faces are measured in the same way from both files.
"""

import argparse
import json
import math
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy

GMSH = """
import sys, gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("General.NumThreads", 1)
gmsh.option.setNumber("Geometry.OCCImportLabels", 0)
gmsh.model.occ.importShapes(sys.argv[1])
gmsh.model.occ.synchronize()
size = float(sys.argv[2])
gmsh.option.setNumber("Mesh.MeshSizeMin", 0)
gmsh.option.setNumber("Mesh.MeshSizeMax", size)
gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
gmsh.model.mesh.generate(2)
gmsh.write(sys.argv[3])
"""
LIMIT = 100  # seconds


def run(command):
    """Runs a command; returns its exit code, None after the time limit, and its CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        code = subprocess.run(command, capture_output=True, timeout=LIMIT, check=False).returncode
    except subprocess.TimeoutExpired:
        code = None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return code, seconds


def diagonal_of(program, path):
    text = subprocess.run([program, "info", path], capture_output=True, text=True, check=False).stdout
    found = re.search(r"diagonal ([\d.e+-]+)", text)
    return float(found.group(1)) if found else None


def angles_of(path):
    """Returns the smallest and the largest angle and the number of the triangles of a binary STL file."""
    data = pathlib.Path(path).read_bytes()
    count = int.from_bytes(data[80:84], "little")
    if count == 0:
        return None
    records = numpy.frombuffer(data, dtype=numpy.dtype([("f", "<f4", 12), ("a", "<u2")]), offset=84, count=count)
    corners = records["f"][:, 3:].reshape(-1, 3, 3).astype(float)
    angles = []
    for i in range(3):
        u = corners[:, (i + 1) % 3] - corners[:, i]
        v = corners[:, (i + 2) % 3] - corners[:, i]
        cross = numpy.linalg.norm(numpy.cross(u, v), axis=1)
        angles.append(numpy.degrees(numpy.arctan2(cross, (u * v).sum(axis=1))))
    angles = numpy.array(angles)
    return float(angles.min()), float(angles.max()), count, float((angles.min(axis=0) < 20).mean())


def ours(program, path, size, folder):
    out, report = f"{folder}/ours.stl", f"{folder}/report.json"
    code, seconds = run([program, path, "-o", out, "--dimension", "2", "--size", str(size), "--threads", "1",
                         "--report", report])
    row = {"code": code, "seconds": seconds}
    if code in (0, 7):
        check = json.loads(pathlib.Path(report).read_text())["check"]
        row |= {"distance": check["max_surface_distance"] / size, "findings": check["findings_total"]}
        row["angles"] = angles_of(out)
    return row


def gmshs(path, size, folder):
    out = f"{folder}/gmsh.stl"
    pathlib.Path(out).unlink(missing_ok=True)
    script = GMSH.replace('gmsh.write(', 'gmsh.option.setNumber("Mesh.Binary", 1)\ngmsh.write(')
    code, seconds = run([sys.executable, "-c", script, path, str(size), out])
    row = {"code": code, "seconds": seconds}
    if code == 0 and pathlib.Path(out).exists():
        row["angles"] = angles_of(out)
    return row


def text_of(row):
    if not row.get("angles"):
        return f"failed ({row['code']}) {row['seconds']:.1f} s"
    smallest, largest, count, poor = row["angles"]
    return f"{count:7d} {smallest:6.2f} {largest:6.1f} {100 * poor:5.2f}% {row['seconds']:6.2f} s"


def summary(name, rows):
    done = [row for row in rows if row.get("angles")]
    if not done:
        return f"| {name} | 0 of {len(rows)} |"
    column = lambda i: sorted(row["angles"][i] for row in done)
    seconds = sorted(row["seconds"] for row in rows)
    share = lambda bound: 100 * sum(row["angles"][0] >= bound for row in done) / len(rows)
    at = lambda values, p: values[min(len(values) - 1, math.ceil(p * len(values)) - 1)]
    return (f"| {name} | {len(done)} of {len(rows)} | {statistics.median(column(0)):.1f} | {share(15):.0f} % | "
            f"{share(20):.0f} % | {statistics.median(column(1)):.1f} | {statistics.median(column(2)):.0f} | "
            f"{statistics.median(seconds):.2f} | {at(seconds, 0.95):.2f} | {seconds[-1]:.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--shares", nargs="+", type=float, default=[20, 60])
    parser.add_argument("--only", default="")
    parser.add_argument("--without-gmsh", action="store_true")
    parser.add_argument("--rows", help="a JSON file for all rows")
    arguments = parser.parse_args()
    files = sorted(p for p in pathlib.Path(arguments.folder).iterdir() if re.search(arguments.only, p.name))
    tables, all_rows = [], []
    with tempfile.TemporaryDirectory() as folder:
        for share in arguments.shares:
            mine, others = [], []
            for path in files:
                diagonal = diagonal_of(arguments.program, str(path))
                if diagonal is None:
                    print(f"{path.name}: not read")
                    mine.append({"code": 3, "seconds": 0})
                    continue
                mine.append(ours(arguments.program, str(path), diagonal / share, folder))
                line = f"1/{share:g} {path.name[:50]:50s} {text_of(mine[-1])} findings {mine[-1].get('findings')}"
                if not arguments.without_gmsh:
                    others.append(gmshs(str(path), diagonal / share, folder))
                    line += f" | Gmsh {text_of(others[-1])}"
                all_rows.append({"share": share, "file": path.name, "ours": mine[-1],
                                 "gmsh": others[-1] if others else None})
                print(line, flush=True)
            tables.append((f"collarmesh, 1/{share:g}", mine))
            if others:
                tables.append((f"Gmsh, 1/{share:g}", others))
                counts = [a["angles"][2] / b["angles"][2] for a, b in zip(mine, others)
                          if a.get("angles") and b.get("angles")]
                if counts:
                    print(f"triangles over Gmsh's, median at 1/{share:g}: {statistics.median(counts):.2f}")
    print("| | meshed | smallest angle, median | at least 15 | at least 20 | largest angle, median | triangles, "
          "median | CPU s, median | 95 % | most |")
    print("|" + "---|" * 10)
    for name, rows in tables:
        print(summary(name, rows))
    if arguments.rows:
        pathlib.Path(arguments.rows).write_text(json.dumps(all_rows))


if __name__ == "__main__":
    main()
