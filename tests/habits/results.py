#!/usr/bin/env python3
"""What CTest's results (JUnit) say: the slowest tests are listed, and a test that was skipped is a failure.

    results.py RESULTS.xml
"""
import sys
import xml.etree.ElementTree

SLOWEST = 25


def main():
    cases = list(xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter("testcase"))
    seconds = {case.get("name"): float(case.get("time")) for case in cases}
    print(f"{len(cases)} tests, {sum(seconds.values()):.0f} s in all; the slowest:")
    for name in sorted(seconds, key=seconds.get, reverse=True)[:SLOWEST]:
        print(f"{seconds[name]:8.1f} s  {name.split('  #')[0]}")
    skipped = [case.get("name") for case in cases if case.find("skipped") is not None]
    for name in skipped:
        print(f"skipped: {name}; install what it needs (cmake/packages.txt), or leave it out by its label")
    return 1 if skipped or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
