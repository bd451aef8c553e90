#!/usr/bin/env python3
"""Checks whether meshes keep the bounds that options request: meshes each acute family and each file of a corpus with
several collar angles, radius-edge ratios and a vertex ratio. The certificate judges each mesh, and so does an
independent program, the judge ($COLLARMESH_JUDGE). The column "judge differs" counts the meshes for which the judge's
findings or numbers differ from the report's, or for which an expected collar or warning is absent. Prints a Markdown
table with a row for each option, then the guarantees that were missed and the differences."""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from acute_inputs import AcuteInput
from acute_peers import curved, members
from acute_peers import size as acute_size
from processes import pin_to_core
from tables import machine, si, table
from tuning import SizeCache

slow = (("fan", 72, 0), ("pyramid", 64, 5), ("comb", 20, 4))   # these take more than 5 s each
judged_surfaces = (".off", ".obj", ".stl", ".ply", ".poly", ".smesh")
relative_distance = 1e-3


@dataclass
class Case:
    name: str
    files: list[Path]
    options: list[str]
    surface: Path | None = None   # the surface with which the judge compares the mesh
    tolerance: list[str] = field(default_factory=list)


@dataclass
class Outcome:
    code: int
    cpu: float
    creases: int = 0
    collar: int = 0
    tets: int = 0
    warned: bool = False
    missed: list[str] = field(default_factory=list)     # guarantees that the certificate says are missed
    differs: list[str] = field(default_factory=list)    # statements in which judge and report disagree
    # whether, by the judge, all tets outside collars (thin ones included) keep the requested radius-edge ratio
    within: bool = False
    largest: float = 0         # largest dihedral angle in collars, by the judge


def acute_cases(generator: Path, folder: Path, with_slow: bool) -> list[Case]:
    cases = []
    for family, *parameters in members:
        if (family, *parameters) in slow and not with_slow:
            continue
        shape = AcuteInput(generator, family, tuple(parameters))
        prefix = folder / shape.name.replace(" ", "_")
        subprocess.run([str(generator), str(prefix), *shape.name.split(), "--triangulated"], check=True)
        told = next(path for path in (Path(f"{prefix}.off"), Path(f"{prefix}.poly")) if path.exists())
        round_ = family in curved
        distance = str(acute_size / 100)
        cases.append(Case(shape.name, sorted(folder.glob(f"{prefix.name}_[0-9]*.poly")),
                          ["--size", str(acute_size), "--feature-angle", "30" if round_ else "0",
                           *(["--distance", distance] if round_ else [])], told,
                          ["--distance", distance] if round_ else ["--exact"]))
    return cases


def corpus_cases(program: Path, corpus: Path, share: float, wanted: Callable[[str], bool]) -> list[Case]:
    cases = []
    with open(corpus / "MANIFEST.tsv", newline="") as manifest:
        rows = list(csv.reader(manifest, delimiter="\t"))[1:]
    for name, expect in (row[:2] for row in rows if wanted(row[0])):
        path = corpus / name
        told = subprocess.run([str(program), "info", str(path), "--json"], capture_output=True, text=True)
        if told.returncode != 0:
            continue
        diagonal = json.loads(told.stdout)["complex"]["diagonal"]
        distance = str(relative_distance * diagonal)
        surface = path if expect.startswith("mesh:") and path.suffix.lower() in judged_surfaces else None
        cases.append(Case(name, [path], ["--size", str(diagonal / share), "--distance", distance], surface,
                          ["--distance", distance]))
    return cases


def asked(question: tuple[str, ...], option: str, default: float) -> float:
    return float(question[1]) if question and question[0] == option else default


def judge(judging: str, case: Case, question: tuple[str, ...], mesh: Path, report: dict) -> dict | str:
    """Returns the judge's result, or the end of the judge's output if the output is not JSON."""
    check = report["check"]
    smallest_thin = min(8, report["complex"]["smallest_angle"] / 2,
                        check["min_forced_dihedral"] if check["forced_tets"] else math.inf)
    command = [sys.executable, judging, str(mesh), "--json", "--rho", str(asked(question, "--radius-edge", 2)),
               "--collar-angle", str(asked(question, "--collar-angle", 150)), "--thin", str(smallest_thin)]
    if case.surface:
        command += ["--surface", str(case.surface), *case.tolerance]
    told = subprocess.run(command, capture_output=True, text=True)
    try:
        return json.loads(told.stdout)
    except ValueError:
        return (told.stdout + told.stderr).strip()[-100:]


def compare(outcome: Outcome, said: dict, report: dict, ratio: float) -> None:
    """Compares the judge's findings and numbers with the report's, and fills in `outcome`."""
    check, of = report["check"], said["quality"]
    inside, outside = of.get("in_collars", {}), of.get("outside_collars", {})
    outcome.within = outside.get("radius_edge_max", 0) <= ratio * (1 + 1e-9)
    outcome.largest = inside.get("max_dihedral", 0)
    if outcome.code == 0:
        outcome.differs += said["failed"]
    if inside.get("tets", 0) != check["collar_tets"]:
        outcome.differs.append(f"{inside.get('tets', 0)} tets of collars, not {check['collar_tets']}")
    if abs(outcome.largest - check["max_collar_dihedral"]) > 1e-6:
        outcome.differs.append(f"largest angle in collars {outcome.largest}, not {check['max_collar_dihedral']}")


def run(program: Path, judging: str | None, case: Case, question: tuple[str, ...], folder: Path,
        time_limit: float) -> Outcome:
    mesh, report_file = folder / "mesh.vtu", folder / "report.json"
    mesh.unlink(missing_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    told = subprocess.run([str(program), *map(str, case.files), "-o", str(mesh), *case.options, *question, "--threads",
                           "1", "--report", str(report_file), "--progress", "none", "--time-limit", str(time_limit)],
                          capture_output=True, text=True)
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    outcome = Outcome(told.returncode, spent.ru_utime + spent.ru_stime - before.ru_utime - before.ru_stime)
    if told.returncode not in (0, 7):
        return outcome
    report = json.loads(report_file.read_text())
    outcome.creases, outcome.collar = len(report["complex"]["creases"]), report["check"]["collar_tets"]
    outcome.tets = report["mesh"]["tets"]
    outcome.warned = bool(question) and any(question[0] in line for line in report["warnings"])
    outcome.missed = sorted({finding["guarantee"] for finding in report["check"]["findings"]})
    if outcome.creases and not outcome.collar:
        outcome.differs.append("creases, but no collar")
    if judging:
        said = judge(judging, case, question, mesh, report)
        if isinstance(said, str):
            outcome.differs.append(said)
        else:
            compare(outcome, said, report, asked(question, "--radius-edge", 2))
    if question[:1] == ("--vertex-ratio",) and outcome.code == 0 and not outcome.warned:
        outcome.differs.append("no warning")
    return outcome


header = ["option", "meshes", "with creases", "with collars there", "exit code 7", "no mesh", "warned",
          "ratio everywhere outside collars", "largest angle in collars", "tets", "judge differs"]


def row(question: tuple[str, ...], outcomes: list[Outcome]) -> list[str]:
    meshes = [o for o in outcomes if o.code in (0, 7)]
    return [" ".join(question) or "none", str(len(meshes)), str(sum(o.creases > 0 for o in meshes)),
            str(sum(o.creases > 0 and o.collar > 0 for o in meshes)), str(sum(o.code == 7 for o in meshes)),
            str(len(outcomes) - len(meshes)), str(sum(o.warned for o in meshes)), str(sum(o.within for o in meshes)),
            f"{max((o.largest for o in meshes), default=0):.1f}", si(sum(o.tets for o in meshes)),
            str(sum(bool(o.differs) for o in meshes))]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--corpus", type=Path, default=os.environ.get("COLLARMESH_CORPUS"))
    parser.add_argument("--only", nargs="*", default=[], help="names of inputs")
    parser.add_argument("--share", type=float, default=12,
                        help="size for files of the corpus: the diagonal divided by this")
    parser.add_argument("--time-limit", type=float, default=120)
    parser.add_argument("--groups", nargs="*", default=["acute families", "corpus"])
    parser.add_argument("--without", nargs="*", default=[], help="names of inputs that are left out")
    parser.add_argument("--angles", type=float, nargs="*", default=[100, 110, 120, 130])
    parser.add_argument("--slow", action="store_true", help="slow acute families, too")
    parser.add_argument("--most", type=float, default=math.inf,
                        help="leave out inputs that take more CPU seconds without an option")
    parser.add_argument("--stop-after", type=float, default=math.inf, help="start no input after these seconds")
    parser.add_argument("--core", type=int)
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    program, judging = options.build / "bin" / "collarmesh", os.environ.get("COLLARMESH_JUDGE")
    folder = SizeCache().folder / "asked"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    begin = time.monotonic()
    print(f"{about}.{'' if judging else ' Without a judge.'}\n")
    remarks: list[str] = []

    def wanted(name: str) -> bool:
        return (not options.only or name in options.only) and name not in options.without

    questions: list[tuple[str, ...]] = [
        (), *(("--collar-angle", f"{angle:g}") for angle in options.angles), ("--vertex-ratio", "4"),
        *(("--radius-edge", str(ratio)) for ratio in (1.5, 2, 3))]
    for title in options.groups:
        cases = (acute_cases(options.build / "bin" / "acute_shape", folder, options.slow)
                 if title == "acute families" else corpus_cases(program, options.corpus, options.share, wanted))
        found: list[list[Outcome]] = [[] for _ in questions]
        left: list[str] = []
        for case in cases:
            if not wanted(case.name):
                continue
            if time.monotonic() - begin > options.stop_after:
                left.append(case.name)
                continue
            for question, outcomes in zip(questions, found):
                outcome = run(program, judging, case, question, folder, options.time_limit)
                if not question and outcome.cpu > options.most:
                    left.append(case.name)
                    break
                outcomes.append(outcome)
                line = f"{case.name}, {' '.join(question) or 'no option'}: exit code {outcome.code}"
                print(line, outcome, file=sys.stderr, flush=True)
                if outcome.code != 0 or outcome.differs:
                    remarks.append(f"{line}: {'; '.join([*outcome.missed, *outcome.differs])}")
        print(f"{title}:\n\n" + table(header, [row(*pair) for pair in zip(questions, found)]) + "\n", flush=True)
        print(f"left out: {', '.join(left) or 'none'}\n", flush=True)
    print("\n".join(f"- {remark}" for remark in remarks))
    return 0


if __name__ == "__main__":
    sys.exit(main())
