#!/usr/bin/env python3
"""Reads CTest's results (JUnit) and its log: lists the slowest tests, and counts a skipped test, or a skipped case of
one, as a failure, unless it needs something that no package list brings.

    results.py RESULTS.xml LOG

LOG is Testing/Temporary/LastTest.log of the build folder: the output of tests that passed, which the results cut short.
"""
import os
import pathlib
import re
import sys
import xml.etree.ElementTree

SLOWEST = 25

# Tests that only run on a machine without Scotch, and those of the Python package, which need venv, pip and mypy.
OTHERS = r"Partition\.WithoutScotch|python\.(install|types)$"
# Tests that need files which are not among the sources, by the variable that names the files.
WITH_FILES = {"COLLARMESH_CORPUS": r".*Corpus|corpus$|acute_families$", "COLLARMESH_REAL": r"real_parts$",
              "COLLARMESH_JUDGE": r"corpus$|acute_families$|real_parts$"}
# Reasons for which a case of a test in Python may be skipped.
REASONS = ["built with HDF5"]
REASONS_WITH_FILES = {"COLLARMESH_REAL": ["no CAD files beside the sources"]}


def may_be_skipped(name):
    reasons = [OTHERS] + [tests for variable, tests in WITH_FILES.items() if not os.environ.get(variable)]
    return any(re.match(reason, name) for reason in reasons)


def is_reason(text):
    return text in REASONS or any(text in reasons for variable, reasons in REASONS_WITH_FILES.items()
                                  if not os.environ.get(variable))


def outputs(log):
    """Yields the name and the output of each test of CTest's log."""
    for part in re.split(r"^\d+/\d+ Testing: ", log, flags=re.M)[1:]:
        yield part.split("\n", 1)[0], part.split("\n<end of output>", 1)[0]


def skipped_cases(log):
    """Yields a text for each case that a test skipped, and whether it may be skipped."""
    for name, output in outputs(log):
        for case in re.findall(r"^\[  SKIPPED \] (\S+)(?:, where GetParam.*)? \(\d+ ms\)$", output, re.M):
            if case != name:  # a whole test is in the results already
                yield f"{name}: {case}", may_be_skipped(case)
        # unittest names the reasons only where it names each case (-v), but always says how many there are.
        reasons = re.findall(r"\bskipped (?:'(.*)'|\"(.*)\")$", output, re.M)
        for reason in (one or other for one, other in reasons):
            yield f"{name}: {reason}", is_reason(reason)
        count = sum(map(int, re.findall(r"^(?:OK|FAILED) \(.*\bskipped=(\d+)", output, re.M)))
        if count > len(reasons):
            yield f"{name}: {count} cases without a reason; run it with -v", False


def main():
    cases = list(xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter("testcase"))
    seconds = {case.get("name"): float(case.get("time")) for case in cases}
    print(f"{len(cases)} tests, {sum(seconds.values()):.0f} s in all; the slowest:")
    for name in sorted(seconds, key=seconds.get, reverse=True)[:SLOWEST]:
        print(f"{seconds[name]:8.1f} s  {name.split('  #')[0]}")
    skipped = [(case.get("name"), may_be_skipped(case.get("name"))) for case in cases
               if case.find("skipped") is not None]
    skipped += skipped_cases(pathlib.Path(sys.argv[2]).read_text(errors="replace"))
    for name, allowed in skipped:
        print(f"skipped: {name}" +
              ("" if allowed else "; install what it needs (cmake/packages.txt), or leave it out by its label"))
    return 0 if cases and all(allowed for _, allowed in skipped) else 1


if __name__ == "__main__":
    sys.exit(main())
