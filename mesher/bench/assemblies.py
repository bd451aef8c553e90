#!/usr/bin/env python3
"""Measures how the cost of an assembly, a board with components, grows with the number of its parts.

assemblies.py [--parts 50 200 500] [--program collarmesh] [--limit 300]

The board carries blocks and cylinders, each of which touches it in one face, and housings, which stand on four feet.
FreeCAD writes the STEP files. The column "reading" is the share of the time that goes into reading and fusing the
solids."""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from processes import run
from tables import machine, si, table

make_board = """
import sys, math, random
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]
import FreeCAD, Part
V = FreeCAD.Vector
path, count = sys.argv[1], int(sys.argv[2])
random.seed(count)
across = math.ceil(math.sqrt(count))
parts = [Part.makeBox(10 * across, 10 * across, 1.6, V(0, 0, -1.6))]
for k in range(count - 1):
    x, y = 10 * (k % across) + 2, 10 * (k // across) + 2
    kind = random.randrange(3)
    if kind == 0:
        parts.append(Part.makeBox(5, 4, 1.5, V(x, y, 0)))
    elif kind == 1:
        parts.append(Part.makeCylinder(2.5, 4, V(x + 3, y + 3, 0)))
    else:
        feet = [Part.makeBox(1, 0.5, 0.2, V(x - 0.5, y + 0.5 + 1.2 * foot, 0)) for foot in range(4)]
        parts.append(Part.makeBox(6, 6, 1.4, V(x, y, 0.2)).fuse(feet).Solids[0])
Part.makeCompound(parts).exportStep(path)
"""


def row(count: int, arguments: argparse.Namespace, folder: Path) -> list[str]:
    step, report = folder / f"board{count}.step", folder / "report.json"
    subprocess.run(["/usr/bin/python3", "-c", make_board, str(step), str(count)], check=True, stdout=subprocess.DEVNULL)
    command = [arguments.program, str(step), "-o", str(folder / "board.vtu"), "--threads", "1", "--report", str(report),
               "--quiet"]
    done = run(command, folder, arguments.limit, accepted=(0, 7))
    told = json.loads(report.read_text())
    reading = told["seconds"]["read"] / told["seconds"]["total"]
    return [str(count), f"{done.cpu:.1f}", f"{reading:.0%}", si(told["mesh"]["tets"]), str(done.exit_code)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", type=int, nargs="+", default=[50, 200, 500])
    parser.add_argument("--program", default="collarmesh")
    parser.add_argument("--limit", type=float, default=300)
    arguments = parser.parse_args()
    print(machine(Path(arguments.program).resolve().parents[1]))
    with tempfile.TemporaryDirectory() as folder:
        rows = [row(count, arguments, Path(folder)) for count in arguments.parts]
    print(table(["parts", "CPU s", "reading", "tets", "exit code"], rows))


if __name__ == "__main__":
    main()
