"""Compares surface meshes of CAD files with Gmsh's: shells.py PROGRAM FOLDER [--shares 20 60] [--only PATTERN].

Each file of the folder (STEP, IGES, BREP) is meshed with a target edge length of 1/20 and of 1/60 of its diagonal, by
`collarmesh --dimension 2` and by Gmsh (its Python module, with the default algorithm and only a largest size). Each
mesher runs in a process of its own with one thread, so its CPU seconds include everything from reading to writing. The
table also has the CPU seconds without OpenCASCADE's reading and tessellation. Angles, counts and distances are measured
in the same way for both meshes, from files in Gmsh's format:

- angles: of all triangles ("raw"), and of the triangles that are not at a sharp corner of the input ("away"). A
  triangle is at a sharp corner if it has an angle below 20 degrees at a vertex of the input, between two sides that lie
  on edges of the input;
- distance: the largest distance of a triangle's centre from the input's faces, in target edge lengths. OpenCASCADE
  (through `collarmesh repair`) cuts the faces into triangles for this. Needs the Python module vtk;
- counts at equal distance ("equal"): if Gmsh's mesh is farther from the faces than ours, Gmsh makes another mesh, with
  the fewest elements per circle (6, 12 or 24) at which its mesh is as near as ours. The counts of the two meshes are
  compared.

`--kept FOLDER` keeps Gmsh's measures and the triangles of the faces in this folder, so that later runs are shorter.
"""

import argparse
import json
import math
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy

GMSH = """
import sys, time, gmsh
gmsh.initialize()
start = time.process_time()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("General.NumThreads", 1)
gmsh.option.setNumber("Geometry.OCCImportLabels", 0)
gmsh.model.occ.importShapes(sys.argv[1])
gmsh.model.occ.synchronize()
size = float(sys.argv[2])
gmsh.option.setNumber("Mesh.MeshSizeMin", 0)
gmsh.option.setNumber("Mesh.MeshSizeMax", size)
gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
gmsh.option.setNumber("Mesh.SaveAll", 1)
gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", float(sys.argv[4]))
read = time.process_time()
gmsh.model.mesh.generate(2)
print(read - start, time.process_time() - read)
gmsh.write(sys.argv[3])
"""
LIMIT = 200  # seconds
SHARP = 20  # degrees


def run(command, **environment):
    """Runs a command. Returns its exit code (None if it exceeded the time limit), CPU seconds and standard output."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False,
                              env=os.environ | environment)
        code, text = done.returncode, done.stdout
    except subprocess.TimeoutExpired:
        code, text = None, ""
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return code, seconds, text


def stages_of(path):
    """Returns the recorded CPU seconds of each stage; some stages are OpenCASCADE's work."""
    stages = {}
    for line in pathlib.Path(path).read_text().splitlines()[1:]:
        stage, _, _, _, serial, work = line.split("\t")[:6]
        stages[stage] = stages.get(stage, 0.0) + float(serial) + float(work)
    return stages


def own_seconds(row):
    """Returns the CPU seconds of a run without those for OpenCASCADE's reading and tessellation."""
    return row["seconds"] - row.get("reading", 0) - row.get("cutting", 0)


def read_mesh(path):
    """Returns points, triangles, the set of edges on curves (pairs of point numbers in ascending order), and the set of
    points that are vertices of the input."""
    import gmsh

    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        tags, points, _ = gmsh.model.mesh.getNodes()
        number = numpy.zeros(int(tags.max()) + 1 if len(tags) else 1, dtype=int)
        number[tags] = numpy.arange(len(tags))
        elements = {}
        for dimension, kind, corners in ((1, 1, 2), (2, 2, 3)):
            kinds, _, nodes = gmsh.model.mesh.getElements(dimension)
            of_kind = [n for k, n in zip(kinds, nodes) if k == kind]
            elements[dimension] = number[numpy.concatenate(of_kind or [[]]).astype(int)].reshape(-1, corners)
        given = set(number[gmsh.model.mesh.getNodes(0)[0]].tolist())
        return points.reshape(-1, 3), elements[2], set(map(tuple, numpy.sort(elements[1]).tolist())), given
    finally:
        gmsh.finalize()


def at_sharp_corner(triangle, angles, edges, given):
    for i, angle in enumerate(angles):
        p, a, b = triangle[i], triangle[(i + 1) % 3], triangle[(i + 2) % 3]
        if angle < SHARP and p in given and {tuple(sorted((p, a))), tuple(sorted((p, b)))} <= edges:
            return True
    return False


def measures_of(path, reference, size):
    points, triangles, edges, given = read_mesh(path)
    if len(triangles) == 0:
        return None
    corners = points[triangles]
    angles = []
    for i in range(3):
        u = corners[:, (i + 1) % 3] - corners[:, i]
        v = corners[:, (i + 2) % 3] - corners[:, i]
        cross = numpy.linalg.norm(numpy.cross(u, v), axis=1)
        angles.append(numpy.degrees(numpy.arctan2(cross, (u * v).sum(axis=1))))
    angles = numpy.array(angles).T
    least = angles.min(axis=1)
    sharp = [t for t in numpy.nonzero(least < SHARP)[0]
             if at_sharp_corner(triangles[t].tolist(), angles[t], edges, given)]
    away = numpy.delete(angles, sharp, axis=0)
    return {"raw": float(least.min()), "away": float(away.min()) if len(away) else SHARP,
            "largest": float(away.max()) if len(away) else 60.0, "count": len(triangles), "sharp": len(sharp),
            "poor": int((away.min(axis=1) < SHARP).sum()),
            "distance": distance_between(corners.mean(axis=1), reference, size)}


def distance_between(points, reference, size):
    """Returns the largest distance of a point from the triangles of an STL file, divided by the size. Returns None
    if this file or vtk is missing."""
    if not pathlib.Path(reference).exists():
        return None
    try:
        import vtk
    except ImportError:
        return None
    reader = vtk.vtkSTLReader()
    reader.SetFileName(str(reference))
    reader.Update()
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(reader.GetOutput())
    locator.BuildLocator()
    most, foot = 0.0, [0.0, 0.0, 0.0]
    cell, part, squared = vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
    for p in points:
        locator.FindClosestPoint(p, foot, cell, part, squared)
        most = max(most, float(squared))
    return math.sqrt(most) / size


def ours(program, path, size, folder):
    out, report = f"{folder}/ours.msh", f"{folder}/report.json"
    costs = f"{folder}/costs.tsv"
    pathlib.Path(costs).unlink(missing_ok=True)
    code, seconds, _ = run([program, path, "-o", out, "--dimension", "2", "--size", str(size), "--threads", "1",
                            "--report", report], COLLARMESH_RECORD_COSTS=costs)
    row = {"code": code, "seconds": seconds}
    if code in (0, 7):
        row["stages"] = stages_of(costs)
        of_work = lambda word: sum(s for stage, s in row["stages"].items() if f": {word}" in stage)
        row |= {"reading": of_work("reading"), "cutting": of_work("cutting")}
        row["findings"] = json.loads(pathlib.Path(report).read_text())["check"]["findings_total"]
        row["measures"] = measures_of(out, f"{folder}/reference.stl", size)
    return row


def gmshs(path, size, folder, per_circle=0):
    out = f"{folder}/gmsh.msh"
    pathlib.Path(out).unlink(missing_ok=True)
    code, seconds, text = run([sys.executable, "-c", GMSH, path, str(size), out, str(per_circle)])
    row = {"code": code, "seconds": seconds}
    if code == 0 and pathlib.Path(out).exists():
        row["reading"] = float(text.split()[-2])
        row["measures"] = measures_of(out, f"{folder}/reference.stl", size)
    return row


def kept_or_made(arguments, path, share, size, folder, per_circle=0):
    """Returns Gmsh's row; reads it from the folder --kept if it is there."""
    kept = pathlib.Path(arguments.kept) / f"{path.name}.{share:g}.{per_circle}.json" if arguments.kept else None
    if kept and kept.exists():
        return json.loads(kept.read_text())
    row = gmshs(str(path), size, folder, per_circle)
    if kept:
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(row))
    return row


def at_equal_distance(arguments, path, share, size, folder, mine, other):
    """Returns Gmsh's row with the fewest elements per circle at which its mesh is as near to the faces as ours;
    None if 24 are too few."""
    distance = lambda row: (row.get("measures") or {}).get("distance")
    if distance(mine) is None:
        return None
    per_circle = 0
    while distance(other) is None or distance(other) > distance(mine):
        per_circle = 2 * per_circle or 6
        if per_circle > 24 or not other.get("measures"):
            return None
        other = kept_or_made(arguments, path, share, size, folder, per_circle)
    return other


def text_of(row):
    if not row.get("measures"):
        return f"failed ({row['code']}) {row['seconds']:.1f} s"
    m = row["measures"]
    return (f"{m['count']:7d} {m['raw']:6.2f} {m['away']:6.2f} {m['largest']:6.1f} {m['poor']:6d} "
            f"{m['distance'] or 0:.4f} {row['seconds']:6.2f} s ({own_seconds(row):.2f})")


def summary(name, rows):
    done = [row for row in rows if row.get("measures")]
    if not done:
        return f"| {name} | 0 of {len(rows)} |"
    values = lambda key: [row["measures"][key] for row in done if row["measures"][key] is not None]
    column = lambda key: statistics.median(values(key) or [0])
    share = lambda key, bound: 100 * sum(row["measures"][key] >= bound for row in done) / len(rows)
    seconds = sorted(row["seconds"] for row in rows)
    at = lambda p: seconds[min(len(seconds) - 1, math.ceil(p * len(seconds)) - 1)]
    return (f"| {name} | {len(done)} of {len(rows)} | {column('raw'):.1f} | {column('away'):.1f} | "
            f"{share('away', 15):.0f} % | {share('away', 20):.0f} % | {column('largest'):.1f} | "
            f"{column('count'):.0f} | {column('distance'):.3f} | {statistics.median(seconds):.2f} | {at(0.95):.2f} | "
            f"{seconds[-1]:.1f} | {sum(s <= 2 for s in seconds)}, {sum(s <= 10 for s in seconds)} | "
            f"{sum(own_seconds(row) <= 2 for row in rows)}, {sum(own_seconds(row) <= 10 for row in rows)} |")


def ratio_of_counts(pairs):
    """Returns, as text, the median ratio of triangle counts (first mesh of a pair over the second) and the number of
    pairs."""
    counts = [a["measures"]["count"] / b["measures"]["count"] for a, b in pairs
              if a.get("measures") and b and b.get("measures")]
    return f"{statistics.median(counts):.2f} on {len(counts)} files" if counts else "none"


def rows_of_file(arguments, path, share, folder):
    """Returns three rows for a file: ours, Gmsh's, and Gmsh's at equal distance; None where there is none."""
    info = subprocess.run([arguments.program, "info", path], capture_output=True, text=True, check=False).stdout
    found = re.search(r"diagonal ([\d.e+-]+)", info)
    if not found:
        return {"code": 3, "seconds": 0}, None, None
    size = float(found.group(1)) / share
    reference = pathlib.Path(f"{folder}/reference.stl")
    reference.unlink(missing_ok=True)
    kept = pathlib.Path(arguments.kept or folder) / f"{path.name}.stl"
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        run([arguments.program, "repair", str(path), "-o", str(kept)])
    if kept.exists():
        reference.symlink_to(kept.resolve())
    mine = ours(arguments.program, str(path), size, folder)
    if arguments.without_gmsh:
        return mine, None, None
    other = kept_or_made(arguments, path, share, size, folder)
    if arguments.without_equal:
        return mine, other, None
    return mine, other, at_equal_distance(arguments, path, share, size, folder, mine, other)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--shares", nargs="+", type=float, default=[20, 60])
    parser.add_argument("--only", default="")
    parser.add_argument("--without-gmsh", action="store_true")
    parser.add_argument("--without-equal", action="store_true", help="no meshes of Gmsh at equal distance")
    parser.add_argument("--kept", help="a folder for Gmsh's measures and the triangles of the faces")
    parser.add_argument("--rows", help="a JSON file for all rows")
    arguments = parser.parse_args()
    files = sorted(p for p in pathlib.Path(arguments.folder).iterdir() if re.search(arguments.only, p.name))
    tables, all_rows = [], []
    with tempfile.TemporaryDirectory() as folder:
        for share in arguments.shares:
            rows = []
            for path in files:
                rows.append(rows_of_file(arguments, path, share, folder))
                mine, other, equal = rows[-1]
                all_rows.append({"share": share, "file": path.name, "ours": mine, "gmsh": other, "equal": equal})
                line = f"1/{share:g} {path.name[:50]:50s} {text_of(mine)} findings {mine.get('findings')}"
                if other:
                    line += f" | Gmsh {text_of(other)}"
                if equal:
                    line += f" | equal {equal['measures']['count']}"
                print(line, flush=True)
            tables.append((f"collarmesh, 1/{share:g}", [mine for mine, _, _ in rows]))
            if not arguments.without_gmsh:
                tables.append((f"Gmsh, 1/{share:g}", [other for _, other, _ in rows if other]))
                print(f"triangles over Gmsh's, median at 1/{share:g}: "
                      f"{ratio_of_counts((mine, other) for mine, other, _ in rows)}; at equal distance "
                      f"{ratio_of_counts((mine, equal) for mine, _, equal in rows)}")
            if arguments.rows:
                pathlib.Path(arguments.rows).write_text(json.dumps(all_rows))
    print("| | meshed | smallest angle, raw, median | away, median | away at least 15 | at least 20 | largest, away, "
          "median | triangles, median | distance, median | CPU s, median | 95 % | most | in 2 s, in 10 s | "
          "without OpenCASCADE |")
    print("|" + "---|" * 14)
    for name, rows in tables:
        print(summary(name, rows))


if __name__ == "__main__":
    main()
