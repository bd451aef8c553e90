"""Predicts with the program, before meshing, how many elements each size makes and how long that takes."""

import collections
import contextlib
import dataclasses
import json
import os
import pathlib

from PySide import QtCore

from . import compatibility, contacts, inputs, mesh_properties, preferences, processes, up_to_date
from .option_table import OPTIONS
from .program import find_program
from .work_folder import WorkFolder

WAIT = 400  # milliseconds after the last change
COUNTING = {"--region-size", "--patch-size", "--curve-size",
            *("--" + name.replace("_", "-") for name, option in OPTIONS.items() if option.counts)}
SHAPES = 50  # number of shapes whose answers are kept

_answers = collections.deque(maxlen=SHAPES)  # (numbers of a shape, {(arguments, size field, size): answer})


def _answers_for(numbers):
    """Returns the answers for the shape with these numbers (see up_to_date). The answers for the last SHAPES shapes are
    kept while FreeCAD runs."""
    for known_numbers, answers in _answers:
        if up_to_date.same_shape(known_numbers, numbers):
            return answers
    _answers.append((numbers, {}))
    return _answers[-1][1]


class Predictions(QtCore.QObject):
    """A predictor that runs the program in a separate process, a moment after the last `ask`. If the program makes no
    prediction for a size, the answers lack it."""

    made = QtCore.Signal(object)  # all known answers: {asked size in mm: (number of tetrahedra, seconds)}

    def __init__(self, obj, parent=None):
        super().__init__(parent)
        self.object = obj
        self._folder = None  # created when needed; contains the shape
        self._shape = ""  # path of the shape's file
        self._numbers = None  # numbers that identify the shape; None: not computed
        self._known = {}  # known answers for the shape
        self._arguments, self._size_field, self._sizes = (), "", ()  # the current question
        self._process = None
        self._timer = QtCore.QTimer(self, singleShot=True)
        self._timer.timeout.connect(self._begin)

    def ask(self, settings, sizes, wait=WAIT):
        """Asks for predictions for the Settings with each of these sizes (mm), after `wait` milliseconds. Returns the
        answers that are known already. Asks nothing for meshes that are not coarsened, for which the program makes no
        predictions."""
        answers = self.known(settings, sizes)
        if settings.coarsen:
            self._timer.start(wait)
        return answers

    def known(self, settings, sizes):
        """Returns the known answers without running the program."""
        self.pause()
        self._look_at_shape()
        settings = self._in_mesh_numbers(settings)
        self._arguments = tuple(_arguments(settings))
        self._size_field = json.dumps(settings.size_field) if settings.size_field else ""
        sizes = [size for size in sizes if size >= settings.size_min]  # the program rejects sizes below size_min
        self._sizes = tuple(dict.fromkeys(sizes)) if settings.coarsen else ()
        return self._told()

    def pause(self):
        """Pauses until the next `ask`, to free the processor."""
        self._timer.stop()
        self._stop()

    def forget(self):
        """Forgets all answers, because the shape has changed or the panel is closed."""
        self.pause()
        self._numbers, self._known = None, {}
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def is_asking(self):
        """Returns whether more answers may come without another `ask`."""
        return self._process is not None

    def shape_has_changed(self):
        """Returns whether the shape differs from the one that the answers are for."""
        part = compatibility.meshed_object(self.object)
        return self._numbers is not None and not up_to_date.has_shape(part, self._numbers)

    def _look_at_shape(self):
        """Looks at the shape and uses the known answers for it, including those made for another panel."""
        if self._numbers is None:
            try:
                self._numbers = up_to_date.shape_numbers(mesh_properties.part_to_mesh(self.object))
                self._known = _answers_for(self._numbers)
            except Exception:  # OpenCASCADE's exceptions, too; the run reports the problem
                self._known = {}

    def _in_mesh_numbers(self, settings):
        try:
            return contacts.in_mesh_numbers(settings, inputs.shape_of(compatibility.meshed_object(self.object)))
        except Exception:  # OpenCASCADE's exceptions, too; the run reports the problem
            return settings

    def _stop(self):
        process, self._process = self._process, None
        if process is not None and processes.end(process):
            self._folder.program_is(None)

    def _key(self, size):
        return self._arguments, self._size_field, size

    def _begin(self):
        asked = [size for size in self._sizes if self._key(size) not in self._known]
        try:
            if asked:
                program = find_program(preferences.program())
                self._write_files()
        except Exception:  # OpenCASCADE's exceptions, too; the run reports the problem
            asked = []
        if not asked:
            self._tell()
            return
        sources = ["--size-field", self._size_field_path()] if self._size_field else []
        self._process = process = processes.new()
        process.setReadChannel(QtCore.QProcess.StandardError)
        process.setStandardOutputFile(QtCore.QProcess.nullDevice())
        process.readyReadStandardError.connect(self._read)
        process.finished.connect(self._finished)
        sizes = ",".join(map(repr, asked))
        process.start(program, ["info", self._shape, *self._arguments, *sources, "--predict", sizes,
                                "--progress", "json"])
        if process.waitForStarted():
            self._folder.program_is(process.processId())
        else:
            self._stop()
            self._tell()

    def _write_files(self):
        """Writes the program's input. Raises MesherError."""
        if self._folder is None:
            part = mesh_properties.part_to_mesh(self.object)
            folder = WorkFolder()
            self._shape = os.path.join(folder.name, inputs.file_name(part))
            try:
                inputs.write(part, self._shape)
            except BaseException:
                folder.cleanup()
                raise
            self._folder = folder
        if self._size_field:
            pathlib.Path(self._size_field_path()).write_text(self._size_field, encoding="utf-8")

    def _size_field_path(self):
        return os.path.join(self._folder.name, "sizes.json")

    def _read(self):
        """Reads output. The program writes the prediction for each size as soon as it is known."""
        known = len(self._known)
        while self._process.canReadLine():
            self._learn(bytes(self._process.readLine()))
        if len(self._known) > known:
            self._tell()

    def _finished(self, *_):
        self._read()
        self._stop()
        self._tell()

    def _learn(self, line):
        """Records a prediction from a line of the program's output; ignores other lines."""
        with contextlib.suppress(ValueError, KeyError, TypeError):
            made = json.loads(line)["prediction"]
            self._known[self._key(made["size"])] = made["tets"], made["seconds"]

    def _told(self):
        return {size: self._known[self._key(size)] for size in self._sizes if self._key(size) in self._known}

    def _tell(self):
        self.made.emit(self._told())


def _arguments(settings):
    """Returns the options that affect the number of elements, except the size."""
    without_flags = dataclasses.replace(settings, keep_apart=False, interior_node=False, layers_tets=False)
    arguments = without_flags.arguments()  # pairs of option and value
    pairs = zip(arguments[::2], arguments[1::2])
    return [word for pair in pairs if pair[0] in COUNTING for word in pair]
