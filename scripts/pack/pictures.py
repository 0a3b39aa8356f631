"""Draws the pictures of the pages and of the README from renders of the command line.

Run from the repository's root, after `npm run build`; without names, every picture is drawn:

    /usr/bin/python3 scripts/pack/pictures.py [NAME ...]

The names are those of the files: see `PICTURES`. "labels" writes the table of the labels into
Documentation~/effects-and-outputs.md. Scene and stroke of the README's picture and of the lag are `crossing` of
Samples~/HeadlessScenes.
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
from renders import (
    FULL_SCALE_MPS2,
    MODEL,
    ROOT,
    SAMPLES,
    Render,
    colour_of,
    contacts_of,
    draw_spectrogram,
    labels_of,
    outline,
    read_wave,
    render,
    render_file,
    rest_of,
    run,
    save,
)
from scipy.ndimage import uniform_filter1d
from scipy.signal import spectrogram

from haptoflow_benchmark.engine.engine_library import default_engine
from haptoflow_benchmark.engine.wave_frames import wave_frames
from haptoflow_training.model_stamp import model_line, sha256_of, with_measured_words

SCENE = SAMPLES / "HeadlessScenes/crossing.scene.json"
STROKE = SAMPLES / "HeadlessScenes/crossing.stroke.csv"
INK = "#1c1c1e"
# Of the lag: the rate of the level, its seeds, the full scale of the output, the stretch that is shown, a pen at rest.
LEVEL_HZ = 8000
SEEDS = range(1, 17)
OUTPUT_MPS2 = 200.0
SHOWN_SECONDS = (4.9, 6.5)
FLOOR_MPS = 0.01
# Of the effects.
EFFECTS_PAGE = ROOT / "Training/results/effects.md"
# Statistics of the intensity error, and how each is printed.
FIGURES = (("mean", "+"), ("mean_magnitude", ""), ("p95", ""))
RATE_HZ = 48000
DEEP_METRES = 0.0005
# Slower than what counts as a touch-down, 30 mm/s.
SINKING_MPS = 0.02


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


def levels_db() -> np.ndarray:
    """Level [n] in dB re 1 m/s^2 at LEVEL_HZ."""
    power = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in SEEDS:
            wav = Path(folder) / "crossing.wav"
            render_file(SCENE, STROKE, wav, "--seed", seed, "--rate", LEVEL_HZ, "--model", MODEL)
            power.append(np.square(read_wave(wav)[1] * OUTPUT_MPS2))
    shortest = min(len(each) for each in power)
    mean = np.mean([each[:shortest] for each in power], axis=0)
    return 10.0 * np.log10(uniform_filter1d(mean, LEVEL_HZ // 100) + 1e-8)


def true_speed() -> tuple[np.ndarray, np.ndarray]:
    """Seconds and the pen's speed over the table in m/s, at 1 kHz, from the stroke's own points."""
    rows = np.loadtxt(STROKE, delimiter=",", skiprows=1)
    times = np.arange(0.0, rows[-1, 0], 1e-3)
    places = np.stack([np.interp(times, rows[:, 0], rows[:, axis]) for axis in (1, 3)], axis=1)
    velocity = np.gradient(uniform_filter1d(places, 9, axis=0), times, axis=0)
    return times, np.hypot(*velocity.T)


def lag_ms(times: np.ndarray, speed: np.ndarray, level_db: np.ndarray, touching: np.ndarray) -> float:
    wanted = 20.0 * np.log10(np.maximum(speed, FLOOR_MPS))

    def likeness(lag_seconds: float) -> float:
        shifted = np.interp(times + lag_seconds, np.arange(len(level_db)) / LEVEL_HZ, level_db)
        return float(np.corrcoef(shifted[touching], wanted[touching])[0, 1])

    lags = np.arange(0.0, 0.06, 0.0005)
    return float(1e3 * lags[int(np.argmax([likeness(lag) for lag in lags]))])


def crossing_picture() -> plt.Figure:
    """The pen's speed and the vibration's level over 16 renders with other seeds. The lag is the shift at which log level
    and log speed correlate best, over all of the stroke that touches."""
    times, speed = true_speed()
    contacts = contacts_of(SCENE, STROKE)
    touches = [float(row["touching"]) for row in contacts]
    # Landings and lift-offs have levels of their own.
    touching = uniform_filter1d(np.interp(times, [float(row["t"]) for row in contacts], touches), 201) > 0.99
    figure, axis = plt.subplots(figsize=(9.0, 2.9), layout="constrained")
    level = levels_db()
    lag = lag_ms(times, speed, level, touching)
    print(f"{lag:.1f} ms")
    axis.plot(times, 1000.0 * speed, color="#8fa3b8", label="speed of the pen, mm/s")
    axis.set_ylabel("mm/s")
    other = axis.twinx()
    other.plot(np.arange(len(level)) / LEVEL_HZ, level, color="#b4533c", label="level of the vibration, dB")
    other.set_ylim(-30.0, 30.0)
    other.set_ylabel("dB re 1 m/s²")
    axis.set_title(f"the level follows the speed {lag:.0f} ms later", loc="left", fontsize=11)
    lines = [*axis.lines, *other.lines]
    place = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": 2, "frameon": False, "fontsize": 9}
    axis.legend(lines, [str(line.get_label()) for line in lines], **place)
    axis.set_xlim(*SHOWN_SECONDS)
    axis.set_xlabel("s")
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


def wave_of(surfaces: list[dict], stroke: np.ndarray, *words: str) -> np.ndarray:
    """[N] in m/s^2 at RATE_HZ."""
    return render({"surfaces": surfaces}, stroke, *words).acceleration_mps2


def intensity_errors(surfaces: list[dict], stroke: np.ndarray) -> dict[str, dict[str, float]]:
    """Intensity errors of the frames and of a motor, in dB: see `haptoflow render -o x.json`."""
    with tempfile.TemporaryDirectory() as folder:
        frames = Path(folder) / "out.json"
        render_file({"surfaces": surfaces}, stroke, frames, "--full-scale", FULL_SCALE_MPS2)
        return json.loads(frames.read_text(encoding="utf-8"))["intensity_error_db"]


def plane(label: str) -> dict:
    return {"name": "plane", "shape": {"plane": {}}, "material": label}


def box(name: str, label: str, left: float, top: float) -> dict:
    """A box half a metre long with the given left end and top."""
    return {"name": name, "shape": {"box": {"size": [0.5, 0.1, 0.5]}}, "position": [left + 0.25, top - 0.05, 0.0],
            "material": label}


def stroke_of(
    times: np.ndarray, x: np.ndarray | float, y: np.ndarray | float, force: np.ndarray | float = 1.0
) -> np.ndarray:
    """Rows of a stroke file [n, 5]: seconds, metres (z is 0), newtons."""
    return np.column_stack(np.broadcast_arrays(times, x, y, 0.0, force))


def drop(speed_mps: float) -> np.ndarray:
    """Straight down onto y = 0, touching down after 0.1 s, then at rest."""
    times = np.arange(0.0, 0.4, 0.002)
    height = np.maximum(speed_mps * (0.1 - times), -DEEP_METRES)
    return stroke_of(times, 0.0, height)


def slide(speed_mps: float, step_metres: float) -> np.ndarray:
    """Along x, over 0 at 0.5 s; from there on the tip sinks by the step, as slowly as a hand follows."""
    times = np.arange(0.0, 1.0, 0.002)
    x = speed_mps * (times - 0.5)
    sunk = np.clip(SINKING_MPS * (times - 0.5), 0.0, step_metres)
    return stroke_of(times, x, -sunk - DEEP_METRES)


def accelerating() -> np.ndarray:
    """Four seconds along x, from 0.05 to 0.35 m/s, with 0.5 to 1.5 N."""
    times = np.arange(0.0, 4.0, 0.002)
    speed = 0.05 + 0.3 * times / 4.0
    force = 1.0 + 0.5 * np.sin(2.0 * np.pi * 0.5 * times)
    return stroke_of(times, np.cumsum(speed) * 0.002, -DEEP_METRES, force)


def first_sound(wave: np.ndarray) -> int:
    return int(np.argmax(np.abs(wave) > 1e-6))


def impact_picture() -> plt.Figure:
    figure, (waves, law) = plt.subplots(1, 2, figsize=(10.0, 3.6), layout="constrained")
    for place, label in enumerate(("rubber", "wood", "stone")):
        colour = colour_of(label)
        wave = wave_of([plane(label)], drop(0.6), "--effects", "impact")
        begin = first_sound(wave)
        seconds = np.arange(int(0.06 * RATE_HZ)) / RATE_HZ
        waves.plot(1000.0 * seconds, wave[begin : begin + len(seconds)] - 500.0 * place, color=colour)
        waves.annotate(label, (58.0, 40.0 - 500.0 * place), color=colour, ha="right")
        speeds = np.geomspace(0.01, 2.0, 9)
        peaks = [np.abs(wave_of([plane(label)], drop(speed), "--effects", "impact")).max() for speed in speeds]
        law.loglog(speeds, peaks, "o-", color=colour, label=label, markersize=4)
    waves.set(xlabel="ms after the landing", ylabel="m/s², one below the other", title="A landing at 0.6 m/s")
    waves.set_yticks([0, -500, -1000], ["0", "0", "0"])
    law.set(xlabel="approach, m/s", ylabel="peak, m/s²", title="The amplitude is proportional to the approach")
    law.grid(alpha=0.3, which="both")
    law.legend(frameon=False)
    return figure


def edge_picture() -> plt.Figure:
    figure, (waves, law) = plt.subplots(1, 2, figsize=(10.0, 3.6), layout="constrained")
    pairs = {
        "a step down of 2 mm, wood": ("wood", "wood", 0.002),
        "a step down of 0.5 mm, wood": ("wood", "wood", 0.0005),
        "glass to sandpaper, flush": ("glass", "sandpaper", 0.0),
        "wood to wood, flush": ("wood", "wood", 0.0),
    }
    for place, (name, (before, after, height)) in enumerate(pairs.items()):
        scene = [box("before", before, -0.5, 0.0), box("after", after, 0.0, -height)]
        energies = []
        speeds = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5]
        for speed in speeds:
            wave = wave_of(scene, slide(speed, height), "--effects", "edge")
            energies.append(np.sum(wave**2) / RATE_HZ)
            if speed == 0.2:
                begin = int(0.49 * RATE_HZ)
                seconds = np.arange(int(0.06 * RATE_HZ)) / RATE_HZ
                waves.plot(1000.0 * (seconds - 0.01), wave[begin : begin + len(seconds)] - 20.0 * place, label=name)
        law.plot(speeds, np.sqrt(energies), "o-", markersize=4, label=name)
    waves.set(xlabel="ms after the edge", ylabel="m/s², one below the other", title="At 0.2 m/s")
    waves.set_yticks([-20.0 * place for place in range(len(pairs))], ["0"] * len(pairs))
    law.set(xlabel="speed, m/s", ylabel="root of the energy, m/s² √s", title="It follows speed and height or level")
    law.grid(alpha=0.3)
    law.legend(frameon=False)
    return figure


def delay_picture() -> plt.Figure:
    figure, axes = plt.subplots(figsize=(10.0, 2.6), layout="constrained")
    times = np.arange(0.0, 0.8, 0.002)
    x = 0.2 * np.clip(times - 0.15, 0.0, 0.3)
    height = np.where(times < 0.45, np.maximum(0.6 * (0.1 - times), -DEEP_METRES), 0.01)
    stroke = stroke_of(times, x, height)
    for place, milliseconds in enumerate((0, 100)):
        wave = wave_of([plane("wood")], stroke, "--effects", "texture,impact", "--delay-ms", str(milliseconds))
        axes.plot(np.arange(len(wave)) / RATE_HZ, wave - 150.0 * place, linewidth=0.6, label=f"delay {milliseconds} ms")
    axes.set(xlabel="s", ylabel="m/s², one below the other", title="A landing and a stroke of 0.3 s")
    axes.set_yticks([0, -150], ["0", "0"])
    axes.legend(frameon=False, loc="upper right")
    return figure


def features_picture() -> plt.Figure:
    figure, (wave_axes, controller, motor) = plt.subplots(3, 1, figsize=(10.0, 6.0), sharex=True, layout="constrained")
    times = np.arange(0.0, 1.0, 0.002)
    x = 0.2 * np.clip(times - 0.2, 0.0, 0.5)
    height = np.where(times < 0.8, np.maximum(0.6 * (0.1 - times), -DEEP_METRES), 0.01)
    stroke = stroke_of(times, x, height)
    wave = wave_of([plane("concrete")], stroke, "--effects", "texture,impact")
    wave_axes.plot(np.arange(len(wave)) / RATE_HZ, wave, linewidth=0.6, color="#444")
    wave_axes.set(ylabel="m/s²", title="Wanted: a landing and a stroke on concrete")
    engine = default_engine(ROOT)
    frames = wave_frames(engine, wave, RATE_HZ, 0.005, 40.0, 400.0)
    controller.step(frames["seconds"], frames["amplitude_mps2"], where="post", color="#3465a4", label="amplitude, m/s²")
    onsets = frames[frames["transient_mps2"] > 0.0]
    controller.plot(onsets["seconds"] + onsets["transient_offset_seconds"], onsets["transient_mps2"], "v", color="#cc4c02",
                    label="transient")
    controller.set(ylabel="m/s²", title="Sent to a controller of 40 to 400 Hz, every 5 ms")
    hertz = controller.twinx()
    hertz.step(frames["seconds"], frames["frequency_hz"], where="post", color="#999", linewidth=0.8)
    hertz.set_ylabel("Hz (grey)")
    controller.legend(frameon=False, loc="upper right")
    frames = wave_frames(engine, wave, RATE_HZ, 0.008, 160.0, 160.0)
    motor.step(frames["seconds"], frames["amplitude_mps2"], where="post", color="#3465a4")
    motor.set(xlabel="s", ylabel="m/s²", title="Sent to a motor of 160 Hz, every 8 ms: each frame feels as strong as the wave")
    return figure


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


IMAGES = ROOT / "Documentation~/images"
# Names, files and drawings.
PICTURES: dict[str, tuple[Path, Callable[[], plt.Figure]]] = {
    "stroke": (IMAGES / "stroke.png", stroke_picture),
    "TextureGallery": (SAMPLES / "TextureGallery/TextureGallery.png", gallery_picture),
    "crossing-lag": (IMAGES / "crossing-lag.png", crossing_picture),
    "effect-impact": (IMAGES / "effect-impact.png", impact_picture),
    "effect-edge": (IMAGES / "effect-edge.png", edge_picture),
    "effect-delay": (IMAGES / "effect-delay.png", delay_picture),
    "features-of-the-wave": (IMAGES / "features-of-the-wave.png", features_picture),
}


def main(names: list[str]) -> None:
    unknown = [name for name in names if name not in (*PICTURES, "labels")]
    if unknown:
        raise SystemExit(f"{unknown[0]}: expected some of {', '.join((*PICTURES, 'labels'))}")
    for name, (file, draw) in PICTURES.items():
        if not names or name in names:
            save(draw(), file)
    if not names or "labels" in names:
        page = with_measured_words(EFFECTS_PAGE.read_text(encoding="utf-8"), label_table())
        EFFECTS_PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
