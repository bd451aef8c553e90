"""A part of a panel that can be folded to one line."""

from PySide import QtCore, QtGui


class Fold(QtGui.QToolButton):
    """A line with an arrow that shows and hides a widget."""

    def __init__(self, body, text=""):
        super().__init__()
        self.body = body
        self.setText(text)
        self.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
        self.setAutoRaise(True)
        self.setCheckable(True)
        self.toggled.connect(self._unfold)
        self._unfold(False)

    def _unfold(self, shown):
        self.setArrowType(QtCore.Qt.DownArrow if shown else QtCore.Qt.RightArrow)
        self.body.setVisible(shown)
