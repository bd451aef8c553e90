"""Results of solvers: fields on the nodes of a mesh."""

import os
from typing import Dict, List, Tuple

import numpy

from ._core import ReadError
from ._inputs import Array, Path


_LARGEST_NODE = 10**8  # a larger number would need more memory than its mesh could have had


def read_frd(path: Path) -> Dict[str, Array]:
    """Read the fields on nodes from a text file of results of CalculiX (.frd; CalculiX CGX manual, "Result Format").

    Returns for each field's name, such as "DISP", "STRESS" or "NDTEMP", its values in the last step that has it: shape
    (n, k), row i for node i + 1, which is point i of the mesh that was written as .inp; NaN where a node has no value.
    Raises ReadError for files that cannot be read, are binary or end early.
    """
    name = os.fspath(path)
    try:
        with open(name, encoding="ascii", errors="strict") as file:
            lines = file.read().splitlines()
    except (OSError, UnicodeDecodeError) as fault:
        raise ReadError(
            f"{name}: cannot be read as text; CalculiX writes text with *NODE FILE and *EL FILE ({fault})") from None
    fields: Dict[str, Array] = {}
    at = 0
    while at < len(lines):
        at += 1
        if lines[at - 1].startswith(" -4"):
            words = lines[at - 1].split()
            if len(words) < 2:
                raise ReadError(f"{name}, line {at}: expected the name of a field after -4")
            field = words[1]
            while at < len(lines) and lines[at].startswith(" -5"):
                at += 1
            fields[field], at = _values(name, field, lines, at)
    if not fields:
        raise ReadError(f"{name}: no results on nodes; is it an .frd file? Ask for them with *NODE FILE")
    return fields


def _values(name: str, field: str, lines: List[str], at: int) -> Tuple[Array, int]:
    """Returns the values of a block that begins at line `at`, and the line after it."""
    numbers: List[int] = []
    rows: List[List[float]] = []
    try:
        while not lines[at].startswith(" -3"):
            line = lines[at]
            values = [float(line[place : place + 12]) for place in range(13, len(line.rstrip()), 12)]
            if line.startswith(" -1"):
                numbers.append(int(line[3:13]))
                rows.append(values)
            elif line.startswith(" -2"):
                rows[-1] += values
            else:
                raise ValueError(line[:40])
            at += 1
        if min(numbers, default=1) < 1:
            raise ValueError("a node below 1")
        if max(numbers, default=1) > _LARGEST_NODE:
            raise ValueError(f"a node above {_LARGEST_NODE}")
        known = numpy.array(rows, dtype=numpy.float64).reshape(len(rows), -1)
    except (IndexError, ValueError) as fault:
        raise ReadError(
            f"{name}, line {at + 1}: expected values of the field {field}, then a line with -3 ({fault})") from None
    result = numpy.full((max(numbers, default=0), known.shape[1]), numpy.nan)
    result[numpy.array(numbers, dtype=numpy.int64) - 1] = known
    return result, at + 1
