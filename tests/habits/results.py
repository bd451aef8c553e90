#!/usr/bin/env python3
"""Reads CTest's results (JUnit): lists the slowest tests, and counts a skipped test as a failure, unless it
needs something that no package list brings.

    results.py RESULTS.xml
"""
import os
import re
import sys
import xml.etree.ElementTree

SLOWEST = 25

# Tests that only run on a machine without Scotch, and those of the Python package, which need venv, pip and mypy.
OTHERS = r"Partition\.WithoutScotch|python\.(install|types)$"
# Tests with files beside the sources, by the variable that names the folder.
WITH_FILES = {"COLLARMESH_CORPUS": r".*Corpus|corpus$|acute_families$", "COLLARMESH_REAL": r"real_parts$",
              "COLLARMESH_JUDGE": r"corpus$|acute_families$|real_parts$"}


def may_be_skipped(name):
    reasons = [OTHERS] + [tests for variable, tests in WITH_FILES.items() if not os.environ.get(variable)]
    return any(re.match(reason, name) for reason in reasons)


def main():
    cases = list(xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter("testcase"))
    seconds = {case.get("name"): float(case.get("time")) for case in cases}
    print(f"{len(cases)} tests, {sum(seconds.values()):.0f} s in all; the slowest:")
    for name in sorted(seconds, key=seconds.get, reverse=True)[:SLOWEST]:
        print(f"{seconds[name]:8.1f} s  {name.split('  #')[0]}")
    skipped = [case.get("name") for case in cases if case.find("skipped") is not None]
    faults = [name for name in skipped if not may_be_skipped(name)]
    for name in skipped:
        print(f"skipped: {name}" + ("; install what it needs (cmake/packages.txt), or leave it out by its label"
                                    if name in faults else ""))
    return 1 if faults or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
