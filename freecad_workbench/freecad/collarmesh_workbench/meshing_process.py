"""Runs of the mesher beside FreeCAD's window: one process for each mesh object, whether its panel is open or
not.
An object's mesh is replaced only when a run has succeeded. A run is killed when its object is deleted, when
its document is closed, and when FreeCAD ends."""

import contextlib
import dataclasses
import os
import traceback

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

from . import compatibility, elements, mesh_object, mesh_undo, processes, up_to_date
from .later import later
from .objects import key_of
from .program import MesherError, Progress
from .time_left import TimeLeft
from .translations import translate

WAIT = 200  # milliseconds until a run that has ended checks again whether its mesh can be put in place
_runs = {}  # runs in progress, by (document, object)
_outcomes = {}  # outcomes of the last runs


@dataclasses.dataclass
class Outcome:
    """The result of a run."""

    report: dict = None  # None: no mesh
    error: str = ""
    cancelled: bool = False
    page: str = ""  # path of the report's HTML page; empty: none
    part_changed: bool = False  # whether the part changed during meshing
    warnings: tuple = ()  # warnings about the shape, from before the run
    mesh_number: int = 0  # see mesh_undo


def run_of(obj):
    """Returns the run in progress, else None."""
    return _runs.get(key_of(obj))


def outcome_of(obj):
    """Returns the outcome of the object's last run since its document was opened. None without such a run, or if the
    object now has another mesh, for example after undo."""
    outcome = _outcomes.get(key_of(obj))
    if outcome is None or outcome.report is None:
        return outcome
    is_there = elements.is_there(obj.FemMesh) and getattr(obj, mesh_undo.NUMBER) == outcome.mesh_number
    return outcome if is_there else None


def start(obj, time_left=None, prepare=mesh_object.start):
    """Begins a run of the Job that `prepare(obj)` returns, unless the object has a run already. `time_left` is a
    TimeLeft, if there is an estimate. Returns the object's run. Raises MesherError."""
    if run_of(obj) is None:
        _runs[key_of(obj)] = MeshingProcess(obj, time_left, prepare)
    return run_of(obj)


class MeshingProcess(QtCore.QObject):
    advanced = QtCore.Signal(object)  # a Progress
    ended = QtCore.Signal()  # the outcome is available

    def __init__(self, obj, time_left, prepare):
        super().__init__()
        self.object = obj
        part = compatibility.meshed_object(obj)
        self.label = part.Label if part else ""
        self.job = prepare(obj)
        if self.job.dimension == 3:  # the page is about tetrahedra
            self.job.add_page()
        self.warnings = tuple(self.job.warnings())
        self.progress = None
        self.time_left = time_left or TimeLeft()
        self._cancelled = self._abandoned = False
        self.clock = QtCore.QElapsedTimer()
        self.clock.start()
        self._process = processes.new()
        self._process.setReadChannel(QtCore.QProcess.StandardError)
        self._process.readyReadStandardError.connect(self._read)
        self._process.finished.connect(self._finished)
        self._process.start(self.job.command[0], self.job.command[1:])
        if not self._process.waitForStarted():
            self.job.folder.cleanup()
            error = MesherError(translate("collarmesh", "{program} cannot be started: {error}"),
                                program=self.job.command[0], error=self._process.errorString())
            processes.end(self._process)
            raise error
        self.job.folder.program_is(self._process.processId())

    def cancel(self):
        self._cancelled = True
        self._process.kill()

    def abandon(self):
        """Ends the run at once, without an outcome: nothing is left that could use it."""
        self._abandoned = True
        if processes.end(self._process):
            self.job.folder.program_is(None)
        self.job.folder.cleanup()
        self.ended.emit()

    def seconds(self):
        return self.clock.elapsed() / 1000

    def _read(self):
        while self._process.canReadLine():
            step = self.job.heard(bytes(self._process.readLine()).decode(errors="replace"))
            if step:
                self.progress = step
                self.advanced.emit(step)

    def _finished(self, exit_code, *_):
        self.job.folder.program_is(None)
        self._read()
        self.progress = Progress("load", 1, self.progress.tets if self.progress else 0)
        self.advanced.emit(self.progress)
        later(lambda: self._end(exit_code), 20)  # after the window has been redrawn

    def _end(self, exit_code):
        if self._abandoned:
            return
        if self._something_else_is_edited():
            text = translate("collarmesh", "{object}: the mesh is made and shows when the other panel is closed")
            _say(text.format(object=self.object.Label), 5 * WAIT)
            later(lambda: self._end(exit_code), WAIT)
            return
        key = key_of(self.object)
        try:
            outcome = self._outcome(exit_code)
        except Exception as error:  # exceptions of FreeCAD; the panel continues
            FreeCAD.Console.PrintError(traceback.format_exc())
            outcome = Outcome(error=f"{type(error).__name__}: {error}")
        _outcomes[key] = outcome
        del _runs[key]
        self.job.folder.cleanup()
        processes.end(self._process)
        _tell(self.object, outcome)
        if outcome.report is not None:
            self.object.ViewObject.Proxy.show_in_place_of_part()
        self.ended.emit()

    def _outcome(self, exit_code):
        if self._cancelled:
            return Outcome(cancelled=True)
        if compatibility.meshed_object(self.object) is None:
            return Outcome(error=translate("collarmesh", "The part was deleted while it was meshed."))
        try:
            report = mesh_object.finish(self.object, self.job, exit_code)
        except MesherError as error:
            return Outcome(error=str(error))
        outcome = Outcome(report=report, warnings=self.warnings, mesh_number=getattr(self.object, mesh_undo.NUMBER))
        part = compatibility.meshed_object(self.object)
        outcome.part_changed = not up_to_date.has_shape(part, self.job.state.shape)
        with _told_in_report_view():
            self.object.Document.recompute()
        if self.job.dimension < 3:
            return outcome
        page = os.path.join(self.object.Document.TransientDir, f"{self.object.Name}_report.html")
        with _told_in_report_view():
            self.job.move_page(page, self.label)
            outcome.page = page
        return outcome

    def _something_else_is_edited(self):
        """Returns whether another object is being edited in an undo step that is still open, so that "Cancel"
        can undo it. Putting a mesh in place would end that step."""
        document = self.object.Document
        if not document.HasPendingTransaction:
            return False
        edited = FreeCADGui.getDocument(document.Name).getInEdit()
        return edited is not None and edited.Object is not self.object


@contextlib.contextmanager
def _told_in_report_view():
    """Reports failures after meshing in the report view, because they do not affect the finished mesh."""
    try:
        yield
    except Exception:
        FreeCAD.Console.PrintError(traceback.format_exc())


def _tell(obj, outcome):
    """Shows in the status bar whether the mesh was made; needed if the panel is closed."""
    text = translate("collarmesh", "{object}: the mesh is made")
    if outcome.report is None:
        text = translate("collarmesh", "{object}: no new mesh is made")
    _say(text.format(object=obj.Label), 10000)


def _say(text, milliseconds):
    """Shows a text in the status bar."""
    FreeCADGui.getMainWindow().statusBar().showMessage(text, milliseconds)


class _Observer:
    def slotDeletedObject(self, deleted):
        _forget(lambda key: key == key_of(deleted))

    def slotDeletedDocument(self, document):
        _forget(lambda key: key[0] == document.Name)


def _forget(condition):
    for key in [key for key in _runs if condition(key)]:
        _runs.pop(key).abandon()
    for key in [key for key in _outcomes if condition(key)]:
        del _outcomes[key]


def _abandon_all():
    with contextlib.suppress(RuntimeError):  # Qt's objects may no longer exist
        _forget(lambda _key: True)


def observe():
    FreeCAD.addDocumentObserver(_Observer())
    QtGui.QApplication.instance().aboutToQuit.connect(_abandon_all)
