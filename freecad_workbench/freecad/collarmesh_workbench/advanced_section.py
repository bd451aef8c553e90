"""The folded part of the panel: all settings except size and order."""

import dataclasses

from PySide import QtCore, QtGui

from . import mesh_properties, numbers_typed, preferences, widgets
from .fold import Fold
from .objects import value_of
from .quantity_field import QuantityField
from .translations import translate

MOST = 1000000


@dataclasses.dataclass
class Row:
    """A property of the mesh object, with the texts of its field."""

    name: str  # name of the property
    text: str
    unit: str = ""  # "mm" or "deg"
    zero: str = ""  # text shown for 0
    choices: tuple = ()  # texts: in the order of the values 0, 1, ..., or by the property's own words
    tip: str = ""  # tool tip; empty: the property's text, translated


def sections():
    """Returns headings and their rows."""
    any_number = translate("collarmesh", "any")
    any_growth = translate("collarmesh", "as the sizes ask for")
    no_limit, default = translate("collarmesh", "no limit"), translate("collarmesh", "default")
    none = translate("collarmesh", "none")
    repair = {
        "Automatic": translate("collarmesh", "automatic"),
        "None": translate("collarmesh", "none, refuse"),
        "Wrap": translate("collarmesh", "wrap where it fails"),
    }
    return (
        (translate("collarmesh", "Sizes"), (
            Row("CharacteristicLengthMin", translate("collarmesh", "Smallest size"), "mm", no_limit),
            Row("MeshSizeFromCurvature", translate("collarmesh", "Elements on a full circle"), zero=any_number),
            Row("ElementsAcrossGap", translate("collarmesh", "Elements across gaps"), zero=any_number),
            Row("Gradation", translate("collarmesh", "Growth of the size"), zero=any_growth),
        )),
        (translate("collarmesh", "Shape"), (
            Row("SurfaceDistance", translate("collarmesh", "Largest distance from the shape"), "mm", default),
            Row("CreaseAngle", translate("collarmesh", "Sharp below this angle"), "deg", default),
            Row("CollarAngle", translate("collarmesh", "Largest angle in collars"), "deg", default),
            Row("PlanarTolerance", translate("collarmesh", "Tolerance of planes"), zero=default),
            Row("WeldTolerance", translate("collarmesh", "Tolerance of points"), zero=default),
            Row("Repair", translate("collarmesh", "Repair of the shape"), choices=repair),
            Row("RepairTolerance", translate("collarmesh", "Tolerance of repair"), zero=default),
            Row("FillHoles", translate("collarmesh", "Fill holes of open surfaces")),
            Row("SplitFaces", translate("collarmesh", "Faces to split"), zero=none,
                tip=translate("collarmesh", "Inner faces whose nodes are made twice, one for each side, as for cracks; "
                                            "their names, with spaces between them")),
            Row("PeriodicFaces", translate("collarmesh", "Periodic faces"), zero=none,
                tip=translate("collarmesh", "Pairs of sides that get the same nodes and triangles, with spaces between "
                                            "them: x y z, or Face1=Face2")),
        )),
        (translate("collarmesh", "Quality"), (
            Row("ImproveLevel", translate("collarmesh", "Improvement"), choices=preferences.improve_levels(),
                tip=translate("collarmesh", "How much time goes into removing flat elements")),
            Row("MinDihedralAngle", translate("collarmesh", "Improve below this angle"), "deg", default),
            Row("Coarsen", translate("collarmesh", "As few elements as the sizes ask for")),
            Row("InteriorNode", translate("collarmesh", "A node inside of each element")),
            Row("RadiusEdgeRatio", translate("collarmesh", "Circumradius / shortest edge")),
        )),
        (translate("collarmesh", "Run"), (
            Row("Seed", translate("collarmesh", "Seed")),
            Row("TimeLimit", translate("collarmesh", "Time limit in seconds"), zero=none),
        )),
    )


class AdvancedSection(QtGui.QWidget):
    """A form with a field for each property. Emits `changed` when one is edited."""

    changed = QtCore.Signal()

    def __init__(self, obj):
        super().__init__()
        self.object = obj
        self._readers = {}
        body = QtGui.QWidget()
        self.fold = Fold(body, translate("collarmesh", "Advanced"))
        self.fold.setObjectName("collarmesh_advanced")
        rows = QtGui.QFormLayout(body)
        rows.setContentsMargins(12, 0, 0, 0)
        rows.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        for heading, properties in sections():
            label = QtGui.QLabel(f"<b>{heading}</b>")
            rows.addRow(label)
            for row in properties:
                if row.name in obj.PropertiesList:
                    self._add(rows, row)
        widgets.stack(self, self.fold, body)

    def store(self):
        """Stores the values in the object's properties. Raises ValueError, which names the field."""
        for name, (text, read) in self._readers.items():
            try:
                value = read()
            except ValueError as error:
                self.fold.setChecked(True)
                raise ValueError(f"{text}: {error}") from error
            if value != value_of(self.object, name):
                setattr(self.object, name, value)

    def tick(self, name):
        """Ticks the check box of a property."""
        self.findChild(QtGui.QCheckBox, "collarmesh_" + name).setChecked(True)

    def apply_to(self, settings):
        """Copies the values of the fields to Settings, except values that cannot be read."""
        for _, name, field, *_ in mesh_properties.PROPERTIES:
            if name in self._readers:
                try:
                    setattr(settings, field, self._readers[name][1]())
                except ValueError:
                    pass

    def _add(self, rows, row):
        widget, read = self._widget(row)
        widget.setObjectName("collarmesh_" + row.name)
        widget.setToolTip(row.tip or self._text_of(row.name))
        self._readers[row.name] = row.text, read
        if isinstance(widget, QtGui.QCheckBox):
            widget.setText(row.text)
            rows.addRow(widget)
            return
        rows.addRow(row.text, widget)
        rows.labelForField(widget).setToolTip(widget.toolTip())

    def _text_of(self, name):
        """Returns the text of a property, translated."""
        texts = (text for _, other, _, _, text in mesh_properties.PROPERTIES if other == name)
        return translate("App::Property", next(texts, self.object.getDocumentationOfProperty(name)))

    def _widget(self, row):
        """Returns the widget, and a function that reads its value."""
        value = value_of(self.object, row.name)
        if row.choices:
            return self._combo(row, value)
        if row.unit:
            field = QuantityField(row.unit, value, self.object, zero=row.zero)
            field.widget.textChanged.connect(self.changed)
            return field.widget, field.value
        if isinstance(value, bool):
            box = QtGui.QCheckBox()
            box.setChecked(value)
            box.toggled.connect(self.changed)
            return box, box.isChecked
        if isinstance(value, int):
            number = QtGui.QSpinBox()
            number.setRange(0, MOST)
            number.setSpecialValueText(row.zero)
            number.setValue(value)
            number.valueChanged.connect(self.changed)
            return number, number.value
        if isinstance(value, (list, tuple)):
            words = QtGui.QLineEdit(" ".join(value))
            words.setPlaceholderText(row.zero)
            words.textChanged.connect(self.changed)
            return words, lambda: words.text().split()
        text = QtGui.QLineEdit("" if value == 0 and row.zero else f"{value:.12g}")
        text.setPlaceholderText(row.zero)
        text.textChanged.connect(self.changed)
        return text, lambda: _ratio(text.text(), row.zero)

    def _combo(self, row, value):
        combo = narrow_combo()
        words = row.choices if isinstance(row.choices, dict) else dict(enumerate(row.choices))
        for word, text in words.items():
            combo.addItem(text, word)
        combo.setCurrentIndex(list(words).index(value) if value in words else 0)
        combo.currentIndexChanged.connect(self.changed)
        return combo, combo.currentData


def in_panel_words(text):
    """Replaces options in a message of the program by the names of the panel's fields."""
    labels = {row.name: row.text for _, rows in sections() for row in rows}
    labels["CharacteristicLengthMax"] = translate("collarmesh", "Size of the elements")
    fields = {name: field for _, name, field, *_ in mesh_properties.PROPERTIES}
    words = {"--" + fields[name].replace("_", "-"): text for name, text in labels.items() if name in fields}
    words["--repair wrap"] = f"{labels['Repair']}: {translate('collarmesh', 'wrap where it fails')}"
    words["--repair"] = labels["Repair"]
    dimension = translate("collarmesh", "Dimension of the elements")
    words |= {"--dimension 2": f"{dimension}: 2D", "--dimension 1": f"{dimension}: 1D", "--dimension": dimension}
    for option in sorted(words, key=len, reverse=True):
        text = text.replace(option, f"“{words[option]}”")
    return text


def narrow_combo():
    """Returns a combo box that may be narrower than its texts."""
    combo = QtGui.QComboBox()
    combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    combo.setMinimumContentsLength(6)
    combo.setSizePolicy(QtGui.QSizePolicy.Expanding, QtGui.QSizePolicy.Fixed)
    return combo


def _ratio(text, zero):
    """Reads a number without unit that is not negative. Empty text is 0 if the field has a text for 0 (`zero`)."""
    if not text.strip():
        if zero:
            return 0.0
        raise ValueError(translate("collarmesh", "there is no value"))
    value = numbers_typed.number(text)
    if value < 0:
        raise ValueError(translate("collarmesh", "'{text}' is negative").format(text=text))
    return value
