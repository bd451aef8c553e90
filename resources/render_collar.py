#!/usr/bin/python3
"""Picture of the collars in a mesh: their cells coloured by kind, the creases in red, and of the other cells
those behind a plane.

    render_collar.py MESH.vtu [PICTURE.png] [options]

The picture in the documentation (acute_shape is built with the tests):

    acute_shape sectors sectors 8
    collarmesh sectors_?.poly -o sectors.vtu --size 0.17 --feature-angle 0
    render_collar.py sectors.vtu collar.png --open 7 8

Draws off screen with python3-vtk9; where that needs a display, run it under xvfb-run.
"""

import argparse
import os
from itertools import combinations

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from render_mesh import actor_of, centres, extract, save, surface_of

STAR, BOOK, CREASE = (0.96, 0.62, 0.20), (0.22, 0.50, 0.76), (0.80, 0.08, 0.16)
BEHIND = (0.86, 0.89, 0.93)


def read(path):
    """The tets and the edges on curves."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    kinds = vtk_to_numpy(grid.GetCellTypesArray())
    return extract(grid, (kinds == vtk.VTK_TETRA).nonzero()[0]), extract(grid, (kinds == vtk.VTK_LINE).nonzero()[0])


def array(grid, name):
    return vtk_to_numpy(grid.GetCellData().GetArray(name))


def corners(grid, cell):
    return frozenset(grid.GetPoint(grid.GetCell(cell).GetPointId(k))
                     for k in range(grid.GetCell(cell).GetNumberOfPoints()))


def crease_edges(tets, edges):
    """The curve edges whose tets are all books."""
    around = {corners(edges, e): set() for e in range(edges.GetNumberOfCells())}
    for cell, kind in enumerate(array(tets, "collar")):
        for edge in combinations(corners(tets, cell), 2):
            around.get(frozenset(edge), set()).add(kind)
    return [e for e in range(edges.GetNumberOfCells()) if around[corners(edges, e)] == {2}]


def shrunk(grid, factor):
    shrink = vtk.vtkShrinkFilter()
    shrink.SetInputData(grid)
    shrink.SetShrinkFactor(factor)
    shrink.Update()
    return shrink.GetOutput()


def tinted(grid, colour, opacity=1.0, width=1.6):
    actor = actor_of(surface_of(grid))
    look = actor.GetProperty()
    look.SetColor(*colour)
    look.SetOpacity(opacity)
    look.SetLineWidth(width)
    return actor


def tubes(grid, radius):
    surface = surface_of(grid)
    joined = vtk.vtkStripper()
    joined.SetInputData(surface)
    joined.JoinContiguousSegmentsOn()
    tube = vtk.vtkTubeFilter()
    tube.SetInputConnection(joined.GetOutputPort())
    tube.SetRadius(radius)
    tube.SetNumberOfSides(24)
    tube.CappingOn()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(tube.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*CREASE)
    actor.GetProperty().SetAmbient(0.45)
    return actor


def legend(entries):
    """Squares of colour and what they mean, below on the left."""
    actors = []
    for k, (words, colour) in enumerate(reversed(entries)):
        for text, place in (("    ", 28), (words, 66)):
            actor = vtk.vtkTextActor()
            actor.SetInput(text)
            actor.SetPosition(place, 36 + 38 * k)
            look = actor.GetTextProperty()
            look.SetFontFamilyToArial()
            look.SetFontSize(23)
            look.SetColor(0.15, 0.15, 0.18)
            look.SetVerticalJustificationToCentered()
            if text != words:
                look.SetBackgroundColor(*colour)
                look.SetBackgroundOpacity(1)
            actors.append(actor)
    return actors


def render(tets, edges, arguments):
    collar = array(tets, "collar")
    offsets = centres(tets) @ np.array(arguments.normal)
    cut = offsets.min() + arguments.at * (offsets.max() - offsets.min())
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0.98, 0.98, 0.985)
    renderer.AddActor(tinted(extract(tets, ((collar == 0) & (offsets <= cut)).nonzero()[0]), BEHIND, width=1.1))
    shown = ~np.isin(array(tets, "region"), arguments.open)
    for kind, colour in ((1, STAR), (2, BOOK)):
        cells = ((collar == kind) & shown).nonzero()[0]
        if len(cells):
            renderer.AddActor(tinted(shrunk(extract(tets, cells), arguments.shrink), colour))
    diagonal = tets.GetLength()
    creases = crease_edges(tets, edges)
    if creases:
        renderer.AddActor(tubes(extract(edges, np.array(creases)), 0.0045 * diagonal))
    for actor in legend([("crease", CREASE), ("stars: one corner on the crease", STAR),
                         ("books: an edge on the crease", BOOK), ("other cells", BEHIND)]):
        renderer.AddActor2D(actor)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*arguments.view)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(arguments.zoom)
    camera.SetWindowCenter(0, -0.42)   # up, so that the legend has room
    for position, strength in (((-1, -2, 1.5), 0.55), ((2.5, -0.5, 1.5), 0.6)):
        light = vtk.vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(*position)
        light.SetFocalPoint(0, 0, 0)
        light.SetIntensity(strength)
        renderer.AddLight(light)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(8)
    window.SetSize(*arguments.size)
    window.AddRenderer(renderer)
    window.Render()
    return window


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("picture", nargs="?")
    parser.add_argument("--normal", nargs=3, type=float, default=(0, -1, 0), help="of the cutting plane")
    parser.add_argument("--at", type=float, default=0.5, help="where it cuts, 0 to 1 along the normal")
    parser.add_argument("--view", nargs=3, type=float, default=(0.12, -1.6, 0.8), help="direction to the camera")
    parser.add_argument("--open", nargs="*", type=int, default=(), help="regions whose collar is removed")
    parser.add_argument("--shrink", type=float, default=0.94, help="of the collar's cells, to tell them apart")
    parser.add_argument("--zoom", type=float, default=2.1)
    parser.add_argument("--size", nargs=2, type=int, default=(1200, 740))
    arguments = parser.parse_args()
    images = os.path.join(os.path.dirname(os.path.abspath(__file__)), "images")
    name = os.path.splitext(os.path.basename(arguments.mesh))[0] + ".png"
    path = arguments.picture or os.path.join(images, name)
    save(render(*read(arguments.mesh), arguments), path)
    print(path)


if __name__ == "__main__":
    main()
