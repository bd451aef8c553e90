"""Surface meshes of CAD files beside Gmsh's: shells.py PROGRAM FOLDER [--shares 20 60] [--only PATTERN].

Each file of the folder (STEP, IGES, BREP) is meshed with triangles of 1/20 and 1/60 of its diagonal, by
`collarmesh --dimension 2` and by Gmsh (its Python module; default algorithm, sizes between corners alone). Both
run in a process of their own with one thread, so that the CPU seconds are those of everything from reading to
writing. Angles, counts and distances are measured in the same way from both meshes, in Gmsh's own format:

- angles: of all triangles ("raw"), and without those at corners of the input that are sharper than 20 degrees
  ("away"): triangles with such an angle between two sides on edges of the input, at a vertex of the input;
- distance: the largest one of the triangles' centres from the faces, which OpenCASCADE has cut into triangles
  (`collarmesh repair`), in target edge lengths; needs the Python module vtk.
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
gmsh.option.setNumber("Mesh.SaveAll", 1)
gmsh.model.mesh.generate(2)
gmsh.write(sys.argv[3])
"""
LIMIT = 200  # seconds
SHARP = 20  # degrees


def run(command):
    """Runs a command; returns its exit code (None if it exceeded the time limit) and its CPU seconds."""
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


def read_mesh(path):
    """Returns points, triangles, the edges on curves as pairs, and which points are vertices of the input."""
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
    """Returns the largest distance of the points from the triangles of an STL file, divided by the size; None
    without that file or vtk."""
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
    code, seconds = run([program, path, "-o", out, "--dimension", "2", "--size", str(size), "--threads", "1",
                         "--report", report])
    row = {"code": code, "seconds": seconds}
    if code in (0, 7):
        row["findings"] = json.loads(pathlib.Path(report).read_text())["check"]["findings_total"]
        row["measures"] = measures_of(out, f"{folder}/reference.stl", size)
    return row


def gmshs(path, size, folder):
    out = f"{folder}/gmsh.msh"
    pathlib.Path(out).unlink(missing_ok=True)
    code, seconds = run([sys.executable, "-c", GMSH, path, str(size), out])
    row = {"code": code, "seconds": seconds}
    if code == 0 and pathlib.Path(out).exists():
        row["measures"] = measures_of(out, f"{folder}/reference.stl", size)
    return row


def text_of(row):
    if not row.get("measures"):
        return f"failed ({row['code']}) {row['seconds']:.1f} s"
    m = row["measures"]
    return (f"{m['count']:7d} {m['raw']:6.2f} {m['away']:6.2f} {m['largest']:6.1f} {m['poor']:6d} "
            f"{m['distance'] or 0:.4f} {row['seconds']:6.2f} s")


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
            f"{seconds[-1]:.1f} |")


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
                pathlib.Path(f"{folder}/reference.stl").unlink(missing_ok=True)
                run([arguments.program, "repair", str(path), "-o", f"{folder}/reference.stl"])
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
                counts = [a["measures"]["count"] / b["measures"]["count"] for a, b in zip(mine, others)
                          if a.get("measures") and b.get("measures")]
                if counts:
                    print(f"triangles over Gmsh's, median at 1/{share:g}: {statistics.median(counts):.2f}")
    print("| | meshed | smallest angle, raw, median | away, median | away at least 15 | at least 20 | largest, away, "
          "median | triangles, median | distance, median | CPU s, median | 95 % | most |")
    print("|" + "---|" * 12)
    for name, rows in tables:
        print(summary(name, rows))
    if arguments.rows:
        pathlib.Path(arguments.rows).write_text(json.dumps(all_rows))


if __name__ == "__main__":
    main()
