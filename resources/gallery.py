#!/usr/bin/python3
"""Makes the fifteen pictures of the gallery and that of a report, from input to PNG.

    xvfb-run -a resources/gallery.py [--only NAME...] [--into FOLDER] [--draft]

Needs the program `collarmesh` on the PATH, python3-vtk9, python3-pil, calculix-ccx (which makes the analysis) and
chromium (which shows the report).
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import vtk
from PIL import Image
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from drawing import (BOOK, SCALE, STAR, actor_of, array, centres, crease_edges, extract, label, legend, palette, save,
                     shrunk, split_by_origin, surface_of, tinted, tubes, with_quality)

HERE = pathlib.Path(__file__).resolve().parent
SIZE = (2800, 1960)  # pictures are drawn twice as large as they are saved
COLOURS = 128
draft = False  # True: pictures are drawn as small as they are saved
HUES = ((0.36, 0.56, 0.78), (0.93, 0.66, 0.32), (0.50, 0.72, 0.47), (0.80, 0.46, 0.46), (0.62, 0.53, 0.76),
        (0.40, 0.72, 0.74), (0.88, 0.80, 0.40), (0.72, 0.60, 0.50), (0.86, 0.60, 0.74), (0.58, 0.64, 0.70),
        (0.30, 0.62, 0.56), (0.95, 0.75, 0.62), (0.44, 0.44, 0.66), (0.70, 0.82, 0.60), (0.60, 0.32, 0.40))
GREY = (0.86, 0.89, 0.93)


# Input

def run(*command):
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def mesh(source, *options):
    """Returns the grid that collarmesh makes: tets, boundary triangles and curve edges with their tags."""
    run("collarmesh", source, "-o", "mesh.vtk", "--quiet", *options)
    return read("mesh.vtk")


def read(path):
    reader = vtk.vtkUnstructuredGridReader()
    reader.SetFileName(path)
    reader.ReadAllScalarsOn()
    reader.ReadAllFieldsOn()
    reader.Update()
    return reader.GetOutput()


def write_off(path, points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(f"{x:.9g}" for x in p) for p in points]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


def box(low, high):
    points = [[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)]
    return points, [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def joined(*parts):
    points, faces = [], []
    for part_points, part_faces in parts:
        faces += [tuple(v + len(points) for v in face) for face in part_faces]
        points += list(part_points)
    return points, faces


def tube(begin, end, radius, sides=24):
    """Returns a closed prism of many sides."""
    begin, end = np.array(begin, float), np.array(end, float)
    axis = (end - begin) / np.linalg.norm(end - begin)
    u = np.cross(axis, (0.3, 0.5, 0.8))
    u /= np.linalg.norm(u)
    v = np.cross(axis, u)
    turns = [radius * (np.cos(t) * u + np.sin(t) * v) for t in np.linspace(0, 2 * np.pi, sides, endpoint=False)]
    points = [begin + t for t in turns] + [end + t for t in turns]
    faces = [(k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in range(sides)]
    return points, [tuple(reversed(range(sides))), tuple(range(sides, 2 * sides)), *faces]


def sectors(path, count, height=1.2):
    """Writes `count` solids around an axis, which is their common edge."""
    angles = np.linspace(0, 2 * np.pi, count, endpoint=False)
    ring = [(np.cos(t), np.sin(t)) for t in angles]
    points = [(0, 0, 0), (0, 0, height)] + [(x, y, z) for z in (0, height) for x, y in ring]
    below, above = (lambda k: 2 + k % count), (lambda k: 2 + count + k % count)
    facets = []
    for k in range(count):
        facets += [(0, below(k + 1), below(k)), (1, above(k), above(k + 1)),
                   (below(k), below(k + 1), above(k + 1), above(k)), (0, below(k), above(k), 1)]
    half = np.pi / count
    inside = [(0.5 * np.cos(t + half), 0.5 * np.sin(t + half), height / 2) for t in angles]
    lines = [f"{len(points)} 3 0 0"] + [f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate(points)]
    lines += [f"{len(facets)} 0"] + ["\n".join(("1", " ".join(map(str, (len(f), *f))))) for f in facets]
    lines += ["0", str(count)] + [f"{k} {x} {y} {z} {k + 1}" for k, (x, y, z) in enumerate(inside)]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


# Scenes

def kind(grid, vtk_type):
    types = vtk_to_numpy(grid.GetCellTypesArray())
    return extract(grid, (types == vtk_type).nonzero()[0])


def tets(grid):
    return kind(grid, vtk.VTK_TETRA)


def behind(grid, normal, at):
    """Returns for each cell whether it is behind a plane. `at`: the plane's place, as a share of the way through the
    grid along the normal."""
    offsets = centres(grid) @ np.array(normal, float)
    return offsets <= offsets.min() + at * (offsets.max() - offsets.min())


def cut_open(grid, normal, at):
    """Returns actors for the tets behind a plane; where the mesh is cut, colours show the smallest dihedral angles."""
    whole = with_quality(tets(grid))
    outside, inside = split_by_origin(extract(whole, behind(whole, normal, at).nonzero()[0]), whole)
    return [actor_of(outside), actor_of(inside, palette()), legend(palette())]


def coloured(grid, values):
    """Returns an actor for each value: the cells with this value, in a colour of their own."""
    actors = []
    for k, value in enumerate(sorted(set(values))):
        actors.append(tinted(extract(grid, (values == value).nonzero()[0]), HUES[k % len(HUES)], width=1.1))
    return actors


def surface(path, colour):
    """Returns an actor for the polygons of an .off file."""
    words = pathlib.Path(path).read_text().split()
    count, facets = int(words[1]), int(words[2])
    points, polygons = vtk.vtkPoints(), vtk.vtkCellArray()
    for k in range(count):
        points.InsertNextPoint([float(x) for x in words[4 + 3 * k:7 + 3 * k]])
    at = 4 + 3 * count
    for _ in range(facets):
        corners = int(words[at])
        polygons.InsertNextCell(corners, [int(v) for v in words[at + 1:at + 1 + corners]])
        at += 1 + corners
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(polygons)
    actor = actor_of(data)
    actor.GetProperty().SetColor(*colour)
    return actor


def scene(actors, view, zoom, place=(0, 0, 1, 1)):
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*place)
    renderer.SetBackground(0.98, 0.98, 0.985)
    for actor in actors:
        if actor.IsA("vtkActor2D"):
            renderer.AddActor2D(actor)
            continue
        renderer.AddActor(actor)
        if actor.IsA("vtkActor"):
            actor.GetProperty().SetLineWidth(SCALE * actor.GetProperty().GetLineWidth())
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*view)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(zoom)
    for position, strength in (((-1, -2, 1.5), 0.55), ((2.5, -0.5, 1.5), 0.6)):
        light = vtk.vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(*position)
        light.SetFocalPoint(0, 0, 0)
        light.SetIntensity(strength)
        renderer.AddLight(light)
    return renderer


def picture(path, *renderers):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(8 * (not draft))
    window.SetSize(*(length // (2 if draft else 1) for length in SIZE))
    for renderer in renderers:
        window.AddRenderer(renderer)
    window.Render()
    save(window, "large.png")
    image = Image.open("large.png").convert("RGB").resize((SIZE[0] // 2, SIZE[1] // 2), Image.LANCZOS)
    image.quantize(COLOURS).save(path, optimize=True)


FRONT = (1.1, -1.9, 1.15)
LEFT, RIGHT = (0, 0, 0.5, 1), (0.5, 0, 1, 1)


# Pictures

def bracket(path):
    picture(path, scene(cut_open(mesh("bracket.off", "--size", 4), (0, -1, 0), 0.74), FRONT, 1.12))


def names(path):
    """Draws each face with a colour and its number, as `info` shows it."""
    faces = kind(mesh("bracket.off", "--size", 5), vtk.VTK_TRIANGLE)
    tags = array(faces, "tag")
    renderer = scene(coloured(faces, tags), FRONT, 1.1)
    eye = np.array(renderer.GetActiveCamera().GetPosition())
    locator = vtk.vtkCellLocator()
    locator.SetDataSet(faces)
    locator.BuildLocator()
    for tag in sorted(set(tags)):
        at = middle(faces, (tags == tag).nonzero()[0])
        if tags[first_cell(locator, eye, at)] == tag:  # otherwise another face hides it
            renderer.AddActor(label(str(tag), at + 8 * (eye - at) / np.linalg.norm(eye - at)))
    picture(path, renderer)


def first_cell(locator, eye, at):
    """Returns the first cell on the way from the eye through `at`."""
    share, cell, part = vtk.mutable(0.0), vtk.mutable(0), vtk.mutable(0)
    place, within = [0.0] * 3, [0.0] * 3
    beyond = eye + 1.1 * (at - eye)
    locator.IntersectWithLine(eye, beyond, 1e-9, share, place, within, part, cell)
    return int(cell)


def middle(grid, cells):
    """Returns the centre of the cell that is nearest to the middle of these cells."""
    places = centres(grid)[cells]
    return places[np.linalg.norm(places - places.mean(axis=0), axis=1).argmin()]


def curved(path):
    """Draws meshes of the same size with straight and with curved elements."""
    options, view = ("--size", 14, "--distance", 1.2), (1.1, -1.5, 1.6)
    straight = actor_of(surface_of(kind(mesh("flange.step", *options), vtk.VTK_TRIANGLE)))
    faces = kind(mesh("flange.step", *options, "--order", 2), vtk.VTK_QUADRATIC_TRIANGLE)
    smooth = actor_of(subdivided(faces))
    smooth.GetProperty().SetEdgeVisibility(False)
    smooth.GetProperty().SetInterpolationToGouraud()
    picture(path, scene([straight], view, 1.05, LEFT), scene([smooth, edges_of(faces)], view, 1.05, RIGHT))


def subdivided(faces):
    """Divides curved triangles into small flat ones."""
    filter_ = vtk.vtkDataSetSurfaceFilter()
    filter_.SetInputData(faces)
    filter_.SetNonlinearSubdivisionLevel(3)
    filter_.Update()
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(filter_.GetOutput())
    normals.SetFeatureAngle(40)
    normals.Update()
    return normals.GetOutput()


def edges_of(faces):
    """Returns the curved edges of curved triangles."""
    lines, points = vtk.vtkCellArray(), vtk.vtkPoints()
    for c in range(faces.GetNumberOfCells()):
        corner = [np.array(faces.GetPoint(faces.GetCell(c).GetPointId(k))) for k in range(6)]
        for a, b, m in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
            t = np.linspace(0, 1, 9)[:, None]
            curve = (1 - t) * (1 - 2 * t) * corner[a] + t * (2 * t - 1) * corner[b] + 4 * t * (1 - t) * corner[m]
            first = [points.InsertNextPoint(p) for p in curve]
            lines.InsertNextCell(len(first), first)
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetLines(lines)
    actor = actor_of(data)
    actor.GetProperty().SetColor(0.13, 0.16, 0.20)
    actor.GetProperty().SetLineWidth(1.6)
    return actor


def field(path):
    pathlib.Path("field.json").write_text(
        '{"sources": [{"ball": {"centre": [1.5, 0.7, 1], "radius": 0.12}, "size": 0.035, "growth": 0.25}]}')
    grid = mesh("box.off", "--size", 0.4, "--size-field", "field.json")
    picture(path, scene(cut_open(grid, (0, -1, 0), 0.66), (0.5, -1.9, 1.0), 1.05))


def tiny(path):
    write_off("outer.off", *box((0, 0, 0), (1, 1, 1)))
    points, faces = box((0.5, 0.49, 0.5), (0.51, 0.5, 0.51))
    write_off("inner.off", points, [tuple(reversed(f)) for f in faces])
    run("collarmesh", "outer.off", "inner.off", "-o", "mesh.vtk", "--quiet", "--size", 0.2, "--gradation", 0.4)
    grid = read("mesh.vtk")
    left, right = (scene([section(grid, 0.495)], (0, -1, 0), zoom, place)
                   for zoom, place in ((0.82, (0, 0, 0.44, 1)), (1, (0.44, 0, 0.88, 1))))
    right.GetActiveCamera().SetFocalPoint(0.505, 0.49, 0.505)
    right.GetActiveCamera().SetPosition(0.505, 0.3, 0.505)
    right.GetActiveCamera().SetClippingRange(0.01, 2)
    bar = legend(lengths_palette(), "edge\nlength", "%.2f")
    bar.SetPosition(0.15, 0.3)
    bar.SetWidth(0.7)
    picture(path, left, right, scene([bar], FRONT, 1, (0.88, 0, 1, 1)))


def lengths_palette():
    """Returns colours for edge lengths from short (dark) to long, by their logarithm."""
    colours = vtk.vtkColorTransferFunction()
    colours.SetScaleToLog10()
    for length, rgb in ((0.005, (0.16, 0.30, 0.55)), (0.02, (0.27, 0.60, 0.70)), (0.08, (0.60, 0.82, 0.62)),
                        (0.25, (0.96, 0.92, 0.66))):
        colours.AddRGBPoint(length, *rgb)
    return colours


def section(grid, y):
    """Returns an actor for a plane's cuts of tets, coloured by the edge length of the regular tet of equal volume."""
    sizes = vtk.vtkMeshQuality()
    sizes.SetInputData(tets(grid))
    sizes.SetTetQualityMeasureToVolume()
    sizes.Update()
    cells = sizes.GetOutput()
    volume = vtk_to_numpy(cells.GetCellData().GetArray("Quality"))
    length = numpy_to_vtk((6 * 2**0.5 * np.abs(volume)) ** (1 / 3), deep=True)
    length.SetName("length")
    cells.GetCellData().AddArray(length)
    plane = vtk.vtkPlane()
    plane.SetOrigin(0, y, 0)
    plane.SetNormal(0, 1, 0)
    cut = vtk.vtkCutter()
    cut.SetInputData(cells)
    cut.SetCutFunction(plane)
    cut.GenerateTrianglesOff()
    cut.Update()
    actor = actor_of(cut.GetOutput(), lengths_palette())
    actor.GetMapper().SelectColorArray("length")
    actor.GetProperty().LightingOff()
    return actor


def regions(path):
    sectors("sectors.poly", 5)
    sizes = [word for tag, size in ((1, 0.3), (2, 0.15), (3, 0.3), (4, 0.08), (5, 0.3))
             for word in ("--region-size", f"{tag}={size}")]
    grid = tets(mesh("sectors.poly", "--gradation", 0.4, *sizes))
    region = array(grid, "tag")
    actors = []
    for k, value in enumerate(sorted(set(region))):
        actor = tinted(extract(grid, (region == value).nonzero()[0]), HUES[k], width=1.1)
        turn = (2 * k + 1) * np.pi / 5
        actor.SetPosition(0.12 * np.cos(turn), 0.12 * np.sin(turn), 0)
        actors.append(actor)
    picture(path, scene(actors, (0.5, -1.6, 1.5), 1.3))


def collar(path):
    sectors("sectors.poly", 8)
    grid = mesh("sectors.poly", "--size", 0.17, "--coarsen", "off")
    cells, edges = tets(grid), kind(grid, vtk.VTK_LINE)
    marks, open_ = array(cells, "collar"), np.isin(array(cells, "region"), (5, 6, 7))
    rest = (marks == 0) & behind(cells, (0, -1, 0), 0.5)
    actors = [tinted(extract(cells, rest.nonzero()[0]), GREY, width=1.1)]
    for mark, colour in ((1, STAR), (2, BOOK)):
        actors.append(tinted(shrunk(extract(cells, ((marks == mark) & ~open_).nonzero()[0]), 0.94), colour))
    actors.append(tubes(extract(edges, np.array(crease_edges(cells, edges))), 0.012))
    picture(path, scene(actors, (0.12, -1.6, 0.8), 1.35))


def fan(path):
    """Draws solids between sheets that meet in the axis of a cylinder, 10 degrees from each other."""
    sectors("fan.poly", 36, height=0.8)
    grid = mesh("fan.poly", "--size", 0.12)
    cells = tets(grid)
    shown = ~np.isin(array(cells, "tag") % 36, range(24, 30))
    part = extract(cells, shown.nonzero()[0])
    picture(path, scene(coloured(part, array(part, "tag") % 2), (0.2, -1.6, 1.5), 1.35))


def thin(path):
    write_off("plate.off", *box((0, 0, 0), (60, 60, 1.5)))
    pair = []
    for coarsen, place in (("off", (0, 0.5, 1, 1)), ("on", (0, 0, 1, 0.5))):
        grid = mesh("plate.off", "--size", 8, "--coarsen", coarsen)
        pair.append(scene(cut_open(grid, (0, -1, 0), 1)[:1], (0.5, -1.6, 0.9), 1.9, place))
    picture(path, *pair)


def repair(path):
    parts = [tube((-2, 0, 0), (2, 0, 0), 0.8), tube((0, -2, 0), (0, 2, 0), 0.8), tube((0, 0, -2), (0, 0, 2), 0.8)]
    points, faces = joined(*parts)
    write_off("broken.off", points, faces[:1] + faces[2:])      # without one end
    before = scene([surface("broken.off", (0.90, 0.80, 0.72))], FRONT, 0.85, LEFT)
    after = scene(cut_open(mesh("broken.off", "--size", 0.4), (0, -1, 0), 0.5)[:2], FRONT, 0.85, RIGHT)
    picture(path, before, after)


def wrap(path):
    """Draws nine strips that are not joined, as a drawing may contain them, and the mesh of their wrap."""
    points, faces = [], []
    for k in range(9):
        turn = k * np.pi / 9
        ring = [(np.cos(t) * np.cos(turn), np.cos(t) * np.sin(turn), np.sin(t))
                for t in np.linspace(0, 2 * np.pi, 41)]
        side = 0.11 * np.array((-np.sin(turn), np.cos(turn), 0))
        base = len(points)
        for p in ring:
            points += [np.array(p) - side, np.array(p) + side]
        faces += [(base + 2 * j, base + 2 * j + 1, base + 2 * j + 3, base + 2 * j + 2) for j in range(40)]
    write_off("strips.off", points, faces)
    before = scene([surface("strips.off", (0.90, 0.80, 0.72))], FRONT, 0.85, LEFT)
    grid = mesh("strips.off", "--repair", "wrap", "--wrap-offset", 0.02, "--size", 0.2)
    after = scene(cut_open(grid, (0, -1, 0), 0.5)[:2], FRONT, 0.85, RIGHT)
    picture(path, before, after)


DECK = """*INCLUDE, INPUT=bracket.inp
*MATERIAL, NAME=STEEL
*ELASTIC
210000, 0.3
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
*STEP
*STATIC
*BOUNDARY
FIXED_NODES, 1, 3
*DSLOAD
LOADED, P, 2
*NODE FILE
U
*END STEP
"""


def displacements(path):
    """Returns the displacements in CalculiX's result file, by the numbers of nodes."""
    found, reading = {}, False
    for line in pathlib.Path(path).read_text().splitlines():
        if line.startswith(" -4"):
            reading = "DISP" in line
        elif reading and line.startswith(" -1"):
            found[int(line[3:13])] = [float(line[13 + 12 * k:25 + 12 * k]) for k in range(3)]
    return found


def analysis(path):
    pathlib.Path("names.json").write_text(
        '{"patches": {"fixed": {"at": [5, 20, 60]}, "loaded": {"at": [80, 30, 5]}}}')
    run("collarmesh", "bracket.off", "-o", "bracket.inp", "--size", 4, "--order", 2, "--names", "names.json", "--quiet")
    pathlib.Path("job.inp").write_text(DECK)
    run("ccx", "job")
    run("collarmesh", "convert", "bracket.inp", "-o", "mesh.vtk", "--quiet")
    grid, moved = read("mesh.vtk"), displacements("job.frd")
    ways = np.array([moved[k + 1] for k in range(grid.GetNumberOfPoints())])
    lengths = numpy_to_vtk(np.linalg.norm(ways, axis=1), deep=True)
    lengths.SetName("displacement")
    whole = vtk.vtkUnstructuredGrid()
    whole.DeepCopy(grid)
    whole.GetPoints().SetData(numpy_to_vtk(vtk_to_numpy(grid.GetPoints().GetData()) + 60 * ways, deep=True))
    whole.GetPointData().SetScalars(lengths)
    part = surface_of(kind(whole, vtk.VTK_QUADRATIC_TETRA))
    colours = vtk.vtkColorTransferFunction()
    largest = float(np.linalg.norm(ways, axis=1).max())
    loaded = array(grid, "tag") == 5
    loaded &= vtk_to_numpy(grid.GetCellTypesArray()) == vtk.VTK_QUADRATIC_TRIANGLE
    for share, rgb in ((0, (0.20, 0.40, 0.70)), (0.5, (0.75, 0.85, 0.72)), (1, (0.85, 0.30, 0.18))):
        colours.AddRGBPoint(share * largest, *rgb)
    actor = actor_of(part)
    actor.GetMapper().SetLookupTable(colours)
    actor.GetMapper().SetScalarModeToUsePointData()
    actor.GetMapper().ScalarVisibilityOn()
    actor.GetProperty().SetLineWidth(0.8)
    arrows = arrows_at(centres(extract(whole, loaded.nonzero()[0]))[::2], (-1, 0, 0), 9)
    words = [label("pressure", (102, 30, 14)), label("held", (5, 20, 66))]
    picture(path, scene([actor, arrows, *words, legend(colours, "displacement\n(mm)", "%.3f")], FRONT, 1.2))


def arrows_at(places, direction, length):
    """Returns arrows that end at these places."""
    points = vtk.vtkPoints()
    for place in places:
        points.InsertNextPoint(place - length * np.array(direction, float))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    ways = numpy_to_vtk(np.tile(np.array(direction, float), (len(places), 1)), deep=True)
    ways.SetName("way")
    data.GetPointData().SetVectors(ways)
    source = vtk.vtkArrowSource()
    source.SetTipResolution(20)
    source.SetShaftResolution(16)
    glyph = vtk.vtkGlyph3D()
    glyph.SetInputData(data)
    glyph.SetSourceConnection(source.GetOutputPort())
    glyph.SetScaleModeToDataScalingOff()
    glyph.SetScaleFactor(length)
    glyph.Update()
    actor = actor_of(glyph.GetOutput())
    actor.GetProperty().SetColor(0.75, 0.12, 0.16)
    actor.GetProperty().SetEdgeVisibility(False)
    return actor


def report(path):
    page = pathlib.Path("report.html").resolve()
    mesh("bracket.off", "--size", 5, "--report", page)
    run("chromium", "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader", "--hide-scrollbars", "--window-size=1400,1000", "--virtual-time-budget=20000",
        f"--screenshot={path}", f"{page.as_uri()}#cut=x,0.5&turn=15")
    Image.open(path).convert("RGB").save(path, optimize=True)  # with all colours, for the legend


def coil(path):
    """Draws a wire of five turns as edges of the tets around it."""
    grid = mesh("coil_in_box.brep", "--size", 5, "--curve-size", "13=1", "--gradation", 0.5)
    edges = kind(grid, vtk.VTK_LINE)
    wire = extract(edges, np.isin(array(edges, "tag"), (13, 14, 15)).nonzero()[0])
    picture(path, scene([*cut_open(grid, (0, -1, 0), 0.4), tubes(wire, 0.35)], FRONT, 1.12))


def crack(path):
    """Draws the two sides of a sheet with separate nodes, moved apart."""
    grid = mesh("cracked_box.poly", "--size", 0.2, "--patch-size", "7=0.04", "--name", "crack=7", "--split", "crack")
    is_face = vtk_to_numpy(grid.GetCellTypesArray()) == vtk.VTK_TRIANGLE
    on_sheet = is_face & (np.abs(centres(grid) - 0.5).max(axis=1) < 0.45)
    tags = sorted(set(array(grid, "tag")[on_sheet]))
    places = vtk_to_numpy(grid.GetPoints().GetData()).copy()
    half, way = 0.2, 0.09
    for tag, sign in zip(tags, (-1, 1)):
        cells = (on_sheet & (array(grid, "tag") == tag)).nonzero()[0]
        for v in {grid.GetCell(int(c)).GetPointId(k) for c in cells for k in range(3)}:
            places[v, 2] += sign * way * (1 - ((places[v, :2] - 0.5) / half) ** 2).clip(0).prod() ** 0.5
    grid.GetPoints().SetData(numpy_to_vtk(places, deep=True))
    sides = [tinted(extract(grid, (on_sheet & (array(grid, "tag") == tag)).nonzero()[0]), colour, width=1.1)
             for tag, colour in zip(tags, (HUES[1], HUES[0]))]
    whole = tets(grid)
    rest = tinted(extract(whole, behind(whole, (0, -1, 0), 0.36).nonzero()[0]), GREY, width=1.1)
    picture(path, scene([rest, *sides], (0.4, -1.9, 0.06), 1.15))


def cell(path):
    """Draws a cell with a square fibre and its images on three sides: nodes and triangles match."""
    square = ((0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75))
    points = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    points += [(x, y, z) for z in (0, 1) for x, y in square]
    sides = ["1 0 1\n4 0 3 7 4", "1 0 2\n4 1 2 6 5", "1 0 3\n4 0 1 5 4", "1 0 4\n4 2 3 7 6",
             "2 0 5\n4 0 1 2 3\n4 8 9 10 11", "2 0 6\n4 4 5 6 7\n4 12 13 14 15"]
    sides += [f"1 0 7\n4 {8 + k} {8 + (k + 1) % 4} {12 + (k + 1) % 4} {12 + k}" for k in range(4)]
    pathlib.Path("cell.poly").write_text("\n".join(
        [f"{len(points)} 3 0 0", *(f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate(points)), f"{len(sides)} 1", *sides,
         "0", "2", "0 0.5 0.5 0.5 1", "1 0.1 0.1 0.1 2"]) + "\n")
    periodic = [word for axis in "xyz" for word in ("--periodic", axis)]
    grid = tets(mesh("cell.poly", "--size", 0.2, *periodic))
    actors = []
    for place in ((0, 0, 0), (1.04, 0, 0), (0, 0, 1.04), (1.04, 0, 1.04)):
        for actor in coloured(grid, array(grid, "tag")):
            actor.SetPosition(*place)
            actors.append(actor)
    picture(path, scene(actors, FRONT, 1.0))


PICTURES = (bracket, names, curved, field, tiny, regions, collar, fan,
            thin, repair, wrap, analysis, report, coil, crack, cell)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="pictures by name")
    parser.add_argument("--into", type=pathlib.Path, default=HERE / "images")
    parser.add_argument("--draft", action="store_true", help="without smooth edges, four times as fast")
    arguments = parser.parse_args()
    global draft
    draft = arguments.draft
    into = arguments.into.resolve()
    for make in PICTURES:
        if arguments.only and make.__name__ not in arguments.only:
            continue
        with tempfile.TemporaryDirectory() as folder:
            for model in (HERE / "models").iterdir():
                shutil.copy(model, folder)
            os.chdir(folder)
            path = into / f"{make.__name__}.png"
            make(path)
            os.chdir(HERE)
        print(path, path.stat().st_size)


if __name__ == "__main__":
    main()
