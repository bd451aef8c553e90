#!/usr/bin/python3
"""Draws the picture of the page on shells: a panel with ribs, a planar domain, and faces of a solid.

    xvfb-run -a resources/shells_pictures.py [FOLDER]

Needs the program `collarmesh` on the PATH, python3-vtk9 and python3-pil.
"""

import math
import os
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "mesher" / "bench")]
import gallery  # noqa: E402
import planar_domains  # noqa: E402
import vtk  # noqa: E402


def ribbed_panel(path):
    """Writes a vaulted panel with three ribs below it, which it meets in T-junctions, as a .mesh file."""
    points, triangles = [], []

    def add(tag, point, columns, rows):
        first = len(points)
        points.extend(point(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1))
        for j in range(rows):
            for i in range(columns):
                a = first + j * (columns + 1) + i + 1
                triangles.extend([(a, a + 1, a + columns + 2, tag), (a, a + columns + 2, a + columns + 1, tag)])

    def vault(x):
        return round(18 * math.sin(math.pi * x / 120), 9)

    for bay in range(4):
        add(1, lambda s, t, bay=bay: (120.0 * s, 20.0 * (bay + t), vault(120 * s)), 48, 1)
    for rib in range(3):
        add(2 + rib, lambda s, t, rib=rib: (120.0 * s, 20.0 * (rib + 1), vault(120 * s) - 14.0 * t), 48, 1)
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += [f"{x!r} {y!r} {z!r} 0" for x, y, z in points] + ["Triangles", str(len(triangles))]
    pathlib.Path(path).write_text("\n".join(lines + [" ".join(map(str, each)) for each in triangles] + ["End", ""]))


def coloured(source, *options):
    grid = gallery.mesh(source, "--dimension", "2", *options)
    triangles = gallery.kind(grid, vtk.VTK_TRIANGLE)
    return gallery.coloured(triangles, gallery.array(triangles, "tag"))


def main():
    into = (pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "images").resolve()
    gallery.SIZE = (3000, 1100)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        ribbed_panel("panel.mesh")
        pathlib.Path("gear.poly").write_text(planar_domains.gear().poly())
        scenes = [gallery.scene(coloured("panel.mesh", "--size", "7"), (1.1, -1.9, 0.3), 1.1, (0, 0, 0.4, 1)),
                  gallery.scene(coloured("gear.poly", "--size", "6"), (0, -0.001, 1), 1.05, (0.4, 0, 0.68, 1)),
                  gallery.scene(coloured(HERE / "models" / "flange.step", "--size", "4"), gallery.FRONT, 1.3,
                                (0.68, 0, 1, 1))]
        gallery.picture(into / "shells.png", *scenes)


if __name__ == "__main__":
    main()
