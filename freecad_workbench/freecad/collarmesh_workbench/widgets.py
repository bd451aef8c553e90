"""Parts that the panels are made of."""

from PySide import QtCore, QtGui


def label(name="", text="", selectable=False):
    """Returns a label whose text wraps. `selectable`: the mouse can select the text."""
    made = QtGui.QLabel(text)
    made.setObjectName(name)
    made.setWordWrap(True)
    if selectable:
        made.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
    return made


def button(name, text, action, tip=""):
    made = QtGui.QPushButton(text)
    made.setObjectName(name)
    made.setToolTip(tip)
    made.clicked.connect(action)
    return made


def stack(owner, *parts):
    """Puts widgets and layouts one below the other, without a margin."""
    layout = QtGui.QVBoxLayout(owner)
    layout.setContentsMargins(0, 0, 0, 0)
    for part in parts:
        (layout.addLayout if isinstance(part, QtGui.QLayout) else layout.addWidget)(part)
    return layout


def form():
    """Returns a layout of texts and fields, which wraps long rows."""
    rows = QtGui.QFormLayout()
    rows.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
    return rows
