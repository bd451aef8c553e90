#!/usr/bin/python3
"""VTK packs our .vtu with LZ4 in every way that it knows; we read the mesh that we wrote.

    vtk_lz4_test.py PROGRAM MODELS   (Debian's python3-vtk9)
"""

import itertools
import pathlib
import subprocess
import sys
import tempfile

try:
    import vtk
except ImportError:
    vtk = None

BLOCK = 1024  # bytes, so that arrays have several blocks


def pack(source, target, mode, base64, wide):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(source))
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileName(str(target))
    writer.SetCompressorTypeToLZ4()
    writer.SetBlockSize(BLOCK)
    writer.SetDataModeToBinary() if mode == "binary" else writer.SetDataModeToAppended()
    writer.SetEncodeAppendedData(base64)
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    if not writer.Write() or b"vtkLZ4DataCompressor" not in target.read_bytes()[:500]:
        raise SystemExit("VTK wrote no file packed with LZ4")


def main():
    program, models = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    if vtk is None:
        print("python3-vtk9 is not installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)

        def as_text(source):
            out = source.with_suffix(".mesh")
            subprocess.run([program, "convert", source, "-o", out, "--quiet"], check=True)
            return out.read_text()

        ours = folder / "ours.vtu"
        subprocess.run([program, models / "box.off", "-o", ours, "--size", "0.3", "--quiet"], check=True)
        expected = as_text(ours)
        for mode, base64, wide in itertools.product(("binary", "appended"), (False, True), (False, True)):
            packed = folder / f"{mode}{base64}{wide}.vtu"
            pack(ours, packed, mode, base64, wide)
            if as_text(packed) != expected:
                raise SystemExit(f"{packed.name} is another mesh")
        damaged = bytearray(packed.read_bytes())
        damaged[len(damaged) // 2] ^= 0x55
        (folder / "damaged.vtu").write_bytes(damaged[: len(damaged) * 3 // 4])
        run = subprocess.run([program, "convert", folder / "damaged.vtu",
                             "-o", folder / "out.mesh"], capture_output=True)
        if run.returncode != 3:
            raise SystemExit(f"a damaged file: exit code {run.returncode}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
