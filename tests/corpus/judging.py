"""Programs that the tests run, and the independent checker that judges meshes.

COLLARMESH_JUDGE may name one:
    JUDGE MESH --surface FILE [--exact | --distance D] [--rho BOUND]; exit code 0 when everything holds.
It takes some milliseconds for a tet. Of meshes that are made in addition it sees the small ones, and all of them
where COLLARMESH_LONG is set.
"""

import math
import os
import subprocess
import sys

JUDGE = os.environ.get("COLLARMESH_JUDGE", "")
TIME_LIMIT = 120  # seconds
MOST_TETS = math.inf if os.environ.get("COLLARMESH_LONG") else 4000  # larger additional meshes are not judged


class Failed(Exception):
    pass


def run(*arguments, limit=TIME_LIMIT):
    try:
        return subprocess.run(list(map(str, arguments)), capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        raise Failed(f"still running after {limit} s")


def verdict(mesh, *against, radius_edge=2):
    """Runs the judge; returns its last line if it finds no fault. The judge knows no thin tetrahedra, so
    coarsened meshes need an infinite bound. Raises Failed."""
    result = run(sys.executable, JUDGE, mesh, *against, "--rho", radius_edge)
    last = (result.stdout + result.stderr or "it says nothing").strip().splitlines()[-1]
    if result.returncode != 0:
        raise Failed(f"judge: {last}")
    return last
