"""Run a script in FreeCAD with the add-on installed in a home of its own.

    run.py PROGRAM SCRIPT [--gui] [--addon FOLDER] [-- ARGUMENT]

PROGRAM is the mesher, "" where the add-on is to find it; FOLDER is the add-on, by default that of the sources;
with --gui the script runs in FreeCAD's window on a virtual screen. ARGUMENT reaches the script as
COLLARMESH_TEST_ARGUMENT. Exit code: the script's; 77 (skipped) where FreeCAD is not installed.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile


def main():
    program, script = (path and str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
    addon = pathlib.Path(__file__).resolve().parents[2] / "freecad_workbench"
    if "--addon" in sys.argv:
        addon = pathlib.Path(sys.argv[sys.argv.index("--addon") + 1]).resolve()
    gui = "--gui" in sys.argv
    names = ("freecad", "FreeCAD") if gui else ("freecadcmd", "FreeCADCmd")
    freecad = next(filter(None, map(shutil.which, names)), None)
    if freecad is None or (gui and shutil.which("xvfb-run") is None):
        print("FreeCAD or xvfb-run is not installed")
        return 77
    screen = ["xvfb-run", "-a", "-s", "-screen 0 2600x1000x24"] if gui else []
    with tempfile.TemporaryDirectory(prefix="collarmesh-freecad-") as home:
        mods = pathlib.Path(home) / "Mod"
        mods.mkdir()
        (mods / "collarmesh").symlink_to(addon)
        environment = dict(os.environ, FREECAD_USER_HOME=home, FREECAD_USER_DATA=home, COLLARMESH_PROGRAM=program)
        environment["QTWEBENGINE_DISABLE_SANDBOX"] = "1"  # else the start page ends FreeCAD when run by root
        environment["COLLARMESH_TEST_ARGUMENT"] = sys.argv[-1] if "--" in sys.argv else ""
        result = pathlib.Path(home) / "result"
        environment["COLLARMESH_TEST_RESULT"] = str(result)
        code = subprocess.run([*screen, freecad, script], stdin=subprocess.DEVNULL, env=environment, timeout=500).returncode
        if result.exists():
            print(result.read_text())
        return code


if __name__ == "__main__":
    sys.exit(main())
