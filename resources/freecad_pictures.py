#!/usr/bin/python3
"""Makes the pictures of the FreeCAD page: the window during its tests, and a strip from a part to its stresses.

    resources/freecad_pictures.py PROGRAM [FOLDER]

PROGRAM is the mesher. Needs freecad, xvfb, calculix-ccx and python3-pil. Fails if a test fails.
"""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
TESTS = HERE.parent / "tests" / "freecad"
PAGE = {  # pictures, by the test that makes them
    "panel_test.py": ("freecad_panel", "freecad_worst_elements", "freecad_message", "freecad_advanced"),
    "preview_gui_test.py": ("freecad_size_colours",),
    "parts_gui_test.py": ("freecad_volumes",),
    "triangles_gui_test.py": ("freecad_groups",),
    "shells_gui_test.py": ("freecad_shell",),
    "sizes_gui_test.py": ("freecad_size_handles", "freecad_sizes"),
    "layers_gui_test.py": ("freecad_layers_panel", "freecad_layers"),
    "refine_by_result_gui_test.py": ("freecad_refine_by_result", "freecad_refined"),
    "document_gui_test.py": ("freecad_out_of_date", "freecad_menu", "freecad_statistics"),
}
LARGEST = 200000  # largest size of a file, bytes
STEP = (500, 327)
BARS = 100  # pixels at the top of FreeCAD's window, the same in all pictures
GAP = 8


def take(program, script, folder):
    subprocess.run([sys.executable, TESTS / "run.py", program, script, "--gui", "--", folder], check=True)


def save(picture, path):
    """Saves a picture with the most colours (256 to 64) with which its file is smaller than LARGEST."""
    for colours in (256, 192, 128, 96, 64):
        few = picture.convert("RGB").quantize(colours, kmeans=2, dither=Image.Dither.NONE)
        few.save(path, optimize=True)
        if path.stat().st_size < LARGEST:
            break
    print(path, path.stat().st_size)


def strip(folder):
    """Joins pictures in two rows of three."""
    width, height = STEP
    whole = Image.new("RGB", (3 * width + 2 * GAP, 2 * height + GAP), "white")
    for i in range(6):
        step = Image.open(folder / f"step{i + 1}.png").convert("RGB")
        step = step.crop((0, BARS, *step.size)).resize(STEP, Image.Resampling.LANCZOS)
        whole.paste(step, ((i % 3) * (width + GAP), (i // 3) * (height + GAP)))
    return whole


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    into = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else HERE / "images"
    with tempfile.TemporaryDirectory(prefix="collarmesh-pictures-") as name:
        folder = pathlib.Path(name)
        take(program, HERE / "freecad_strip.py", folder)
        save(strip(folder), into / "freecad_strip.png")
        for test, pictures in PAGE.items():
            take(program, TESTS / test, folder)
            for picture in pictures:
                save(Image.open(folder / f"{picture}.png"), into / f"{picture}.png")


if __name__ == "__main__":
    main()
