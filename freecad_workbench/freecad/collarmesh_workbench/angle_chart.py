"""A chart of the dihedral angles of all tetrahedra, or of the angles of all triangles, with a mark at the smallest
one."""

from PySide import QtCore, QtGui

from .translations import translate

SMALLEST, LARGEST, WORST = "#4c86c6", "#e0a040", "#c83c3c"
STRAIGHT = 180  # degrees


class AngleChart(QtGui.QWidget):
    """Two series of bars: how many elements have their smallest angle, and their largest, in each range of angles.
    Emits `worst_clicked` when the mark of the worst tetrahedron is clicked."""

    worst_clicked = QtCore.Signal()

    def __init__(self):
        super().__init__()
        self.setObjectName("collarmesh_chart")
        self.setMinimumHeight(120)
        self.setMouseTracking(True)
        self.series = []  # (colour, text, counts)
        self.bin_width = 10
        self.extremes = (0, STRAIGHT)
        self.is_of_tetrahedra = True

    def show_report(self, report):
        """Shows the angles of a run; lines have no angles."""
        dimension = report["options"]["dimension"]
        of_elements = report["check"]["triangles"] if dimension == 2 else report["mesh"]
        names, counted = (("min_angle", "max_angle"), "triangles") if dimension == 2 else (
            ("min_dihedral", "max_dihedral"), "tets")
        self.series = []
        self.is_of_tetrahedra = dimension == 3
        if dimension == 1:
            return
        first, last = (of_elements["histograms"][name] for name in names)
        self.bin_width = first["bin_width"]
        self.series = [(SMALLEST, translate("collarmesh", "smallest angle"), first[counted]),
                       (LARGEST, translate("collarmesh", "largest angle"), last[counted])]
        self.extremes = tuple(of_elements[name] for name in names)
        self.update()

    def sizeHint(self):
        return QtCore.QSize(260, 130)

    def _frame(self):
        """Returns the rectangle of the bars; text is above and below it."""
        line = self.fontMetrics().height()
        return QtCore.QRectF(6, line + 4, self.width() - 12, self.height() - 2 * line - 12)

    def _x(self, angle):
        frame = self._frame()
        return frame.left() + frame.width() * angle / STRAIGHT

    def _mark(self):
        """Returns the triangle that marks the smallest angle, which is that of the worst element."""
        x, bottom = self._x(self.extremes[0]), self._frame().bottom()
        corners = ((x, bottom - 1), (x - 5, bottom - 12), (x + 5, bottom - 12))
        return QtGui.QPolygonF([QtCore.QPointF(*corner) for corner in corners])

    def paintEvent(self, _event):
        painter = QtGui.QPainter(self)
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        ink = self.palette().color(QtGui.QPalette.WindowText)
        frame = self._frame()
        most = max([1, *(max(counts, default=0) for _, _, counts in self.series)])
        width = frame.width() * self.bin_width / STRAIGHT
        for i, (colour, _, counts) in enumerate(self.series):
            for bin_number, count in enumerate(counts):
                if count == 0:
                    continue
                height = max(2, frame.height() * count / most)  # so that even a single element is visible
                left = frame.left() + bin_number * width + i * width / 2
                bar = QtCore.QRectF(left, frame.bottom() - height, width / 2 - 0.5, height)
                painter.fillRect(bar, QtGui.QColor(colour))
        painter.setPen(ink)
        painter.drawLine(frame.bottomLeft(), frame.bottomRight())
        self._draw_scale(painter, frame)
        self._draw_legend(painter, frame)
        painter.setPen(QtGui.QPen(QtGui.QColor("white"), 1))
        painter.setBrush(QtGui.QColor(WORST))
        painter.drawPolygon(self._mark())
        painter.end()

    def _draw_scale(self, painter, frame):
        line = self.fontMetrics().height()
        for angle in range(0, STRAIGHT + 1, 30):
            place = QtCore.QRectF(self._x(angle) - 25, frame.bottom() + 3, 50, line)
            along = QtCore.Qt.AlignHCenter
            if angle == 0:
                place, along = QtCore.QRectF(frame.left(), place.top(), 50, line), QtCore.Qt.AlignLeft
            elif angle == STRAIGHT:
                place, along = QtCore.QRectF(frame.right() - 50, place.top(), 50, line), QtCore.Qt.AlignRight
            painter.drawLine(QtCore.QLineF(self._x(angle), frame.bottom(), self._x(angle), frame.bottom() + 3))
            painter.drawText(place, along, f"{angle}°")

    def _draw_legend(self, painter, frame):
        metrics, x = self.fontMetrics(), frame.left()
        line = metrics.height()
        for colour, text, _ in self.series:
            painter.fillRect(QtCore.QRectF(x, 2 + line * 0.25, line * 0.6, line * 0.6), QtGui.QColor(colour))
            painter.drawText(QtCore.QPointF(x + line * 0.8, 2 + metrics.ascent()), text)
            x += line * 1.6 + metrics.boundingRect(text).width()

    def _is_on_mark(self, place):
        around = self._mark().boundingRect().adjusted(-3, -3, 3, 3) if self.is_of_tetrahedra else None
        return around is not None and around.contains(QtCore.QPointF(place))

    def mousePressEvent(self, event):
        if self._is_on_mark(event.pos()):
            self.worst_clicked.emit()

    def mouseMoveEvent(self, event):
        over = self._is_on_mark(event.pos())
        self.setCursor(QtCore.Qt.PointingHandCursor if over else QtCore.Qt.ArrowCursor)
        self.setToolTip(self._tip(event.pos(), over))

    def _tip(self, place, over_mark):
        if over_mark:
            return translate("collarmesh", "The worst tetrahedron: {angle}°. Click to see it.").format(
                angle=f"{self.extremes[0]:.2f}")
        frame = self._frame()
        number = int((place.x() - frame.left()) / (frame.width() * self.bin_width / STRAIGHT))
        first = number * self.bin_width
        counts = [f"{text}: {counts[number]}" for _, text, counts in self.series if 0 <= number < len(counts)]
        return "\n".join([f"{first}° to {first + self.bin_width}°", *counts]) if counts else ""
