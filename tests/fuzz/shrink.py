#!/usr/bin/env python3
"""Removes facets from a surface as long as a command ends in the same way as with all facets.

    shrink.py IN.off OUT.off -- COMMAND ...

{} in the command is the file. OUT.off is the smallest surface found: no facet of it can be left out alone.
"""
import pathlib
import subprocess
import sys
import tempfile


def read_off(path):
    words = [line.split("#")[0].split() for line in path.read_text().splitlines()]
    words = [line for line in words if line and line != ["OFF"]]
    count = int(words[0][0])
    corners = [[int(n) for n in line[1:1 + int(line[0])]] for line in words[1 + count:]]
    return [" ".join(line[:3]) for line in words[1:1 + count]], corners


def write_off(path, points, facets):
    used = sorted({corner for facet in facets for corner in facet})
    number = {corner: i for i, corner in enumerate(used)}
    lines = ["OFF", f"{len(used)} {len(facets)} 0", *(points[corner] for corner in used)]
    lines += [" ".join(map(str, [len(facet), *(number[corner] for corner in facet)])) for facet in facets]
    path.write_text("\n".join(lines) + "\n")


def shrunk(facets, is_same):
    """Leaves out ever smaller parts (Zeller and Hildebrandt: Simplifying and isolating failure-inducing
    input, 2002)."""
    size = max(len(facets) // 2, 1)
    while True:
        before = len(facets)
        start = 0
        while start < len(facets):
            rest = facets[:start] + facets[start + size:]
            if rest and is_same(rest):
                facets = rest
            else:
                start += size
        if size == 1 and len(facets) == before:
            return facets
        size = max(size // 2, 1)


def main():
    split = sys.argv.index("--") if "--" in sys.argv else 0
    if split != 3:
        sys.exit(__doc__)
    source, target, command = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[split + 1:]
    points, facets = read_off(source)
    with tempfile.TemporaryDirectory() as folder:
        trial = pathlib.Path(folder) / "trial.off"

        def end_of(some):
            write_off(trial, points, some)
            return subprocess.run([word.replace("{}", str(trial)) for word in command],
                                  capture_output=True, check=False).returncode

        wanted = end_of(facets)
        facets = shrunk(facets, lambda some: end_of(some) == wanted)
    write_off(target, points, facets)
    print(f"{len(facets)} facets end with exit code {wanted}")


if __name__ == "__main__":
    main()
