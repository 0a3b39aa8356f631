"""Draws the pictures of the pages and of the README from renders of the command line.

Run from the repository's root, after `npm run build`; without names, every picture is drawn:

    /usr/bin/python3 scripts/pack/pictures.py [NAME ...]

The names are those of the files: see `PICTURES`. "boards" writes the map of the sample scene, "labels" the table of the
labels into
Training/results/effects.md. Scene and stroke of the README's picture are `crossing` of Samples~/HeadlessScenes.
"""

from __future__ import annotations

import colorsys
import json
import re
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from PIL import Image
from renders import (
    FULL_SCALE_MPS2,
    MODEL,
    ROOT,
    SAMPLES,
    Render,
    colour_of,
    draw_spectrogram,
    labels_of,
    outline,
    render,
    render_file,
    rest_of,
    run,
    save,
)
from scipy.signal import spectrogram

from haptoflow_training.model_stamp import model_line, sha256_of, with_measured_words

SCENE = SAMPLES / "HeadlessScenes/crossing.scene.json"
STROKE = SAMPLES / "HeadlessScenes/crossing.stroke.csv"
INK = "#1c1c1e"
# Of the effects.
EFFECTS_PAGE = ROOT / "Training/results/effects.md"
# Statistics of the intensity error, and how each is printed.
FIGURES = (("mean", "+"), ("mean_magnitude", ""), ("p95", ""))
DEEP_METRES = 0.0005


def name_of(surface: dict) -> str:
    material = surface["material"]
    return material if isinstance(material, str) else " + ".join(material)


def free_height(path: np.ndarray, x: float, z: float, reach: float) -> float:
    """Where a name hides the path [n, 2] least: at the bottom, in the middle or at the top of a surface."""
    across = x + np.linspace(-0.06, 0.06, 13)

    def clearance(height: float) -> float:
        return float(np.hypot(path[:, :1] - across, path[:, 1:] - height).min())

    return max((z - reach, z, z + reach), key=clearance)


def draw_surface(axes: Axes, surface: dict, path: np.ndarray) -> None:
    """A surface from above, as it lies when the scene starts, with its name clear of the path [n, 2]."""
    colour = colour_of(labels_of(surface)[0])
    if "plane" in surface["shape"]:
        axes.set_facecolor(colour + "55")
        axes.text(-0.51, -0.22, name_of(surface), ha="left", va="bottom", fontsize=11)
        return
    corners = outline(surface, [0, 2])
    axes.add_patch(Polygon(corners, facecolor=colour, edgecolor="none", alpha=0.85))
    x, _, z = rest_of(surface)
    ((_, shape),) = surface["shape"].items()
    reach = shape["size"][2] / 2 if "size" in shape else np.ptp(corners[:, 1]) / 2
    axes.text(x, free_height(path, x, z, reach - 0.015), name_of(surface), ha="center", va="center", fontsize=11,
              zorder=6, path_effects=[withStroke(linewidth=3.0, foreground="white")])


def draw_scene(axes: Axes, scene: dict, stroke: np.ndarray, touching: np.ndarray) -> None:
    path = stroke[:, [1, 3]]
    for surface in scene["surfaces"]:
        draw_surface(axes, surface, path)
    axes.plot(*path.T, color=INK, linewidth=1.0, linestyle=":")
    axes.plot(np.where(touching, path[:, 0], np.nan), path[:, 1], color=INK, linewidth=2.4, solid_capstyle="round")
    axes.plot(*path[0], marker="o", color="white", markeredgecolor=INK, markersize=8, zorder=5)
    axes.set(xlim=(-0.53, 0.53), ylim=(-0.23, 0.21), xticks=[], yticks=[], aspect="equal")


def draw_touches(axes: Axes, scene: dict, felt: Render) -> None:
    """A coloured band for each touch."""
    labels = {surface["name"]: labels_of(surface)[0] for surface in scene["surfaces"]}
    for surface, begin, end in felt.touches():
        axes.axvspan(begin, end, color=colour_of(labels[surface]), alpha=0.45, linewidth=0.0)


def draw_wave(axes: Axes, scene: dict, felt: Render) -> None:
    draw_touches(axes, scene, felt)
    axes.plot(felt.times, felt.acceleration_mps2, color=INK, linewidth=0.35)
    reach = 1.1 * float(np.abs(felt.acceleration_mps2).max())
    axes.set(xlim=(0.0, felt.seconds), ylim=(-reach, reach), ylabel="m/s²", xticklabels=[])


def stroke_picture() -> plt.Figure:
    """A stroke over objects and its vibration. Top: the scene from above, the stroke solid where the tip touches and dotted
    where it does not. Below: acceleration in m/s^2 and its spectrogram."""
    felt = render(SCENE, STROKE)
    scene = json.loads(SCENE.read_text(encoding="utf-8"))
    stroke = np.loadtxt(STROKE, delimiter=",", skiprows=1)
    figure, (above, wave, colours) = plt.subplots(
        3, 1, figsize=(9.6, 6.6), height_ratios=(3.7, 1.2, 1.2), layout="constrained"
    )
    draw_scene(above, scene, stroke, felt.touching(stroke[:, 0]))
    draw_wave(wave, scene, felt)
    draw_spectrogram(colours, felt)
    colours.set(xlim=(0.0, felt.seconds), ylabel="Hz", xlabel="seconds")
    return figure


def there_and_back(seconds: float = 0.7, metres: float = 0.12) -> np.ndarray:
    """A stroke over a tile, 1 mm deep under a tip of 2 mm: minimum jerk, there and back."""
    times = np.arange(int(2 * seconds * 120) + 1) / 120.0
    share = np.where(times <= seconds, times / seconds, 2.0 - times / seconds)
    way = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return np.column_stack(np.broadcast_arrays(times, metres * (way - 0.5), 0.001, 0.0))


def gallery_picture() -> plt.Figure:
    """The wall of tiles, with the same stroke on each label of the model and the level (RMS) beside the name."""
    header = json.loads(run("inspect", MODEL, "--json"))["header"]
    labels = [label["name"] for label in header["labels"]]
    felt = [tile_render(label) for label in labels]
    reach = np.ceil(max(np.abs(one.acceleration_mps2).max() for one in felt) / 10.0) * 10.0
    top_db = max(10.0 * np.log10(spectrogram(one.acceleration_mps2, one.rate_hz)[2].max()) for one in felt)
    # The same layout as in Wall.cs.
    columns = int(np.ceil(np.sqrt(1.25 * len(labels))))
    rows = -(-len(labels) // columns)
    figure, grid = plt.subplots(
        2 * rows + 1, columns, figsize=(9.6, 1.75 * rows + 0.9), height_ratios=[1.3, 1.0] * rows + [0.8],
        layout="constrained", squeeze=False,
    )
    board = figure.add_subplot(grid[-1, 0].get_gridspec()[-1, :])
    figure.suptitle(
        f"One stroke on each tile. All waveforms ±{reach:.0f} m/s², all spectrograms of one scale "
        "(drawn from renders: not a screenshot of Unity)", fontsize=10,
    )
    for axes in grid.flat:
        axes.axis("off")
    board.set(facecolor=(0.82, 0.8, 0.76), xticks=[], yticks=[])
    board.text(0.5, 0.5, "the board: takes the label of the tile that was pressed last", ha="center", va="center")
    for index, (label, one) in enumerate(zip(labels, felt, strict=True)):
        wave, colours = grid[2 * (index // columns), index % columns], grid[2 * (index // columns) + 1, index % columns]
        draw_tile(wave, label, one, reach, colorsys.hsv_to_rgb(index / len(labels), 0.45, 0.85))
        draw_spectrogram(colours, one, top_db)
    return figure


def tile_render(label: str) -> Render:
    shape = {"box": {"size": [0.13, 0.02, 0.09]}}
    tile = {"name": "tile", "shape": shape, "position": [0, -0.01, 0], "material": label}
    return render({"surfaces": [tile], "stylus": {"tip_radius": 0.002}, "update_rate": 72}, there_and_back())


def draw_tile(
    axes: plt.Axes, label: str, felt: Render, reach_mps2: float, colour: tuple[float, float, float]
) -> None:
    """The tile in its colour, on it the waveform and its level."""
    axes.axis("on")
    axes.set_facecolor(colour)
    axes.set_xticks([])
    axes.set_yticks([])
    level = float(np.sqrt(np.mean(felt.acceleration_mps2**2)))
    axes.set_title(f"{label}, {level:.2g} m/s²", fontsize=9, pad=2)
    axes.plot(felt.acceleration_mps2, color="#1a1a1a", linewidth=0.4)
    axes.set_ylim(-reach_mps2, reach_mps2)
    axes.set_xlim(0, len(felt.acceleration_mps2))


def intensity_errors(surfaces: list[dict], stroke: np.ndarray) -> dict[str, dict[str, float]]:
    """Intensity errors of the frames and of a motor, in dB: see `haptoflow render -o x.json`."""
    with tempfile.TemporaryDirectory() as folder:
        frames = Path(folder) / "out.json"
        render_file({"surfaces": surfaces}, stroke, frames, "--full-scale", FULL_SCALE_MPS2)
        return json.loads(frames.read_text(encoding="utf-8"))["intensity_error_db"]


def plane(label: str) -> dict:
    return {"name": "plane", "shape": {"plane": {}}, "material": label}


def stroke_of(
    times: np.ndarray, x: np.ndarray | float, y: np.ndarray | float, force: np.ndarray | float = 1.0
) -> np.ndarray:
    """Rows of a stroke file [n, 5]: seconds, metres (z is 0), newtons."""
    return np.column_stack(np.broadcast_arrays(times, x, y, 0.0, force))


def accelerating() -> np.ndarray:
    """Four seconds along x, from 0.05 to 0.35 m/s, with 0.5 to 1.5 N."""
    times = np.arange(0.0, 4.0, 0.002)
    speed = 0.05 + 0.3 * times / 4.0
    force = 1.0 + 0.5 * np.sin(2.0 * np.pi * 0.5 * times)
    return stroke_of(times, np.cumsum(speed) * 0.002, -DEEP_METRES, force)


def label_table() -> str:
    """The losses of each label: the actuator's spectrum, with and without compensation, and the intensity of frames."""
    shown = run("actuator", "show", "voice-coil", "--labels")
    rows = re.findall(r"^  ([a-z ]+?) +([0-9.]+) +([0-9.]+)$", shown.split("Log-spectral distance")[1], re.MULTILINE)
    lines = [
        model_line(sha256_of(MODEL)),
        "",
        "| label | LSD, uncompensated | compensated | frames of 60-400 Hz | motor of 160 Hz |",
        "|---|---|---|---|---|",
    ]
    for label, plain, compensated in rows:
        errors = intensity_errors([plane(label)], accelerating())
        cells = [" / ".join(f"{errors[kind][name]:{sign}.1f}" for name, sign in FIGURES) for kind in errors]
        lines.append(f"| {label} | {float(plain):.1f} | {float(compensated):.1f} | {' | '.join(cells)} |")
    return "\n".join(lines)


# A tile of a brick wall: its size in metres, its bricks, the width of their joints and how deep these are.
WALL_METRES, BRICK_METRES, JOINT_METRES, JOINT_DEPTH_METRES = (0.16, 0.08), (0.08, 0.04), 0.006, 0.0008


def brick_wall(columns: int = 640) -> np.ndarray:
    """Heights of the tile, 0 to 1 [rows, columns], the first row at the top: rounded bricks and rough mortar."""
    rows = round(columns * WALL_METRES[1] / WALL_METRES[0])
    y, x = (np.indices((rows, columns)) + 0.5) * (WALL_METRES[0] / columns)
    course = np.floor(y / BRICK_METRES[1])
    along = (x + 0.5 * BRICK_METRES[0] * (course % 2)) % BRICK_METRES[0]
    across = y % BRICK_METRES[1]
    edge = np.minimum.reduce([along, BRICK_METRES[0] - along, across, BRICK_METRES[1] - across])
    rise = np.clip((edge - 0.5 * JOINT_METRES) / 0.002 + 0.5, 0.0, 1.0)
    rough = 0.06 * np.random.default_rng(4).random((rows, columns))
    return np.clip(rise * rise * (3.0 - 2.0 * rise) + rough * (1.0 - rise), 0.0, 1.0)


def relief_picture() -> plt.Figure:
    """A wall whose map the tip follows: the map with the stroke, the heights under it, the wave and its spectrogram."""
    times = np.arange(int(1.6 * 240) + 1) / 240.0
    share = times / times[-1]
    path = np.column_stack([0.012 + 0.27 * (share**2 * (3.0 - 2.0 * share)), 0.024 + 0.018 * np.sin(9.0 * share)])
    heights = brick_wall()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "wall.png"
        Image.fromarray((65535.0 * heights).astype(np.uint16)).save(file)
        surface = plane("brick") | {
            "relief": {"image": str(file), "size": list(WALL_METRES), "depth": JOINT_DEPTH_METRES}
        }
        scene = {"surfaces": [surface], "stylus": {"tip_radius": 0.0005}}
        stroke = np.column_stack([times, path[:, 0], np.full_like(times, -0.0005), path[:, 1], np.ones_like(times)])
        felt = [render(scene, stroke, "--effects", effects) for effects in ("none", "texture")]
    figure, (above, profile, wave, colours) = plt.subplots(
        4, 1, figsize=(9.6, 7.4), height_ratios=(2.2, 0.8, 1.3, 1.3), layout="constrained"
    )
    above.imshow(np.tile(heights, (1, 2)), extent=(0.0, 2000.0 * WALL_METRES[0], 0.0, 1000.0 * WALL_METRES[1]), cmap="copper")
    above.plot(1000.0 * path[:, 0], 1000.0 * path[:, 1], color="white", lw=1.2)
    above.set(xlim=(0.0, 300.0), ylabel="mm", title="a map of heights, and the pen's stroke over it (mm)")
    columns, rows = (np.array(heights.shape[::-1]) * path / WALL_METRES % np.array(heights.shape[::-1])).astype(int).T
    profile.plot(times, 1000.0 * JOINT_DEPTH_METRES * heights[-1 - rows, columns], color="#8a4b2d")
    profile.set(xlim=(0.0, times[-1]), ylabel="mm", title="heights under the tip")
    for one, colour, name in zip(felt[::-1], ("#c9a08f", "#8a1f11"), ("with the texture of brick", "relief alone"), strict=True):
        wave.plot(one.times, one.acceleration_mps2, color=colour, lw=0.7, label=name)
    wave.set(xlim=(0.0, times[-1]), ylabel="m/s²")
    wave.legend(loc="upper left", fontsize=8)
    draw_spectrogram(colours, felt[1])
    colours.set(xlim=(0.0, times[-1]), ylabel="Hz", xlabel="seconds")
    return figure


IMAGES = ROOT / "Documentation~/images"
# Names, files and drawings.
PICTURES: dict[str, tuple[Path, Callable[[], plt.Figure]]] = {
    "stroke": (IMAGES / "stroke.png", stroke_picture),
    "relief": (IMAGES / "effect-relief.png", relief_picture),
    "TextureGallery": (SAMPLES / "TextureGallery/TextureGallery.png", gallery_picture),
}


def save_boards() -> None:
    """The map of the sample scene `boards`: one board and its gap, with rounded edges."""
    x = (np.arange(480) + 0.5) / 480.0
    rise = np.clip((np.abs(x - 0.5) - 0.05) / 0.02 + 0.5, 0.0, 1.0)
    row = (65535.0 * rise * rise * (3.0 - 2.0 * rise)).astype(np.uint16)
    Image.fromarray(np.tile(row, (8, 1))).save(SAMPLES / "HeadlessScenes/boards.png")


def main(names: list[str]) -> None:
    known = (*PICTURES, "boards", "labels")
    unknown = [name for name in names if name not in known]
    if unknown:
        raise SystemExit(f"{unknown[0]}: expected some of {', '.join(known)}")
    if not names or "boards" in names:
        save_boards()
    for name, (file, draw) in PICTURES.items():
        if not names or name in names:
            save(draw(), file)
    if not names or "labels" in names:
        page = with_measured_words(EFFECTS_PAGE.read_text(encoding="utf-8"), label_table())
        EFFECTS_PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
