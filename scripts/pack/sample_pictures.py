"""Draws the pictures of the samples' pages from renders of the command line.

Run from the repository's root, after `npm run build`:

    /usr/bin/python3 scripts/pack/sample_pictures.py

StylusTracing.png: the scene as its camera sees it with a stroke, the vibration in m/s^2, and its spectrogram.
TextureGallery.png: the wall of tiles, in their colours, with the same stroke of 12 cm, there and back, on each label of
the shipped model: waveforms and spectrograms of one scale, the level (RMS) beside the name.
Workshop.png: the bench as its camera sees it, and a stroke over its terrain, whose three layers run into each other:
the weights, the vibration in m/s^2, and its spectrogram.
"""

from __future__ import annotations

import colorsys
import json
import re
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.patheffects import withStroke
from renders import MODEL, ROOT, SAMPLES, Render, colour_of, draw_spectrogram, render, run, save
from scene_view import Camera, draw_solids, facets
from scipy.signal import spectrogram

NAMED = {"ha": "center", "va": "center", "path_effects": [withStroke(linewidth=3.0, foreground="white")], "zorder": 7}


def draw_scene(axes: plt.Axes, scene: dict, felt: Render, stroke: np.ndarray) -> None:
    """The view of the sample's camera of table, objects, stroke and pen."""
    camera = camera_of(SAMPLES / "StylusTracing/StylusTracing.unity")
    table, *objects = scene["surfaces"]
    far_first = sorted(objects, key=lambda surface: -facets(surface)[..., 2].mean())
    # The table hides everything below it.
    shown = [(np.maximum(facets(surface), [-np.inf, 0.0, -np.inf]), surface["material"]) for surface in far_first]
    draw_solids(axes, camera, [(faces, colour_of(label)) for faces, label in ((facets(table), table["material"]), *shown)])
    held = felt.touching(stroke[:, 0])
    path = camera.seen(stroke[:, 1:4])
    axes.plot(path[:, 0], path[:, 1], color="#222222", linewidth=0.7, linestyle=":")
    axes.plot(np.where(held, path[:, 0], np.nan), path[:, 1], color="black", linewidth=2.0)
    for surface in scene["surfaces"]:
        corners = facets(surface).reshape(-1, 3)
        place = corners.mean(axis=0) * [1, 0, 1] + [0.0, corners[:, 1].max(), 0.0]
        place[2] = corners[:, 2].min() - 0.016
        slides = " (slides)" if "motion" in surface else ""
        right, up, _ = camera.seen(np.array([0.22, 0.0, -0.27]) if surface is table else place)
        axes.text(right, up, surface["material"] + slides, fontsize=10, **NAMED)
    draw_pen(axes, camera, stroke[np.flatnonzero(held)[-1], 1:4])
    axes.set(xlim=(-0.83, 0.83), ylim=(-0.43, 0.36), aspect="equal")
    axes.axis("off")


def camera_of(unity_scene: Path) -> Camera:
    """The pose of a scene's main camera, from Unity's own file."""
    text = unity_scene.read_text(encoding="utf-8").split("m_Name: Main Camera")[1]
    turn, place = (
        tuple(map(float, re.findall(r"[xyzw]: ([-\d.e]+)", re.search(rf"{key}: (\{{.*\}})", text)[1])))
        for key in ("m_LocalRotation", "m_LocalPosition")
    )
    return Camera(place, turn)


def draw_pen(axes: plt.Axes, camera: Camera, tip: np.ndarray) -> None:
    """Tip and shaft, leaning back towards the right hand."""
    ends = camera.seen(np.stack([tip, tip + [0.008, 0.02, -0.006], tip + [0.06, 0.15, -0.045]]))
    axes.plot(ends[:2, 0], ends[:2, 1], color="#c2410c", linewidth=3.0, solid_capstyle="round", zorder=6)
    axes.plot(ends[1:, 0], ends[1:, 1], color="#30343a", linewidth=7.0, solid_capstyle="round", zorder=5)


def draw_touches(axes: plt.Axes, scene: dict, felt: Render) -> None:
    label_of = {surface["name"]: surface["material"] for surface in scene["surfaces"]}
    for surface, begin, end in felt.touches():
        label = label_of[surface]
        axes.axvspan(begin, end, color=colour_of(label), alpha=0.3, linewidth=0.0)
        axes.text((begin + end) / 2.0, 0.97, label, ha="center", va="top", fontsize=8,
                  transform=axes.get_xaxis_transform())  # fmt: skip


def tracing_picture(file: Path) -> None:
    scene_file = SAMPLES / "StylusTracing/StylusTracing.scene.json"
    stroke_file = SAMPLES / "StylusTracing/StylusTracing.stroke.csv"
    felt = render(scene_file, stroke_file)
    scene = json.loads(scene_file.read_text(encoding="utf-8"))
    figure, (above, wave, colours) = plt.subplots(
        3, 1, figsize=(9.6, 8.4), height_ratios=(3.6, 1.2, 1.6), layout="constrained"
    )
    figure.suptitle("The sample's scene, drawn from its scene file: not a screenshot of Unity", fontsize=10)
    draw_scene(above, scene, felt, np.loadtxt(stroke_file, delimiter=",", skiprows=1))
    wave.plot(felt.times, felt.acceleration_mps2, color="#1f4e79", linewidth=0.3)
    reach = 1.35 * np.abs(felt.acceleration_mps2).max()
    wave.set(ylim=(-reach, reach), ylabel="m/s²", xticklabels=[])
    draw_touches(wave, scene, felt)
    draw_spectrogram(colours, felt)
    colours.set(ylabel="Hz", xlabel="seconds")
    for axes in (wave, colours):
        axes.set_xlim(0.0, felt.seconds)
    save(figure, file)


def there_and_back(seconds: float = 0.7, metres: float = 0.12) -> np.ndarray:
    """A stroke over a tile, 1 mm deep under a tip of 2 mm: minimum jerk, there and back."""
    times = np.arange(int(2 * seconds * 120) + 1) / 120.0
    share = np.where(times <= seconds, times / seconds, 2.0 - times / seconds)
    way = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return np.column_stack(np.broadcast_arrays(times, metres * (way - 0.5), 0.001, 0.0))


def gallery_picture(file: Path) -> None:
    header = json.loads(run("inspect", MODEL, "--json"))["header"]
    labels = [label["name"] for label in header["labels"]]
    felt = [tile_render(label) for label in labels]
    reach = np.ceil(max(np.abs(one.acceleration_mps2).max() for one in felt) / 10.0) * 10.0
    top_db = max(10.0 * np.log10(spectrogram(one.acceleration_mps2, one.rate_hz)[2].max()) for one in felt)
    # The same layout as Wall in GalleryScene.cs.
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
    save(figure, file)


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


# The same as in GardenBed (Shapes.cs): corner and size in metres, layers with their labels and colours.
GARDEN_CORNER = np.array([-0.45, 0.001, -0.02])
GARDEN_SIZE = np.array([0.42, 0.012, 0.26])
GARDEN_LABELS = ("concrete", "carpet", "sandpaper")
GARDEN_COLOURS = np.array([[0.6, 0.6, 0.58], [0.36, 0.55, 0.27], [0.87, 0.76, 0.5]])
GARDEN_STRIPS = 48


def garden_weights(along: np.ndarray) -> np.ndarray:
    """[..., 3] of the layers at places from 0 to 1."""
    gravel = np.clip(1.5 - 3.0 * along, 0.0, 1.0)
    sand = np.clip(3.0 * along - 1.5, 0.0, 1.0)
    return np.stack([gravel, 1.0 - gravel - sand, sand], axis=-1)


def draw_workshop(axes: plt.Axes) -> None:
    """The bench of the sample Workshop from its camera: each object with its label."""
    camera = camera_of(ROOT / "Assets/Workshop.unity")
    solids = [(box_facets([0, -0.01, 0], [1, 0.02, 0.6]), "#ba7840")]
    edges = np.linspace(0.0, 1.0, GARDEN_STRIPS + 1)
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        colour = garden_weights(np.array(0.5 * (low + high))) @ GARDEN_COLOURS
        solids.append((sheet_facets(GARDEN_CORNER, GARDEN_SIZE, low, high), tuple(colour)))
    solids += [
        (box_facets([0.145, 0.006, 0.11], [0.19, 0.012, 0.22]), "#a37340"),
        (box_facets([0.335, 0.006, 0.11], [0.19, 0.012, 0.22]), "#8c99ad"),
        (box_facets([0.02, 0.001, -0.16], [0.16, 0.002, 0.14]), "#73a8d9"),
        (box_facets([0.27, 0.004, -0.16], [0.2, 0.008, 0.14]), "#d1ccc2"),
    ]
    draw_solids(axes, camera, solids)
    draw_pane(axes, camera)
    names = [
        ((-0.375, 0.01, 0.11), "Gravel:\nconcrete"), ((-0.24, 0.012, 0.11), "Turf:\ncarpet"),
        ((-0.105, 0.01, 0.11), "Sand:\nsandpaper"), ((0.145, 0.012, 0.11), "Oak:\nwood"),
        ((0.335, 0.012, 0.11), "Steel:\nmetal mesh"), ((-0.25, 0.008, -0.16), "ceramic"),
        ((-0.25, 0.008, -0.225), "ring: jute"), ((0.02, 0.002, -0.16), "layer Water:\nglass"),
        ((0.27, 0.008, -0.16), "Specimen"), ((0.0, 0.0, -0.27), "Bench: wood"),
    ]  # fmt: skip
    for place, text in names:
        right, up, _ = camera.seen(np.array(place))
        axes.text(right, up, text, fontsize=9, **NAMED)
    axes.set(xlim=(-0.83, 0.83), ylim=(-0.43, 0.36), aspect="equal")
    axes.axis("off")


def box_facets(position: list[float], size: list[float]) -> np.ndarray:
    return facets({"shape": {"box": {"size": size}}, "position": position})


def sheet_facets(corner: np.ndarray, size: np.ndarray, low: float, high: float) -> np.ndarray:
    """[12, 4, 3] of the terrain's hill between two places along x, each 0 to 1."""
    depth = np.linspace(0.0, 1.0, 13)

    def point(x: float, z: float) -> np.ndarray:
        return corner + size * [x, np.sin(np.pi * x) * np.sin(np.pi * z), z]

    return np.array([
        [point(low, a), point(low, b), point(high, b), point(high, a)]
        for a, b in zip(depth[:-1], depth[1:], strict=True)
    ])  # fmt: skip


def draw_pane(axes: plt.Axes, camera: Camera) -> None:
    """The inlaid pane in the colours of its texture, as InlaidPane (Shapes.cs) paints it."""
    size, texels = np.array([0.26, 0.18]), 64
    centres = (np.arange(texels) + 0.5) / texels
    x, z = np.meshgrid(centres, centres)
    ring = np.clip(5.0 - 250.0 * np.abs(np.hypot((x - 0.5) * size[0], (z - 0.5) * size[1]) - 0.055), 0.0, 1.0)
    share = (ring * (1.0 - 0.5 * x))[..., None]
    colours = ((1.0 - share) * [225, 228, 222] + share * [181, 154, 76]) / 255.0
    corners = np.linspace(0.0, 1.0, texels + 1) - 0.5
    right, far = np.meshgrid(corners * size[0] - 0.25, corners * size[1] - 0.16)
    seen = camera.seen(np.stack([right, np.full_like(right, 0.008), far], axis=-1))
    flat = seen[..., :2]
    cells = np.stack([flat[:-1, :-1], flat[1:, :-1], flat[1:, 1:], flat[:-1, 1:]], axis=2).reshape(-1, 4, 2)
    axes.add_collection(PolyCollection(cells, facecolors=colours.reshape(-1, 3), edgecolors="face", linewidths=0.4))


def workshop_picture(file: Path) -> None:
    seconds = 1.6
    edges = np.linspace(0.0, GARDEN_SIZE[0], GARDEN_STRIPS + 1)
    strips = [
        {
            "name": f"strip {index}", "shape": {"box": {"size": [float(high - low), 0.02, 0.1]}},
            "position": [float(0.5 * (low + high)), -0.01, 0.0],
            "material": blend_at(0.5 * (low + high) / GARDEN_SIZE[0]),
        }
        for index, (low, high) in enumerate(zip(edges[:-1], edges[1:], strict=True))
    ]  # fmt: skip
    times = np.arange(int(seconds * 120) + 1) / 120.0
    places = 0.01 + (GARDEN_SIZE[0] - 0.02) * times / seconds
    stroke = np.column_stack(np.broadcast_arrays(times, places, 0.001, 0.0))
    felt = render({"surfaces": strips, "stylus": {"tip_radius": 0.002}, "update_rate": 120}, stroke)
    figure, (above, shares, wave, colours) = plt.subplots(
        4, 1, figsize=(9.6, 9.0), height_ratios=(3.6, 0.7, 1.1, 1.5), layout="constrained"
    )
    figure.suptitle(
        "The sample's bench, drawn from its sources: not a screenshot of Unity. Below: a stroke over the terrain from "
        "left to right", fontsize=10,
    )
    draw_workshop(above)
    shares.stackplot(
        times, garden_weights(places / GARDEN_SIZE[0]).T, labels=GARDEN_LABELS,
        colors=[tuple(colour) for colour in GARDEN_COLOURS],
    )
    shares.set(ylabel="weights", ylim=(0.0, 1.0), xticklabels=[])
    shares.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    wave.plot(felt.times, felt.acceleration_mps2, color="#1f4e79", linewidth=0.3)
    wave.set(ylabel="m/s²", xticklabels=[])
    draw_spectrogram(colours, felt)
    colours.set(ylabel="Hz", xlabel="seconds")
    for axes in (shares, wave, colours):
        axes.set_xlim(0.0, seconds)
    save(figure, file)


def blend_at(along: float) -> dict[str, float]:
    weights = garden_weights(np.array(along))
    return {label: float(weight) for label, weight in zip(GARDEN_LABELS, weights, strict=True) if weight > 0.0}


def main() -> None:
    pictures = {"StylusTracing": tracing_picture, "TextureGallery": gallery_picture, "Workshop": workshop_picture}
    for sample, draw in pictures.items():
        draw(SAMPLES / sample / f"{sample}.png")


if __name__ == "__main__":
    main()
