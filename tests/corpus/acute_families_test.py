"""Mesh members of the acute families and let an independent checker judge the meshes.

    acute_families_test.py PROGRAM ACUTE_SHAPE [-k WORD] [--keep FOLDER] [--workers N]

Every family that ACUTE_SHAPE can write, at set parameters and at random ones. Half of the members are due each day,
all of them with -k or where COLLARMESH_LONG is set. Planar members are judged with
--exact, curved ones by the distance tolerance. Exit code 77 (skipped) without a checker (judging.py).

The checker knows triangles that share their corners; it knows no facets, no segments and no several files. So it is
told the same complex as triangles, made of the input alone (acute_shape --triangulated); where they bound solids and
nothing else it compares volumes and areas, too. It cannot see the angle of an edge and a face, nor lone
segments: each end of one that something else touches is told as the acute corner of a triangle nearly without width.
So the checker accepts collars at such an end whatever the angle there, and none at ends that nothing touches; the
certificate, which has to hold before the checker is asked, judges the angles there as everywhere.
"""

import argparse
import concurrent.futures
import json
import math
import os
import re
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from judging import JUDGE, LONG, MOST_TETS, TIME_LIMIT, Failed, is_due, run, verdict

SIZE = 0.3 if LONG else 0.4
DISTANCE = 2e-3  # about a thousandth of the diagonals
RANDOM_SEEDS = (1,)

PLANAR = """
    wedge 80 1; wedge 60 1; wedge 40 1; wedge 20 1; wedge 10 1; wedge 5 1; wedge 2 1; wedge 1 1
    wedge_on_a_large_one 20 1e-6
    fan 3 0; fan 4 4; fan 8 0; fan 14 14; fan 24 0; fan 40 0
    sectors 5; sectors 20
    pyramid 3 60; pyramid 7 10; pyramid 4 2
    star_prism 9 0.4; star_prism 12 0.7
    spiked_octahedron 1; spiked_octahedron 2
    knife 30; knife 2; two_knives 10 20
    wedges_touching_in_an_edge 30 5; cubes_touching_in_an_edge 10
    cubes_touching_in_a_corner; pyramids_tip_to_tip 3 60; pyramids_tip_to_tip 4 5
    pyramid_on_a_box 20; pyramid_on_a_box 120
    facet_ending_inside 20; facet_ending_inside 3
    segment_meeting_a_facet 45; segment_meeting_a_facet 3
    segments_from_a_point 2 2; segments_from_a_point 12 12
    segment_near_a_crease 20 0.03 0; segment_near_a_crease 50 0.1 1; facet_near_a_crease 20 0.03
    comb 3 10
"""
CURVED = """
    round_cone 15; lens 40; cut_torus 0.5; long_lens 40 0.2; drop_bar 20; drop_cone 100 30
    drop_cone_in_a_room 75 30; curved_facet_ending_inside 20
"""


@dataclass
class Member:
    words: list[str]  # arguments of acute_shape
    name: str
    curved: bool = False

    @property
    def family(self):
        return re.match(r"\w+", self.name.removeprefix("turned("))[0]


def members_of(table, curved=False):
    texts = [text.strip() for line in table.splitlines() for text in line.split(";")]
    return [Member(text.split(), text, curved) for text in texts if text]


def random_members(generator):
    return [Member(["random_member", str(seed), str(number)], name)
            for seed in RANDOM_SEEDS
            for number, name in enumerate(run(generator, "--random-members", seed).stdout.splitlines())]


def families_without_member(generator, members):
    return set(run(generator, "--families").stdout.split()) - {member.family for member in members}


def run_well(*arguments):
    result = run(*arguments)
    if result.returncode != 0:
        raise Failed(f"exit code {result.returncode}: {(result.stderr.splitlines() or [''])[0]}")


def mesh_and_judge(program, generator, member, folder):
    """Returns a line for the table. Raises Failed."""
    prefix = folder / "_".join(member.words)
    run_well(generator, prefix, *member.words, "--triangulated")
    files = sorted(folder.glob(f"{prefix.name}_[0-9]*.poly"))
    told = next(path for path in map(Path, (f"{prefix}.off", f"{prefix}.poly")) if path.exists())
    mesh, report = f"{prefix}.vtu", f"{prefix}.json"
    tets = {}
    for coarsen, radius_edge in (("off", 2), ("on", math.inf)):
        run_well(program, *files, "-o", mesh, "--size", SIZE, "--distance", DISTANCE, "--report", report, "--coarsen",
                 coarsen, "--feature-angle", 30 if member.curved else 0, "--threads", 1, "--time-limit", TIME_LIMIT)
        tets[coarsen] = json.loads(Path(report).read_text())["mesh"]["tets"]
        if coarsen == "on" or tets[coarsen] <= MOST_TETS:
            said = verdict(mesh, "--surface", told, *(["--distance", DISTANCE] if member.curved else ["--exact"]),
                           radius_edge=radius_edge)
    return f"{tets['off']:7} tets, coarsened {tets['on']:7}, judge ({told.suffix}): {said}"


def outcome(*arguments):
    begin = time.monotonic()
    try:
        return "ok", f"{mesh_and_judge(*arguments)} [{time.monotonic() - begin:.1f} s]"
    except Failed as failure:
        return "FAILED", f"{failure} [{time.monotonic() - begin:.1f} s]"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("generator", metavar="acute_shape")
    parser.add_argument("-k", default="", help="only members whose name contains this")
    parser.add_argument("--keep", help="folder for the meshes")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="inputs at the same time")
    arguments = parser.parse_args()
    if not JUDGE:
        print("COLLARMESH_JUDGE is not set: no judge to ask")
        return 77
    members = members_of(PLANAR) + random_members(arguments.generator) + members_of(CURVED, curved=True)
    if missing := families_without_member(arguments.generator, members):
        print(f"families without a member: {', '.join(sorted(missing))}")
        return 1
    days = 1 if LONG or arguments.k else 2
    members = [member for member in members if arguments.k in member.name and is_due(member.name, days)]
    failures = 0
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
        folder = Path(arguments.keep or temporary)
        results = [pool.submit(outcome, arguments.program, arguments.generator, member, folder) for member in members]
        for member, result in zip(members, results):
            state, text = result.result()
            failures += state == "FAILED"
            print(f"{state:8}{member.name:66}{text}", flush=True)
    print(f"{len(members)} members, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
