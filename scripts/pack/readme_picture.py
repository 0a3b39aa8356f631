"""Draws Documentation~/images/stroke.png, the picture of the README: a stroke over objects and its vibration.

Run from the repository's root, after `npm run build`:

    /usr/bin/python3 scripts/pack/readme_picture.py

Scene and stroke are `crossing` of Samples~/HeadlessScenes, rendered by the command line with the shipped model. Top: the scene
from above, the stroke solid where the tip touches and dotted where it does not. Below: acceleration in m/s^2 and its
spectrogram.
"""

from __future__ import annotations

import json

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from renders import ROOT, SAMPLES, Render, colour_of, draw_spectrogram, labels_of, render, save
from scene_view import outline, rest_of

SCENE = SAMPLES / "HeadlessScenes/crossing.scene.json"
STROKE = SAMPLES / "HeadlessScenes/crossing.stroke.csv"
PICTURE = ROOT / "Documentation~/images/stroke.png"
INK = "#1c1c1e"


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


def draw_picture(felt: Render) -> plt.Figure:
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


if __name__ == "__main__":
    save(draw_picture(render(SCENE, STROKE)), PICTURE)
