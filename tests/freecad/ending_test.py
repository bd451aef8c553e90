"""FreeCAD ends while the mesher runs, by its window's button or killed: nothing of the run stays.

    ending_test.py PROGRAM

Exit code 77 (skipped) where FreeCAD is not installed.
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import run

IN_FREECAD = """
import json, os, sys
import FreeCAD, FreeCADGui
from PySide import QtCore, QtGui
sys.path.insert(0, {tests!r})
import window
from freecad.collarmesh_workbench import mesh_object, meshing_process

async def begin():
    FreeCADGui.activateWorkbench("FemWorkbench")
    document = FreeCAD.newDocument()
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = window.plate()
    obj = mesh_object.make(document, part)
    document.saveAs(os.path.join(os.environ["FREECAD_USER_HOME"], "plate.FCStd"))
    await window.open_panel(obj)
    window.child("CharacteristicLengthMax").setText("0.25 mm")
    await window.click(window.child("run"))
    work = meshing_process.run_of(obj)
    await window.wait_until(lambda: work.progress is not None and work.progress.tets > 1000, "progress")
    with open(os.environ["COLLARMESH_TEST_RESULT"], "w") as file:
        json.dump([os.getpid(), work._process.processId(), work.job.folder.name], file)
    if {close}:
        QtCore.QTimer.singleShot(100, window.window.close)
        QtCore.QTimer.singleShot(1500, discard)

def discard():
    box = QtGui.QApplication.activeModalWidget()
    box.button(QtGui.QMessageBox.Discard).click()

QtCore.QTimer.singleShot(1500, lambda: window.follow(begin(), print))
"""


def is_running(process_id):
    """Returns whether a process runs. Nobody collects the exit status of children of a killed process."""
    try:
        state = pathlib.Path(f"/proc/{process_id}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state != "Z"


def children(process_id):
    lists = [task.read_text() for task in pathlib.Path(f"/proc/{process_id}/task").glob("*/children")]
    return [int(each) for text in lists for each in text.split()]


def wait_until(condition, what, seconds=180):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise SystemExit(f"waited too long for {what}")
        time.sleep(0.05)


def ends_cleanly(program, by_its_button):
    tests = str(pathlib.Path(__file__).resolve().parent)
    with tempfile.TemporaryDirectory(prefix="collarmesh-ending-") as home:
        script = pathlib.Path(home) / "script.py"
        script.write_text(IN_FREECAD.format(tests=tests, close=by_its_button))
        variables = run.environment(home, program)
        result = pathlib.Path(variables["COLLARMESH_TEST_RESULT"])
        screen = subprocess.Popen(run.command(script, gui=True), stdin=subprocess.DEVNULL, env=variables,
                                  start_new_session=True)
        try:
            begun = lambda: result.exists() and result.read_text().endswith("]")  # noqa: E731
            wait_until(lambda: screen.poll() is not None or begun(), "a run")
            freecad, mesher, folder = json.loads(result.read_text())
            workers = children(mesher) if is_running(mesher) else []
            if not by_its_button:
                if not (workers and pathlib.Path(folder).exists()):
                    raise SystemExit("the mesher does not run")
                os.kill(freecad, signal.SIGKILL)
            wait_until(lambda: not is_running(freecad), "FreeCAD's end")
            wait_until(lambda: not any(map(is_running, [mesher, *workers])), "the mesher's end", 15)
            wait_until(lambda: not pathlib.Path(folder).exists(), f"the end of {folder}", 15)
        finally:
            if screen.poll() is None:
                os.killpg(screen.pid, signal.SIGKILL)
            screen.wait()


def main():
    if run.command("", gui=True) is None:
        print("FreeCAD or xvfb-run is not installed")
        return 77
    for by_its_button in (False, True):
        ends_cleanly(str(pathlib.Path(sys.argv[1]).resolve()), by_its_button)
        print("closed:" if by_its_button else "killed:", "nothing stays")
    return 0


if __name__ == "__main__":
    sys.exit(main())
