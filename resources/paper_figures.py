#!/usr/bin/python3
"""Draws figures 1 to 4 of the paper, and the ten pictures of the page "How it works", from the traces of runs.

    xvfb-run -a resources/paper_figures.py [--only NAME...] [--into FOLDER]

Needs the program `collarmesh` on the PATH, python3-vtk9 and python3-pil. "The paper" is G. L. Miller and T. Phillips,
Runtime-Efficient Meshing for Piecewise-Linear Complexes, 2010.
"""

import argparse
import os
import pathlib
import subprocess
import tempfile
import xml.etree.ElementTree

import numpy as np
import vtk
from PIL import Image
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from drawing import (BOOK, CREASE, EDGES, SCALE, STAR, actor_of, array, centres, extract, legend, palette, save,
                     surface_of, tinted, tubes, with_quality)
from gallery import write_off

HERE = pathlib.Path(__file__).resolve().parent
COLOURS = 160
TET, PATCH, COLLAR_SURFACE, SEGMENT, BALL = range(5)
OUTSIDE, REGION, RIPPED, IN_STAR, IN_BOOK, THIN = range(6)
# Colours of balls, by BallReason in collarmesh/trace.h.
REASONS = {1: (0.55, 0.60, 0.66), 3: (0.93, 0.66, 0.32), 4: (0.36, 0.56, 0.78), 5: (0.50, 0.72, 0.47),
           6: (0.80, 0.46, 0.46), 7: (0.62, 0.53, 0.76)}
PLAIN, GOLD = (0.80, 0.84, 0.90), (0.96, 0.74, 0.30)
WHITE, GREEN = (0.93, 0.93, 0.90), (0.62, 0.80, 0.60)
PROFILE = [(0, 0), (3, 0), (3, 1.4), (2, 1.4)]
FRONT = (0, -1, 0)
SECTION = {OUTSIDE: WHITE, REGION: GREEN, RIPPED: GOLD}
CREASE_CORNER = ((0.35, 0.4, 0.1), 0.62)
VIEW = (0.9, -2.2, 0.9)


# Runs

def chisel(path):
    """Writes a prism, 1.5 long, with an edge of 35 degrees."""
    points = [(x, y, z) for y in (0, 1.5) for x, z in PROFILE]
    write_off(path, points, [(0, 1, 2, 3), (7, 6, 5, 4), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)])


def planes(path):
    """Writes a box with two planes inside, which cross in a segment at 30 degrees. The segment divides each plane."""
    low, high, half = (-1, -1, -0.6), (1, 1, 0.6), np.tan(np.radians(15))
    points = [[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)]
    facets = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    axis = len(points)
    points += [(0, 0, -0.35), (0, 0, 0.35)]
    for x, y in ((0.7, 0.7 * half), (-0.7, -0.7 * half), (0.7, -0.7 * half), (-0.7, 0.7 * half)):
        facets.append((axis, axis + 1, len(points) + 1, len(points)))
        points += [(x, y, -0.35), (x, y, 0.35)]
    lines = [f"{len(points)} 3 0 0"] + [f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate(points)]
    lines += [f"{len(facets)} 0"] + ["\n".join(("1", " ".join(map(str, (len(f), *f))))) for f in facets]
    pathlib.Path(path).write_text("\n".join(lines + ["0", "0"]) + "\n")


def trace(source, *options):
    """Returns the steps of a run, as pairs of a stage and a grid."""
    folder = pathlib.Path(f"trace_of_{pathlib.Path(source).stem}_{len(options)}")
    if not folder.exists():
        subprocess.run(["collarmesh", source, "-o", "mesh.vtu", "--quiet",
                       "--trace", folder, *map(str, options)], check=True)
    names = [entry.get("file") for entry in xml.etree.ElementTree.parse(folder / "trace.pvd").iter("DataSet")]
    return [(name[3:-4], read(folder / name)) for name in names]


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def last(steps, stage):
    return [grid for name, grid in steps if name == stage][-1]


# Parts of a step

def cells(grid, kind, *states):
    found = array(grid, "kind") == kind
    if states:
        found &= np.isin(array(grid, "state"), states)
    return extract(grid, found.nonzero()[0])


def below(grid, axis, at):
    """Returns the cells whose centres lie below a plane."""
    if grid.GetNumberOfCells() == 0:
        return grid
    return extract(grid, (centres(grid)[:, axis] <= at).nonzero()[0])


def curves(grid, colour=EDGES, radius=0.008):
    segments = cells(grid, SEGMENT)
    if segments.GetNumberOfCells() == 0:
        return []
    actor = tubes(segments, radius)
    actor.GetProperty().SetColor(*colour)
    return [actor]


def balls(grid, reasons=REASONS, opacity=0.55):
    found = cells(grid, BALL)
    radius = vtk_to_numpy(found.GetPointData().GetArray("radius")) if found.GetNumberOfCells() else ()
    actors = []
    for c in range(found.GetNumberOfCells()):
        reason = int(array(found, "reason")[c])
        if reason not in reasons:
            continue
        point = found.GetCell(c).GetPointId(0)
        sphere = vtk.vtkSphereSource()
        sphere.SetCenter(found.GetPoint(point))
        sphere.SetRadius(float(radius[point]))
        sphere.SetThetaResolution(48)
        sphere.SetPhiResolution(32)
        sphere.Update()
        actor = actor_of(sphere.GetOutput())
        look = actor.GetProperty()
        look.SetEdgeVisibility(False)
        look.SetInterpolationToGouraud()
        look.SetColor(*reasons[reason])
        look.SetOpacity(opacity)
        actors.append(actor)
    return actors


def crease(a, b, radius=0.02):
    line = vtk.vtkLineSource()
    line.SetPoint1(*a)
    line.SetPoint2(*b)
    line.Update()
    return tubes(line.GetOutput(), radius)


def solid(grid, colour=PLAIN, opacity=1.0):
    return [tinted(grid, colour, opacity, 1.1)] if grid.GetNumberOfCells() else []


def by_angle(grid):
    return actor_of(with_quality(surface_of(grid)), palette())


def sliced(grid, colours, y=0.75):
    """Returns actors for the plane's cuts of cells, with a colour for each state."""
    plane = vtk.vtkPlane()
    plane.SetOrigin(0, y, 0)
    plane.SetNormal(0, 1, 0)
    actors = []
    for state, colour in colours.items():
        cutter = vtk.vtkCutter()
        cutter.SetCutFunction(plane)
        cutter.SetInputData(cells(grid, TET, state))
        cutter.GenerateTrianglesOff()
        cutter.Update()
        actor = actor_of(cutter.GetOutput())
        actor.GetProperty().SetColor(*colour)
        actor.GetProperty().SetAmbient(0.9)
        actor.GetProperty().SetDiffuse(0.1)
        actors.append(actor)
    return actors


def outline(y=0.75):
    """Returns an actor for the outline of the chisel's cross-section."""
    points, lines = vtk.vtkPoints(), vtk.vtkCellArray()
    for x, z in PROFILE:
        points.InsertNextPoint(x, y, z)
    lines.InsertNextCell(len(PROFILE) + 1, [*range(len(PROFILE)), 0])
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetLines(lines)
    return [tubes(data, 0.012)]


def collars(grid, axis=1, at=10.0):
    return [*solid(below(cells(grid, TET, REGION, THIN), axis, at)),
            *solid(below(cells(grid, TET, IN_STAR), axis, at), STAR),
            *solid(below(cells(grid, TET, IN_BOOK), axis, at), BOOK)]


# Pictures

def draw(path, *panels, size=(2800, 1400), view=VIEW, zoom=1.25, around=None):
    """Draws panels side by side, each a list of actors, twice as large as they are saved. `around`: the place in the
    middle, and half the height that is shown; without it everything is shown."""
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    for k, actors in enumerate(panels):
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(k / len(panels), 0, (k + 1) / len(panels), 1)
        renderer.SetBackground(0.98, 0.98, 0.985)
        for actor in actors:
            if actor.IsA("vtkActor2D"):
                renderer.AddActor2D(actor)
            else:
                renderer.AddActor(actor)
                actor.GetProperty().SetLineWidth(SCALE * actor.GetProperty().GetLineWidth())
        camera = renderer.GetActiveCamera()
        camera.SetPosition(*view)
        camera.SetFocalPoint(0, 0, 0)
        camera.SetViewUp(0, 0, 1)
        renderer.ResetCamera()
        camera.Zoom(zoom)
        if around:
            place, reach = np.array(around[0], float), around[1]
            camera.SetFocalPoint(*place)
            camera.SetPosition(*(place + 100 * np.array(view)))
            camera.ParallelProjectionOn()
            camera.SetParallelScale(reach)
            renderer.ResetCameraClippingRange()
        window.AddRenderer(renderer)
    window.Render()
    save(window, "large.png")
    image = Image.open("large.png").convert("RGB").resize((size[0] // 2, size[1] // 2), Image.LANCZOS)
    image.quantize(COLOURS).save(path, optimize=True)


def figure_1(path):
    """Draws an input of planes and segments; the collar around the crease; its balls."""
    planes("planes.poly")
    steps = trace("planes.poly", "--size", 0.25, "--coarsen", "off", "--improve", 0)
    grid = last(steps, "stitch")
    inner = extract(grid, ((array(grid, "kind") == PATCH) & (np.abs(centres(grid)[:, :2]).max(1) < 0.75)
                           & (np.abs(centres(grid)[:, 2]) < 0.4)).nonzero()[0])
    sheets = lambda opacity: solid(inner, PLAIN, opacity)
    axis = crease((0, 0, -0.35), (0, 0, 0.35), 0.012)
    draw(path, [*sheets(1), axis],
         [*sheets(0.35), *solid(cells(grid, TET, IN_STAR), STAR), *solid(cells(grid, TET, IN_BOOK), BOOK)],
         [*sheets(0.35), axis, *balls(grid)], size=(2800, 1000), view=(0.6, -1.6, 0.9), zoom=1.35)


def figure_2(path):
    """Draws the mesh while the input is being resolved, cut by a plane."""
    refining = [grid for name, grid in the_run() if name in ("refine", "rip")]
    chosen = [refining[round(k * (len(refining) - 1) / 3)] for k in range(4)]
    draw(path, *([*sliced(grid, SECTION), *outline()] for grid in chosen),
         size=(2800, 800), view=FRONT, around=((1.5, 0.75, 0.7), 1.9))


def figure_3(path):
    """Draws the crease and its balls; the refinement, which stops at them; the collar's surface; the stars
    that replace the cells inside."""
    steps = the_run()
    before, after = last(steps, "rip"), last(steps, "stitch")
    line = crease((0, 0, 0), (0, 1.5, 0), 0.012)
    shape = lambda opacity: solid(cells(after, PATCH), PLAIN, opacity)
    draw(path, [*shape(0.4), line, *balls(after)], [*sliced(before, SECTION, 0.6), *outline(0.6)],
         [*shape(0.3), line, *solid(inside_surface(before), GOLD)], [*collars(after, 1, 0.6)], size=(2800, 800),
         view=(-0.5, -1.6, 0.7), around=((0.3, 0.6, 0.1), 0.75))


def inside_surface(grid):
    """Returns the triangles of the collars' surface whose corners all belong to cells in the region."""
    inner, surface = cells(grid, TET, REGION), cells(grid, COLLAR_SURFACE)
    known = {inner.GetPoint(p) for p in range(inner.GetNumberOfPoints())}
    keep = [c for c in range(surface.GetNumberOfCells())
            if all(surface.GetPoint(surface.GetCell(c).GetPointId(k)) in known for k in range(3))]
    return extract(surface, np.array(keep))


def figure_4(path):
    """Draws the surface of the balls' union; the Voronoi cells restricted to it; the restricted triangles."""
    grid = last(the_run(), "rip")
    spheres = vtk.vtkAppendPolyData()
    found = cells(grid, BALL)
    radius = vtk_to_numpy(found.GetPointData().GetArray("radius"))
    places = [(np.array(found.GetPoint(found.GetCell(c).GetPointId(0))), float(radius[found.GetCell(c).GetPointId(0)]))
              for c in range(found.GetNumberOfCells()) if array(found, "reason")[c] > 1]
    for centre, r in places:
        sphere = vtk.vtkSphereSource()
        sphere.SetCenter(*centre)
        sphere.SetRadius(r)
        sphere.SetThetaResolution(160)
        sphere.SetPhiResolution(100)
        sphere.Update()
        spheres.AddInputData(sphere.GetOutput())
    spheres.Update()
    union = spheres.GetOutput()
    middles = centres(union)
    outer = np.all([np.linalg.norm(middles - c, axis=1) > 0.995 * r for c, r in places], axis=0)
    union = extract(union, outer.nonzero()[0])
    locator = vtk.vtkPointLocator()
    vertices = vtk.vtkPolyData()
    vertices.SetPoints(cells(grid, TET).GetPoints())
    locator.SetDataSet(vertices)
    locator.BuildLocator()
    owner = np.array([locator.FindClosestPoint(p) for p in centres(union)])
    colours = (np.random.default_rng(1).uniform(0.45, 0.95, (owner.max() + 1, 3)) * 255).astype(np.uint8)[owner]

    def sphere_actor(coloured):
        surface = surface_of(union)
        actor = actor_of(surface)
        actor.GetProperty().SetEdgeVisibility(False)
        if coloured:
            rgb = numpy_to_vtk(colours[vtk_to_numpy(surface.GetCellData().GetArray("vtkOriginalCellIds"))], deep=True)
            rgb.SetName("owner")
            surface.GetCellData().SetScalars(rgb)
            actor.GetMapper().ScalarVisibilityOn()
            actor.GetMapper().SetScalarModeToUseCellData()
            actor.GetMapper().SetColorModeToDirectScalars()
        return actor

    draw(path, [sphere_actor(False), crease((0, 0, 0), (0, 1.5, 0), 0.015)], [sphere_actor(True)],
         solid(cells(grid, COLLAR_SURFACE), GOLD), size=(2800, 1000), view=(-1.2, -1.8, 1.1), zoom=1.2)


def the_run():
    chisel("chisel.off")
    return trace("chisel.off", "--size", 0.3)


def how_1_input(path):
    grid = last(the_run(), "stitch")
    draw(path, [*solid(extract(grid, (array(grid, "kind") == PATCH).nonzero()[0]), PLAIN, 0.999), *curves(grid),
                crease((0, 0, 0), (0, 1.5, 0), 0.025)])


def how_2_box(path):
    grid = the_run()[0][1]
    frame = tinted(cells(grid, TET), PLAIN, 1)
    frame.GetProperty().SetRepresentationToWireframe()
    draw(path, [frame, *curves(grid, CREASE, 0.02), *balls(grid, opacity=0.4)])


def how_3_coarse(path):
    refining = [grid for name, grid in the_run() if name == "refine"]
    draw(path, *([*sliced(grid, SECTION), *outline()] for grid in (refining[1], refining[-1])), size=(2800, 1100),
         view=FRONT, around=((1.5, 0.75, 0.7), 2.3))


def how_4_balls(path):
    grid = last(the_run(), "rip")
    draw(path, [*solid(cells(last(the_run(), "stitch"), PATCH), PLAIN, 0.25),
                *balls(grid, {k: v for k, v in REASONS.items() if k > 1}, 0.9),
                *balls(grid, {1: REASONS[1]}, 0.12)])


def how_5_surface(path):
    refining = [grid for name, grid in the_run() if name == "refine"]
    early, late = refining[len(refining) // 2], last(the_run(), "rip")
    draw(path, [*solid(cells(early, PATCH)), *curves(early, CREASE, 0.015)],
         [*solid(cells(late, PATCH)), *curves(late, CREASE, 0.015)], size=(2800, 1100), zoom=1.3)


def how_6_quality(path):
    grid = last(the_run(), "rip")
    draw(path, [*sliced(grid, SECTION, 0.6), *outline(0.6)], view=FRONT, around=((1.5, 0.6, 0.7), 1.1))


def how_7_rip(path):
    grid = last(the_run(), "rip")
    draw(path, [*solid(below(cells(grid, TET, REGION), 1, 0.75)), *solid(inside_surface(grid), GOLD),
                crease((0, 0, 0), (0, 1.5, 0), 0.008)], view=(-0.5, -1.6, 0.7), around=CREASE_CORNER)


def how_8_stitch(path):
    draw(path, collars(last(the_run(), "stitch"), 1, 0.75), view=(-0.5, -1.6, 0.7), around=CREASE_CORNER)


def how_9_coarsen(path):
    before, after = last(the_run(), "stitch"), last(the_run(), "coarsen")
    draw(path, collars(before, 1, 0.75), collars(after, 1, 0.75), size=(2800, 1100), zoom=1.3)


def how_10_improve(path):
    before, after = last(the_run(), "stitch"), last(the_run(), "improve")
    panels = []
    for grid in (before, after):
        angles = extract(grid, ((array(grid, "kind") == TET) & (centres(grid)[:, 1] <= 0.75)).nonzero()[0])
        panels.append([by_angle(angles)])
    bar = legend(palette())
    bar.SetPosition(0.06, 0.48)
    panels[1].append(bar)
    draw(path, *panels, size=(2800, 1100), zoom=1.3)


PICTURES = {"paper_1": figure_1, "paper_2": figure_2, "paper_3": figure_3, "paper_4": figure_4, "how_1": how_1_input,
            "how_2": how_2_box, "how_3": how_3_coarse, "how_4": how_4_balls, "how_5": how_5_surface,
            "how_6": how_6_quality, "how_7": how_7_rip, "how_8": how_8_stitch, "how_9": how_9_coarsen,
            "how_10": how_10_improve}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=PICTURES, default=list(PICTURES))
    parser.add_argument("--into", type=pathlib.Path, default=HERE / "images")
    asked = parser.parse_args()
    into = asked.into.resolve()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name in asked.only:
            PICTURES[name](str(into / f"{name}.png"))
            print(name, flush=True)
        os.chdir(into)


if __name__ == "__main__":
    main()
