#!/usr/bin/env python3
"""Makes the pictures of the book and of README.md: python3 docs/make_images.py PROGRAM [--check] [NAME ...]

Pictures of the window need Xvfb, xdotool and scrot; Pillow puts the others together. With --check nothing is
written: what the program makes now is compared with the pictures of the book, within the tolerance of the
snapshots of plots (src/app/tests/snapshots.rs). Without names all pictures are made.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from PIL import Image, ImageChops

DOCS = pathlib.Path(__file__).resolve().parent
EXAMPLES = DOCS.parent / "assets" / "examples"
SIZE = (1280, 720)
COLORS = 256
# What a colour may differ by, of 255, and the share of pixels that may differ by more.
LITTLE = 32
SHARE = 5e-4
# Where the time of the fit stands, which is another one each time.
TIMES = {"window": (1012, 357, 1278, 380), "screenshot": (1012, 357, 1278, 380), "planner": (1012, 357, 1278, 380), "joint": (1012, 421, 1278, 444)}
# Seconds after which a window has to be still.
PATIENCE = 90
LAB_TABLE = """Messung vom 3. Mai;;
Einfallswinkel (°);Ausfallswinkel (°);DoLP (%)
30;20;8,1
30;30;10,3
30;40;12,7
50;40;21,9
50;50;26,8
50;60;31,4
"""
WAVELENGTHS = {"blue": "n=1.6,k=2.4", "green": "n=2.07,k=2.9", "red": "n=2.6,k=3.6"}


def tabs(*panes):
    return {"tabs": {"active": 0, "parts": [{"pane": pane} for pane in panes]}}


# Of each picture of the window: the files that are opened, the panes (above, below), and then keys and texts for
# the list of commands.
WINDOWS = {
    "window": (["steel45_simulated.csv"], ["dolp", "landscape"], ["key F5"]),
    "joint": (["blue.csv", "green.csv", "red.csv"], ["dolp", "results"],
              ["command one sample at several", "key F5"]),
    "import": (["lab.csv"], ["dolp", "lobes"], []),
    "planner": (["steel45_simulated.csv"], ["planner"], ["key F5"]),
    "pane_picture": (["steel45_simulated.csv"], ["picture", "dolp"], []),
    "presentation": (["steel45_simulated.csv"], ["dolp", "lobes"], ["key F11"]),
    "screenshot": (["steel45_simulated.csv"], ["dolp", "landscape"], ["key F5"]),
}
DARK = {"screenshot"}


def measurements(program, folder):
    """The files that the window opens."""
    for example in EXAMPLES.iterdir():
        shutil.copy(example, folder)
    (folder / "lab.csv").write_text(LAB_TABLE, encoding="utf-8")
    for seed, (name, index) in enumerate(WAVELENGTHS.items(), 1):
        surface = f"{index},sigma=0.35,kd=0.12,kv=0.2,q=2.2,c=-0.4,sigma_v=0.6"
        subprocess.run([program, "simulate", "--set", surface, "--theta-i", "20:80:20", "--theta-r", "0:80:5", "--noise", "0.005",
                        "--seed", str(seed), "-o", folder / f"{name}.csv"], check=True)


def screenshot(folder):
    path = folder / "screen.png"
    subprocess.run(["scrot", "-o", path], check=True)
    with Image.open(path) as image:
        return image.convert("RGB").copy()


def still(folder):
    """The screen once it no longer changes: what is computed has come."""
    before, since, end = None, time.monotonic(), time.monotonic() + PATIENCE
    while time.monotonic() < end:
        now = screenshot(folder)
        if before is None or differing(before, now) > 0:
            since = time.monotonic()
        elif time.monotonic() - since > 3:
            return now
        before = now
        time.sleep(0.5)
    raise SystemExit(f"the window is not still after {PATIENCE} s")


def press(*words):
    subprocess.run(["xdotool", *words], check=True)


def act(action, folder):
    kind, _, rest = action.partition(" ")
    if kind == "key":
        press("key", rest)
        return
    press("key", "ctrl+shift+p")
    time.sleep(1)
    press("type", "--delay", "40", rest)
    time.sleep(1)
    press("key", "Return")
    still(folder)


def window(program, name, folder):
    """A picture of the window."""
    files, panes, actions = WINDOWS[name]
    measurements(program, folder)
    settings = folder / "config" / "pbrdf-explorer"
    settings.mkdir(parents=True)
    parts = [[1.0, tabs(pane)] for pane in panes]
    (settings / "settings.json").write_text(json.dumps({
        "settings": {"posterior": {"draws": 4000, "chains": 4, "priors": [], "bands": True}},
        "layout": {"rows": parts},
        "window": {"theme": "Dark" if name in DARK else "Light", "language": "English", "size": list(SIZE), "maximized": False, "knows_tour": True},
    }))
    running = subprocess.Popen([program, *files], cwd=folder, stdout=subprocess.DEVNULL)
    try:
        found = ""
        for _ in range(150):
            found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "pBRDF"], capture_output=True, text=True).stdout.split("\n")[0]
            if found:
                break
            time.sleep(0.2)
        press("windowmove", found, "0", "0", "windowsize", found, *map(str, SIZE), "windowfocus", found, "mousemove", "2", str(SIZE[1] - 2))
        still(folder)
        for action in actions:
            act(action, folder)
        return still(folder)
    finally:
        running.terminate()
        running.wait()


def spheres(program, _name, folder):
    """Three spheres side by side: a lamp, and a sky."""
    surface = ["--model", "gauss", "--set", "n=1.5,k=0,sigma=0.15,ks=1,kd=0.02,kv=0", "--size", "360"]
    images = []
    for light in (["--lamp", "70,135", "--show", "dolp"], ["--sky", "1", "--show", "dolp"], ["--sky", "1", "--show", "aop"]):
        subprocess.run([program, "picture", *surface, *light, "-o", folder / "one.png"], check=True)
        with Image.open(folder / "one.png") as image:
            images.append(image.convert("RGB").copy())
    whole = Image.new("RGB", (sum(image.width for image in images), images[0].height), "white")
    left = 0
    for image in images:
        whole.paste(image, (left, 0))
        left += image.width
    return whole


def differing(a, b):
    """Share of pixels that differ by more than a little; all of them where the sizes do."""
    if a.size != b.size:
        return 1.0
    largest = ImageChops.difference(a, b).split()
    largest = ImageChops.lighter(ImageChops.lighter(largest[0], largest[1]), largest[2])
    return sum(largest.histogram()[LITTLE + 1:]) / (a.width * a.height)


def differing_place(a, b):
    """The box (left, top, right, bottom) around the pixels that differ by more than a little."""
    return ImageChops.difference(a, b).convert("L").point(lambda value: 255 if value > LITTLE else 0).getbbox()


def make(how, program, name, display):
    """A picture, made in a place of its own."""
    with tempfile.TemporaryDirectory() as place:
        os.environ.update(HOME=place, DISPLAY=display, **{f"XDG_{kind.upper()}_HOME": f"{place}/{kind}" for kind in ("config", "data", "cache")})
        os.environ.pop("WAYLAND_DISPLAY", None)
        return how(program, name, pathlib.Path(place))


def without_time(name, image):
    """The picture with the place of the time white."""
    rest = image.convert("RGB")
    if name in TIMES:
        rest.paste("white", TIMES[name])
    return rest


def save(path, name, image):
    """Writes the picture in a palette that does not depend on the time of the fit."""
    palette = without_time(name, image).quantize(COLORS)
    path.parent.mkdir(exist_ok=True)
    image.quantize(palette=palette, dither=Image.Dither.NONE).save(path, optimize=True)


def agrees(path, name, image):
    """Whether a picture, in the palette of the book's, is the book's; says how much differs, and where."""
    with Image.open(path) as shown:
        pair = [without_time(name, one) for one in (shown, image.quantize(palette=shown, dither=Image.Dither.NONE))]
    share = differing(*pair)
    where = f" in {differing_place(*pair)}" if share > 0 else ""
    print(f"{path.name}: {share:.1e} of the pixels differ{where}{'' if share <= SHARE else ', too many'}", flush=True)
    return share <= SHARE


def main():
    check = "--check" in sys.argv
    program, *names = [argument for argument in sys.argv[1:] if argument != "--check"]
    program = pathlib.Path(program).resolve()
    made = {"picture": (spheres, DOCS / "picture.png"), **{name: (window, DOCS / "images" / f"{name}.png") for name in WINDOWS}}
    made["screenshot"] = (window, DOCS.parent / "assets" / "screenshot.png")
    told, tells = os.pipe()
    screen = ["Xvfb", "-displayfd", str(tells), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "-noreset"]
    server = subprocess.Popen(screen, pass_fds=[tells], stderr=subprocess.DEVNULL)
    faults = 0
    try:
        # The number of a display that was free.
        display = f":{os.read(told, 16).decode().strip()}"
        for name in names or made:
            how, path = made[name]
            if check:
                faults += not agrees(path, name, make(how, program, name, display))
            else:
                save(path, name, make(how, program, name, display))
    finally:
        server.terminate()
        server.wait()
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
