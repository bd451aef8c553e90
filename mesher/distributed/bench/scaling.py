"""Time and memory of each rank: python3 scaling.py PROGRAM MODEL [--million 1 8] [--ranks 1 2] [--repeat 3]

For each number of tets (about, in millions) and of ranks, prints the quickest of several runs of collarmesh-mpi with
two or three levels, from its report. Efficiency refers to the last level: its time on one rank, divided by the number
of ranks times its time on all of them. Loading is measured with load.py (petsc4py) and dolfinx, including the start of
Python.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
LOAD_DOLFINX = """
import sys
from mpi4py import MPI
import dolfinx.io
with dolfinx.io.XDMFFile(MPI.COMM_WORLD, sys.argv[1], "r") as file:
    assert file.read_mesh(name="mesh").topology.index_map(3).size_global > 0
"""


def mpirun(ranks, *command):
    start = time.perf_counter()
    launcher = ["mpirun", "--oversubscribe", "--allow-run-as-root", "-q", "-n", str(ranks)]
    done = subprocess.run([*launcher, *map(str, command)], capture_output=True, text=True)
    if done.returncode not in (0, 7):
        sys.exit(done.stderr)
    return time.perf_counter() - start


def loading(repeat, ranks, *command):
    """Returns the time of the quickest run in seconds, as text; "fails" if a rank dies, most likely for lack
    of memory."""
    try:
        return f"{min(mpirun(ranks, *command) for _ in range(repeat)):.1f}"
    except SystemExit as failed:
        print(str(failed)[-1000:], file=sys.stderr)
        return "fails"


def coarse_tets(program, model, size, folder):
    report = folder / "coarse.json"
    mpirun(1, program, model, "-o", folder / "coarse.pvtu", "--size", size, "--levels", 0, "-q", "--report",
           report)
    return json.loads(report.read_text())["tets"]


def size_for(program, model, tets, folder):
    """Finds a size that makes about this number of tets."""
    size, made = 4.0, 0
    for _ in range(3):
        made = coarse_tets(program, model, size, folder)
        size *= (made / tets) ** (1 / 3)
    return size


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("model")
    parser.add_argument("--million", type=float, nargs="+", default=[1, 8])
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    print("| tets | ranks | last level s | efficiency | certificate s | writing s | peak of a rank "
          "| bytes per tet of a rank | PETSc loads s | dolfinx loads s |\n" + 10 * "|---" + "|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        sizes = {}
        for million in arguments.million:
            levels = 2 if million < 3 else 3
            coarse = round(million * 1e6 / 8**levels)
            if coarse not in sizes:
                sizes[coarse] = size_for(arguments.program, arguments.model, coarse, folder)
            alone = None
            for ranks in arguments.ranks:
                runs = []
                for _ in range(arguments.repeat):
                    mpirun(ranks, arguments.program, arguments.model, "-o", folder / "mesh.h5", "-q", "--size",
                           sizes[coarse], "--levels", levels, "--max-memory", 0, "--report",
                           folder / "report.json")
                    runs.append(json.loads((folder / "report.json").read_text()))
                last = min(run["levels"][-1]["seconds"] for run in runs)
                alone = alone or last * ranks
                peak = max(runs[0]["peak_bytes_of_ranks"])
                per_tet = peak / max(runs[0]["tets_of_ranks"])
                petsc = loading(arguments.repeat, ranks, "/usr/bin/python3", HERE / "load.py",
                                folder / "mesh.h5")
                dolfinx = loading(arguments.repeat, ranks, "/usr/bin/python3", "-c", LOAD_DOLFINX,
                                  folder / "mesh.xdmf")
                certify = min(run["certify_seconds"] for run in runs)
                write = min(run["write_seconds"] for run in runs)
                print(f"| {runs[0]['tets'] / 1e6:.2f} M | {ranks} | {last:.1f} | {alone / ranks / last:.2f} "
                      f"| {certify:.1f} | {write:.1f} | {peak / 2**30:.2f} GiB | {per_tet:.0f} "
                      f"| {petsc} | {dolfinx} |", flush=True)


if __name__ == "__main__":
    main()
