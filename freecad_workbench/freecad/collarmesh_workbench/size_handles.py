"""Handles of a sphere, box or cylinder in the 3D view. Handles at its middle move it; the others change its
lengths."""

import FreeCAD
import FreeCADGui
from pivy import coin
from PySide import QtCore

SHARE = 0.1  # half a handle's length, relative to the object's diagonal
SHARE_OF_VIEW = 0.025  # least half of a handle's length, relative to the visible height
THICK = 1.3  # thickness of a handle, relative to that of Coin's arrows
EVERY = 20  # milliseconds between readings of the handles
LEAST = 1e-3  # shortest length that dragging can make, relative to the object's diagonal
AXES = {"X": FreeCAD.Vector(1, 0, 0), "Y": FreeCAD.Vector(0, 1, 0), "Z": FreeCAD.Vector(0, 0, 1)}


def rods_of(kind):
    """Returns a pair for each length with a handle: the name of the length, and the axis of the object along which the
    handle slides."""
    return {
        "Sphere": (("Radius", "X"),),
        "Box": (("Length", "X"), ("Width", "Y"), ("Height", "Z")),
        "Cylinder": (("Radius", "X"), ("Height", "Z")),
    }.get(kind, ())


class Handle:
    """An arrow that is dragged along an axis of the object. `name`: of the length that it changes, or of the axis along
    which it moves the object. `dragged(distance)` gets the distance from where the mouse was pressed, in mm.
    """

    def __init__(self, name, axis, dragged):
        self.name = name
        self.axis = axis
        self.dragged = dragged
        self.scale = 1
        self.was_at = 0.0
        self.node = coin.SoSeparator()
        self.transform = coin.SoTransform()
        self.dragger = coin.SoTranslate1Dragger()
        self.node.addChild(self.transform)
        self.node.addChild(self.dragger)

    def moves(self):
        return self.name == self.axis

    def put(self, place, rotation, scale):
        """Moves the handle to a place, and resets its translation. `scale` is half of its length, mm."""
        self.scale = scale
        self.was_at = 0.0
        self.transform.translation = tuple(place)
        self.transform.rotation = coin.SbRotation(*rotation.Q)
        self.transform.scaleFactor = (scale, THICK * scale, THICK * scale)
        self.dragger.translation = (0, 0, 0)

    def is_held(self):
        return bool(self.dragger.isActive.getValue())

    def is_at(self):
        return self.dragger.translation.getValue()[0]

    def look(self):
        """Calls `dragged` if the handle was moved."""
        if self.is_at() != self.was_at:
            self.was_at = self.is_at()
            self.dragged(self.was_at * self.scale)


class Handles:
    """All handles of an object, in its node of the scene, until `remove`. A drag changes the object's properties at
    once; `changed()` is called after each step.

    A timer reads the positions of the handles: the callbacks of pivy's draggers would crash FreeCAD (pivy 0.6 runs
    them without Python's lock)."""

    def __init__(self, obj, kind, changed):
        self.object = obj
        self.changed = changed
        self.node = coin.SoAnnotation()  # drawn in front of everything
        self.node.setName("collarmesh_size_handles")
        self.handles = []
        self._hidden_from_mouse = []
        self._held = None
        self._at_start = None
        self._height = 0  # height of the view when the handles were placed
        for axis in AXES:
            self._add(axis, axis, lambda by, axis=axis: self._move(axis, by))
        for length, axis in rods_of(kind):
            self._add(length, axis, lambda by, name=length: self._stretch(name, by))
        self.place()
        obj.ViewObject.RootNode.insertChild(self.node, 0)  # before the object's placement
        self._hide_others_from_mouse()
        self._timer = QtCore.QTimer()
        self._timer.timeout.connect(self._look)
        self._timer.start(EVERY)

    def _hide_others_from_mouse(self):
        """Lets the mouse reach handles inside a part."""
        for each in self.object.Document.Objects:
            root = getattr(each.ViewObject, "RootNode", None)
            if root is not None:
                style = coin.SoPickStyle()
                style.style = coin.SoPickStyle.UNPICKABLE
                # after the handles' node, so that they stay pickable
                root.insertChild(style, 1 if each is self.object else 0)
                self._hidden_from_mouse.append((root, style))

    def remove(self):
        self._timer.stop()
        for root, style in self._hidden_from_mouse:
            root.removeChild(style)
        self.object.ViewObject.RootNode.removeChild(self.node)

    def _add(self, name, axis, dragged):
        handle = Handle(name, axis, dragged)
        self.handles.append(handle)
        self.node.addChild(handle.node)

    def _look(self):
        held = next(
            (handle for handle in self.handles if handle.is_held() or handle.is_at() != handle.was_at), None
        )
        if held is not None and self._held is None:
            lengths = {
                handle.name: getattr(self.object, handle.name).Value
                for handle in self.handles
                if not handle.moves()
            }
            self._at_start = self.object.Placement.copy(), lengths
        if held is not None or self._held is not None:
            (held or self._held).look()
        if held is None and (self._held is not None or self._shown_height() != self._height):
            self.place()
        self._held = held

    def place(self, but=None):
        """Puts the handles where the object is, except the one named `but`, which is being dragged."""
        placement = self.object.Placement
        self._height = self._shown_height()
        scale = max(SHARE * self.object.Shape.BoundBox.DiagonalLength, SHARE_OF_VIEW * self._height)
        for handle in self.handles:
            if handle.name == but:
                continue
            turn = placement.Rotation.multiply(FreeCAD.Rotation(AXES["X"], AXES[handle.axis]))
            place = self._middle() if handle.moves() else self._end(handle)
            handle.put(placement.multVec(place), turn, scale)

    def _shown_height(self):
        """Returns the visible height at the object, in mm."""
        view = FreeCADGui.getDocument(self.object.Document.Name).ActiveView
        if not hasattr(view, "getCameraNode"):
            return 0
        camera = view.getCameraNode()
        if hasattr(camera, "heightAngle"):
            return camera.focalDistance.getValue() * camera.heightAngle.getValue()
        return camera.height.getValue()

    def _middle(self):
        return self.object.Proxy.middle(self.object)

    def _end(self, handle):
        """Returns the position of the handle of a length, in the object's frame."""
        along = AXES[handle.axis] * getattr(self.object, handle.name).Value
        middle = self._middle()
        if handle.name == "Radius":
            return middle + along
        across = FreeCAD.Vector(*(0 if AXES[handle.axis][i] else middle[i] for i in range(3)))
        return across + along

    def _move(self, axis, by):
        placement, _ = self._at_start
        base = placement.Base + placement.Rotation.multVec(AXES[axis] * by)
        self.object.Placement = FreeCAD.Placement(base, placement.Rotation)
        self._update(axis)

    def _stretch(self, name, by):
        least = LEAST * self.object.Shape.BoundBox.DiagonalLength
        setattr(self.object, name, max(least, self._at_start[1][name] + by))
        self._update(name)

    def _update(self, name):
        self.object.recompute()
        self.place(but=name)
        self.changed()
