"""Draws the plots of Documentation~/effects-and-outputs.md: what each effect does, through the shipped engine and model.

Run from the repository's root, after `npm run build`:

    /usr/bin/python3 scripts/pack/effect_pictures.py

It writes the table of the labels into the page, and effect-impact.png, effect-edge.png, effect-delay.png,
effect-exposure-guard.png, features-of-the-wave.png and output-controller-waveform.png into Documentation~/images.
Renders come from the command line, the exposure guard's minutes and the features of the wave from the C interface, the
controller's wave from a test that plays the C# components; run that first:

    dotnet test Tests/Dotnet/HaptoFlow.ShimTests --filter TestCategory=DocumentationPicture
"""

from __future__ import annotations

import json
import re
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from native_engine import exposure
from renders import FULL_SCALE_MPS2, MODEL, ROOT, colour_of, render, render_file, run, save
from scipy.signal import welch

from haptoflow_benchmark.engine_library import default_engine, wave_frames
from haptoflow_training.model_stamp import model_line, sha256_of, with_measured_words

IMAGES = ROOT / "Documentation~/images"
PAGE = ROOT / "Training/results/effects.md"
# Statistics of the intensity error, and how each is printed.
FIGURES = (("mean", "+"), ("mean_magnitude", ""), ("p95", ""))
RATE_HZ = 48000
DEEP_METRES = 0.0005
# Slower than what counts as a touch-down, 30 mm/s.
SINKING_MPS = 0.02


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


def guard_picture() -> plt.Figure:
    figure, (levels, gains) = plt.subplots(2, 1, figsize=(10.0, 4.4), sharex=True, layout="constrained")
    minutes = 40.0
    engine = default_engine(ROOT)
    for actuator_gain, colour in ((4.0, "#3465a4"), (16.0, "#cc4c02")):
        rows = exposure(engine, MODEL, label="sandpaper", force_newtons=3.0, speed_mps=0.2, actuator_gain=actuator_gain,
                        seconds=60.0 * minutes)
        time = rows["seconds"] / 60.0
        name = f"actuator gain {actuator_gain:g}"
        levels.plot(time, rows["short_term_mps2"], color=colour, label=f"mean of 5 minutes, {name}")
        gains.plot(time, 20.0 * np.log10(rows["gain"]), color=colour, label=name)
    levels.axhline(60.0, color="#888", linewidth=0.8, linestyle="--", label="60 m/s²")
    levels.set(ylabel="m/s²", title="Sandpaper, 3 N, 0.2 m/s, without a pause")
    gains.set(xlabel="minutes", ylabel="gain of the guard, dB")
    for axes in (levels, gains):
        axes.legend(frameon=False, loc="upper right")
        axes.grid(alpha=0.3)
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


def controller_picture() -> plt.Figure:
    figure, axes = plt.subplots(figsize=(10.0, 3.4), layout="constrained")
    for name, rate_hz, colour, title in (("audio", 48000, "#444", "wanted: an audio output at 48 kHz"),
                                         ("controller", 2000, "#3465a4", "sent to a controller at 2 kHz")):
        file = ROOT / f"out/pictures/{name}.txt"
        if not file.exists():
            raise SystemExit(f"{file.relative_to(ROOT)} is missing: dotnet test Tests/Dotnet/HaptoFlow.ShimTests --filter "
                             "TestCategory=DocumentationPicture writes it")
        frequency, density = welch(np.loadtxt(file), rate_hz, nperseg=rate_hz // 8)
        heard = (frequency >= 16.0) & (frequency <= 1000.0)
        axes.semilogx(frequency[heard], 10.0 * np.log10(density[heard]), color=colour, label=title)
    axes.set(xlabel="Hz", ylabel="dB re 1 (m/s²)²/Hz", title="Six seconds of circles on wood, in the stand-in for Unity")
    axes.grid(alpha=0.3, which="both")
    axes.legend(frameon=False)
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


def main() -> None:
    """Draws every picture."""
    pictures = {
        "effect-impact": impact_picture,
        "effect-edge": edge_picture,
        "effect-delay": delay_picture,
        "effect-exposure-guard": guard_picture,
        "features-of-the-wave": features_picture,
        "output-controller-waveform": controller_picture,
    }
    PAGE.write_text(with_measured_words(PAGE.read_text(encoding="utf-8"), label_table()), encoding="utf-8")
    print(PAGE.relative_to(ROOT))
    for name, draw in pictures.items():
        save(draw(), IMAGES / f"{name}.png")


if __name__ == "__main__":
    main()
