"""How many elements sizes will make, and how long that takes, asked of the program before meshing."""

import json

from PySide import QtCore

from . import mesh_object
from .program import MesherError

WAIT = 400  # milliseconds after the last change
COUNTING = {"--size-min", "--elements-per-circle", "--elements-across-gap", "--gradation", "--region-size",
            "--patch-size", "--curve-size", "--distance", "--order", "--planar-tolerance", "--weld", "--repair",
            "--repair-tolerance", "--crease-angle"}  # fmt: skip


class Predictions(QtCore.QObject):
    """Asks in a process of its own, a moment after the last `ask`. Where the program does not know, nothing is told."""

    made = QtCore.Signal(object)  # {asked size in mm: (number of tetrahedra, seconds)}
    partly_made = QtCore.Signal(object)  # the same, while the others are asked for: each may take seconds

    def __init__(self, obj, parent=None):
        super().__init__(parent)
        self.object = obj
        self._job = None  # never run, it has the shape
        self._question = None
        self._process = None
        self._known = {}
        self._timer = QtCore.QTimer(self, singleShot=True, interval=WAIT)
        self._timer.timeout.connect(self._begin)

    def ask(self, settings, sizes):
        """For the Settings with each of these sizes (mm), the first ones first; returns the answers that are known
        already."""
        self._question = tuple(_arguments(settings)), tuple(dict.fromkeys(sizes))
        self.pause()
        self._timer.start()
        return self._answers()

    def pause(self):
        """Until the next `ask`: the processor is for something else."""
        self._timer.stop()
        self._stop()

    def forget(self):
        """The shape has changed."""
        self.pause()
        self._known = {}
        if self._job is not None:
            self._job.folder.cleanup()
            self._job = None

    def _stop(self):
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.waitForFinished(1000)
            process.deleteLater()

    def _missing(self):
        arguments, sizes = self._question
        return [size for size in sizes if (arguments, size) not in self._known]

    def _begin(self):
        missing = self._missing()
        try:
            if missing and self._job is None:
                self._job = mesh_object.start(self.object)
        except MesherError:
            missing = []
        if not missing:
            self._tell()
            return
        program, shape = self._job.command[:2]
        self._process = process = QtCore.QProcess(self)
        process.setStandardInputFile(QtCore.QProcess.nullDevice())
        process.setStandardErrorFile(QtCore.QProcess.nullDevice())
        process.finished.connect(lambda exit_code, *_: self._finished(process, exit_code))
        process.start(program, ["info", shape, *self._question[0], *self._size_field(), "--predict", repr(missing[0]), "--json"])
        if process.waitForStarted():
            self._job.folder.program_is(process.processId())

    def _size_field(self):
        command = self._job.command
        return command[at : at + 2] if (at := _position(command, "--size-field")) >= 0 else []

    def _finished(self, process, exit_code):
        if process is not self._process:  # its answer is no longer asked for
            return
        self._process = None
        self._job.folder.program_is(None)
        learned = exit_code == 0 and self._learn(bytes(process.readAllStandardOutput()))
        process.deleteLater()
        if learned and self._missing():
            self.partly_made.emit(self._answers())
            self._begin()
        else:
            self._tell()

    def _learn(self, answer):
        """False where the program does not know."""
        try:
            found = json.loads(answer)["predictions"][0]
            self._known[self._question[0], self._missing()[0]] = found["tets"], found["seconds"]
        except (ValueError, KeyError, TypeError, IndexError):
            return False
        return True

    def _answers(self):
        arguments, sizes = self._question
        return {size: self._known[arguments, size] for size in sizes if (arguments, size) in self._known}

    def _tell(self):
        self.made.emit(self._answers())


def _arguments(settings):
    """Those of the command line that the number of elements depends on, but for the size, which is asked about."""
    arguments = settings.arguments()
    pairs = zip(arguments[::2], arguments[1::2])
    return [word for pair in pairs if pair[0] in COUNTING for word in pair]


def _position(words, word):
    return words.index(word) if word in words else -1
