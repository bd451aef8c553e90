"""Fuzzes the whole operation: meshes random complexes, changed ones and mutated files, and judges each run.

    operations.py [--seconds N | --runs N] [--seed S] [--kinds complexes,cad,files] [--keep FOLDER]
                  [--sanitized]

--runs is the number of runs of each kind; step, iges and brep are kinds, too. --sanitized is for programs with a
sanitizer: no memory budget, as the sanitizer's memory would count, and ten times the time.

A run is wrong if a signal ends it, if its exit code is 1 or not one of those expected, if it takes longer than its time
limit by more than a tenth (at least a second) and another second, if the volumes of the regions are not those known, or
if it writes a mesh that `check` does not pass. Wrong ones are kept in FOLDER, with how to repeat them.
COLLARMESH_PROGRAM is the program, COLLARMESH_REAL a folder of CAD files to mutate, beside those made here. The seed is
that of the day unless it is given.
"""

import argparse
import collections
import datetime
import itertools
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import complexes  # noqa: E402

PROGRAM = os.path.abspath(shutil.which(os.environ["COLLARMESH_PROGRAM"]) or os.environ["COLLARMESH_PROGRAM"])
SOURCES = pathlib.Path(__file__).resolve().parents[2]
TIME_LIMIT, MEMORY_BUDGET = 15.0, ["--max-memory", "500M"]
REFUSALS = {2, 3, 4, 5, 8}
ANGLES = {"radius_edge", "thin_angles", "collar_dihedral"}  # all that meshes begun with constrained tetrahedra may miss


class Trial:
    """One run of the program under limits."""

    def __init__(self, folder, *arguments):
        begin = time.monotonic()
        with open(folder / "stderr", "w+b") as messages, open(folder / "stdout", "w+b") as results:
            process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=folder, stdout=results, stderr=messages)
            try:
                process.wait(timeout=4 * TIME_LIMIT)
            except BaseException as stopped:
                process.kill()
                process.wait()
                if not isinstance(stopped, subprocess.TimeoutExpired):
                    raise
        self.seconds = time.monotonic() - begin
        self.code = process.returncode
        self.text = (folder / "stderr").read_text(errors="replace")

    def fault(self, codes):
        if self.code < 0 or self.code > 8 or self.code == 1:
            return f"exit {self.code}"
        if self.seconds > max(1.1 * TIME_LIMIT, TIME_LIMIT + 1) + 1:  # because the machine may be busy
            return f"took {self.seconds:.1f} s with a limit of {TIME_LIMIT} s"
        return None if self.code in codes else f"exit {self.code}, expected one of {sorted(codes)}"


def mesh(folder, path, *options):
    return Trial(folder, path, "-o", "out.vtu", "--report", "report.json", "-q", "--time-limit", TIME_LIMIT,
                 *MEMORY_BUDGET, *options)


def near(a, b, tolerance, rounding):
    return len(a) == len(b) and all(abs(x - y) <= tolerance * max(abs(x), abs(y)) + rounding for x, y in zip(a, b))


def judge_volumes(folder, known, rounding, warned):
    report = json.loads((folder / "report.json").read_text())["check"]
    volumes = sorted(report["region_volumes"].values())
    if known is None or warned or near(volumes, known, 1e-5, rounding):
        return None
    return f"volumes {volumes} in place of {known}"


def judge_findings(folder):
    findings = json.loads((folder / "report.json").read_text())["check"]["findings"]
    others = {finding["guarantee"] for finding in findings} - ANGLES
    return f"findings of {sorted(others)}" if others else None


def try_complex(folder, seed):
    made, random_ = complexes.random_complex(seed)
    for change in random_.sample(complexes.CHANGES, random_.randint(0, 2)):
        made = change(made, random_)
    path = folder / "in.off"
    path.write_text(made.off())
    constrained = ["--start", "constrained"]
    size = random_.choice(
        [[], [], ["--size", "1"], ["--coarsen", "off"], ["--order", "2"], ["--improve", "0"], constrained])
    exact = ["--feature-angle", "0"]  # otherwise flat edges are smooth, and volumes are right only within the distance
    run = mesh(folder, path, *size, *exact)
    valid = made.volumes is not None
    allowed = ({0, 5} if valid else REFUSALS | {0}) | ({7} if size is constrained else set())
    fault = run.fault(allowed)
    if fault is None and run.code == 7:
        fault = judge_findings(folder)
    if fault is None and run.code in (0, 7):
        fault = judge_volumes(folder, made.volumes, made.rounding, "is lost" in run.text)
    if fault is None and run.code == 0 and random_.random() < 0.1 and "repaired" not in run.text:
        check = Trial(folder, "check", "out.vtu", "--against", path, *exact,
                      *(["--thin-angle", "0"] if "off" in size else []))
        fault = check.fault({0}) and f"check: {check.fault({0})}"
    return f"complex {made.name}", run.code, fault


def mutate(data, random_):
    data = bytearray(data)
    numbers_only = random_.random() < 0.5  # because readers refuse most other changes
    for _ in range(random_.choice([1, 1, 2, 5, 20])):
        at = random_.randrange(len(data))
        kind = 4 if numbers_only else random_.randrange(5)
        if kind == 0:
            data[at] = random_.randrange(256)
        elif kind == 1:
            data[at:at + 1] = str(random_.choice([0, 1, -1, 7, 10**9, 1e308, "nan"])).encode()
        elif kind == 2:
            del data[at:at + random_.randint(1, 40)]
        elif kind == 3:
            data[at:at] = data[(other := random_.randrange(len(data))):other + random_.randint(1, 40)]
        else:
            digits = [i for i in range(at, min(at + 200, len(data))) if 48 <= data[i] < 58]
            if digits:
                data[random_.choice(digits)] = random_.randrange(48, 58)
        if not data:
            return b"x"
    if not numbers_only and random_.random() < 0.2:
        del data[random_.randrange(len(data)):]
    return bytes(data)


def try_cad(folder, seed, files):
    random_ = random.Random(seed)
    source = random_.choice(files)
    path = folder / f"in{source.suffix.lower()}"
    path.write_bytes(mutate(source.read_bytes(), random_))
    run = mesh(folder, path)
    return f"CAD {path.suffix}", run.code, run.fault(REFUSALS | {0, 7})


def try_file(folder, seed, files):
    random_ = random.Random(seed)
    source = random_.choice(files)
    path = folder / f"in{source.suffix}"
    path.write_bytes(mutate(source.read_bytes(), random_))
    for sibling in source.parent.glob(f"{source.stem}.*"):
        if source.suffix == ".ele" and sibling.suffix != ".ele":
            shutil.copy(sibling, folder / f"in{sibling.suffix}")
    is_mesh = path.suffix in (".vtu", ".vtk", ".msh", ".mesh", ".inp", ".unv", ".ele")
    run = Trial(folder, "info", path, "--time-limit", TIME_LIMIT) if is_mesh else mesh(folder, path)
    return f"file {path.suffix}", run.code, run.fault(REFUSALS | {0, 7} if not is_mesh else REFUSALS | {0})


CAD_KINDS = {"step": (".step", ".stp"), "iges": (".iges", ".igs"), "brep": (".brep", ".brp")}
CAD_KINDS["cad"] = sum(CAD_KINDS.values(), ())


def seeds_of_cad():
    suffixes = CAD_KINDS["cad"]
    files = [p for p in (SOURCES / "tests" / "cli" / "hostile").rglob("*") if p.suffix in suffixes]
    for real in (os.environ.get("COLLARMESH_REAL"), os.environ.get("COLLARMESH_CORPUS")):
        if real:
            files += [p for p in pathlib.Path(real).rglob("*") if p.suffix.lower()
                      in suffixes and p.stat().st_size < 60000]
    return sorted(files)


def seeds_of_files(folder):
    """Returns a sample file of each format."""
    models = SOURCES / "resources" / "models"
    for name in ("box.off", "two_boxes.poly", "bracket.off"):
        for suffix in (".vtu", ".vtk", ".msh", ".mesh", ".inp", ".unv", ".ele", ".off", ".obj", ".stl", ".ply", ".poly",
                       ".smesh"):
            subprocess.run([PROGRAM, "convert", models / name, "-o", folder / f"{pathlib.Path(name).stem}{suffix}",
                            "-q"],
                           capture_output=True, timeout=60)
    return sorted(p for p in folder.iterdir() if p.suffix not in (".node", ".face", ".edge"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("--runs", type=int, help="of each kind; instead of --seconds")
    parser.add_argument("--seed", type=int, default=int(datetime.date.today().strftime("%Y%m%d")) * 100000)
    parser.add_argument("--kinds", default="complexes,cad,files")
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("found"))
    parser.add_argument("--sanitized", action="store_true")
    options = parser.parse_args()
    if options.sanitized:
        global TIME_LIMIT, MEMORY_BUDGET
        TIME_LIMIT, MEMORY_BUDGET = 10 * TIME_LIMIT, []
    outcomes, wrong, interrupted = collections.Counter(), 0, False
    with tempfile.TemporaryDirectory(prefix="collarmesh-fuzz-") as name:
        folder = pathlib.Path(name)
        (folder / "seeds").mkdir()
        kinds = options.kinds.split(",")
        if unknown := set(kinds) - {"complexes", "files", *CAD_KINDS}:
            parser.error(f"no such kinds: {', '.join(sorted(unknown))}")
        files = seeds_of_files(folder / "seeds") if "files" in kinds else []
        trials = {"complexes": try_complex, "files": lambda place, seed: try_file(place, seed, files)}
        for kind in set(kinds) & set(CAD_KINDS):
            seeds = [p for p in seeds_of_cad() if p.suffix.lower() in CAD_KINDS[kind]]
            trials[kind] = lambda place, seed, seeds=seeds: try_cad(place, seed, seeds)
        end = math.inf if options.runs else time.monotonic() + options.seconds
        for seed, kind in ((s, k) for s in itertools.islice(itertools.count(options.seed), options.runs)
                           for k in kinds):
            if time.monotonic() >= end:
                break
            try:
                place = folder / "trial"
                place.mkdir()
                what, code, fault = trials[kind](place, seed)
                outcomes[what, code] += 1
                if fault is not None:
                    wrong += 1
                    print(f"{kind}, seed {seed}: {what}: {fault}", flush=True)
                    shutil.copytree(place, options.keep / f"{kind}-{seed}", dirs_exist_ok=True)
                shutil.rmtree(place)
            except KeyboardInterrupt:
                interrupted = True
                break
    table = collections.defaultdict(dict)
    for (what, code), count in outcomes.items():
        table[what][code] = count
    for what, codes in sorted(table.items()):
        told = ", ".join(f"exit {code}: {count}" for code, count in sorted(codes.items()))
        print(f"{what:18} {sum(codes.values()):6} runs; {told}")
    print(f"{sum(outcomes.values())} runs, {wrong} wrong")
    return 130 if interrupted else 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
