"""The command line of the scripts that compare meshers at equal numbers of tets, on the box and on parts of a
corpus."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from inputs import Surface, box, read_surface


def comparison_options(description: str, default_parts: list[str]) -> argparse.Namespace:
    """Parses the options build, corpus, parts, tets, time_limit (seconds) and core. Ends the program if the
    command line is wrong."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = Path(__file__).resolve().parents[2]
    parser.add_argument("--build", type=Path, default=root / "build" / "bench")
    parser.add_argument("--corpus", type=Path, default=os.environ.get("COLLARMESH_CORPUS"))
    parser.add_argument("--parts", nargs="*", default=default_parts,
                        help="files of the corpus, which are meshed after the built-in box")
    parser.add_argument("--tets", type=int, default=40000)
    parser.add_argument("--time-limit", type=float, default=300, help="seconds for one run of one program")
    parser.add_argument("--core", type=int, help="the core to run on (default: the last one)")
    options = parser.parse_args()
    if options.corpus is None and options.parts:
        parser.error("name a corpus with --corpus or $COLLARMESH_CORPUS")
    return options


def surfaces(options: argparse.Namespace) -> list[Surface]:
    return [box(), *(read_surface(Path(options.corpus) / part) for part in options.parts)]
