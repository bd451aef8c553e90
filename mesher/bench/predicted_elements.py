#!/usr/bin/env python3
"""Compares the predictions of `collarmesh info --predict` with meshes: tets and CPU seconds for CAD files and surfaces,
at the default size and at multiples of it, with elements of both orders.

The constants of the predictions (src/predict/vertex_counts.h) were fitted to every fourth, in alphabetical order, of
the files that the defaults can mesh. The tables have separate rows for these files ("fitted") and for the others. The
file --out keeps the measures of meshes; a mesh that is in this file is not made again. Predictions always are."""

from __future__ import annotations

import argparse
import csv
import json
import statistics
import sys
import tempfile
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np

from meshers import Collarmesh
from processes import pin_to_core, run_limited
from real_parts import cad_suffixes, surface_suffixes
from tables import machine, seconds, table

sizes_per_diagonal = 20
fitted_every = 4
memory = int(12e9)
near = 1.4   # predicted / made numbers of tets from 1 / this to this count as near


@dataclass
class Made:
    file: str
    order: int
    share: float         # size relative to the default
    exit_code: int
    size: float = 0
    tets: int = 0
    cpu: float = 0       # seconds of the whole program


@dataclass
class Pair:
    made: Made
    tets: float          # predicted number of tets
    seconds: float       # predicted seconds
    fitted: bool         # the constants were fitted to this file

    def ratio(self) -> float:
        return self.tets / self.made.tets

    def is_near(self) -> bool:
        return 1 / near <= self.ratio() <= near


def read_rows(out: Path) -> list[Made]:
    if not out.exists():
        return []
    kinds = {"str": str, "int": int, "float": float}
    with open(out, newline="") as lines:
        return [Made(**{f.name: kinds[f.type](line[f.name]) for f in fields(Made)})
                for line in csv.DictReader(lines, delimiter="\t")]


def append_row(out: Path, row: Made) -> None:
    new = not out.exists()
    with open(out, "a", newline="") as lines:
        writer = csv.DictWriter(lines, [f.name for f in fields(Made)], delimiter="\t", lineterminator="\n")
        if new:
            writer.writeheader()
        writer.writerow(asdict(row))


def mesh(path: Path, order: int, share: float, default: float | None, folder: Path, options) -> Made:
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    command = [str(options.program), str(path), "-o", "mesh.vtu", "--report", report.name,
               "--progress", "none", "-q", "--threads", "1", "--order", str(order)]
    if default is not None:
        command += ["--size", repr(default * share)]
    run = run_limited(command, folder, options.limit, memory)
    row = Made(path.name, order, share, run.exit_code, cpu=round(run.cpu, 3))
    if run.exit_code in (0, 7) and report.exists():
        told = json.loads(report.read_text())
        row.tets, row.size = told["mesh"]["tets"], told["complex"]["diagonal"] / sizes_per_diagonal * share
    return row


def predict(path: Path, order: int, sizes: list[float], folder: Path, options) -> tuple[list[dict], float]:
    """Returns one prediction for each size, and their total CPU seconds without those for reading the part."""
    command = [str(options.program), "info", str(path), "--json"]
    wishes = ["--order", str(order), "--predict", ",".join(repr(size) for size in sizes)]
    alone = run_limited(command, folder, options.limit, memory)
    run = run_limited(command + wishes, folder, options.limit, memory)
    if run.exit_code != 0:
        raise RuntimeError(f"{path.name}: {run.output.strip()}")
    return json.loads(run.output[run.output.index("{"):])["predictions"], run.cpu - alone.cpu


def line(order: str, share: str, which: str, pairs: list[Pair]) -> list[str]:
    ratios = [pair.ratio() for pair in pairs]
    times = [pair.seconds / pair.made.cpu for pair in pairs]
    return [order, share, which, str(len(pairs)), f"{statistics.median(ratios):.2f}",
            *(f"{np.percentile(ratios, percent):.2f}" for percent in (10, 90)),
            f"{100 * sum(pair.is_near() for pair in pairs) / len(pairs):.0f}%",
            f"{statistics.median(times):.2f}",
            *(f"{np.percentile(times, percent):.2f}" for percent in (10, 90))]


def tables(pairs: list[Pair]) -> str:
    lines = []
    for order in sorted({pair.made.order for pair in pairs}):
        for share in sorted({pair.made.share for pair in pairs}, reverse=True):
            for fitted in (True, False):
                some = [p for p in pairs if (p.made.order, p.made.share, p.fitted) == (order, share, fitted)]
                if some:
                    lines.append(line(str(order), f"{share:g}", "fitted" if fitted else "others", some))
    judged = [pair for pair in pairs if not pair.fitted]
    lines.append(line("all", "all", "others", judged))
    worst = sorted((pair for pair in judged if not pair.is_near()),
                   key=lambda pair: -abs(np.log(pair.ratio())))
    return "\n\n".join([
        table(["order", "size / default", "files", "number", "tets predicted / made, median", "10%", "90%",
               f"within a factor of {near:g}", "seconds predicted / made, median", "10%", "90%"], lines),
        table(["file", "order", "size / default", "tets made", "predicted"],
              [[pair.made.file, str(pair.made.order), f"{pair.made.share:g}", str(pair.made.tets),
                f"{pair.tets:.0f}"]
               for pair in worst])])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("folders", type=Path, nargs="+", metavar="FOLDER")
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--program", type=Path, help="collarmesh (default: of the build)")
    parser.add_argument("--orders", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--shares", type=float, nargs="+", default=[1, 2, 0.5],
                        help="sizes as shares of the default size; 1 comes first")
    parser.add_argument("--limit", type=int, default=65, help="CPU seconds for one run of the program")
    parser.add_argument("--out", type=Path, default=Path("predicted_elements.tsv"))
    parser.add_argument("--only-predict", action="store_true", help="make no mesh that --out does not hold")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    about = machine(options.build)
    pin_to_core(options.core)
    options.program = (options.program or options.build / "bin" / "collarmesh").resolve()
    made = {(row.file, row.order, row.share): row for row in read_rows(options.out)}
    paths = [path.resolve() for folder in options.folders for path in sorted(folder.iterdir())
             if path.suffix.lower() in cad_suffixes + surface_suffixes]
    pairs, costs = [], []
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)

        def make(path: Path, order: int, share: float, default: float | None) -> Made | None:
            key = (path.name, order, share)
            if key not in made and not options.only_predict:
                made[key] = mesh(path, order, share, default, folder, options)
                append_row(options.out, made[key])
                print(made[key], file=sys.stderr, flush=True)
            row = made.get(key)
            return row if row and row.tets > 0 else None

        meshed = 0
        for path in paths:
            first = make(path, 1, 1, None)
            if not first:
                continue
            fitted = meshed % fitted_every == 0
            meshed += 1
            for order in options.orders:
                rows = [row for share in options.shares if (row := make(path, order, share, first.size))]
                if not rows:
                    continue
                predicted, cost = predict(path, order, [row.size for row in rows], folder, options)
                costs.append(cost / len(rows))
                pairs += [Pair(row, p["tets"], p["seconds"], fitted) for row, p in zip(rows, predicted)]
    print(f"{about}. {Collarmesh(options.program, 0).version()}.\n")
    print(tables(pairs))
    print("\nCPU seconds for one prediction beyond reading the part: "
          f"median {seconds(statistics.median(costs))}, 90% {seconds(float(np.percentile(costs, 90)))}, most "
          f"{seconds(max(costs))}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
