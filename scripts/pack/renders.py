"""Renders sounds with the command line for the pages' pictures, and holds what these pictures have in common: colours of
labels, outlines of a scene's surfaces, spectrograms, the stamp of the model."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import subprocess
import sys
import tempfile
import warnings
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image, PngImagePlugin
from scipy.io import wavfile
from scipy.signal import spectrogram
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

ROOT = Path(__file__).resolve().parents[2]
# For the scripts that measure with the training's packages.
sys.path.insert(0, str(ROOT / "Training"))
SAMPLES = ROOT / "Samples~"
MODEL = ROOT / "Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow"
ENGINE = ROOT / "build/native/haptoflow"
# Far above every texture and impact, so that the limiter changes nothing.
FULL_SCALE_MPS2 = 1000.0
TOP_HZ = 1000.0
COLOURS = {
    "wood": "#b9793f", "plywood": "#d8b483", "stone": "#7d8590", "concrete": "#9a9a94", "brick": "#b4533c",
    "ceramic": "#c9b8a8", "glass": "#6fb7c4", "metal": "#8fa3b8", "metal mesh": "#5b7fb5", "plastic": "#d46fa0",
    "rubber": "#5d5566", "leather": "#8a4b2d", "cotton": "#a9b7e0", "corduroy": "#8f5fa8", "jute": "#b59a4c",
    "fur": "#c98f6b", "paper": "#d9d2b0", "cardboard": "#b08d62", "sandpaper": "#d98e2b", "carpet": "#5f8f5a",
}  # fmt: skip


@dataclass(frozen=True)
class Render:
    """A vibration in m/s^2 [N] at `rate_hz`, and the tip's contact: columns of `haptoflow contact`."""

    rate_hz: int
    acceleration_mps2: np.ndarray
    contacts: list[dict[str, str]]

    @property
    def seconds(self) -> float:
        return len(self.acceleration_mps2) / self.rate_hz

    @property
    def times(self) -> np.ndarray:
        """Seconds of the samples."""
        return np.arange(len(self.acceleration_mps2)) / self.rate_hz

    @property
    def contact_times(self) -> np.ndarray:
        return np.array([float(row["t"]) for row in self.contacts])

    def touching(self, times: np.ndarray) -> np.ndarray:
        """Whether the tip touches at given times in seconds."""
        return np.interp(times, self.contact_times, [float(row["touching"]) for row in self.contacts]) > 0.5

    def touches(self) -> list[tuple[str, float, float]]:
        """Stretches on one surface: its name, begin and end in seconds."""
        touched = [row["surface"] if float(row["touching"]) > 0.5 else "" for row in self.contacts]
        times = [*self.contact_times, self.contact_times[-1]]
        changes = [index for index in range(1, len(touched)) if touched[index] != touched[index - 1]]
        stretches = zip([0, *changes], [*changes, len(touched)], strict=True)
        return [(touched[begin], times[begin], times[end]) for begin, end in stretches if touched[begin]]


def labels_of(surface: dict) -> list[str]:
    """The labels of a surface, the heaviest first."""
    material = surface["material"]
    return [material] if isinstance(material, str) else sorted(material, key=material.get, reverse=True)


def colour_of(label: str) -> str:
    """Labels that the shipped model does not have share one colour."""
    return COLOURS.get(label, "#7a7a7a")


def run(*words: object) -> str:
    done = subprocess.run([str(ENGINE), *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    return done.stdout


def read_wave(wav: Path) -> tuple[int, np.ndarray]:
    """Rate and samples, +-1."""
    with warnings.catch_warnings():
        # SciPy does not know the chunk in which the engine stores its settings.
        warnings.simplefilter("ignore", wavfile.WavFileWarning)
        rate_hz, samples = wavfile.read(wav)
    return rate_hz, samples.astype(np.float64)


def render_file(scene: dict | Path, stroke: np.ndarray | Path, output: Path, *words: object) -> tuple[Path, Path]:
    """Renders to a file that ends in .wav or .json. A scene and a stroke (t, x, y, z[, force]) that are no files are
    written beside it. Returns the files of both."""
    if isinstance(scene, dict):
        file = output.with_suffix(".scene.json")
        file.write_text(json.dumps(scene, indent=2) + "\n", encoding="utf-8")
        scene = file
    if isinstance(stroke, np.ndarray):
        file = output.with_suffix(".stroke.csv")
        header = ",".join(("t", "x", "y", "z", "force")[: stroke.shape[1]])
        np.savetxt(file, stroke, fmt="%.7f", delimiter=",", header=header, comments="")
        stroke = file
    run("render", scene, "--stroke", stroke, "-o", output, "--quiet", *words)
    return scene, stroke


def contacts_of(scene: Path, stroke: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(run("contact", scene, "--stroke", stroke).splitlines()))


def render(
    scene: dict | Path, stroke: np.ndarray | Path, *words: object, full_scale_mps2: float = FULL_SCALE_MPS2
) -> Render:
    with tempfile.TemporaryDirectory() as folder:
        wav = Path(folder) / "felt.wav"
        files = render_file(scene, stroke, wav, "--full-scale", full_scale_mps2, *words)
        rate_hz, samples = read_wave(wav)
        return Render(rate_hz, full_scale_mps2 * samples, contacts_of(*files))


def rest_of(surface: dict) -> np.ndarray:
    """Where a drawing shows a surface: its own place, or the first of its motion."""
    return np.array(surface.get("motion", {}).get("keyframes", [surface])[0]["position"])


def outline(surface: dict, plane_of: list[int]) -> np.ndarray:
    """[n, 2] corners in metres, at the surface's rest pose, in a view along an axis of the world."""
    keyframe = surface.get("motion", {}).get("keyframes", [surface])[0]
    turn = Rotation.from_quat(keyframe.get("rotation", surface.get("rotation", [0.0, 0.0, 0.0, 1.0])))
    shape = surface["shape"]
    if "box" in shape:
        local = np.array(shape["box"]["size"]) / 2.0 * list(product((-1.0, 1.0), repeat=3))
    elif "sphere" in shape:
        local = _ball(shape["sphere"]["radius"], 0.0)
    else:
        capsule = shape["capsule"]
        local = _ball(capsule["radius"], capsule["height"] / 2.0 - capsule["radius"])
    points = (turn.apply(local) + rest_of(surface))[:, plane_of]
    return points[ConvexHull(points).vertices]


def _ball(radius: float, reach: float) -> np.ndarray:
    """[N, 3] points of a sphere; with a reach above 0 of a capsule along y."""
    turns, heights = np.meshgrid(
        np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False), np.linspace(-np.pi / 2.0, np.pi / 2.0, 25)
    )
    lifts = np.where(np.arange(25) > 12, reach, -reach)[:, None]
    wide = radius * np.cos(heights)
    points = [wide * np.cos(turns), radius * np.sin(heights) + lifts, wide * np.sin(turns)]
    return np.stack(points, axis=-1).reshape(-1, 3)


def draw_spectrogram(axes: plt.Axes, felt: Render, top_db: float | None = None, range_db: float = 60.0) -> None:
    """Decibels up to top_db of power density; without top_db, up to the loudest bin."""
    window = int(0.064 * felt.rate_hz)
    frequencies, times, power = spectrogram(
        felt.acceleration_mps2, felt.rate_hz, nperseg=window, noverlap=window * 7 // 8
    )
    shown = frequencies <= TOP_HZ
    levels = 10.0 * np.log10(power[shown] + 1e-20)
    top = float(levels.max()) if top_db is None else top_db
    axes.imshow(
        levels, origin="lower", aspect="auto", cmap="inferno", vmin=top - range_db, vmax=top,
        extent=(times[0], times[-1], 0.0, TOP_HZ), interpolation="bilinear",
    )  # fmt: skip


def stamp() -> PngImagePlugin.PngInfo:
    """Names the model in a picture's file."""
    text = PngImagePlugin.PngInfo()
    text.add_text("Model-SHA-256", hashlib.sha256(MODEL.read_bytes()).hexdigest())
    return text


def save(figure: plt.Figure, file: Path) -> None:
    """Save with a palette, at a quarter of the size and without visible difference."""
    pixels = io.BytesIO()
    figure.savefig(pixels, dpi=100)
    plt.close(figure)
    Image.open(pixels).convert("RGB").quantize(200).save(file, optimize=True, pnginfo=stamp())
    print(file.relative_to(ROOT))


if __name__ == "__main__":
    # Stamps pictures of other programs. With --palette first, they get one of 200 colours.
    names = sys.argv[1:]
    has_palette = names[:1] == ["--palette"]
    for name in names[has_palette:]:
        picture = Image.open(name)
        (picture.convert("RGB").quantize(200) if has_palette else picture).save(name, optimize=True, pnginfo=stamp())
