"""Run a script in FreeCAD with the add-on installed in a home of its own.

    run.py PROGRAM SCRIPT [--gui] [--addon FOLDER] [-- ARGUMENT]

PROGRAM is the mesher, "" where the add-on is to find it; FOLDER is the add-on, by default that of the sources;
with --gui the script runs in FreeCAD's window on a virtual screen. ARGUMENT reaches the script as
COLLARMESH_TEST_ARGUMENT; the environment variable COLLARMESH_TEST_SECONDS gives it more time. Exit code: the script's,
and 1 where a script in the window does not tell that it passed; 77 (skipped) where FreeCAD is not installed.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCES = pathlib.Path(__file__).resolve().parents[2] / "freecad_workbench"
SECONDS = float(os.environ.get("COLLARMESH_TEST_SECONDS", 900))


def command(script, gui):
    """Returns the command that runs a script in FreeCAD, None if that is not installed."""
    names = ("freecad", "FreeCAD") if gui else ("freecadcmd", "FreeCADCmd")
    freecad = next(filter(None, map(shutil.which, names)), None)
    if freecad is None or (gui and shutil.which("xvfb-run") is None):
        return None
    screen = ["xvfb-run", "-a", "-s", "-screen 0 2600x1000x24"] if gui else []
    return [*screen, freecad, str(script)]


def environment(home, program, addon=SOURCES):
    """Returns the environment of a FreeCAD with this folder as home and the add-on in it."""
    mods = pathlib.Path(home) / "Mod"
    mods.mkdir()
    (mods / "collarmesh").symlink_to(addon)
    return dict(os.environ, FREECAD_USER_HOME=home, FREECAD_USER_DATA=home, COLLARMESH_PROGRAM=program,
                COLLARMESH_TEST_RESULT=str(pathlib.Path(home) / "result"),
                QTWEBENGINE_DISABLE_SANDBOX="1")  # without this the start page ends FreeCAD when run by root; fmt: skip


def main():
    program, script = (path and str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
    addon = SOURCES
    if "--addon" in sys.argv:
        addon = pathlib.Path(sys.argv[sys.argv.index("--addon") + 1]).resolve()
    words = command(script, "--gui" in sys.argv)
    if words is None:
        print("FreeCAD or xvfb-run is not installed")
        return 77
    with tempfile.TemporaryDirectory(prefix="collarmesh-freecad-") as home:
        variables = environment(home, program, addon)
        variables["COLLARMESH_TEST_ARGUMENT"] = sys.argv[-1] if "--" in sys.argv else ""
        code = subprocess.run(words, stdin=subprocess.DEVNULL, env=variables, timeout=SECONDS).returncode
        if code == 0 and "--gui" in sys.argv:  # FreeCAD exits with 0 whatever happened
            code = verdict(pathlib.Path(variables["COLLARMESH_TEST_RESULT"]))
        return code


def verdict(result):
    """Returns the exit code for the result that a script in the window leaves behind."""
    text = result.read_text(encoding="utf-8") if result.exists() else "FreeCAD ended without a verdict"
    print(text)
    return 0 if text == "passed" else 1


if __name__ == "__main__":
    sys.exit(main())
