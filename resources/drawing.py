"""Draws meshes: pieces of grids, and VTK's actors for them."""

from itertools import combinations

import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SOLID, EDGES = (0.80, 0.84, 0.90), (0.13, 0.16, 0.20)
SCALE = 2.7  # widths of lines and sizes of letters are for pictures 1040 wide; pictures are drawn 2800 wide
STAR, BOOK, CREASE = (0.96, 0.62, 0.20), (0.22, 0.50, 0.76), (0.80, 0.08, 0.16)


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
    """Adds the cell array `min_dihedral`, the smallest dihedral angle of each tet in degrees, if it is absent."""
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
    """Splits the surface of the kept tets into (the part on the whole mesh's surface, cut faces)."""
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
    """Returns colours for angles in degrees, from poor (warm) to regular (cool)."""
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


def legend(colours, title="smallest\ndihedral\nangle", numbers="%.0f", log=False):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle(title)
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.2g" if log else numbers)
    bar.SetOrientationToVertical()
    bar.SetPosition(0.85, 0.5)
    bar.SetWidth(0.1)
    bar.SetHeight(0.45)
    bar.SetBarRatio(0.3)
    bar.SetVerticalTitleSeparation(int(10 * SCALE))
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.15, 0.15, 0.18)
        text.SetShadow(False)
        text.SetItalic(False)
        text.SetBold(False)
        text.SetFontFamilyToArial()
    bar.SetUnconstrainedFontSize(True)
    bar.GetTitleTextProperty().SetFontSize(int(16 * SCALE))
    bar.GetLabelTextProperty().SetFontSize(int(15 * SCALE))
    return bar


def label(text, place):
    """Returns a label at a place; objects in front hide it."""
    actor = vtk.vtkBillboardTextActor3D()
    actor.SetInput(text)
    actor.SetPosition(*place)
    look = actor.GetTextProperty()
    look.SetFontSize(int(20 * SCALE))
    look.SetFontFamilyToArial()
    look.SetColor(0.08, 0.09, 0.12)
    look.SetBackgroundColor(1, 1, 1)
    look.SetBackgroundOpacity(1)
    look.SetJustificationToCentered()
    look.SetVerticalJustificationToCentered()
    return actor


def save(window, path):
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def array(grid, name):
    return vtk_to_numpy(grid.GetCellData().GetArray(name))


def corners(grid, cell):
    return frozenset(grid.GetPoint(grid.GetCell(cell).GetPointId(k))
                     for k in range(grid.GetCell(cell).GetNumberOfPoints()))


def crease_edges(tets, edges):
    """Returns the numbers of the curve edges whose tets all belong to books."""
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
