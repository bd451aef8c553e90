#!/usr/bin/env python3
"""Looks for rows of tests/expected_counts.tsv that are wrong or that no test uses. Renews the table from the counts
that the tests wrote when COLLARMESH_COUNTED named a file.

    expected_counts.py ROOT [--renew COUNTED]
"""
import pathlib
import re
import sys

COLUMNS = 5


def rows_of(text):
    """Returns the rows of the table as lists of columns."""
    return [line.split("\t") for line in text.splitlines() if line and not line.startswith("#")]


def faults(table, tests):
    """Yields a message for each faulty row, and for each row that no test uses. A test file uses a row if it contains
    all parts of the row's key, which slashes and numbers separate."""
    seen = set()
    for row in table:
        key = row[0]
        if len(row) != COLUMNS or not row[-1]:
            yield f"{key}: expected {COLUMNS} columns, with a text in the last one"
            continue
        if key in seen:
            yield f"{key}: more than one row"
        seen.add(key)
        expected, least, most = map(float, row[1:4])
        if not (0 <= least <= 1 <= most and expected >= 0):
            yield f"{key}: the ratios must enclose 1"
        words = [words for part in key.split("/") for words in re.split(r"[-+0-9.e]*[0-9][-+0-9.e]*", part)]
        wanted = [word.strip() for word in words if word.strip()]
        if not any(all(word in text for word in wanted) for text in tests):
            yield f"{key}: no test uses this row"


def renewed(text, counted):
    """Returns the table with the counts of the tests (for each key the last one); the other columns stay."""
    counts = dict(line.split("\t") for line in counted.splitlines())
    lines = []
    for line in text.splitlines(keepends=True):
        key, *columns = line.split("\t")
        if key in counts and not line.startswith("#"):
            line = "\t".join([key, counts[key], *columns[1:]])
        lines.append(line)
    return "".join(lines)


def main():
    root = pathlib.Path(sys.argv[1])
    path = root / "tests" / "expected_counts.tsv"
    if sys.argv[2:3] == ["--renew"]:
        path.write_text(renewed(path.read_text(), pathlib.Path(sys.argv[3]).read_text()))
        return 0
    table = rows_of(path.read_text())
    tests = [text for source in sorted((root / "tests").glob("*/*.cpp"))
             if "expect_count(" in (text := source.read_text()) and "support" not in source.parts]
    found = list(faults(table, tests))
    print("\n".join(found))
    return 1 if found or not table else 0


if __name__ == "__main__":
    sys.exit(main())
