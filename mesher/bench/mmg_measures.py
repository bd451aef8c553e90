#!/usr/bin/env python3
"""Measures meshes in the same way as MMG's histograms, for comparison with published histograms: the quality of
tetrahedra, 72 sqrt(3) V / (sum of squared edge lengths)^(3/2), which is 1 for a regular tetrahedron; and edge lengths
divided by the requested size. Arguments: MESH SIZE ... Prints a Markdown row for each mesh."""

import itertools
import sys

import meshio
import numpy as np

ASKED = (0.71, 1.41)  # MMG counts edges of lengths between these, relative to the size, as good


def measures(path, size):
    mesh = meshio.read(path)
    tets = np.concatenate([cells.data for cells in mesh.cells if cells.type == "tetra"])
    corners = mesh.points[tets]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    pairs = list(itertools.combinations(range(4), 2))
    squares = sum(((corners[:, a] - corners[:, b]) ** 2).sum(1) for a, b in pairs)
    quality = 72 * 3 ** 0.5 * volumes / squares ** 1.5
    edges = np.unique(np.sort(np.concatenate([tets[:, pair] for pair in pairs]), axis=1), axis=0)
    lengths = np.linalg.norm(mesh.points[edges[:, 0]] - mesh.points[edges[:, 1]], axis=1) / size
    reached = (lengths > ASKED[0]) & (lengths < ASKED[1])
    return [len(tets), f"{quality.mean():.3f}", f"{quality.min():.3f}", f"{100 * (quality > 0.5).mean():.2f}%",
            f"{lengths.mean():.3f}", f"{lengths.min():.2f} to {lengths.max():.2f}", f"{100 * reached.mean():.1f}%"]


def main():
    print("| mesh | tets | mean quality | worst | above 0.5 | mean length | lengths | within 0.71 to 1.41 |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for path, size in zip(sys.argv[1::2], sys.argv[2::2]):
        print("| " + " | ".join(map(str, [path, *measures(path, float(size))])) + " |")


if __name__ == "__main__":
    main()
