"""Handles of a sphere, box or cylinder in the 3D view: one moves it, the others change its lengths."""

import FreeCAD
from pivy import coin

SHARE = 0.12  # of the object's diagonal: a handle's length
LEAST = 1e-3  # of the object's diagonal: no length gets smaller by dragging
AXES = {"X": FreeCAD.Vector(1, 0, 0), "Y": FreeCAD.Vector(0, 1, 0), "Z": FreeCAD.Vector(0, 0, 1)}


def rods_of(kind):
    """What each length's handle slides along: (name of the length, axis in the object's frame)."""
    return {
        "Sphere": (("Radius", "X"),),
        "Box": (("Length", "X"), ("Width", "Y"), ("Height", "Z")),
        "Cylinder": (("Radius", "X"), ("Height", "Z")),
    }.get(kind, ())


class Handle:
    """A dragger of Coin at a place, of a length in mm. `dragged(translation)` is called with millimetres."""

    def __init__(self, dragger, dragged):
        self.node = coin.SoSeparator()
        self.transform = coin.SoTransform()
        self.dragger = dragger
        self.dragged = dragged
        self.scale = 1
        self.node.addChild(self.transform)
        self.node.addChild(dragger)
        dragger.addMotionCallback(self._moved, None)

    def put(self, place, rotation, scale):
        """Back to no translation, there."""
        self.scale = scale
        self.transform.translation = tuple(place)
        self.transform.rotation = coin.SbRotation(*rotation.Q)
        self.transform.scaleFactor = (scale, scale, scale)
        self.dragger.translation = (0, 0, 0)

    def _moved(self, _data, _dragger):
        self.dragged(FreeCAD.Vector(*self.dragger.translation.getValue().getValue()) * self.scale)


class Handles:
    """All handles of an object, in a node of the scene. A drag changes the object's properties at once; `changed()` is
    called after each step."""

    def __init__(self, obj, kind, changed):
        self.object = obj
        self.changed = changed
        self.node = coin.SoSeparator()
        self.node.setName("collarmesh_size_handles")
        self.handles = []
        self._at_start = None
        centre = Handle(coin.SoDragPointDragger(), self._move)
        self._add(centre, "Placement")
        for length, axis in rods_of(kind):
            self._add(Handle(coin.SoTranslate1Dragger(), lambda by, name=length: self._stretch(name, by)), length, axis)
        self.place()

    def _add(self, handle, name, axis=""):
        handle.name, handle.axis = name, axis
        handle.dragger.addStartCallback(self._started, None)
        handle.dragger.addFinishCallback(self._finished, None)
        self.handles.append(handle)
        self.node.addChild(handle.node)

    def place(self, but=None):
        """Put the handles where the object is; `but`: the one that is being dragged."""
        placement = self.object.Placement
        scale = SHARE * max(self.object.Shape.BoundBox.DiagonalLength, 1e-6)
        for handle in self.handles:
            if handle is but:
                continue
            if not handle.axis:
                handle.put(placement.multVec(self._middle()), FreeCAD.Rotation(), scale)
                continue
            axis = AXES[handle.axis]
            turn = placement.Rotation.multiply(FreeCAD.Rotation(AXES["X"], axis))
            handle.put(placement.multVec(self._end(handle)), turn, scale)

    def _middle(self):
        return self.object.Proxy.middle(self.object)

    def _end(self, handle):
        """Where a length ends, in the object's frame."""
        along = AXES[handle.axis] * getattr(self.object, handle.name).Value
        middle = self._middle()
        if handle.name == "Radius":
            return middle + along
        across = FreeCAD.Vector(*(0 if AXES[handle.axis][i] else middle[i] for i in range(3)))
        return across + along

    def _started(self, _data, dragger):
        self._dragging = next(handle for handle in self.handles if handle.dragger == dragger)
        self._at_start = self.object.Placement.copy(), {
            handle.name: getattr(self.object, handle.name).Value for handle in self.handles if handle.axis
        }

    def _finished(self, _data, _dragger):
        self._at_start = self._dragging = None
        self.place()

    def _move(self, by):
        if self._at_start is None:
            return
        placement, _ = self._at_start
        self.object.Placement = FreeCAD.Placement(placement.Base + by, placement.Rotation)
        self._update()

    def _stretch(self, name, by):
        if self._at_start is None:
            return
        least = LEAST * self.object.Shape.BoundBox.DiagonalLength
        setattr(self.object, name, max(least, self._at_start[1][name] + by.x))
        self._update()

    def _update(self):
        self.object.recompute()
        self.place(but=self._dragging)
        self.changed()
