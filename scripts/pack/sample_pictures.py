"""Draws the pictures of the samples' pages from renders of the command line.

Run from the repository's root, after `npm run build`:

    /usr/bin/python3 scripts/pack/sample_pictures.py [--engine build/native/haptoflow]

StylusTracing.png: the scene from above with its stroke, the vibration in m/s^2, and its spectrogram.
TextureGallery.png: the same stroke of 12 cm, there and back, on each label of the shipped model; each
waveform as high as its tile, with its level (RMS) beside the label's name.
"""

from __future__ import annotations

import argparse
import csv
import io
import json
import subprocess
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Polygon
from PIL import Image
from scipy.io import wavfile
from scipy.signal import spectrogram
from scipy.spatial.transform import Rotation

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "Samples~"
MODEL = ROOT / "Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow"
# Far above every texture: nothing that is drawn was bent by the limiter.
FULL_SCALE_MPS2 = 1000.0
TOP_HZ = 1000.0
COLOURS = {
    "wood": "#b9793f", "stone": "#7d8590", "corduroy": "#8f5fa8", "metal mesh": "#5b7fb5",
    "sandpaper": "#d98e2b", "glass": "#6fb7c4", "rubber": "#5d5566", "jute": "#b59a4c",
}


@dataclass(frozen=True)
class Render:
    """A vibration in m/s^2 [N] at `rate_hz`, and what the tip did: columns of `haptoflow contact`."""

    rate_hz: int
    acceleration_mps2: np.ndarray
    contacts: list[dict[str, str]]

    @property
    def seconds(self) -> float:
        return len(self.acceleration_mps2) / self.rate_hz


def run(engine: Path, *words: object) -> str:
    return subprocess.run([str(engine), *map(str, words)], check=True, capture_output=True, text=True).stdout


def render(engine: Path, scene: Path, stroke: Path, folder: Path) -> Render:
    wav = folder / "felt.wav"
    run(engine, "render", scene, "--stroke", stroke, "-o", wav, "--full-scale", FULL_SCALE_MPS2, "--quiet")
    with warnings.catch_warnings():
        # The file says with what it was rendered in a chunk that SciPy does not read.
        warnings.simplefilter("ignore", wavfile.WavFileWarning)
        rate_hz, samples = wavfile.read(wav)
    contacts = list(csv.DictReader(run(engine, "contact", scene, "--stroke", stroke).splitlines()))
    return Render(rate_hz, FULL_SCALE_MPS2 * samples, contacts)


def draw_spectrogram(axes: plt.Axes, felt: Render, bottom_db: float = -60.0) -> None:
    """Decibels below the loudest bin of the picture."""
    window = int(0.064 * felt.rate_hz)
    frequencies, times, power = spectrogram(
        felt.acceleration_mps2, felt.rate_hz, nperseg=window, noverlap=window * 7 // 8
    )
    shown = frequencies <= TOP_HZ
    levels = 10.0 * np.log10(power[shown] + 1e-20)
    axes.imshow(
        levels - levels.max(), origin="lower", aspect="auto", cmap="inferno", vmin=bottom_db, vmax=0.0,
        extent=(times[0], times[-1], 0.0, TOP_HZ), interpolation="bilinear",
    )


def save(figure: plt.Figure, file: Path) -> None:
    """With a palette: a quarter of the bytes, and nobody sees the difference."""
    pixels = io.BytesIO()
    figure.savefig(pixels, dpi=100)
    plt.close(figure)
    Image.open(pixels).convert("RGB").quantize(160).save(file, optimize=True)


def outline(surface: dict) -> np.ndarray:
    """Corners [N, 2] of a surface seen from above, x and z in metres."""
    rest = surface.get("motion", {}).get("keyframes", [surface])[0]
    centre = np.array(rest.get("position", [0.0, 0.0, 0.0]))
    turn = Rotation.from_quat(rest.get("rotation", [0.0, 0.0, 0.0, 1.0]))
    shape = surface["shape"]
    angles = np.linspace(0.0, 2.0 * np.pi, 64)
    if "sphere" in shape:
        height = -centre[1]
        radius = np.sqrt(max(0.0, shape["sphere"]["radius"] ** 2 - height**2))
        return centre[[0, 2]] + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    if "capsule" in shape:
        radius = shape["capsule"]["radius"]
        reach = shape["capsule"]["height"] / 2.0 - radius
        along = turn.apply([0.0, reach, 0.0])[[0, 2]]
        ring = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        side = np.where((ring @ along)[:, None] >= 0.0, 1.0, -1.0)
        return centre[[0, 2]] + ring + side * along
    half = np.array(shape["box"]["size"]) / 2.0
    corners = np.array([[-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]]) * half
    return (centre + turn.apply(corners))[:, [0, 2]]


def draw_scene(axes: plt.Axes, scene: dict, felt: Render, stroke: np.ndarray) -> None:
    for surface in scene["surfaces"]:
        corners = outline(surface)
        is_table = surface["name"] == "Table"
        axes.add_patch(
            Polygon(corners, facecolor=COLOURS[surface["material"]], alpha=0.35 if is_table else 1.0,
                    edgecolor="#333333", linewidth=0.6)
        )
        place = (0.22, -0.262) if is_table else (corners[:, 0].mean(), corners[:, 1].max() + 0.012)
        axes.text(*place, surface["material"], ha="center", va="bottom", fontsize=9)
    times = [float(row["t"]) for row in felt.contacts]
    touching = np.interp(stroke[:, 0], times, [float(row["touching"]) for row in felt.contacts])
    held = touching > 0.5
    axes.plot(stroke[:, 1], stroke[:, 3], color="#222222", linewidth=0.6, linestyle=":")
    axes.plot(np.where(held, stroke[:, 1], np.nan), stroke[:, 3], color="black", linewidth=1.6)
    axes.text(0.30, 0.058, "slides", ha="center", va="top", fontsize=8)
    axes.annotate("", (0.23, 0.065), (0.37, 0.065), arrowprops={"arrowstyle": "<->", "linewidth": 0.9})
    axes.set_xlim(-0.52, 0.52)
    axes.set_ylim(-0.31, 0.31)
    axes.set_aspect("equal")
    axes.axis("off")


def draw_touches(axes: plt.Axes, scene: dict, felt: Render) -> None:
    label_of = {surface["name"]: surface["material"] for surface in scene["surfaces"]}
    times = [float(row["t"]) for row in felt.contacts]
    begin = 0
    for index in range(1, len(times) + 1):
        if index < len(times) and felt.contacts[index]["surface"] == felt.contacts[begin]["surface"]:
            continue
        label = label_of.get(felt.contacts[begin]["surface"])
        if label is not None:
            end = times[min(index, len(times) - 1)]
            axes.axvspan(times[begin], end, color=COLOURS[label], alpha=0.3, linewidth=0.0)
            axes.text((times[begin] + end) / 2.0, 0.97, label, ha="center", va="top", fontsize=8,
                      transform=axes.get_xaxis_transform())
        begin = index


def tracing_picture(engine: Path, folder: Path, file: Path) -> None:
    scene_file = SAMPLES / "StylusTracing/StylusTracing.scene.json"
    stroke_file = SAMPLES / "StylusTracing/StylusTracing.stroke.csv"
    felt = render(engine, scene_file, stroke_file, folder)
    scene = json.loads(scene_file.read_text(encoding="utf-8"))
    figure, (above, wave, colours) = plt.subplots(
        3, 1, figsize=(9.6, 8.2), height_ratios=(3.2, 1.2, 1.6), layout="constrained"
    )
    draw_scene(above, scene, felt, np.loadtxt(stroke_file, delimiter=",", skiprows=1))
    times = np.arange(len(felt.acceleration_mps2)) / felt.rate_hz
    wave.plot(times, felt.acceleration_mps2, color="#1f4e79", linewidth=0.3)
    reach = 1.35 * np.abs(felt.acceleration_mps2).max()
    wave.set_ylim(-reach, reach)
    wave.set_ylabel("m/s²")
    wave.set_xticklabels([])
    draw_touches(wave, scene, felt)
    draw_spectrogram(colours, felt)
    colours.set_ylabel("Hz")
    colours.set_xlabel("seconds")
    for axes in (wave, colours):
        axes.set_xlim(0.0, felt.seconds)
    save(figure, file)


def there_and_back(seconds: float = 0.7, metres: float = 0.12) -> str:
    """A stroke over a tile, 1 mm deep under a tip of 2 mm: minimum jerk, there and back."""
    lines = ["t,x,y,z"]
    for frame in range(int(2 * seconds * 120) + 1):
        time = frame / 120.0
        share = time / seconds if time <= seconds else 2.0 - time / seconds
        way = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        lines.append(f"{time:.6f},{metres * (way - 0.5):.6f},0.001,0")
    return "\n".join(lines) + "\n"


def gallery_picture(engine: Path, folder: Path, file: Path) -> None:
    header = json.loads(run(engine, "inspect", MODEL, "--json"))["header"]
    labels = [label["name"] for label in header["labels"]]
    stroke = folder / "tile.stroke.csv"
    stroke.write_text(there_and_back(), encoding="utf-8")
    rows = -(-len(labels) // 5)
    figure, grid = plt.subplots(
        2 * rows, 5, figsize=(9.6, 1.75 * rows), height_ratios=[1.0, 1.5] * rows, layout="constrained",
        squeeze=False,
    )
    for axes in grid.flat:
        axes.axis("off")
    for index, label in enumerate(labels):
        scene = folder / "tile.scene.json"
        shape = {"box": {"size": [0.13, 0.02, 0.09]}}
        tile = {"name": "tile", "shape": shape, "position": [0, -0.01, 0], "material": label}
        described = {"surfaces": [tile], "stylus": {"tip_radius": 0.002}, "update_rate": 72}
        scene.write_text(json.dumps(described), encoding="utf-8")
        felt = render(engine, scene, stroke, folder)
        wave, colours = grid[2 * (index // 5), index % 5], grid[2 * (index // 5) + 1, index % 5]
        level = float(np.sqrt(np.mean(felt.acceleration_mps2**2)))
        wave.set_title(f"{label}, {level:.1f} m/s²", fontsize=8, pad=2)
        wave.plot(felt.acceleration_mps2, color="#1f4e79", linewidth=0.3)
        reach = 1.05 * np.abs(felt.acceleration_mps2).max()
        wave.set_ylim(-reach, reach)
        wave.set_xlim(0, len(felt.acceleration_mps2))
        draw_spectrogram(colours, felt)
    save(figure, file)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--engine", type=Path, default=ROOT / "build/native/haptoflow")
    engine = parser.parse_args().engine
    pictures = {"StylusTracing": tracing_picture, "TextureGallery": gallery_picture}
    with tempfile.TemporaryDirectory() as folder:
        for sample, draw in pictures.items():
            file = SAMPLES / sample / f"{sample}.png"
            draw(engine, Path(folder), file)
            print(file.relative_to(ROOT))


if __name__ == "__main__":
    main()
