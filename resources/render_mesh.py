#!/usr/bin/python3
"""Picture of a tetrahedral mesh cut open: whole tets behind a plane, coloured by quality.

    render_mesh.py MESH.vtu [PICTURE.png] [--normal X Y Z] [--at FRACTION] [--size W H]

Without PICTURE.png it goes to resources/images/. Draws off screen with python3-vtk9; where that
needs a display, run it under xvfb-run.
"""

import argparse
import os

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

TETRA = vtk.VTK_TETRA
SOLID = (0.80, 0.84, 0.90)
EDGES = (0.13, 0.16, 0.20)


def read_tets(path):
    """The tets of a .vtu file; its boundary triangles and curve edges are left out."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    kinds = vtk_to_numpy(grid.GetCellTypesArray())
    return extract(grid, (kinds == TETRA).nonzero()[0])


def extract(grid, cells):
    ids = numpy_to_vtk(cells, deep=True, array_type=vtk.VTK_ID_TYPE)
    node = vtk.vtkSelectionNode()
    node.SetFieldType(vtk.vtkSelectionNode.CELL)
    node.SetContentType(vtk.vtkSelectionNode.INDICES)
    node.SetSelectionList(ids)
    selection = vtk.vtkSelection()
    selection.AddNode(node)
    extraction = vtk.vtkExtractSelection()
    extraction.SetInputData(0, grid)
    extraction.SetInputData(1, selection)
    extraction.Update()
    return extraction.GetOutput()


def with_quality(grid):
    """Adds the cell array `angle`: the smallest dihedral angle of each tet."""
    if not grid.GetCellData().HasArray("min_dihedral"):
        quality = vtk.vtkMeshQuality()
        quality.SetInputData(grid)
        quality.SetTetQualityMeasureToMinAngle()
        quality.Update()
        grid = quality.GetOutput()
        grid.GetCellData().GetArray("Quality").SetName("min_dihedral")
    return grid


def centres(grid):
    filter_ = vtk.vtkCellCenters()
    filter_.SetInputData(grid)
    filter_.Update()
    return vtk_to_numpy(filter_.GetOutput().GetPoints().GetData())


def surface_of(grid):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.PassThroughCellIdsOn()
    surface.Update()
    return surface.GetOutput()


def split_by_origin(kept, whole):
    """The surface of the kept tets as (part of the whole mesh' surface, cut faces)."""
    def key(data, cell):
        return tuple(sorted(data.GetPoint(cell.GetPointId(k)) for k in range(3)))

    outer = surface_of(whole)
    outside = {key(outer, outer.GetCell(c)) for c in range(outer.GetNumberOfCells())}
    surface = surface_of(kept)
    parts = ([], [])
    for c in range(surface.GetNumberOfCells()):
        parts[key(surface, surface.GetCell(c)) not in outside].append(c)
    return [surface_cells(surface, cells) for cells in parts]


def surface_cells(surface, cells):
    ids = vtk.vtkIdList()
    for c in cells:
        ids.InsertNextId(c)
    part = vtk.vtkExtractCells()
    part.SetInputData(surface)
    part.SetCellList(ids)
    part.Update()
    return part.GetOutput()


def palette():
    """Angles from poor (warm) to regular (cool)."""
    colours = vtk.vtkColorTransferFunction()
    colours.SetColorSpaceToLab()
    for angle, rgb in ((0, (0.72, 0.10, 0.12)), (12, (0.94, 0.45, 0.25)), (25, (0.99, 0.83, 0.45)),
                       (40, (0.62, 0.83, 0.64)), (60, (0.16, 0.48, 0.72))):
        colours.AddRGBPoint(angle, *rgb)
    return colours


def actor_of(data, colours=None):
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputData(data)
    if colours is None:
        mapper.ScalarVisibilityOff()
    else:
        mapper.SetLookupTable(colours)
        mapper.SetScalarModeToUseCellFieldData()
        mapper.SelectColorArray("min_dihedral")
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*SOLID)
    look.SetEdgeVisibility(True)
    look.SetEdgeColor(*EDGES)
    look.SetLineWidth(1.1)
    look.SetInterpolationToFlat()
    look.SetAmbient(0.42)
    look.SetDiffuse(0.75)
    return actor


def legend(colours):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle("smallest\ndihedral\nangle")
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.0f")
    bar.SetOrientationToVertical()
    bar.SetPosition(0.9, 0.52)
    bar.SetWidth(0.075)
    bar.SetHeight(0.4)
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.15, 0.15, 0.18)
        text.SetShadow(False)
        text.SetItalic(False)
        text.SetBold(False)
        text.SetFontFamilyToArial()
    bar.SetUnconstrainedFontSize(True)
    bar.GetTitleTextProperty().SetFontSize(20)
    bar.GetLabelTextProperty().SetFontSize(18)
    return bar


def render(grid, normal, at, size, view):
    whole = with_quality(grid)
    offsets = centres(whole) @ normal
    cut = offsets.min() + at * (offsets.max() - offsets.min())
    kept = extract(whole, (offsets <= cut).nonzero()[0])
    outside, inside = split_by_origin(kept, whole)
    colours = palette()
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0.98, 0.98, 0.985)
    renderer.AddActor(actor_of(outside))
    renderer.AddActor(actor_of(inside, colours))
    renderer.AddActor2D(legend(colours))
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*view)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(1.12)
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
    window.SetSize(*size)
    window.AddRenderer(renderer)
    window.Render()
    return window


def save(window, path):
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("mesh")
    parser.add_argument("picture", nargs="?")
    parser.add_argument("--normal", nargs=3, type=float, default=(0, -1, 0), help="of the cutting plane, to what is removed")
    parser.add_argument("--at", type=float, default=0.74, help="where it cuts, 0 to 1 along the normal")
    parser.add_argument("--view", nargs=3, type=float, default=(1.1, -1.9, 1.15), help="direction to the camera")
    parser.add_argument("--size", nargs=2, type=int, default=(1200, 900))
    arguments = parser.parse_args()
    images = os.path.join(os.path.dirname(os.path.abspath(__file__)), "images")
    name = os.path.splitext(os.path.basename(arguments.mesh))[0] + ".png"
    path = arguments.picture or os.path.join(images, name)
    save(render(read_tets(arguments.mesh), arguments.normal, arguments.at, arguments.size, arguments.view), path)
    print(path)


if __name__ == "__main__":
    main()
