#!/usr/bin/python3
"""Draws the picture of the page on boundary layers: cuts through a bracket and through the room around an airfoil.

    xvfb-run -a resources/layers_pictures.py [FOLDER]

Needs the program `collarmesh` on the PATH, python3-vtk9, python3-pil and FreeCAD (which makes the airfoil).
"""

import os
import pathlib
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "mesher" / "bench")]
import gallery  # noqa: E402
import layers  # noqa: E402
import vtk  # noqa: E402

TETS, ODD, EVEN, PYRAMIDS = gallery.GREY, (0.93, 0.66, 0.32), (0.97, 0.84, 0.60), (0.80, 0.36, 0.36)


def cut_open(grid, normal, at, near=lambda centres: True):
    """Returns actors for the cells behind a plane, with a colour each for tets, odd layers, even layers and pyramids.
    `near`: chooses cells by their centres."""
    kinds = np.array([grid.GetCellType(c) for c in range(grid.GetNumberOfCells())])
    solid = np.isin(kinds, (vtk.VTK_TETRA, vtk.VTK_WEDGE, vtk.VTK_PYRAMID))
    kept = solid & gallery.behind(grid, normal, at) & near(gallery.centres(grid))
    layer = gallery.array(grid, "layer")
    pyramid = kinds == vtk.VTK_PYRAMID
    actors = []
    for chosen, colour in ((layer == 0, TETS), ((layer % 2 == 1) & ~pyramid, ODD),
                           ((layer > 0) & (layer % 2 == 0) & ~pyramid, EVEN), (pyramid, PYRAMIDS)):
        cells = (kept & chosen).nonzero()[0]
        if len(cells):
            actors.append(gallery.tinted(gallery.extract(grid, cells), colour, width=1.1))
    return actors


def main():
    into = (pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "images").resolve()
    gallery.SIZE = (3000, 1100)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        (_, foil), = (each for each in layers.write_solids(pathlib.Path(folder)) if "airfoil" in each[0])
        bracket = gallery.mesh(HERE / "models" / "bracket.off", "--size", "6",
                               "--layers", "all:first=0.5,growth=1.3,count=4")
        air = gallery.mesh(foil, "--size", "0.12", "--layers", "all:first=0.006,growth=1.3,count=5")
        foil_alone = lambda c: (np.abs(c[:, 0] - 1.5) < 0.75) & (np.abs(c[:, 1] - 1) < 0.4)  # noqa: E731
        scenes = [gallery.scene(cut_open(bracket, (0, -1, 0), 0.6), (0.5, -1.9, 0.6), 1.3, (0, 0, 0.5, 1)),
                  gallery.scene(cut_open(air, (0, 0, 1), 0.5, foil_alone), (-0.1, -0.5, 1), 1.4, (0.5, 0, 1, 1))]
        gallery.picture(into / "layers.png", *scenes)


if __name__ == "__main__":
    main()
