#!/usr/bin/env python3
"""Compares the includes between folders with the table "Who includes whom" of the page on architecture.

    includes_test.py ROOT
"""
import graphlib
import pathlib
import re
import sys

PARTS = ("mesher/cli", "mesher/command", "mesher/files", "mesher/process", "mesher/report", "mesher/python",
         "mesher/distributed/program", "mesher/distributed", "mesher/include", "openmesh_io", "freecad_workbench/brep")


def allowed(root):
    """Returns the rows of the table: each folder, and the folders whose headers it may include."""
    page = (root / "mesher" / "doc" / "architecture.md").read_text()
    section = re.search(r"^## Who includes whom\n(.*?)(?=^## |\Z)", page, re.M | re.S)
    if not section:
        sys.exit('architecture.md has no section "Who includes whom"')
    rows = re.findall(r"^\| `([^`]+)` \| (.*?) \|$", section[1], re.M)
    return {folder: set(re.findall(r"`([^`]+)`", others)) for folder, others in rows}


def folder_of(path):
    """Returns the folder of a source, as the table names it; None for folders that the table leaves out. The public
    headers of io belong to it."""
    if path.parts[:2] == ("mesher", "src"):
        return path.parts[2]
    if path.parts[:4] == ("mesher", "include", "collarmesh", "io"):
        return "io"
    return next((part for part in PARTS if path.as_posix().startswith(part + "/")), None)


def target_of(root, source, name):
    """Returns the folder of an included header; None for headers of other projects."""
    if name.startswith("collarmesh/io/"):
        return "io"
    if name.startswith("collarmesh/"):
        return "mesher/include"
    for folder in (root / source.parent, root / "mesher" / "src", root / "mesher",
                   root / "mesher" / "distributed" / "src"):
        if (folder / name).exists():
            return folder_of((folder / name).resolve().relative_to(root.resolve()))
    return None


def arrows(root):
    """Yields every include between two folders, except of public headers: (from, to, source)."""
    for top in ("mesher", "openmesh_io", "freecad_workbench"):
        for path in sorted((root / top).rglob("*")):
            source = path.relative_to(root)
            if path.suffix not in (".h", ".cpp") or folder_of(source) is None:
                continue
            for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M):
                target = target_of(root, source, name)
                if target not in (None, "mesher/include", folder_of(source)):
                    yield folder_of(source), target, source


def main():
    root = pathlib.Path(sys.argv[1])
    table, found, wrong = allowed(root), set(), []
    for folder, target, source in arrows(root):
        found.add((folder, target))
        if target not in table.get(folder, set()):
            wrong.append(f"{source} includes a header of {target}, which the table does not allow to {folder}")
    unused = [f"{folder} may include {target} by the table, but does not"
              for folder, targets in table.items() for target in targets if (folder, target) not in found]
    try:
        list(graphlib.TopologicalSorter(table).static_order())
    except graphlib.CycleError as error:
        wrong.append("the table has a circle: " + " includes ".join(reversed(error.args[1])))
    print("\n".join(wrong + unused))
    return 1 if wrong or unused or not found else 0


if __name__ == "__main__":
    sys.exit(main())
