"""The collarmesh program as a process. This module knows nothing about FreeCAD's documents."""

import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess

from . import size_file, subshape_words
from .option_table import OPTIONS
from .translations import translate
from .work_folder import WorkFolder

GUARANTEE_MISSED = 7  # exit code if the mesh misses a guarantee; a usable mesh is written all the same
# Names of settings: sizes, which no longer hold when a mesh is adapted to other sizes, and settings that still hold.
SIZES = ("size", "size_min", "elements_across_gap", "gradation",
         "solid_sizes", "face_sizes", "edge_sizes", "size_field")
OF_ADAPTING = ("elements_per_circle", "radius_edge", "distance", "planar_tolerance", "min_dihedral", "time_limit",
               "improve", "order")
OF_THEIR_OWN = ("improve", "order", "dimension")  # options with numbers that `arguments` treats individually
DEFAULTS = {"order": 2, "dimension": 0}  # defaults that differ from the program's


class MesherError(RuntimeError):
    """A fault of the input or of the program, with its place and a remedy."""

    def __init__(self, text, /, **values):
        """`values` replace their names in braces in the text."""
        super().__init__(text.format(**values) if values else text)


class Cancelled(MesherError):
    """Raised if the caller cancelled the run."""


def _field(name, option):
    """Returns the field of Settings for an option."""
    default = DEFAULTS.get(name, option.default)
    field = dataclasses.field(default_factory=list) if option.type is list else dataclasses.field(default=default)
    return name, option.type, field


@dataclasses.dataclass
class Settings(dataclasses.make_dataclass("OfProgram", [_field(*item) for item in OPTIONS.items()])):
    """The options for the program (option_table), and settings that only the add-on has. Lengths are in millimetres,
    and sizes are target edge lengths; 0 lets the program choose the value. Dimension 0 means the dimension of the
    shape. `split` and `periodic` name faces as "Face7" and "Face1=Face2". Sizes by sub-shape have FreeCAD's numbers as
    keys: {7: 0.5} in `face_sizes` is Face7."""

    fill_holes: bool = False  # fill holes of open surfaces; otherwise such surfaces are rejected
    solid_sizes: dict = dataclasses.field(default_factory=dict)
    face_sizes: dict = dataclasses.field(default_factory=dict)
    edge_sizes: dict = dataclasses.field(default_factory=dict)
    size_field: dict = None  # sizes by place: sources as in mesher/doc/sizes.md

    def for_adapting(self):
        """Returns the settings that still hold when a mesh is adapted to other sizes. None if a setting that is not at
        its default only takes effect when the shape is meshed anew."""
        without = dataclasses.replace(self, **{name: getattr(Settings(), name) for name in (*SIZES, "seed")})
        kept = Settings(**{name: getattr(self, name) for name in OF_ADAPTING})
        return kept if kept == dataclasses.replace(without, dimension=0) else None

    @classmethod
    def numbers(cls):
        """Returns the fields that are options with a number."""
        return [field for field in dataclasses.fields(cls)
                if field.type in (int, float) and field.name not in OF_THEIR_OWN]

    def arguments(self):
        """Returns arguments for the command line."""
        arguments = []
        for field in self.numbers():
            value = getattr(self, field.name)
            if value and value != field.default:
                arguments += ["--" + field.name.replace("_", "-"), repr(field.type(value))]
        arguments += ["--improve", str(int(self.improve))]
        if not self.coarsen:
            arguments += ["--coarsen", "off"]
        if self.order != 1:
            arguments += ["--order", str(self.order)]
        if self.dimension in (1, 2):
            arguments += ["--dimension", str(self.dimension)]
        if self.repair != "auto":
            arguments += ["--repair", self.repair]
        if self.keep_apart:
            arguments.append("--keep-apart")
        if self.interior_node:
            arguments.append("--interior-node")
        if self.layers and self.layers_tets:
            arguments.append("--layers-tets")
        for option, words in (("split", self.split), ("periodic", self.periodic), ("layers", self.layers)):
            for word in words:
                arguments += [f"--{option}", word]
        for option, sizes in (("region", self.solid_sizes), ("patch", self.face_sizes), ("curve", self.edge_sizes)):
            for number, size in sorted(sizes.items()):
                arguments += [f"--{option}-size", f"{number}={float(size)!r}"]
        return arguments


def find_program(preferred=""):
    """Returns the path of the program: `preferred` or the environment variable COLLARMESH_PROGRAM, if one is given;
    else the first that exists of the program inside the add-on, on the PATH, built from the sources around the add-on,
    or installed with it. Raises MesherError if there is none."""
    for candidate in (preferred, os.environ.get("COLLARMESH_PROGRAM", "")):
        if candidate:
            if shutil.which(candidate):
                return shutil.which(candidate)
            raise MesherError(
                translate("collarmesh", "The mesher {path} is no program; correct its path in the preferences."),
                path=candidate)
    addon = pathlib.Path(__file__).resolve().parents[2]
    candidates = [addon / "bin" / "collarmesh", "collarmesh", addon.parent / "build" / "release" / "bin" / "collarmesh"]
    # An installed add-on is in WHERE/share/freecad/Mod/collarmesh, and the program in WHERE/bin.
    if len(addon.parents) > 3:
        candidates.append(addon.parents[3] / "bin" / "collarmesh")
    for candidate in map(str, candidates):
        if shutil.which(candidate):
            return shutil.which(candidate)
    raise MesherError(translate("collarmesh", "The program collarmesh is not found: install it so that it is on the "
                                              "PATH, or name its path in the preferences."))


@dataclasses.dataclass
class Progress:
    phase: str
    fraction: float  # share of the whole run, 0 to 1
    tets: int


def parse_line(line):
    """Parses a line of the program's standard error: returns a Progress, or the line if it is a message."""
    if line.startswith("{"):
        try:
            values = json.loads(line)
            return Progress(values["phase"], values["fraction"], values["tets"])
        except (ValueError, KeyError):
            pass
    return line.rstrip("\n")


def as_warning(line):
    """Returns a line as a warning if it is a message on the input or its repair; None for other lines."""
    if line.startswith("repaired: "):
        return "warning: the shape was repaired: " + line.removeprefix("repaired: ")
    return line if line.startswith("warning: ") else None


class Job:
    """One run. Its folder, with the shape, the mesh and the report, is removed at the end."""

    def __init__(self, settings, program="", threads=0, input_name="shape.brep", adapts=False):
        """`threads`: largest number of threads, 0: one per core; `input_name`: name of the file `self.shape`, which the
        caller writes; `adapts`: whether the run, in place of meshing the shape, adapts the mesh in `self.before`, which
        the caller writes, too; the settings must then come from `for_adapting()`."""
        self.folder = WorkFolder()
        self.shape = os.path.join(self.folder.name, input_name)
        self.before = os.path.join(self.folder.name, "before.unv")
        self.mesh = os.path.join(self.folder.name, "mesh.unv")
        self._report = os.path.join(self.folder.name, "report.json")
        task = ["remesh", self.before, "--against", self.shape] if adapts else [self.shape]
        self.command = [find_program(program), *task, "-o", self.mesh, "--report", self._report,
                        "--progress", "json", "--threads", str(threads), *settings.arguments()]
        if settings.size_field:
            path = os.path.join(self.folder.name, "sizes.json")
            pathlib.Path(path).write_text(json.dumps(settings.size_field), encoding="utf-8")
            self.command += ["--size-field", path]
        self.messages = []
        self.explain = lambda text: text  # rewrites the program's messages in the caller's terms
        self.names = None  # names of faces, edges and solids by their numbers in the mesh; None: the input has none

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.folder.cleanup()

    def use_sizes(self, points, tets, lengths):
        """Gives the program target edge lengths at the points of a mesh."""
        path = os.path.join(self.folder.name, "sizes.vtu")
        size_file.write(path, points, tets, lengths)
        self.command += ["--size-field", path]

    def heard(self, line):
        """Handles a line of standard error; returns the Progress if it is one."""
        said = parse_line(line)
        if isinstance(said, Progress):
            return said
        if said.strip():
            self.messages.append(self._for_people(said))
        return None

    def _for_people(self, text):
        """Rewrites a message with the names of faces, and without the folder's path, because the folder no longer
        exists when the message is read."""
        text = subshape_words.in_names(text, self.names) if self.names else text
        text = text.replace(self.shape, "the shape").replace(self.folder.name + os.sep, "")
        return re.sub(r"(^|^collarmesh: |\. )the shape\b", r"\1The shape", text)

    def warnings(self):
        """Returns messages about the shape for the user, with places, one line each."""
        return [warning for warning in map(as_warning, self.messages) if warning]

    def require_success(self, exit_code):
        """Raises MesherError unless there is a mesh."""
        if exit_code in (0, GUARANTEE_MISSED) and os.path.exists(self.mesh):
            return
        said = "\n".join(self.messages).removeprefix("collarmesh: ")
        nothing = translate("collarmesh", "The mesher ended with exit code {code} and without a message.")
        raise MesherError(self.explain(said) or nothing.format(code=exit_code))

    def report(self):
        """Returns the program's report (README.md, --report)."""
        with open(self._report, encoding="utf-8") as file:
            report = json.load(file)
        report["notes"] = [self._for_people(note) for note in report["notes"]]
        if self.names:
            subshape_words.report_in_names(report, self.names)
        return report

    def add_page(self):
        """Makes the program write the report as a page, too."""
        self._page = os.path.join(self.folder.name, "report.html")
        self.command += ["--report", self._page]

    def move_page(self, path, name):
        """Moves the report's page to a permanent place. `name`: the shape's name on the page."""
        with open(self._page, encoding="utf-8") as page:
            text = page.read().replace(self.shape, _in_page(name)).replace(self.folder.name + os.sep, "")
        with open(path, "w", encoding="utf-8") as moved:
            moved.write(text)

    def run(self, progress=None):
        """Runs the program and waits. Returns the exit code. `progress(Progress)` may return False to cancel.
        Raises MesherError."""
        try:
            with subprocess.Popen(self.command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.PIPE, text=True, errors="replace") as process:
                self.folder.program_is(process.pid)
                try:
                    for line in process.stderr:
                        step = self.heard(line)
                        if step and progress and progress(step) is False:
                            raise Cancelled(translate("collarmesh", "The mesher was cancelled."))
                except BaseException:
                    process.kill()
                    raise
        finally:
            self.folder.program_is(None)
        self.require_success(process.returncode)
        return process.returncode


def _in_page(name):
    """Returns a name as it appears in the report's page: in a JSON string inside a script."""
    return json.dumps(name)[1:-1].replace("<", "\\u003c")
