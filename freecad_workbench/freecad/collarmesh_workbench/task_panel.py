"""The panel that makes a mesh: settings, run and result."""

import contextlib

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

from . import (colours, compatibility, constraint_faces, constraint_faces_view, cost, dock, elements, extent,
               mesh_properties, meshing_process, new_mesh, open_shape, places, prediction, up_to_date, views, widgets,
               worst_elements)
from .advanced_section import AdvancedSection, in_panel_words
from .contacts_section import ContactsSection
from .dimension_section import DimensionSection
from .later import later
from .objects import key_of
from .order_section import OrderSection
from .places_list import PlacesList
from .program import MesherError
from .refine_section import RefineSection
from .result_section import ResultSection
from .run_section import RunSection
from .size_preview import SizePreview
from .size_section import SizeSection
from .time_left import TimeLeft
from .translations import translate
from .view_marks import ViewMarks

WIDTH = 400  # pixels
MOMENT = 100  # milliseconds; a part that is being dragged changes again within this time
WHAT_IS_MESHED = ("Shape", "Placement", "Mesh", "LinkPlacement")  # properties that hold geometry


class MeshTaskPanel:
    """The panel of a mesh object. It shows the object's run, which continues when the panel is closed."""

    def __init__(self, obj):
        self.object = obj
        self.run = None
        self.outcome = None  # the outcome that is shown
        self.known = {}  # known predictions
        self.marks = ViewMarks(obj)
        self._build()
        self.predictions = prediction.Predictions(obj)
        self.predictions.made.connect(self._show_made)
        for section in (self.size, self.advanced, self.order, self.dimension, self.contacts):
            section.changed.connect(self._ask)
        if meshing_process.run_of(obj) is not None:
            self._follow(meshing_process.run_of(obj))
        else:
            self._show_outcome(meshing_process.outcome_of(obj))
        out_of_date = up_to_date.is_out_of_date(obj)
        self.result.show_out_of_date(out_of_date)
        # Whoever opens an up-to-date mesh may only want to see it, so run no prediction then.
        self._predict(None if elements.is_there(obj.FemMesh) and not out_of_date else 0)
        self.form.destroyed.connect(self.dismiss)
        self.changes = QtCore.QTimer(self.form, singleShot=True, interval=MOMENT)
        self.changes.timeout.connect(self._ask_anew)
        FreeCAD.addDocumentObserver(self)
        dock.widen(self.form, WIDTH)

    def _build(self):
        self.form = QtGui.QWidget()
        self.form.setObjectName("collarmesh_panel")
        self.form.setWindowTitle(translate("collarmesh", "Mesh by collarmesh"))
        self.form.setWindowIcon(QtGui.QIcon(views.ICON))
        diagonal = extent.diagonal(compatibility.meshed_object(self.object))
        self.size = SizeSection(self.object, diagonal)
        self.dimension = DimensionSection(self.object)
        self.order = OrderSection(mesh_properties.ORDERS.index(self.object.ElementOrder) + 1)
        self.advanced = AdvancedSection(self.object)
        self.preview = SizePreview(self.object, self._settings)
        self.contacts = ContactsSection(self.object)
        self.run_section = RunSection()
        self.run_section.run_clicked.connect(self.start)
        self.run_section.cancel_clicked.connect(self.cancel)
        self.refine = RefineSection(self.object)
        self.refine.clicked.connect(self.start_refinement)
        self.result = ResultSection()
        self.result.chart.worst_clicked.connect(self.show_worst)
        self.list = PlacesList()
        self.list.picked.connect(self.marks.show)
        self.report_button = widgets.button(
            "collarmesh_report", translate("collarmesh", "Report"), self.open_report,
            translate("collarmesh", "Open a page with all measurements and a view of the mesh"))
        self.faces_button = widgets.button(
            "collarmesh_constraint_faces", translate("collarmesh", "Faces for constraints"), self.show_constraint_faces,
            translate("collarmesh", "Show a face for each group of this mesh of triangles, for the constraints of FEM"))
        layout = QtGui.QVBoxLayout(self.form)
        for widget in (self.size, self.preview, self.dimension, self.order, self.advanced, self.contacts, self.refine,
                       self.run_section, self.result, self.list, self.report_button, self.faces_button):
            layout.addWidget(widget)
        layout.addStretch()
        self.list.hide()
        self.report_button.hide()

    def _store(self):
        """Stores the fields in the properties. Raises MesherError."""
        try:
            size = self.size.size()
            self.advanced.store()
        except ValueError as error:
            raise MesherError(str(error)) from error
        if size != self.object.CharacteristicLengthMax.Value:
            self.object.CharacteristicLengthMax = size
        order = mesh_properties.ORDERS[self.order.order() - 1]
        if order != self.object.ElementOrder:
            self.object.ElementOrder = order
        self.dimension.store()
        self.contacts.store()

    def _ask(self, *_):
        """Updates the predictions after a change."""
        self.preview.update_soon()
        self.run_section.withdraw()
        self._predict(prediction.WAIT)

    def _predict(self, wait):
        """Predicts the meshes that the current fields make with each size, after `wait` milliseconds. With None, and
        while the mesher runs, only shows known answers."""
        settings = self._settings()
        if settings is None:
            return
        settings.dimension = self.dimension.chosen(settings.fill_holes)
        self.order.show_dimension(settings.dimension)
        self.dimension.show_note(settings.fill_holes)
        if settings.dimension < 3:
            self.predictions.pause()
            part = compatibility.meshed_object(self.object)
            self._show_predictions(cost.estimates(part, self.size.sizes(), settings.dimension))
        elif wait is None or self.run is not None or not settings.coarsen:
            self._show_predictions(self.predictions.known(settings, self.size.sizes()))
        else:
            self._show_predictions(self.predictions.ask(settings, self.size.sizes(), wait), "…")

    def _settings(self):
        """Returns the Settings of the fields; None if they are invalid."""
        try:
            settings = mesh_properties.settings_of(self.object)
        except MesherError:
            return None
        with contextlib.suppress(ValueError):
            settings.size = self.size.size()
        self.advanced.apply_to(settings)
        settings.order = self.order.order()
        self.dimension.apply_to(settings)
        self.contacts.apply_to(settings)
        return settings

    def _show_made(self, known):
        self._show_predictions(known, "…" if self.predictions.is_asking() else "")

    def _show_predictions(self, known, missing=""):
        self.known = known
        order = self.order.order()
        self.size.show_predictions(
            {size: (count, None if seconds is None else seconds + cost.loading_seconds(count, order))
             for size, (count, seconds) in known.items()}, missing)

    def start(self):
        if self.run is not None:
            return
        answered = bool(self.run_section.asked())
        try:
            if answered and self._open_surface():
                self.advanced.tick("FillHoles")
            self._store()
            if not answered and self._asks():
                return
            self._clear()
            self.preview.button.setChecked(False)
            self._follow(meshing_process.start(self.object, self._time_left()))
        except MesherError as error:
            self._clear()
            self._show_outcome(meshing_process.Outcome(error=str(error)))

    def start_refinement(self):
        """Starts a run that adapts the mesh to the error of a result."""
        if self.run is not None or self.refine.asks():
            return
        try:
            self._clear()
            self._follow(meshing_process.start(self.object, prepare=self.refine.prepare))
        except MesherError as error:
            self._show_outcome(meshing_process.Outcome(error=str(error)))

    def _clear(self):
        """Clears the messages of the last run."""
        self.marks.clear()
        self.list.fill([])
        self.result.clear()
        self.report_button.hide()

    def _asks(self):
        """Shows a question if one must be answered before meshing. Returns whether there is one."""
        holes, question = "" if self.object.FillHoles else self._open_surface(), self._question()
        if holes:
            self.run_section.ask(" ".join((holes, question)), translate("collarmesh", "Fill the holes"))
        elif question:
            self.run_section.ask(question)
        return bool(holes or question)

    def _open_surface(self):
        """Returns the question about filling the holes of an open surface for tetrahedra; "" for other parts."""
        part = compatibility.meshed_object(self.object)
        is_asked = part is not None and self.dimension.chosen(self.object.FillHoles) == 3
        return open_shape.question(part) if is_asked else ""

    def _question(self):
        """Returns the question about an expensive mesh; "" if there is none."""
        part, size = compatibility.meshed_object(self.object), self.object.CharacteristicLengthMax.Value
        count, seconds = self.known.get(size, (0, None))
        if not count and part is not None:
            count = cost.elements_by_extent(part, size, self.dimension.chosen(self.object.FillHoles))
        if seconds is not None:
            seconds += cost.loading_seconds(count, self.order.order())
        return cost.question(count, self.order.order(), seconds)

    def _time_left(self):
        count, seconds = self.known.get(self.object.CharacteristicLengthMax.Value, (0, None))
        return TimeLeft(seconds, cost.loading_seconds(count, self.order.order()))

    def cancel(self):
        if self.run is not None:
            self.run.cancel()

    def _follow(self, run):
        self.run = run
        self.predictions.pause()
        self.refine.refresh(busy=True)
        self.run_section.begin(run.time_left)
        run.advanced.connect(self._advance)
        run.ended.connect(self._ended)
        if run.progress is not None:
            self._advance(run.progress)

    def _advance(self, progress):
        self.run_section.advance(progress, self.run.seconds())

    def _ended(self):
        self._let_go()
        self.run_section.rest()
        self.refine.refresh()
        self._ask()
        self._show_outcome(meshing_process.outcome_of(self.object))

    def _let_go(self):
        run, self.run = self.run, None
        if run is not None:
            run.advanced.disconnect(self._advance)
            run.ended.disconnect(self._ended)

    def show_state(self, out_of_date):
        """Updates the panel after a recompute, a run or an undo: shows the outcome of the mesh that the object has now,
        and whether the mesh is up to date. Keeps messages about the fields or the part."""
        outcome = meshing_process.outcome_of(self.object)
        tells_of_mesh = self.outcome is None or self.outcome.report is not None
        if self.run is None and tells_of_mesh and outcome is not self.outcome:
            self._show_outcome(outcome)
            self.refine.refresh()
        self.result.show_out_of_date(out_of_date)

    def _show_outcome(self, outcome):
        """Shows the outcome of a run. None: the mesh was made before the document was opened, so only its
        worst elements are known."""
        self.outcome = outcome
        if outcome is None:
            self.result.clear()
            found = worst_elements.in_mesh(self.object.FemMesh)
        else:
            self.result.show_outcome(outcome)
            found = places.in_error(in_panel_words(outcome.error))
            if outcome.report is not None:
                found += places.in_report(outcome.report, outcome.warnings)
                found += worst_elements.in_report(self.object.FemMesh, outcome.report)
        self.report_button.setVisible(outcome is not None and bool(outcome.page))
        self.faces_button.setVisible(constraint_faces.can_be_made(self.object))
        self.list.fill(found)

    def show_worst(self):
        self.list.pick_first(places.WORST)

    def open_report(self):
        page = meshing_process.outcome_of(self.object).page
        if not QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(page)):
            text = translate("collarmesh", "Found no browser to show the report; it is in {path}")
            self.result.say(text.format(path=page), colours.BAD)

    def show_constraint_faces(self):
        self.marks.clear()
        self.preview.button.setChecked(False)
        try:
            constraint_faces_view.show(self.object)
        except MesherError as error:  # an undo may have removed the mesh
            self.result.say(str(error), colours.BAD)

    def getStandardButtons(self):
        return compatibility.as_number(QtGui.QDialogButtonBox.Ok | QtGui.QDialogButtonBox.Cancel)

    def accept(self):
        """Stores the fields for the next run."""
        try:
            self._store()
        except MesherError as error:
            self._clear()
            self._show_outcome(meshing_process.Outcome(error=str(error)))
            return False
        self.object.ViewObject.Proxy.is_new = False
        self._close()
        return True

    def reject(self):
        """Removes a new mesh object if it is still empty; a run continues."""
        is_wanted = not self.object.ViewObject.Proxy.is_new or self.object.FemMesh.NodeCount or self.run is not None
        self._close()
        if not is_wanted:
            key = key_of(self.object)
            later(lambda: new_mesh.take_back(*key))  # after the panel is closed
        return True

    def _close(self):
        self.dismiss()
        FreeCADGui.getDocument(self.object.Document.Name).resetEdit()

    def dismiss(self, *_):
        """Closes the panel and removes its marks from the view."""
        with contextlib.suppress(ValueError):
            FreeCAD.removeDocumentObserver(self)
        self._let_go()
        self.predictions.forget()
        with contextlib.suppress(ReferenceError, RuntimeError):  # the object may no longer exist
            self.marks.clear()
            self.preview.clear()

    def slotChangedObject(self, changed, name):
        if name in WHAT_IS_MESHED and changed is compatibility.meshed_object(self.object):
            self.changes.start()

    def slotRecomputedDocument(self, _document):
        """Handles a recompute, after which a link or a container may show another shape without having
        changed itself."""
        if self.predictions.shape_has_changed():
            self.changes.start()

    def _ask_anew(self):
        """Predicts again for another shape."""
        self.predictions.forget()
        self.contacts.look_soon()
        self.preview.update_soon(shape_too=True)
        self._ask()
        self.show_state(up_to_date.is_out_of_date(self.object))

    def slotStartSaveDocument(self, document, _path):
        """Removes marks before the document is saved, so that the file does not contain them."""
        if document is self.object.Document:
            self.marks.clear()
            self.preview.button.setChecked(False)

    def slotDeletedObject(self, deleted):
        if deleted is self.object:
            self.dismiss()
            FreeCADGui.Control.closeDialog()

    def slotDeletedDocument(self, document):
        if document is self.object.Document:
            self.dismiss()
            FreeCADGui.Control.closeDialog()
