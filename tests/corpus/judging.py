"""Programs that the tests run, and the independent checker that judges meshes.

COLLARMESH_JUDGE may name one:
    JUDGE MESH --surface FILE [--exact | --distance D] [--rho BOUND]; exit code 0 when everything holds.
It takes some milliseconds for a tet, and five seconds for a surface. So it sees a sixth of the meshes each day, and of
those that are made in addition only the small ones; all of them where COLLARMESH_LONG is set. The certificate judges
every mesh.
"""

import datetime
import math
import os
import pathlib
import subprocess
import sys
import zlib

JUDGE = os.environ.get("COLLARMESH_JUDGE", "")
TIME_LIMIT = 120  # seconds
LONG = bool(os.environ.get("COLLARMESH_LONG"))
MOST_TETS = math.inf if LONG else 4000  # larger additional meshes are not judged
DAYS = 1 if LONG else 6  # days until the judge has seen every mesh


class Failed(Exception):
    pass


def run(*arguments, limit=TIME_LIMIT):
    try:
        return subprocess.run(list(map(str, arguments)), capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        raise Failed(f"still running after {limit} s")


def is_due(what, days):
    """Returns whether a run of this name is due today if each is due once in so many days."""
    return (zlib.crc32(what.encode()) + datetime.date.today().toordinal()) % days == 0


def verdict(mesh, *against, radius_edge=2):
    """Runs the judge if meshes of this name and bound are due today; returns its last line if it finds no
    fault. The judge knows no thin tetrahedra, so coarsened meshes need an infinite bound. Raises Failed."""
    if not is_due(f"{pathlib.Path(mesh).name} {radius_edge}", DAYS):
        return "not judged today"
    result = run(sys.executable, JUDGE, mesh, *against, "--rho", radius_edge)
    last = (result.stdout + result.stderr or "it says nothing").strip().splitlines()[-1]
    if result.returncode != 0:
        raise Failed(f"judge: {last}")
    return last
