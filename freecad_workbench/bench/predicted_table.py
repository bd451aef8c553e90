"""Measures the time from opening the panel to the chosen size's row in the table of predictions, and to all rows.

    tests/freecad/run.py PROGRAM freecad_workbench/bench/predicted_table.py --gui -- FOLDER

FOLDER has STEP files; PARTS of them are measured, spread by file size. Prints the time of the clock, and the processor
time of FreeCAD and of the mesher, which depends less on other work of the machine. The time of importing the part into
FreeCAD is not included."""

import os
import pathlib
import resource
import sys
import time

import FreeCAD
import FreeCADGui
import numpy
import Part

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "freecad"))
import window as w  # noqa: E402
from freecad.collarmesh_workbench import mesh_object, task_panel, view_provider  # noqa: E402

PARTS = int(os.environ.get("COLLARMESH_BENCH_PARTS", 21))
LIMIT = 120  # seconds to wait for a table
ROW = ", ".join(f"{which} {{:.2f}} s (CPU time: FreeCAD {{:.2f}} s, mesher {{:.2f}} s)"
                for which in ("chosen", "all"))


def spread(paths):
    """Returns PARTS of the files, or all if there are fewer, from the smallest to the largest."""
    paths = sorted(paths, key=lambda path: path.stat().st_size)
    return [paths[i * (len(paths) - 1) // (PARTS - 1)] for i in range(PARTS)] if len(paths) > PARTS else paths


def used_by(process_id):
    """Returns the processor time in seconds that a running process and its children have used."""
    folder = pathlib.Path("/proc", str(process_id))
    words = (folder / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    children = (folder / "task" / str(process_id) / "children").read_text(encoding="utf-8").split()
    return sum(map(int, words[11:15])) / os.sysconf("SC_CLK_TCK") + sum(map(used_by, children))


def now(process=None):
    """Returns three times in seconds: of the clock, FreeCAD's processor time, and the mesher's processor time.
    `process`: the mesher if it runs, a child of this process."""
    used = [resource.getrusage(kind) for kind in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    own, of_ended = (each.ru_utime + each.ru_stime for each in used)
    running = used_by(process.processId()) if process is not None and process.processId() else 0
    return numpy.array([time.monotonic(), own, of_ended + running])


class Watched(task_panel.MeshTaskPanel):
    """A panel that records the times at which its table gets numbers."""

    told = []

    def _show_predictions(self, known, missing=""):
        super()._show_predictions(known, missing)
        self.told.append((now(self.predictions._process), set(known),
                         self.size.size(), {size for _, size in self.size.presets}))


view_provider.MeshTaskPanel = Watched


def first_when(condition):
    """Returns the times (see `now`) at which the condition was first met; None: never."""
    return next((moment for moment, *what in Watched.told if condition(*what)), None)


def chosen(known, size, _presets):
    return size in known


def complete(known, _size, presets):
    return presets <= known


async def measured(path):
    """Returns the number of faces, and the times (see `now`) from opening the panel to the chosen size's row and to all
    rows."""
    shape = Part.read(str(path))
    document = FreeCAD.newDocument("part")
    part = document.addObject("Part::Feature", "Part")
    part.Shape = shape
    obj = mesh_object.make(document, part)
    document.recompute()
    await w.pause(500)
    Watched.told.clear()
    begin = now()
    FreeCADGui.getDocument(document.Name).setEdit(obj.Name)
    while first_when(complete) is None and now()[0] < begin[0] + LIMIT:
        await w.pause(200)
    found = len(shape.Faces), first_when(chosen), first_when(complete)
    await w.close_panel(w.QtGui.QDialogButtonBox.Cancel)
    FreeCAD.closeDocument(document.Name)
    return found[0], *(None if each is None else each - begin for each in found[1:])


async def test():
    FreeCADGui.activateWorkbench("FemWorkbench")
    folder = pathlib.Path(os.environ["COLLARMESH_TEST_ARGUMENT"])
    w.PICTURES = ""
    rows = []
    for path in spread([each for each in folder.iterdir() if each.suffix.lower() in (".step", ".stp")]):
        faces, first, whole = await measured(path)
        print(f"{path.name[:40]:40} {faces:5} faces:",
              "no table" if whole is None else ROW.format(*first, *whole), flush=True)
        rows += [] if whole is None else [(*first, *whole)]
    print(len(rows), "tables, medians:", ROW.format(*numpy.median(rows, axis=0)), flush=True)


w.run_test(test)
