"""The panel of boundary layers: their faces, heights and number. Changes take effect at once."""

import contextlib
import math
import re

import FreeCADGui
from PySide import QtGui

from . import colours, compatibility, dock, inputs, layer_objects, size_objects, widgets
from .edit_panel import EditPanel
from .quantity_field import QuantityField
from .translations import translate

WIDTH = 340  # pixels
TETRAHEDRA = "LayersAsTetrahedra"  # property of the mesh object


def title():
    return translate("collarmesh", "Boundary layers")


class LayersPanel(EditPanel):
    def __init__(self, obj):
        super().__init__(obj, title(), "collarmesh_layers_panel")
        self.mesh = layer_objects.mesh_object_of(obj)
        self.part = None if self.mesh is None else compatibility.meshed_object(self.mesh)
        layout = QtGui.QVBoxLayout(self.form)
        self._add_faces(layout)
        rows = widgets.form()
        layout.addLayout(rows)
        self.first = self._add_length(rows, "FirstHeight", translate("collarmesh", "First height"),
                                      translate("collarmesh", "a tenth of the size"))
        self.count = self._add_number(rows, QtGui.QSpinBox(), "Count", translate("collarmesh", "Number of layers"),
                                      layer_objects.MOST_LAYERS)
        self.growth = self._add_number(rows, QtGui.QDoubleSpinBox(), "Growth",
                                       translate("collarmesh", "Each is thicker by the factor"),
                                       layer_objects.MOST_GROWTH)
        self.growth.setSingleStep(0.05)
        self.thickness = self._add_length(rows, "Thickness", translate("collarmesh", "Thickness of all"),
                                          translate("collarmesh", "from the first height"))
        self._add_tetrahedra(layout)
        self.note = widgets.label("collarmesh_layers_note")
        layout.addWidget(self.note)
        layout.addStretch()
        self.fill()
        dock.widen(self.form, WIDTH)

    def _add_faces(self, layout):
        label = widgets.label(text=translate(
            "collarmesh", "Faces with layers: type their names, or select them in the 3D view and add them. With a "
            "solid among them, layers are inside that solid only."))
        self.faces = QtGui.QLineEdit()
        self.faces.setObjectName("collarmesh_layers_faces")
        self.faces.setPlaceholderText(translate("collarmesh", "all outer faces"))
        self.faces.textChanged.connect(self._names_typed)
        add = widgets.button("collarmesh_layers_add", translate("collarmesh", "Add the selected"), self.add_selected)
        for widget in (label, self.faces, add):
            layout.addWidget(widget)

    def _add_length(self, rows, name, text, zero):
        field = QuantityField("mm", 0.0, self.object, zero=zero)
        field.widget.textChanged.connect(lambda _text: self._length_typed(field, name))
        self._add_row(rows, field.widget, name, text)
        return field

    def _add_number(self, rows, field, name, text, most):
        field.setRange(1, most)
        field.setKeyboardTracking(False)
        field.valueChanged.connect(lambda value: self._changed(name, value))
        self._add_row(rows, field, name, text)
        return field

    def _add_row(self, rows, widget, name, text):
        widget.setObjectName("collarmesh_layers_" + name)
        widget.setToolTip(translate("App::Property", self.object.getDocumentationOfProperty(name)))
        rows.addRow(text, widget)

    def _add_tetrahedra(self, layout):
        self.tetrahedra = QtGui.QCheckBox(translate("collarmesh", "Tetrahedra in place of prisms"))
        self.tetrahedra.setObjectName("collarmesh_layers_tetrahedra")
        self.tetrahedra.setToolTip(
            translate("collarmesh", "In all layers of this mesh, for solvers that accept only tetrahedra"))
        self.tetrahedra.toggled.connect(self._tetrahedra_toggled)
        self.tetrahedra.setVisible(self.mesh is not None)
        layout.addWidget(self.tetrahedra)

    def fill(self):
        """Copies the object's values to the fields."""
        self.filling = True
        names = [name for _, name in size_objects.references(self.object)]
        self.faces.setText(", ".join(names))
        self.first.show(self.object.FirstHeight.Value)
        self.thickness.show(self.object.Thickness.Value)
        self.count.setValue(self.object.Count)
        self.growth.setValue(self.object.Growth)
        self.tetrahedra.setChecked(self.mesh is not None and getattr(self.mesh, TETRAHEDRA))
        self.filling = False
        self._show_note()

    def _show_note(self):
        """Shows the height that follows from the other fields, if it is known."""
        relative = relative_thickness(self.object.Growth, self.object.Count)
        first, thickness = self.object.FirstHeight.Value, self.object.Thickness.Value
        self.first.widget.setEnabled(thickness == 0)
        text = ""
        if thickness > 0:
            text = translate("collarmesh", "The first layer is {height} mm high.").format(
                height=f"{thickness / relative:.4g}")
        elif first > 0:
            text = translate("collarmesh", "All layers together are {height} mm high.").format(
                height=f"{first * relative:.4g}")
        self.note.setText(text)

    def _length_typed(self, field, name):
        """Stores a length if it is valid; the field shows it in red if not."""
        with contextlib.suppress(ValueError):
            self._changed(name, field.value())

    def _changed(self, name, value):
        if self.filling:
            return
        setattr(self.object, name, value)
        self._show_note()

    def _tetrahedra_toggled(self, checked):
        if not self.filling:
            setattr(self.mesh, TETRAHEDRA, checked)

    def _names_typed(self, text):
        """Stores the names if the part has all of them; shows them in red if not."""
        names = [name for name in re.split(r"[\s,;]+", text) if name]
        is_known = all(self._is_known(name) for name in names)
        self.faces.setStyleSheet("" if is_known else colours.css(colours.BAD))
        if is_known and not self.filling:
            self._set_references(names)

    def _is_known(self, name):
        kind, number = size_objects.kind_and_number(name)
        if self.part is None or kind not in ("Face", "Solid"):
            return False
        return number <= len(getattr(inputs.shape_of(self.part), kind + "s"))

    def _set_references(self, names):
        self.object.References = [(self.part, (name,)) for name in dict.fromkeys(names)]
        self.object.recompute()

    def add_selected(self):
        """Adds the faces and solids of the part that are selected in the 3D view."""
        names = [name for _, name in size_objects.references(self.object)]
        names += selected_names(self.part)
        self._set_references(names)
        self.fill()


def relative_thickness(growth, count):
    """Returns the height of all layers relative to the first one; infinite beyond the largest number."""
    try:
        return count if growth == 1 else (growth**count - 1) / (growth - 1)
    except OverflowError:
        return math.inf


def selected_names(part):
    """Returns the names of the faces and solids of a part that are selected."""
    return [name for each in FreeCADGui.Selection.getSelectionEx() if each.Object is part
            for name in each.SubElementNames if name.startswith(("Face", "Solid"))]
