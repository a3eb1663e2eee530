#!/usr/bin/env python3
"""Makes the pictures of the window in docs/view.md.

    benchmarks/view/tour.py SCENE FOLDER [--glint FILE] [--size WxH] [--spp N]

SCENE is the gallery (build/release/bin/gallery FOLDER writes it). Replays the tour below in an Xvfb of its own and
writes FOLDER/view_*.png with 256 colours each. Needs Pillow (python3-pil).
"""
import argparse
import os
import pathlib
import subprocess
import tempfile

from PIL import Image

from measure import ROOT, Screen

TOUR = """
    wait complete
    number max-roughness 0.6
    click find
    type rough
    move 100 300
    wait complete
    picture view_settings.png
    click find
    key ctrl+a BackSpace
    key F1
    picture view_help.png
    key F1
    # why a pixel looks as it does
    click {pixel}
    wait control tab Pixel
    move 20 20
    picture view_pixel.png
    key Escape
    # where the time goes
    click tab Passes
    key Home
    wait complete
    move 20 20
    picture view_passes.png
    click tab Settings
    # two settings beside each other
    click find
    type weight
    key Return b
    wait complete
    number skip-below 0.2
    move 20 20
    wait complete
    click Measure
    move 20 20
    picture view_compare.png
    click show difference
    move 20 20
    picture view_difference.png
    click edit A
    click Compare
    # a view and a layer
    click tab Views
    click view reflection.hit-shader
    move 20 20
    wait complete
    picture view_views.png
    click layer normal
    move 20 20
    wait complete
    picture view_layer.png
    quit
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default=str(ROOT / "build/release/tests/glint-view-script"))
    parser.add_argument("--size", default="440x500")
    parser.add_argument("--spp", default="8")
    parser.add_argument("--pixel", default="220 305", help="of the window, which is explained")
    arguments = parser.parse_args()
    with Screen() as screen, tempfile.TemporaryDirectory() as work:
        script = pathlib.Path(work) / "tour"
        script.write_text(TOUR.format(pixel=arguments.pixel))
        subprocess.run([arguments.program, str(script), "view", str(arguments.scene.resolve()), "--size", arguments.size,
                        "--spp", arguments.spp, "--verbose"], cwd=work, check=True,
                       env=dict(os.environ, DISPLAY=screen.display))
        for picture in sorted(pathlib.Path(work).glob("view_*.png")):
            image = Image.open(picture).convert("RGB")
            image.quantize(256, dither=Image.Dither.NONE).save(arguments.folder / picture.name, optimize=True)


if __name__ == "__main__":
    main()
