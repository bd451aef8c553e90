"""The part of the panel that starts and cancels runs, and shows their progress."""

import math

from PySide import QtCore, QtGui

from . import widgets
from .numbers_typed import grouped
from .size_presets import duration_text
from .translations import translate


class RunSection(QtGui.QWidget):
    """A form with buttons and progress. Emits `run_clicked` and `cancel_clicked`."""

    run_clicked = QtCore.Signal()
    cancel_clicked = QtCore.Signal()

    def __init__(self):
        super().__init__()
        self.question = widgets.label("collarmesh_question")
        self.run = widgets.button("collarmesh_run", "", self.run_clicked)
        self.run.setDefault(True)
        self.cancel = widgets.button("collarmesh_cancel", translate("collarmesh", "Stop"), self.cancel_clicked,
                                     translate("collarmesh", "End the run; the mesh stays as it is"))
        self.bar = QtGui.QProgressBar()
        self.bar.setObjectName("collarmesh_progress")
        self.bar.setRange(0, 1000)
        self.left = QtGui.QLabel()
        self.left.setObjectName("collarmesh_left")
        buttons = QtGui.QHBoxLayout()
        buttons.addWidget(self.run)
        buttons.addWidget(self.cancel)
        widgets.stack(self, self.question, buttons, self.bar, self.left)
        self.rest()

    def ask(self, text, answer=""):
        """Asks a question. The button then shows the answer; another click on it confirms."""
        self.question.setText(text)
        self.question.show()
        self.run.setText(answer or translate("collarmesh", "Mesh all the same"))

    def asked(self):
        """Returns the current question; "" if there is none."""
        return self.question.text()

    def withdraw(self):
        """Withdraws the question."""
        self.question.clear()
        self.question.hide()
        self.run.setText(translate("collarmesh", "Mesh"))

    def rest(self):
        """Shows that no run is in progress."""
        self.withdraw()
        self.run.setEnabled(True)
        self.cancel.setEnabled(False)
        self.bar.hide()
        self.left.hide()

    def begin(self, time_left):
        """Shows that a run has begun. `time_left`: a TimeLeft."""
        self.withdraw()
        self.run.setEnabled(False)
        self.cancel.setEnabled(True)
        self.bar.setValue(0)
        self.bar.setFormat("%p%")
        self._time_left = time_left
        self.left.setText("")
        self.bar.show()
        self.left.show()

    def advance(self, progress, seconds):
        """Shows the progress; `seconds` have passed since the start."""
        self.bar.setValue(int(1000 * progress.fraction))
        self.bar.setFormat(phase_text(progress.phase) + " %p%")
        left = self._time_left.seconds(seconds, progress.fraction)
        words = []
        if progress.tets:
            words.append(translate("collarmesh", "{tets} elements so far").format(tets=grouped(progress.tets)))
        if left == math.inf:
            words.append(translate("collarmesh", "it takes longer than was estimated"))
        elif left is not None:
            words.append(translate("collarmesh", "about {time} left").format(time=duration_text(left)))
        self.left.setText(", ".join(words))


def phase_text(phase):
    """Translates the program's name of a stage into plain words."""
    return {
        "read": translate("collarmesh", "reading the shape"),
        "repair": translate("collarmesh", "repairing"),
        "complex": translate("collarmesh", "faces and edges"),
        "refine": translate("collarmesh", "making elements"),
        "remesh": translate("collarmesh", "adapting"),
        "tetrahedralize": translate("collarmesh", "making elements"),
        "coarsen": translate("collarmesh", "coarsening"),
        "improve": translate("collarmesh", "improving"),
        "project": translate("collarmesh", "onto the exact faces"),
        "second order": translate("collarmesh", "second order"),
        "layers": translate("collarmesh", "boundary layers"),
        "check": translate("collarmesh", "checking"),
        "write": translate("collarmesh", "writing"),
        "load": translate("collarmesh", "loading the mesh"),
    }.get(phase, phase)
