#!/usr/bin/env python3
"""Measures how evenly `--partitions` divides meshes and how many faces it cuts, compared with Scotch's own
program (scotch_gpart with its defaults, Debian's package scotch; the median of five runs, because their results
differ) and with Gmsh's METIS (gmsh -part). All three divide the same mesh. This script counts cut faces and the tets of
each partition; it reads both from the corners of the tetrahedra.
partitions.py [--program build/release/bin/collarmesh]"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import tempfile
from pathlib import Path

import meshio
import numpy as np

from tables import si, table

sources = Path(__file__).resolve().parents[2]
models = sources / "resources" / "models"
partition_counts = (2, 4, 8, 16, 64)
inputs = {  # the file of each mesh and the options for making it
    "box": ("box.off", "--size", "0.082"),
    "bracket": ("bracket.off", "--size", "3"),
    "bracket, finer": ("bracket.off", "--size", "1.2"),
    "flange (CAD)": ("flange.step",),
    "flange (CAD), finer": ("flange.step", "--size", "2"),
}


def run(*command) -> str:
    found = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if found.returncode != 0:
        raise SystemExit(f"{command}: {found.returncode}\n{found.stdout[-2000:]}\n{found.stderr[-2000:]}")
    return found.stdout + found.stderr


def tetrahedra(path: Path) -> tuple[np.ndarray, np.ndarray | None]:
    """Returns the corners (m, 4) and partitions (m,) of the tetrahedra of a .vtu file."""
    mesh = meshio.read(path)
    return mesh.cells_dict["tetra"], mesh.cell_data_dict.get("partition", {}).get("tetra")


def pairs_with_a_face(tets: np.ndarray) -> np.ndarray:
    """Returns the pairs of tets with a common face, as an array (f, 2) of row numbers in `tets`."""
    corners = np.sort(tets, axis=1)
    sides = np.concatenate([np.delete(corners, k, axis=1) for k in range(4)])
    owner = np.tile(np.arange(len(tets)), 4)
    order = np.lexsort(sides.T)
    sides, owner = sides[order], owner[order]
    same = (sides[1:] == sides[:-1]).all(axis=1)
    return np.stack([owner[:-1][same], owner[1:][same]], axis=1)


def write_graph(path: Path, tets: int, pairs: np.ndarray) -> None:
    """Writes a graph in Scotch's format (its user's guide, "Graph files")."""
    neighbours: list[list[int]] = [[] for _ in range(tets)]
    for t, u in pairs.tolist():
        neighbours[t].append(u)
        neighbours[u].append(t)
    lines = [f"0\n{tets} {2 * len(pairs)}\n0 000"]
    lines += [" ".join(map(str, (len(each), *each))) for each in neighbours]
    path.write_text("\n".join(lines) + "\n")


def by_scotch(graph: Path, partitions: int, tets: int) -> np.ndarray:
    mapping = graph.with_suffix(".map")
    run("scotch_gpart", partitions, graph, mapping)
    numbers = np.loadtxt(mapping, skiprows=1, dtype=np.int64)
    found = np.full(tets, -1)
    found[numbers[:, 0]] = numbers[:, 1]
    return found


def by_gmsh(mesh: Path, partitions: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns corners (m, 4) and partitions (m,) of the tetrahedra, in Gmsh's own order."""
    out = mesh.with_name("by_gmsh.msh")
    run("gmsh", mesh, "-0", "-part", partitions, "-part_no_topo", "-save_all", "-format", "msh22", "-o", out)
    corners, found = [], []
    for line in out.read_text().split("$Elements\n", 1)[1].split("$EndElements", 1)[0].splitlines()[1:]:
        words = line.split()
        if words[1] == "4":
            assert int(words[2]) == 4 and words[5] == "1", line
            found.append(int(words[6]) - 1)
            corners.append([int(word) for word in words[7:]])
    return np.array(corners), np.array(found)


def judged(partition: np.ndarray, pairs: np.ndarray, partitions: int) -> tuple[int, float]:
    """Returns the number of cut faces, and the size of the largest partition divided by the mean size, minus 1."""
    sizes = np.bincount(partition, minlength=partitions)
    assert len(sizes) == partitions and partition.min() >= 0
    cut = int((partition[pairs[:, 0]] != partition[pairs[:, 1]]).sum())
    return cut, sizes.max() * partitions / len(partition) - 1


def debian_version(package: str) -> str:
    return run("dpkg-query", "-W", "-f", "${Version}", package)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default=sources / "build/release/bin/collarmesh")
    arguments = parser.parse_args()
    missing = [name for name in ("scotch_gpart", "gmsh") if shutil.which(name) is None]
    if missing:
        raise SystemExit(f"{missing} not installed")
    program = arguments.program.resolve()
    print(f"scotch {debian_version('scotch')}, gmsh {debian_version('gmsh')}\n")
    rows, worst = [], {"scotch_gpart": 0.0, "Gmsh": 0.0}
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        for name, (file, *options) in inputs.items():
            run(program, models / file, "-o", place / "mesh.vtu", "-q", *options)
            run(program, "convert", place / "mesh.vtu", "-o", place / "mesh.msh2", "-q")
            shutil.copy(place / "mesh.msh2", place / "mesh.msh")
            tets, _ = tetrahedra(place / "mesh.vtu")
            pairs = pairs_with_a_face(tets)
            write_graph(place / "mesh.grf", len(tets), pairs)
            for partitions in partition_counts:
                run(program, "convert", place / "mesh.vtu", "-o", place / "divided.vtu",
                    "--partitions", partitions)
                runs = [judged(by_scotch(place / "mesh.grf", partitions, len(tets)), pairs, partitions)
                        for _ in range(5)]
                cuts = {"collarmesh": judged(tetrahedra(place / "divided.vtu")[1], pairs, partitions),
                        "scotch_gpart": sorted(runs)[2]}
                gmsh_tets, partition = by_gmsh(place / "mesh.msh", partitions)
                assert len(gmsh_tets) == len(tets)
                cuts["Gmsh"] = judged(partition, pairs_with_a_face(gmsh_tets), partitions)
                ours = cuts["collarmesh"][0]
                for peer in worst:
                    worst[peer] = max(worst[peer], ours / cuts[peer][0])
                rows.append([name, si(len(tets)), str(partitions)]
                            + [f"{cut} ({100 * uneven:.1f} %)" for cut, uneven in cuts.values()]
                            + [f"{ours / cuts['scotch_gpart'][0]:.2f}", f"{ours / cuts['Gmsh'][0]:.2f}"])
    print(table(["mesh", "tets", "partitions", "collarmesh: cut faces (imbalance)", "scotch_gpart",
                 "Gmsh's METIS", "to scotch_gpart", "to Gmsh's"], rows))
    print("\nat most " + ", ".join(f"{ratio:.3f} times {peer}'s" for peer, ratio in worst.items()))


if __name__ == "__main__":
    main()
