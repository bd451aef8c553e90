"""The panel of a size object: size, growth and place. Changes take effect at once."""

import contextlib

import FreeCADGui
from PySide import QtGui

from . import dock, size_objects, widgets
from .edit_panel import EditPanel
from .size_handles import Handles
from .quantity_field import ANY, NOT_NEGATIVE, POSITIVE, QuantityField
from .translations import translate

AXES = ("x", "y", "z")
WIDTH = 340  # pixels


def texts():
    """Returns the panel's names of the properties."""
    return {
        "Size": translate("collarmesh", "Element size"),
        "Growth": translate("collarmesh", "Growth away from it"),
        "Radius": translate("collarmesh", "Radius"),
        "Length": translate("collarmesh", "Length"),
        "Width": translate("collarmesh", "Width"),
        "Height": translate("collarmesh", "Height"),
        "Within": translate("collarmesh", "Holds within"),
    }


def titles():
    return {
        "Sphere": translate("collarmesh", "Size in a sphere"),
        "Box": translate("collarmesh", "Size in a box"),
        "Cylinder": translate("collarmesh", "Size in a cylinder"),
        "Distance": translate("collarmesh", "Size near faces and edges"),
    }


class SizePanel(EditPanel):
    def __init__(self, obj):
        self.kind = size_objects.kind_of(obj)
        super().__init__(obj, titles()[self.kind], "collarmesh_size_panel")
        self.handles = None
        layout = QtGui.QVBoxLayout(self.form)
        self.rows = QtGui.QFormLayout()
        layout.addLayout(self.rows)
        self.fields = {}
        for name in ("Size", *(name for name, _, _ in obj.Proxy.lengths)):
            self._add_property(name)
        if self.kind == "Distance":
            self._add_property("Within", NOT_NEGATIVE)
        self._add_growth()
        if self.kind == "Distance":
            self._add_references(layout)
        else:
            for i, axis in enumerate(AXES):
                text = translate("collarmesh", "Position {axis}").format(axis=axis)
                self._add_length(axis, text, lambda value, i=i: self._put(i, value), ANY)
            self._add_hint(layout)
            self._add_handles()
        self.fill()
        dock.widen(self.form, WIDTH)

    def _add_property(self, name, allowed=POSITIVE):
        self._add_length(name, texts()[name], lambda value: setattr(self.object, name, value), allowed)

    def _add_length(self, name, text, store, allowed=POSITIVE):
        field = QuantityField("mm", 0.0, self.object, allowed)
        field.widget.setObjectName("collarmesh_size_" + name)
        if name in self.object.PropertiesList:
            field.widget.setToolTip(translate("App::Property", self.object.getDocumentationOfProperty(name)))
        field.widget.textChanged.connect(lambda _text: self._typed(field, store))
        self.rows.addRow(text, field.widget)
        self.fields[name] = field

    def _typed(self, field, store):
        """Stores a value if it is valid; if not, the field shows it in red."""
        with contextlib.suppress(ValueError):
            self._changed(store, field.value())

    def _add_growth(self):
        field = QtGui.QDoubleSpinBox()
        field.setObjectName("collarmesh_size_Growth")
        field.setRange(0, 10)
        field.setSingleStep(0.05)
        field.setKeyboardTracking(False)
        field.setSuffix(translate("collarmesh", " mm per mm"))
        field.setToolTip(translate("App::Property", self.object.getDocumentationOfProperty("Growth")))
        field.valueChanged.connect(
            lambda value: self._changed(lambda v: setattr(self.object, "Growth", v), value)
        )
        self.rows.addRow(texts()["Growth"], field)
        self.fields["Growth"] = field

    def _add_references(self, layout):
        self.list = QtGui.QListWidget()
        self.list.setObjectName("collarmesh_size_references")
        self.list.setMaximumHeight(140)
        self.list.setSelectionMode(QtGui.QAbstractItemView.ExtendedSelection)
        layout.addWidget(
            QtGui.QLabel(translate("collarmesh", "Select faces and edges in the 3D view, then add them:"))
        )
        layout.addWidget(self.list)
        row = QtGui.QHBoxLayout()
        layout.addLayout(row)
        for name, text, action in (
            ("add", translate("collarmesh", "Add the selected"), self.add_selected),
            ("remove", translate("collarmesh", "Remove"), self.remove_marked),
        ):
            row.addWidget(widgets.button("collarmesh_size_" + name, text, action))

    def _add_hint(self, layout):
        layout.addWidget(widgets.label(text=translate(
            "collarmesh", "Drag the handles in the 3D view. To turn it, close this panel and choose Transform in its "
            "context menu.")))

    def _add_handles(self):
        self.object.recompute()
        self.handles = Handles(self.object, self.kind, self.fill)

    def fill(self):
        """Copies the object's values to the fields."""
        self.filling = True
        for name, field in self.fields.items():
            if name in AXES:
                field.show(self.object.Placement.Base[AXES.index(name)])
            elif name == "Growth":
                field.setValue(self.object.Growth)
            else:
                field.show(getattr(self.object, name).Value)
        if self.kind == "Distance":
            self.list.clear()
            self.list.addItems(
                [f"{linked.Label}: {name}" for linked, name in size_objects.references(self.object)]
            )
        self.filling = False

    def _changed(self, store, value):
        if self.filling:
            return
        store(value)
        self.object.recompute()
        if self.handles:
            self.handles.place()

    def _put(self, axis, value):
        placement = self.object.Placement
        base = placement.Base
        base[axis] = value
        placement.Base = base
        self.object.Placement = placement

    def add_selected(self):
        """Adds the faces and edges selected in the 3D view."""
        found = size_objects.references(self.object)
        for each in FreeCADGui.Selection.getSelectionEx(self.object.Document.Name):
            for name in each.SubElementNames:
                if name.startswith(("Face", "Edge")) and (each.Object, name) not in found:
                    found.append((each.Object, name))
        self._set_references(found)

    def remove_marked(self):
        marked = {index.row() for index in self.list.selectedIndexes()}
        self._set_references(
            [each for i, each in enumerate(size_objects.references(self.object)) if i not in marked]
        )

    def _set_references(self, found):
        self.object.References = [(linked, (name,)) for linked, name in found]
        self.object.recompute()
        self.fill()

    def close(self):
        if self.handles:
            self.handles.remove()
            self.handles = None
