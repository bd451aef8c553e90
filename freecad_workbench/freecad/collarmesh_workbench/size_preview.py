"""Shows the requested sizes as colours on the part, with a legend."""

import contextlib

import numpy
from PySide import QtCore, QtGui

from . import asked_sizes, compatibility, numbers_typed, widgets
from .translations import translate

NAME = "collarmesh_sizes"
# Colours from the smallest size to the largest one. Lightness increases, so that they can be told apart in
# grey.
SCALE = numpy.array([(0.267, 0.005, 0.329), (0.230, 0.322, 0.546), (0.128, 0.567, 0.551), (0.369, 0.789, 0.383),
                     (0.993, 0.906, 0.144)])
WAIT = 300  # milliseconds to wait after a change
HEIGHT = 12  # height of the colour scale, pixels


class SizePreview(QtGui.QWidget):
    """A button that shows the part in colours while it is down. `settings()` returns Settings, or None if the
    fields are invalid."""

    def __init__(self, obj, settings):
        super().__init__()
        self.object, self.settings = obj, settings
        self._surface, self._node, self._before = None, None, ()
        self.button = QtGui.QPushButton(translate("collarmesh", "Show sizes"))
        self.button.setObjectName("collarmesh_show_sizes")
        self.button.setCheckable(True)
        self.button.setToolTip(translate("collarmesh",
                                         "The sizes that are asked for, as colours on the part. The mesh is finer "
                                         "where thin places and sharp corners need it"))
        self.legend = QtGui.QLabel()
        self.legend.setObjectName("collarmesh_sizes_legend")
        self.ends = QtGui.QLabel()
        self.ends.setObjectName("collarmesh_sizes_ends")
        widgets.stack(self, self.button, self.legend, self.ends)
        self.legend.hide()
        self.ends.hide()
        self._timer = QtCore.QTimer(self, singleShot=True, interval=WAIT)
        self._timer.timeout.connect(self._show)
        self.button.toggled.connect(self._toggle)

    def update_soon(self, shape_too=False):
        """Updates the colours soon, after a change of sizes or of the shape."""
        if shape_too:
            self._surface = None
        if self.button.isChecked():
            self._timer.start()

    def clear(self):
        """Restores the appearance of part and mesh."""
        self._timer.stop()
        with contextlib.suppress(ReferenceError, RuntimeError):  # objects may no longer exist
            if self._node is not None:
                self._remove()
            for obj, visible in self._before:
                if obj.Document is not None:
                    obj.ViewObject.Visibility = visible
        self._before = ()
        self._surface = None

    def _toggle(self, down):
        if down:
            self._show()
        else:
            self.clear()
        self.legend.setVisible(down and self._node is not None)
        self.ends.setVisible(down and self._node is not None)

    def _show(self):
        part, settings = compatibility.meshed_object(self.object), self.settings()
        if part is None or settings is None:
            return
        try:
            self._surface = self._surface or asked_sizes.surface_of(part)
            sizes = asked_sizes.on(self._surface, part, settings)
        except Exception:  # OpenCASCADE's exceptions, too; the run reports the problem
            return
        if len(sizes) == 0:
            return
        if not self._before:
            self._before = tuple((each, each.ViewObject.Visibility) for each in (part, self.object))
            for each, _ in self._before:
                each.ViewObject.Visibility = False
        self._draw(sizes)
        self._explain(sizes.min(), sizes.max())

    def _draw(self, sizes):
        from pivy import coin

        if self._node is not None:
            self._remove()
        self._node = coloured(coin, self._surface.places, colours(sizes))
        self.object.ViewObject.RootNode.addChild(self._node)  # it stays visible when the object is hidden

    def _remove(self):
        node, self._node = self._node, None
        self.object.ViewObject.RootNode.removeChild(node)

    def _explain(self, smallest, largest):
        picture = QtGui.QImage(256, 1, QtGui.QImage.Format_RGB32)
        for x, colour in enumerate(on_scale(numpy.linspace(0, 1, 256))):
            picture.setPixel(x, 0, QtGui.QColor.fromRgbF(*map(float, colour)).rgb())
        self.legend.setPixmap(QtGui.QPixmap.fromImage(picture.scaled(max(60, self.button.width()), HEIGHT)))
        text = f"{smallest:.3g} mm" if smallest == largest else f"{smallest:.3g} mm … {largest:.3g} mm"
        self.ends.setText(numbers_typed.shown(text))
        self.legend.show()
        self.ends.show()


def colours(sizes):
    """Returns red, green and blue for each size, by its logarithm; one colour if all sizes are equal."""
    smallest, largest = numpy.log(sizes.min()), numpy.log(sizes.max())
    if largest - smallest < 1e-6:
        return on_scale(numpy.ones(len(sizes)))
    return on_scale((numpy.log(sizes) - smallest) / (largest - smallest))


def on_scale(shares):
    """Returns colours, shape (n, 3), for positions on the scale from 0 to 1."""
    marks = numpy.linspace(0, 1, len(SCALE))
    return numpy.stack([numpy.interp(shares, marks, SCALE[:, i]) for i in range(3)], axis=1)


def coloured(coin, places, rgb):
    """Returns a node that shows separate triangles, with a colour for each corner."""
    node, hints, points = coin.SoSeparator(), coin.SoShapeHints(), coin.SoCoordinate3()
    node.setName(NAME)
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE  # lit from both sides
    hints.shapeType = coin.SoShapeHints.UNKNOWN_SHAPE_TYPE
    points.point.setValues(0, len(places), places.tolist())
    material, binding, faces = coin.SoMaterial(), coin.SoMaterialBinding(), coin.SoIndexedFaceSet()
    material.diffuseColor.setValues(0, len(rgb), rgb.tolist())
    binding.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
    corners = numpy.arange(len(places)).reshape(-1, 3)
    indices = numpy.concatenate([corners, numpy.full((len(corners), 1), -1)], axis=1).ravel()
    faces.coordIndex.setValues(0, len(indices), indices.tolist())
    pick = coin.SoPickStyle()
    pick.style = coin.SoPickStyle.UNPICKABLE
    for each in (pick, hints, points, material, binding, faces):
        node.addChild(each)
    return node
