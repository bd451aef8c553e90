"""How many elements sizes will make, and how long that takes, asked of the program before meshing."""

import json
import os
import pathlib

from PySide import QtCore

from . import compatibility, inputs, mesh_properties, preferences, processes, up_to_date
from .program import find_program
from .work_folder import WorkFolder

WAIT = 400  # milliseconds after the last change
COUNTING = {"--size-min", "--elements-per-circle", "--elements-across-gap", "--gradation", "--region-size",
            "--patch-size", "--curve-size", "--distance", "--order", "--planar-tolerance", "--weld", "--repair",
            "--repair-tolerance", "--crease-angle"}


class Predictions(QtCore.QObject):
    """Asks in a process of its own, a moment after the last `ask`. Where the program does not know, nothing is told."""

    made = QtCore.Signal(object)  # {asked size in mm: (number of tetrahedra, seconds)}
    partly_made = QtCore.Signal(object)  # the same, while the others are asked for: each may take seconds

    def __init__(self, obj, parent=None):
        super().__init__(parent)
        self.object = obj
        self._folder = None  # with the shape, once it is needed
        self._shape = ""  # its path
        self._shape_numbers = []  # see up_to_date
        self._arguments, self._size_field, self._sizes = (), "", ()  # what is asked for
        self._process = None
        self._known = {}  # {(arguments, size field, size): (number of tetrahedra, seconds)}
        self._timer = QtCore.QTimer(self, singleShot=True, interval=WAIT)
        self._timer.timeout.connect(self._begin)

    def ask(self, settings, sizes):
        """For the Settings with each of these sizes (mm), the first ones first; returns the answers that are known
        already. Of meshes that are not coarsened the program predicts nothing."""
        answers = self.known(settings, sizes)
        if settings.coarsen:
            self._timer.start()
        return answers

    def known(self, settings, sizes):
        """The answers that are known already; nothing is asked of the program."""
        self.pause()
        self._arguments = tuple(_arguments(settings))
        self._size_field = json.dumps(settings.size_field) if settings.size_field else ""
        self._sizes = tuple(dict.fromkeys(sizes)) if settings.coarsen else ()
        return self._answers()

    def pause(self):
        """Until the next `ask`: the processor is for something else."""
        self._timer.stop()
        self._stop()

    def forget(self):
        """The shape has changed."""
        self.pause()
        self._known = {}
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def shape_has_changed(self):
        """Is it another one than the one that the answers are about?"""
        part = compatibility.meshed_object(self.object)
        return self._folder is not None and not up_to_date.has_shape(part, self._shape_numbers)

    def _stop(self):
        process, self._process = self._process, None
        if process is not None and processes.end(process):
            self._folder.program_is(None)

    def _missing(self):
        return [size for size in self._sizes if self._key(size) not in self._known]

    def _key(self, size):
        return self._arguments, self._size_field, size

    def _begin(self):
        missing = self._missing()
        try:
            if missing:
                program = find_program(preferences.program())
                self._write_files()
        except Exception:  # of OpenCASCADE's, too; the run tells what is wrong
            missing = []
        if not missing:
            self._tell()
            return
        sources = ["--size-field", self._size_field_path()] if self._size_field else []
        self._process = process = processes.new()
        process.setStandardErrorFile(QtCore.QProcess.nullDevice())
        process.finished.connect(self._finished)
        arguments = [*self._arguments, *sources, "--predict", repr(missing[0]), "--json"]
        process.start(program, ["info", self._shape, *arguments])
        if process.waitForStarted():
            self._folder.program_is(process.processId())
        else:
            self._stop()
            self._tell()

    def _write_files(self):
        """For the program. Raises MesherError."""
        if self._folder is None:
            part = mesh_properties.part_to_mesh(self.object)
            folder = WorkFolder()
            self._shape = os.path.join(folder.name, inputs.file_name(part))
            try:
                inputs.write(part, self._shape)
                self._shape_numbers = up_to_date.shape_numbers(part)
            except BaseException:
                folder.cleanup()
                raise
            self._folder = folder
        if self._size_field:
            pathlib.Path(self._size_field_path()).write_text(self._size_field, encoding="utf-8")

    def _size_field_path(self):
        return os.path.join(self._folder.name, "sizes.json")

    def _finished(self, exit_code, *_):
        learned = exit_code == 0 and self._learn(bytes(self._process.readAllStandardOutput()))
        self._stop()
        if learned and self._missing():
            self.partly_made.emit(self._answers())
            self._begin()
        else:
            self._tell()

    def _learn(self, answer):
        """False where the program does not know."""
        try:
            found = json.loads(answer)["predictions"][0]
            self._known[self._key(self._missing()[0])] = found["tets"], found["seconds"]
        except (ValueError, KeyError, TypeError, IndexError):
            return False
        return True

    def _answers(self):
        return {size: self._known[self._key(size)] for size in self._sizes if self._key(size) in self._known}

    def _tell(self):
        self.made.emit(self._answers())


def _arguments(settings):
    """Those of the command line that the number of elements depends on, but for the size, which is asked about."""
    arguments = settings.arguments()
    pairs = zip(arguments[::2], arguments[1::2])
    return [word for pair in pairs if pair[0] in COUNTING for word in pair]
