#!/usr/bin/env python3
"""Meshes inputs with `--start constrained`: does each valid complex give a mesh within a limit of CPU time, and how
many tets miss the bounds on angles? TetGen makes constrained tetrahedra (-p, without bounds on quality) of the same
complexes. Prints Markdown tables. The log has one JSON line for each input, so an interrupted run can be continued."""

from __future__ import annotations

import argparse
import gzip
import json
import re
import statistics
import sys
import tempfile
from pathlib import Path

import numpy as np

from adaptation import dihedral_angles
from processes import Measured, ProgramFailed, run, run_limited
from tables import machine, seconds, table

read_suffixes = {".off", ".obj", ".stl", ".ply", ".poly", ".smesh", ".msh", ".step", ".stp", ".brep", ".iges", ".igs"}
bounds = (8, 150)        # on dihedral angles, in degrees
allowed_memory = 8 << 30
on_shapes = {"thin_angles", "collar_dihedral", "radius_edge"}   # guarantees that the start may miss
complexes = (0, 5, 6, 7)  # exit codes that show that the input was a valid complex


def inputs_in(folders: list[Path], every: int) -> list[Path]:
    """Sorts the inputs in the folders by name, and returns every `every`-th one."""
    found = sorted(path for folder in folders for path in (folder.rglob("*") if folder.is_dir() else [folder])
                   if path.with_suffix("").suffix.lower() + path.suffix.lower() in {s + ".gz" for s in read_suffixes}
                   or path.suffix.lower() in read_suffixes)
    return found[::every]


def unpacked(path: Path, folder: Path) -> Path:
    if path.suffix != ".gz":
        return path
    made = folder / path.stem
    made.write_bytes(gzip.decompress(path.read_bytes()))
    return made


def angles_of(path: Path) -> np.ndarray:
    """Returns the smallest and the largest dihedral angle of each tet in a Medit file, in degrees."""
    text = path.read_text()

    def rows(keyword: str, width: int) -> np.ndarray:
        at = re.search(rf"^{keyword}\s+(\d+)\s", text, re.MULTILINE)
        return np.array(text[at.end():].split(None, width * int(at[1]))[:width * int(at[1])],
                        dtype=float).reshape(-1, width)

    points, tets = rows("Vertices", 4)[:, :3], rows("Tetrahedra", 5)[:, :4].astype(int) - 1
    return dihedral_angles(points[tets])


def measure(program: Path, path: Path, cpu_limit: int, peer_limit: float) -> dict:
    """Meshes one input and returns its measures, with TetGen's measures if the complex is valid."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        source = unpacked(path, folder)
        made = run_limited([str(program), str(source), "-o", "mesh.mesh", "--start", "constrained", "--threads", "1",
                            "--report", "report.json", "--progress", "none", "-q"], folder, cpu_limit, allowed_memory)
        row = {"input": path.name, "exit": made.exit_code, "cpu": made.cpu, "said": last_line(made)}
        report = folder / "report.json"
        if report.exists():
            told = json.loads(report.read_text())
            row |= {"start": told["seconds"].get("tetrahedralize", 0), "message": told["message"],
                    "triangles": (told["complex"] or {}).get("triangles", 0) if "complex" in told else 0,
                    "added": (told.get("statistics") or {}).get("vertices_inserted"),
                    "missed": sorted({finding["guarantee"]
                                      for finding in (told.get("check") or {}).get("findings", [])})}
        if (folder / "mesh.mesh").exists():
            angles = angles_of(folder / "mesh.mesh")
            beyond = (angles[:, 0] < bounds[0]) | (angles[:, 1] > bounds[1])
            row |= {"tets": len(angles), "beyond": int(beyond.sum()), "smallest": float(angles[:, 0].min()),
                    "largest": float(angles[:, 1].max())}
        if made.exit_code in complexes or made.exit_code < 0 or "near to each other" in row.get("message", ""):
            row["tetgen"] = tetgen(program, source, folder, peer_limit)
        return row


def last_line(made: Measured) -> str:
    lines = made.output.strip().splitlines()
    return lines[-1][:200] if lines else ""


def tetgen(program: Path, source: Path, folder: Path, limit: float) -> dict:
    """Returns TetGen's measures for the complex that our program reads from the input."""
    try:
        run([str(program), "repair", str(source), "-o", "complex.smesh", "-q"], folder, limit)
        made = run(["tetgen", "-pV", "complex.smesh"], folder, limit)
    except ProgramFailed as failure:
        return {"failed": str(failure)}
    number = lambda pattern: int((re.search(pattern, made.output) or [0, 0])[1])
    return {"cpu": made.cpu, "tets": number(r"Mesh tetrahedra: +(\d+)"),
            "added": number(r"Mesh points: +(\d+)") - number(r"Input points: +(\d+)")}


def summary(rows: list[dict], cpu_limit: int) -> str:
    """Returns the table of counts and medians over the inputs whose complex is valid."""
    valid = [row for row in rows if row["exit"] in complexes or row["exit"]
             < 0 or "near to each other" in row.get("message", "")]
    meshed = [row for row in valid if "tets" in row]
    shares = [100 * row["beyond"] / row["tets"] for row in meshed]
    beside = [row["tetgen"] for row in valid if "tetgen" in row]
    ended = [row for row in beside if "failed" not in row]
    return table(["", "constrained start", "`tetgen -p`"], [
        ["inputs with a valid complex", f"{len(valid)} of {len(rows)}", f"{len(beside)}"],
        [f"meshed within {cpu_limit} s of CPU", f"{len(meshed)} ({100 * len(meshed) / len(valid):.1f}%)",
         f"{len(ended)} ({100 * len(ended) / len(beside):.1f}%)"],
        ["every guarantee holds", f"{sum(row['exit'] == 0 for row in valid)}", ""],
        ["only bounds on the shape of tets are missed",
         f"{sum(bool(missed := row.get('missed')) and set(missed) <= on_shapes for row in meshed)}", ""],
        ["another guarantee is missed", f"{sum(bool(set(row.get('missed', ())) - on_shapes) for row in meshed)}", ""],
        ["CPU s, median and largest", spread([row["cpu"] for row in meshed]), spread([row["cpu"] for row in ended])],
        ["tets beyond 8 to 150 degrees, median and largest %", spread(shares), ""],
        ["inputs with more than 1% of them", f"{sum(share > 1 for share in shares)}", ""],
    ])


def spread(values: list[float]) -> str:
    return f"{seconds(statistics.median(values))}, {seconds(max(values))}" if values else ""


def rest(rows: list[dict]) -> str:
    """Returns the table of the inputs that got no mesh, or a mesh with more than 1% of its tets beyond the bounds."""
    poor = [row for row in rows if "tets" in row and row["beyond"] > 0.01 * row["tets"]]
    lines = [[row["input"], f"{row['tets']}", f"{100 * row['beyond'] / row['tets']:.2f}%", f"{row['smallest']:.2g} to "
              f"{row['largest']:.5g}", seconds(row["cpu"])] for row in poor]
    lines += [[row["input"], "", row.get("message", row["said"])[:120].replace("|", " "), "", seconds(row["cpu"])]
              for row in rows if "tets" not in row]
    return table(["input", "tets", "beyond 8 to 150 degrees", "angles", "CPU s"], lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("inputs", nargs="+", type=Path, help="files and folders")
    parser.add_argument("--every", type=int, default=1, help="take only every N-th of them")
    parser.add_argument("--log", type=Path, required=True,
                        help="one JSON line for each input; inputs in it are not run again")
    parser.add_argument("--cpu", type=int, default=60, help="limit in seconds")
    options = parser.parse_args()
    known = [json.loads(line) for line in options.log.read_text().splitlines()] if options.log.exists() else []
    done = {row["path"] for row in known}
    chosen = inputs_in(options.inputs, options.every)
    for path in chosen:
        if str(path) not in done:
            row = measure(options.program.resolve(), path.resolve(), options.cpu, options.cpu) | {"path": str(path)}
            known.append(row)
            with options.log.open("a") as log:
                log.write(json.dumps(row) + "\n")
            print(row, file=sys.stderr, flush=True)
    rows = [row for row in known if row["path"] in set(map(str, chosen))]
    print(machine(options.program.parents[1]), "\n")
    print(summary(rows, options.cpu), "\n")
    print(rest(rows))


if __name__ == "__main__":
    main()
