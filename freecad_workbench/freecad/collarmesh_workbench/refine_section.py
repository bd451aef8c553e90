"""The part of the panel that refines the mesh by the error of a result."""

from PySide import QtCore, QtGui

from . import colours, cost, result_refinement, widgets
from .fold import Fold
from .numbers_typed import shown
from .program import MesherError
from .size_presets import count_text
from .translations import translate

LEAST = 10  # elements
PREFERRED_GROWTH = 2  # factor of the number of elements that is proposed


class RefineSection(QtGui.QWidget):
    """A line that unfolds to the estimated error and the fields for the next mesh. Hidden without a result. Emits
    `clicked` when the user asks for a run."""

    clicked = QtCore.Signal()

    def __init__(self, obj):
        super().__init__()
        self.object = obj
        self.plan = self.factors = None
        body = QtGui.QWidget()
        self.fold = Fold(body, translate("collarmesh", "Refine by result"))
        self.fold.setObjectName("collarmesh_refine_fold")
        self.fold.setToolTip(translate("collarmesh",
                                       "Make the mesh finer where the error of the stresses is large, and "
                                       "coarser where it is small"))
        self.fold.toggled.connect(lambda _shown: self.refresh())
        self.note = widgets.label("collarmesh_refine_note")
        self.elements = QtGui.QSpinBox()
        self.elements.setObjectName("collarmesh_refine_elements")
        self.elements.setRange(LEAST, cost.MANY)
        self.elements.setGroupSeparatorShown(True)
        self.elements.setToolTip(translate("collarmesh", "Number of elements to aim for"))
        self.error = QtGui.QDoubleSpinBox()
        self.error.setObjectName("collarmesh_refine_error")
        self.error.setRange(0.01, 100)
        self.error.setDecimals(2)
        self.error.setSuffix(" %")
        self.error.setToolTip(translate("collarmesh", "Error to aim for, relative to the energy norm of the solution"))
        for field, action in ((self.elements, self._for_elements), (self.error, self._for_error)):
            field.setKeyboardTracking(False)
            field.valueChanged.connect(action)
        self.question = widgets.label("collarmesh_refine_question")
        self.button = widgets.button("collarmesh_refine", "", self.clicked)
        rows = QtGui.QFormLayout(body)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addRow(self.note)
        rows.addRow(translate("collarmesh", "Elements"), self.elements)
        rows.addRow(translate("collarmesh", "≈ error"), self.error)
        rows.addRow(self.question)
        rows.addRow(self.button)
        widgets.stack(self, self.fold, body)
        self.refresh()

    def unfold(self):
        self.fold.setChecked(True)

    def refresh(self, busy=False):
        """Looks at the mesh and its result again. `busy`: a run is in progress."""
        self.setVisible(result_refinement.is_possible(self.object))
        self.plan = None
        self._withdraw()
        if not self.isHidden() and self.fold.isChecked() and not busy:
            self._estimate()
        for widget in (self.elements, self.error, self.button):
            widget.setEnabled(self.plan is not None)

    def _estimate(self):
        QtGui.QApplication.setOverrideCursor(QtCore.Qt.WaitCursor)
        try:
            self.plan = result_refinement.plan(self.object)
        except MesherError as error:
            self.note.setText(f'<span style="{colours.css(colours.CARE)}">{error}</span>')
            return
        finally:
            QtGui.QApplication.restoreOverrideCursor()
        text = translate(
            "collarmesh", "{label}: estimated error {error} % of the energy norm, with {elements} elements")
        count = len(self.plan.solution.tets)
        self.note.setText(text.format(label=self.plan.label, error=_percent(self.plan.errors.relative),
                                      elements=count_text(count)))
        _put(self.elements, PREFERRED_GROWTH * count)
        self._for_elements(self.elements.value())

    def _for_elements(self, value):
        self._withdraw()
        if self.plan is not None:
            self.factors = self.plan.sizes.for_elements(value)
            _put(self.error, 100 * self.plan.sizes.error(self.factors))

    def _for_error(self, value):
        self._withdraw()
        if self.plan is not None:
            self.factors = self.plan.sizes.for_error(value / 100)
            _put(self.elements, round(self.plan.sizes.count(self.factors)))

    def asks(self):
        """Shows a question if one must be answered before an expensive run; another click confirms. Returns whether a
        question was shown."""
        question = "" if self.question.text() else cost.question(self.plan.sizes.count(self.factors),
                                                                 self.plan.solution.order)
        if question:
            self.question.setText(question)
            self.question.show()
            self.button.setText(translate("collarmesh", "Refine all the same"))
        return bool(question)

    def _withdraw(self):
        self.question.clear()
        self.question.hide()
        self.button.setText(translate("collarmesh", "Refine"))

    def prepare(self, obj):
        """Returns the Job that the fields ask for. Raises MesherError."""
        return result_refinement.start(obj, self.plan, self.factors)


def _put(field, value):
    """Shows a value without emitting the signals of the field."""
    field.blockSignals(True)
    field.setValue(value)
    field.blockSignals(False)


def _percent(share):
    return shown(f"{100 * share:.3g}")
