"""The part of the panel that asks for the kind of elements: tetrahedra, triangles or lines."""

from PySide import QtCore, QtGui

from . import compatibility, mesh_properties, open_shape, widgets
from .groups import analysis_of
from .objects import type_of
from .translations import translate


class DimensionSection(QtGui.QWidget):
    """A form with a choice. Emits `changed` when another dimension is chosen."""

    changed = QtCore.Signal()

    def __init__(self, obj):
        super().__init__()
        self.object = obj
        self.combo = QtGui.QComboBox()
        self.combo.setObjectName("collarmesh_ElementDimension")
        self.combo.addItems([translate("collarmesh", "from shape"), translate("collarmesh", "1D: lines, for beams"),
                             translate("collarmesh", "2D: triangles, for shells"),
                             translate("collarmesh", "3D: tetrahedra")])
        self.combo.setToolTip(translate(
            "collarmesh",
            "From shape: tetrahedra in what encloses a volume, triangles on faces and open surfaces, lines on wires"))
        self.note = widgets.label("collarmesh_dimension_note")
        row = widgets.form()
        row.addRow(translate("collarmesh", "Dimension of the elements"), self.combo)
        widgets.stack(self, row, self.note)
        self.combo.setCurrentIndex(mesh_properties.DIMENSIONS.index(obj.ElementDimension))
        self.combo.currentIndexChanged.connect(lambda _index: self.changed.emit())

    def asked(self):
        """Returns the chosen dimension, 1, 2 or 3; 0: from the shape."""
        return self.combo.currentIndex()

    def store(self):
        chosen = mesh_properties.DIMENSIONS[self.asked()]
        if chosen != self.object.ElementDimension:
            self.object.ElementDimension = chosen

    def apply_to(self, settings):
        settings.dimension = self.asked()

    def chosen(self, fill_holes):
        """Returns the dimension, 1, 2 or 3: the chosen one, or that of the shape."""
        part = compatibility.meshed_object(self.object)
        if part is None:
            return self.asked() or 3
        try:
            return open_shape.dimension(part, self.asked(), fill_holes)
        except Exception:  # OpenCASCADE's exceptions, too; the run reports the problem
            return self.asked() or 3

    def show_note(self, fill_holes):
        """Shows the dimension that follows from the shape, and what FEM needs for it."""
        part, chosen = compatibility.meshed_object(self.object), self.chosen(fill_holes)
        words = [] if part is None or self.asked() else [open_shape.word(part, chosen)]
        words.append(missing_section(self.object, chosen))
        text = " ".join(filter(None, words))
        self.note.setText(text)
        self.note.setVisible(bool(text))


def missing_section(mesh_object, dimension):
    """Returns text on the cross section (dimension 1) or thickness (2) that FEM needs for elements of this dimension,
    if the analysis lacks it; "" if nothing is missing."""
    analysis = analysis_of(mesh_object)
    members = [] if analysis is None else analysis.Group
    if dimension == 3 or any(type_of(each) == f"Fem::ElementGeometry{dimension}D" for each in members):
        return ""
    if dimension == 1:
        return translate("collarmesh", "The analysis needs a beam cross section (FEM: Beam cross section).")
    return translate("collarmesh", "The analysis needs a thickness (FEM: Shell plate thickness).")
