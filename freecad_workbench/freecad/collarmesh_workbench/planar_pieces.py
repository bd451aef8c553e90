"""Merges triangles into few planar faces. Connected triangles in one plane become one face, with its holes."""

import math

import numpy
import Part

FLAT = 0.1  # degrees: triangles whose normals differ by less are in one plane
COARSE = 1  # degrees, in place of FLAT if there would be more than MOST faces; doubled until there are fewer
MOST = 2000


def faces(points, triangles):
    """Returns faces for triangles (indices of `points`, counterclockwise as seen from outside), the largest first. If a
    finely curved surface would have too many faces, fewer faces only approximate it."""
    normals = numpy.cross(points[triangles[:, 1]] - points[triangles[:, 0]],
                          points[triangles[:, 2]] - points[triangles[:, 0]])
    areas = numpy.linalg.norm(normals, axis=1)
    normals /= numpy.maximum(areas, 1e-300)[:, None]
    neighbours, angle = _neighbours(triangles), FLAT
    pieces = _pieces(normals, areas, neighbours, angle)
    while len(pieces) > MOST and angle < 45:
        angle = max(COARSE, 2 * angle)
        pieces = _pieces(normals, areas, neighbours, angle)
    pieces.sort(key=lambda piece: -areas[piece].sum())
    return [_face(points, triangles[piece], normals[piece[0]]) for piece in pieces[:MOST]]


def _neighbours(triangles):
    """Returns for each triangle its neighbours."""
    at_edge = {}
    for number, corners in enumerate(triangles.tolist()):
        for a, b in zip(corners, corners[1:] + corners[:1]):
            at_edge.setdefault((min(a, b), max(a, b)), []).append(number)
    neighbours = [[] for _ in triangles]
    for numbers in at_edge.values():
        for number in numbers:
            neighbours[number] += [other for other in numbers if other != number]
    return neighbours


def _pieces(normals, areas, neighbours, angle):
    """Returns pieces, each a list of connected triangles whose normals are within `angle` (degrees) of the normal of
    its first one. Begins with the largest triangles."""
    least, free, pieces = math.cos(math.radians(angle)), [True] * len(normals), []
    vectors = normals.tolist()
    for seed in numpy.argsort(-areas, kind="stable").tolist():
        if not free[seed]:
            continue
        free[seed] = False
        x, y, z = vectors[seed]
        piece = [seed]
        for number in piece:  # this loop appends to the list
            for other in neighbours[number]:
                if free[other]:
                    u, v, w = vectors[other]
                    if x * u + y * v + z * w > least:
                        free[other] = False
                        piece.append(other)
        pieces.append(piece)
    return pieces


def _face(points, triangles, normal):
    """Returns the face with the outline of triangles, in the plane of the first triangle; only that triangle if the
    outline bounds no valid face."""
    origin = points[triangles[0, 0]]
    try:
        wires = [_wire(points[loop], origin, normal) for loop in _loops(triangles.tolist())]
        face = Part.makeFace(wires, "Part::FaceMakerBullseye")
        if face.ShapeType != "Face" or not face.isValid():
            raise ValueError
    except (Part.OCCError, ValueError):  # the outline touches itself, or crosses itself in the plane
        face = Part.Face(_wire(points[triangles[0]], origin, normal))
    if numpy.dot(face.normalAt(*(sum(face.ParameterRange[i:i + 2]) / 2 for i in (0, 2))), normal) < 0:
        face.reverse()
    return face


def _wire(corners, origin, normal):
    flat = corners - numpy.outer((corners - origin) @ normal, normal)
    along = flat - numpy.roll(flat, 1, axis=0)
    along /= numpy.maximum(numpy.linalg.norm(along, axis=1), 1e-300)[:, None]
    turns = (along * numpy.roll(along, -1, axis=0)).sum(axis=1) < math.cos(math.radians(FLAT))
    flat = flat[turns] if turns.sum() > 2 else flat
    return Part.makePolygon([tuple(each) for each in (*flat, flat[0])])


def _loops(triangles):
    """Returns the outlines of triangles. No outline passes a point twice."""
    edges = {(a, b) for corners in triangles for a, b in zip(corners, corners[1:] + corners[:1])}
    after = {}
    for a, b in sorted(edges):
        if (b, a) not in edges:
            after.setdefault(a, []).append(b)
    loops, at = [], None
    path = {}  # points in order, each once
    while after or path:
        if not path:
            at = next(iter(after))
        path[at] = True
        following = after[at].pop()
        if not after[at]:
            del after[at]
        at = following
        if at in path:
            passed = list(path)
            loops.append(passed[passed.index(at):])
            for each in loops[-1]:
                del path[each]
    return loops
