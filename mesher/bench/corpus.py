#!/usr/bin/env python3
"""Meshes the valid parts of a corpus that have no acute creases: with collarmesh at a size of 1/25 of the diagonal, and
with TetGen at a size that gives as many tetrahedra. TetGen keeps every triangle of the surface; if it therefore cannot
make so few tetrahedra, it makes as few as it can.

Prints a Markdown table of medians of CPU seconds of the whole programs; ours reads, meshes, certifies and writes.
Ratios are TetGen's CPU seconds per tetrahedron over ours: above 1 we are faster. The last ratio is TetGen's CPU seconds
for whole runs over ours without the certificate."""

from __future__ import annotations

import argparse
import csv
import math
import os
import shutil
import statistics
import sys
from dataclasses import dataclass, field
from pathlib import Path

from inputs import read_surface
from meshers import Collarmesh, TetGen
from processes import ProgramFailed, pin_to_core
from tables import machine, seconds, si, table
from tuning import SizeCache, size_for

header = ["input", "triangles or facets", "tets", "CPU s", "refinement s", "TetGen: tets", "CPU s", "refinement s",
          "ratio", "without the certificate", "of refinement", "of the runs"]


@dataclass
class CorpusFile:
    """A file of the corpus that both programs read unchanged."""
    path: Path
    polygons: range           # its length is the number of polygons, from the manifest
    volume: float = 1
    diagonal: float = math.inf
    suffix: str = field(init=False)

    def __post_init__(self) -> None:
        self.suffix = self.path.suffix.lower()

    feature_angle = 30   # degrees, collarmesh's default

    @property
    def name(self) -> str:
        return self.path.name

    @property
    def files(self) -> list[str]:
        return [f"input{self.suffix}"]

    def write(self, path_without_suffix: Path) -> None:
        # TetGen does not read .obj, and reads .stl only if it is text.
        textual = self.path.read_bytes()[:5] == b"solid"
        if self.suffix == ".obj" or self.suffix == ".stl" and not textual:
            self.suffix = ".off"
            read_surface(self.path).write_off(path_without_suffix.with_suffix(".off"))
        else:
            shutil.copy(self.path, path_without_suffix.with_suffix(self.suffix))


def corpus_files(corpus: Path, only: list[str]) -> list[CorpusFile]:
    with open(corpus / "MANIFEST.tsv", newline="") as manifest:
        rows = list(csv.reader(manifest, delimiter="\t"))[1:]
    return [CorpusFile(corpus / row[0], range(int(row[3] or 0))) for row in rows
            if row[1].startswith(("mesh: clean", "mesh: smooth")) and (not only or row[0] in only)]


def row(file: CorpusFile, ours: Collarmesh, tetgen: TetGen, options, cache: SizeCache) -> list[str]:
    folders = []
    for mesher in (ours, tetgen):
        folders.append(cache.folder / f"{file.name}_{mesher.name}")
        folders[-1].mkdir(exist_ok=True)
        mesher.prepare(file, folders[-1])
    described = ours.describe(file, folders[0])
    file.diagonal, file.volume = described["diagonal"], sum(r["volume"] for r in described["regions"])
    size = file.diagonal / options.share
    line = [file.name, si(len(file.polygons))]
    runs = [ours.mesh(file, size, folders[0])]
    try:
        peer_size = size_for(tetgen, file, runs[0].tets, folders[1], cache)
        peers = []
        for _ in range(options.rounds):
            runs.append(ours.mesh(file, size, folders[0]))
            peers.append(tetgen.mesh(file, peer_size, folders[1]))
    except ProgramFailed as failure:
        return [*line, si(runs[0].tets), seconds(runs[0].cpu), seconds(runs[0].refinement_cpu), str(failure),
                *[""] * 6]

    def median(of, member):
        return statistics.median(getattr(run, member) for run in of)

    def ratio(member: str) -> str:
        mine, theirs = median(runs[1:], member) / runs[0].tets, median(peers, member) / peers[0].tets
        return f"{theirs / mine:.2f}"

    return [*line, si(runs[0].tets), seconds(median(runs[1:], "cpu")), seconds(median(runs[1:], "refinement_cpu")),
            si(peers[0].tets), seconds(median(peers, "cpu")), seconds(median(peers, "refinement_cpu")),
            ratio("cpu"), ratio("meshing_cpu"), ratio("refinement_cpu"),
            f"{median(peers, 'cpu') / median(runs[1:], 'meshing_cpu'):.2f}"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--corpus", type=Path, default=os.environ.get("COLLARMESH_CORPUS"), required=False)
    parser.add_argument("--files", nargs="*", default=[], help="only these")
    parser.add_argument("--share", type=float, default=25, help="size: the diagonal over this")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--time-limit", type=float, default=120, help="seconds for one run of one program")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    parser.add_argument("--quality", default="1.414", help="TetGen's bound on radius-edge ratios; ours is 2")
    options = parser.parse_args()
    if options.corpus is None:
        parser.error("name a corpus with --corpus or $COLLARMESH_CORPUS")
    about = machine(options.build)
    pin_to_core(options.core)
    ours = Collarmesh(options.build.resolve() / "bin" / "collarmesh", options.time_limit)
    tetgen = TetGen(options.time_limit, quality=options.quality)
    cache = SizeCache()
    rows = []
    for file in corpus_files(Path(options.corpus), options.files):
        rows.append(row(file, ours, tetgen, options, cache))
        print(*rows[-1], file=sys.stderr, flush=True)
    print(f"{about}. collarmesh {ours.version()}, TetGen {tetgen.version()}. Medians of {options.rounds}.\n")
    print(table(header, rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
