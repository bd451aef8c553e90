"""Mesh a sample of real parts as they come.

    real_parts_test.py PROGRAM [--every N] [--workers N]

COLLARMESH_REAL names a folder of CAD files and surfaces, good and bad. Each N-th of them and those that once failed
are meshed with the defaults. A file may be refused with a message or reach its time limit, but nothing may crash, no
guarantee may be missed, no dihedral angle may exceed 150 degrees, `check` must agree, and most files must be meshed.
Some get boundary layers, too.
Exit code 77 (skipped) without such a folder.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import sys
import tempfile

from judging import LONG, Failed, run

KINDS = {".step", ".stp", ".brep", ".brp", ".igs", ".iges", ".stl", ".obj", ".off", ".ply"}
LARGEST = 600_000  # bytes
SECONDS = 30 if LONG else 20
MESHED = 0.8  # least share of the sample; some files are open sheets or need more time
# Parts of file names, for faults that are mended now: refinement did not end beside a sheet outside all
# regions, where a sample across a gap fell onto a point of a curve, and in folds as fine as the repair's
# tolerance; a ball was too large for the curved patch inside it; a face was made twice; a tet in a fillet of
# one row kept an angle of 157 degrees; the reader took a quarter of a sphere for the other three.
ONCE_FAILED = ["gebco7510", "MS-X-BAR-ALU", "Wrist_Roll_SO101", "e3b91037__middle2", "Upside_Down_ERCP_ArmLong",
               "box_cover", "HEAD_BACK"]
# Parts that once failed with layers on all faces, a tenth of the size high, with this size: tets of the core missed
# their angles beside faces that meet sharply, or all layers were given up.
LAYERS_ONCE_FAILED = [("bad-wings__a3f5ad0a__bottom", "13.223310355442266"),
                      ("bad-wings__a3f5ad0a__bottom", "13.223310353942266")]
COVERED = 0.95
LARGEST_ANGLE = 150.01  # degrees; not a guarantee together with the radius-edge bound, but promised to users


def sample(folder, every):
    files = sorted(f for f in pathlib.Path(folder).rglob("*") if f.suffix.lower() in KINDS)
    chosen = [f for f in files if f.stat().st_size < LARGEST][every // 2 :: every]
    for name in ONCE_FAILED:
        found = [f for f in files if name in f.name]
        if not found:
            print(f"{name}: not there")
        chosen += [f for f in found if f not in chosen]
    return chosen


def outcome(program, path, folder):
    mesh, report = (pathlib.Path(folder) / (path.name + suffix) for suffix in (".vtu", ".json"))
    result = run(program, path, "-o", mesh, "--report", report, "--time-limit", SECONDS)
    said = (result.stderr.splitlines() or [""])[0]
    if result.returncode in (4, 5):
        return False, f"exit code {result.returncode}: {said}"
    if result.returncode != 0:
        raise Failed(f"exit code {result.returncode}: {said}")
    largest = json.loads(report.read_text())["mesh"]["max_dihedral"]
    if largest > LARGEST_ANGLE:
        raise Failed(f"a dihedral angle of {largest:.2f} degrees")
    checked = run(program, "check", mesh, "--against", path)
    if checked.returncode != 0:
        raise Failed(f"check disagrees: {(checked.stdout.splitlines() or [''])[0]}")
    return True, "meshed and checked"


def outcome_with_layers(program, path, size, folder):
    mesh, report = (pathlib.Path(folder) / f"{path.name}_{size}{suffix}" for suffix in (".vtu", ".json"))
    result = run(program, path, "-o", mesh, "--report", report, "--size", size,
                 "--layers", f"all:first={0.1 * float(size)},growth=1.2,count=3")
    if result.returncode != 0:
        raise Failed(f"with layers: exit code {result.returncode}: {(result.stderr.splitlines() or [''])[0]}")
    coverage = json.loads(report.read_text())["layers"]["coverage"]
    if coverage < COVERED:
        raise Failed(f"layers cover {coverage:.3f}")
    return True, "meshed with layers"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--every", type=int, default=12 if LONG else 18)
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="inputs at the same time")
    arguments = parser.parse_args()
    folder = os.environ.get("COLLARMESH_REAL", "")
    if not folder:
        print("COLLARMESH_REAL is not set: no parts to mesh")
        return 77
    files = sample(folder, arguments.every)
    meshed = failures = 0
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
        results = [(path, pool.submit(outcome, arguments.program, path, temporary)) for path in files]
        for name, size in LAYERS_ONCE_FAILED:
            for path in pathlib.Path(folder).rglob(f"*{name}*"):
                results.append((path, pool.submit(outcome_with_layers, arguments.program, path, size, temporary)))
        for path, result in results:
            try:
                good, text = result.result()
                meshed += good
            except Failed as failure:
                failures += 1
                text = f"FAILED: {failure}"
            print(f"{path.name:70}{text}"[:220], flush=True)
    print(f"{meshed} of {len(results)} meshed, {failures} failed")
    return 1 if failures or meshed < MESHED * len(results) else 0


if __name__ == "__main__":
    sys.exit(main())
