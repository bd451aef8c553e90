#!/usr/bin/env python3
"""Writes the add-on's table of options from the program's: make_option_table.py PROGRAM [--check]

The table is kept in the repository, because a clone of the add-on has no program to generate it with. --check changes
nothing and fails if the table differs from the program's.
"""

import json
import pathlib
import subprocess
import sys
import textwrap

TABLE = pathlib.Path(__file__).resolve().parent / "freecad" / "collarmesh_workbench" / "option_table.py"
SETTINGS = (
    "size", "size_min", "elements_per_circle", "elements_across_gap", "gradation", "radius_edge", "crease_angle",
    "collar_angle", "distance", "planar_tolerance", "weld", "repair_tolerance", "min_dihedral", "seed", "time_limit",
    "improve", "coarsen", "order", "dimension", "repair", "keep_apart", "split", "periodic", "interior_node", "layers",
    "layers_tets")
# Options whose texts are about the command line; the add-on has its own for them.
OWN_TEXTS = {"order", "dimension", "repair", "keep_apart", "split", "periodic", "layers"}
BEGIN = '''"""The program's options that are settings of the add-on. Written by make_option_table.py: see there."""

import dataclasses

from .translations import doc


@dataclasses.dataclass(frozen=True)
class Option:
    """An option of the program."""

    type: type
    default: object  # a number 0 leaves the value to the program
    unit: str  # "length", "degrees", "diagonal", "seconds" or none
    counts: bool  # whether predictions pass it to `collarmesh info`; `size` is passed apart
    text: str  # what it does; empty if the add-on has its own text


'''


def type_of(option):
    """Returns the type of a setting. A number whose value is called N is an integer."""
    if option["kind"] == "number":
        return int if option["value_name"] == "N" else float
    if option["kind"] == "choice":
        return bool if isinstance(option["default"], bool) else str
    return {"flag": bool, "count": int, "text": str, "texts": list}[option["kind"]]


def default_of(option):
    """Returns the default of a setting. It is 0 if the program chooses the value, and also for lengths relative to the
    diagonal, which FreeCAD would show as 0."""
    if option["unit"] == "diagonal" or option["default"] is None:
        return type_of(option)()
    return type_of(option)(option["default"])


def text_of(option):
    """Returns the text of a setting. If the default is 0, the text says what 0 stands for."""
    if option["key"] in OWN_TEXTS:
        return ""
    text = option["help"].split("; 0:")[0]
    if option["kind"] in ("number", "count") and not default_of(option) and option["default_text"] != "0":
        text += f"; 0: {option['default_text']}"
    return text


def line_of(option):
    """Returns the lines of an option in the table."""
    begin = f'    "{option["key"]}": Option('
    values = (f'{type_of(option).__name__}, {default_of(option)!r}, "{option["unit"]}", '
              f'{"info" in option["takers"] and option["key"] not in ("size", "time_limit")},')
    if not text_of(option):
        return f'{begin}{values} ""),\n'
    pieces = textwrap.wrap(text_of(option), 100, drop_whitespace=False, break_on_hyphens=False)
    text = "\n            ".join(json.dumps(piece, ensure_ascii=False) for piece in pieces)
    return f"{begin}\n        {values}\n        doc({text})),\n"


def table_of(program):
    """Returns the text of the table for the options of a program."""
    written = subprocess.run([program, "--generate", "options"], check=True, capture_output=True, text=True).stdout
    options = {}
    for option in json.loads(written):
        if "mesh" in option["takers"]:
            options.setdefault(option["key"], option)
    return BEGIN + "OPTIONS = {\n" + "".join(line_of(options[key]) for key in SETTINGS) + "}\n"


def main():
    table = table_of(sys.argv[1])
    if "--check" not in sys.argv:
        TABLE.write_text(table, encoding="utf-8")
    elif table != TABLE.read_text(encoding="utf-8"):
        sys.exit(f"{TABLE.name} differs from the program's table of options: run "
                 f"freecad_workbench/{pathlib.Path(__file__).name} {sys.argv[1]}, then translations/update.py")


if __name__ == "__main__":
    main()
