#!/usr/bin/env python3
"""Frame times while a slider is dragged, as eframe's cpu_usage has them: logic and drawing without the swap of buffers.

    tests/frame_times.py target/release/pbrdf-explorer [--lamp] [MEASUREMENTS POINTS PINS [PANE ...]]

Opens that many simulated measurements of so many points with so many pinned surfaces in a window of 1280 x 800 under a
virtual display, drags a slider (which, it says) for seven seconds, and prints median and 99th percentile of the last five. Without
numbers: three measurements of 27 points and ten of 500, with two pins each. PANE brings further panes to the screen, beside
DoLP and lobes. With --lamp and the pane "picture" as the last one, the lamp is turned in the picture in place of a slider.
Needs Xvfb, xdotool and scrot. GALLIUM_NOOP=1 in the environment leaves out Mesa's software rasteriser.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MODEL = {"distribution": "cauchy", "specular": True, "masking": True, "diffuse": "minnaert", "volume": True}
TRUTH = {"n": 2.07, "k": 2.9, "sigma": 0.35, "ks": 1.0, "kd": 0.12, "kv": 0.2, "q": 2.2, "c": -0.4, "sigma_v": 0.6}
# Angles of incidence and of view of so many points.
GRIDS = {27: ("30,40,50", "20:60:5"), 500: ("10:82:8", "0:85.75:1.75")}
# Where a slider lies, by the number of measurements in the list over it, with two pins in theirs.
SLIDERS = {3: (100, 400), 10: (100, 470)}
# The middle of the sphere with DoLP and lobes above it, and how far to either side the lamp is dragged.
SPHERE = (442, 700)
LAMP = 40
SECONDS = 7.0


def simulated(program, points, seed):
    """The lines of a simulated measurement."""
    theta_i, theta_r = GRIDS[points]
    values = ",".join(f"{name}={value}" for name, value in TRUTH.items())
    command = [program, "simulate", "--model", "cauchy", "--set", values, "--theta-i", theta_i, "--theta-r", theta_r]
    text = subprocess.run(command + ["--noise", "0.005", "--seed", str(seed), "-o", "/dev/stdout"], check=True, capture_output=True, text=True).stdout
    rows = [line for line in text.splitlines() if line[:1].isdigit()]
    assert len(rows) == points, (len(rows), points)
    return text.splitlines()


def session(program, measurements, points, pins, panes):
    """A session with everything open; the first measurement is active."""
    tables = []
    for number in range(measurements):
        table = {"name": f"sample {number + 1}", "sha256": None, "table": simulated(program, points, number + 1)}
        if number > 0:
            table["surface"] = {"parameters": TRUTH | {"sigma": 0.3 + 0.01 * number}, "model": MODEL}
        tables.append(table)
    pinned = [
        {"name": f"pin {i + 1}", "color": 5 + i, "model": MODEL, "parameters": TRUTH | {"sigma": 0.2 + 0.1 * i}, "shown": True}
        for i in range(pins)
    ]
    layout = {"rows": [[1.0, {"pane": pane}] for pane in ["dolp", "lobes", *panes]]}
    head = {"format": "pbrdf-session", "version": 2, "settings": {"parameters": TRUTH, "model": MODEL}, "layout": layout}
    return head | {"measurements": tables, "pinned": pinned, "fits": [], "shown": None}


def xdotool(*arguments):
    return subprocess.run(["xdotool", *map(str, arguments)], check=True, capture_output=True, text=True).stdout.split()


def measure(program, measurements, points, pins, panes, lamp):
    """Medians and percentiles in the words of the program."""
    folder = Path(tempfile.mkdtemp())
    places = {"HOME": folder, "XDG_CONFIG_HOME": folder / "config", "XDG_DATA_HOME": folder / "data", "XDG_RUNTIME_DIR": folder}
    os.environ.update({name: str(place) for name, place in places.items()})
    os.environ.pop("WAYLAND_DISPLAY", None)
    settings = folder / "config/pbrdf-explorer/settings.json"
    settings.parent.mkdir(parents=True)
    settings.write_text(json.dumps({"window": {"show_frame_times": True, "knows_tour": True, "size": [1280, 800], "theme": "Light"}}))
    work = folder / "frames.pbrdf.json"
    work.write_text(json.dumps(session(program, measurements, points, pins, panes)))
    read, write = os.pipe()
    server = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"]
    xvfb = subprocess.Popen(server, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.environ["DISPLAY"] = ":" + os.read(read, 16).decode().strip()
    window = subprocess.Popen([program, work], stderr=subprocess.PIPE, text=True)
    try:
        time.sleep(6)
        found = xdotool("search", "--onlyvisible", "--pid", window.pid)[0]
        xdotool("windowmove", found, 0, 0, "windowsize", found, 1280, 800, "windowfocus", found)
        time.sleep(2)
        subprocess.run(["scrot", "-o", folder / "before.png"], check=True)
        x, y = SLIDERS[measurements]
        if lamp:
            x, y = SPHERE[0] - LAMP, SPHERE[1]
        xdotool("mousemove", x, y, "mousedown", 1)
        begun, step = time.monotonic(), 0
        while time.monotonic() - begun < SECONDS:
            # There and back over eighty points, ever a new value.
            step += 1
            xdotool("mousemove", x + abs(step % 161 - 80), y, "sleep", 0.01)
        subprocess.run(["scrot", "-o", folder / "after.png"], check=True)
        xdotool("mouseup", 1, "key", "ctrl+q")
        said = window.communicate(timeout=20)[1]
    finally:
        window.kill()
        xvfb.terminate()
    kept = max((folder / "data/pbrdf-explorer/work").glob("*.pbrdf.json"), key=lambda path: path.stat().st_mtime)
    now = json.loads(kept.read_text())["settings"]
    if lamp:
        if now.get("picture", {}).get("azimuth", 135.0) == 135.0:
            sys.exit(f"the lamp was not turned: look at {folder}/before.png and mend SPHERE")
        return f"lamp: {said.strip()}"
    now = now["parameters"]
    moved = [name for name in TRUTH if now[name] != TRUTH[name]]
    if len(moved) != 1:
        sys.exit(f"no slider was dragged ({moved}): look at {folder}/before.png and mend SLIDERS")
    return f"{moved[0]}: {said.strip()}"


def main():
    lamp = "--lamp" in sys.argv
    program, *rest = [argument for argument in sys.argv[1:] if argument != "--lamp"]
    program = str(Path(program).resolve())
    cases = [(3, 27, 2), (10, 500, 2)]
    if rest:
        cases = [tuple(map(int, rest[:3]))]
    for measurements, points, pins in cases:
        print(f"{measurements} measurements of {points} points, {pins} pins:", measure(program, measurements, points, pins, rest[3:], lamp), flush=True)


if __name__ == "__main__":
    main()
