"""The list of places: a heading for each kind, with the findings below it."""

from PySide import QtCore, QtGui

from . import places
from .translations import translate

MOST = 200  # rows shown of one kind
MOST_PIXELS = 10000  # largest height of a row


class PlacesList(QtGui.QTreeWidget):
    """A tree of findings. Emits `picked` on a click or an arrow key: with the Place of the row, or with all
    Places of a heading."""

    picked = QtCore.Signal(object)

    def __init__(self):
        super().__init__()
        self.setObjectName("collarmesh_places")
        self.setHeaderHidden(True)
        self.setWordWrap(True)
        self.setIndentation(12)
        self.setUniformRowHeights(False)
        self.setMinimumHeight(170)
        self.setVerticalScrollMode(QtGui.QAbstractItemView.ScrollPerPixel)
        self.setItemDelegate(_Wrapped(self))
        self.setToolTip(translate("collarmesh", "Click to see the place"))
        self.itemClicked.connect(self._clicked)
        self.currentItemChanged.connect(self._moved)
        self._moved_to = None  # item that the current click has moved to
        self._filling = False

    def fill(self, found):
        """Shows these Places, in the order of their kinds."""
        self._filling = True
        self.clear()
        for kind, heading, colour in _kinds():
            of_kind = [place for place in found if place.kind == kind]
            if of_kind:
                top = self._add(heading.format(count=len(of_kind)), colour, of_kind)
                top.setExpanded(kind != places.WORST or len(of_kind) == len(found))
        self._filling = False
        self.setVisible(bool(found))

    def _add(self, heading, colour, of_kind):
        top = QtGui.QTreeWidgetItem(self, [heading])
        top.setIcon(0, _dot(colour))
        font = top.font(0)
        font.setBold(True)
        top.setFont(0, font)
        top.setData(0, QtCore.Qt.UserRole, of_kind)
        for place in of_kind[:MOST]:
            row = QtGui.QTreeWidgetItem(top, [place.text])
            row.setToolTip(0, place.text)
            row.setData(0, QtCore.Qt.UserRole, [place])
        if len(of_kind) > MOST:
            text = translate("collarmesh", "and {count} more").format(count=len(of_kind) - MOST)
            more = QtGui.QTreeWidgetItem(top, [text])
            more.setData(0, QtCore.Qt.UserRole, of_kind[MOST:])
        return top

    def pick_first(self, kind):
        """Picks the first row of the kind, as a click would."""
        for i in range(self.topLevelItemCount()):
            top = self.topLevelItem(i)
            if top.data(0, QtCore.Qt.UserRole)[0].kind == kind:
                top.setExpanded(True)
                self.setCurrentItem(top.child(0))

    def resizeEvent(self, event):
        super().resizeEvent(event)
        self.scheduleDelayedItemsLayout()

    def mousePressEvent(self, event):
        self._moved_to = None
        super().mousePressEvent(event)

    def _moved(self, item, _previous):
        if item is not None and not self._filling:
            self._moved_to = item
            self._pick(item)

    def _clicked(self, item, _column):
        """Handles a click on the current row, because the view may have moved since it was picked."""
        if item is not self._moved_to:
            self._pick(item)

    def _pick(self, item):
        self.picked.emit(item.data(0, QtCore.Qt.UserRole))


class _Wrapped(QtGui.QStyledItemDelegate):
    """A delegate that makes rows as high as their texts need."""

    def sizeHint(self, option, index):
        tree = self.parent()
        levels = 2 if index.parent().isValid() else 1
        around = 2 * tree.frameWidth() + tree.verticalScrollBar().sizeHint().width()  # scroll bar
        wrapped = QtGui.QStyleOptionViewItem(option)
        wrapped.rect = QtCore.QRect(0, 0, tree.width() - levels * tree.indentation() - around, MOST_PIXELS)
        return super().sizeHint(wrapped, index) + QtCore.QSize(0, 3)


def _kinds():
    return (
        (places.PROBLEM, translate("collarmesh", "Problems ({count})"), "#c83c3c"),
        (places.WARNING, translate("collarmesh", "Warnings ({count})"), "#e0a040"),
        (places.REPAIR, translate("collarmesh", "Repaired ({count})"), "#4c86c6"),
        (places.OFF_FACE, translate("collarmesh", "Nodes off their face ({count})"), "#e0a040"),
        (places.LAYERS, translate("collarmesh", "Lower layers ({count})"), "#4c86c6"),
        (places.WORST, translate("collarmesh", "Worst elements ({count})"), "#909090"),
    )


def _dot(colour):
    picture = QtGui.QPixmap(12, 12)
    picture.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(picture)
    painter.setRenderHint(QtGui.QPainter.Antialiasing)
    painter.setPen(QtCore.Qt.NoPen)
    painter.setBrush(QtGui.QColor(colour))
    painter.drawEllipse(1, 1, 10, 10)
    painter.end()
    return QtGui.QIcon(picture)
