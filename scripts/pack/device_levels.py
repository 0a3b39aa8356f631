"""Measures how strongly devices play every shipped label, by the loudness law and in straight proportion, and how loud
Listen makes each label on loudspeakers.

Run from the repository's root, after `npm run build`:

    /usr/bin/python3 scripts/pack/device_levels.py

It prints the fit of the law, and writes the tables of Training/results/device-loudness.md and its picture.
"""

from __future__ import annotations

from ctypes import byref, c_double, c_float, c_int32, c_uint64, c_void_p
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from renders import ENGINE, FULL_SCALE_MPS2, MODEL, ROOT, render, save
from scipy.signal import butter, sosfiltfilt

from haptoflow_benchmark.engine_library import EngineLibrary, default_engine, wave_frames
from haptoflow_benchmark.engine_render import model_labels
from haptoflow_training.model_stamp import model_line, read_measured_page, sha256_of, with_measured_words

PAGE = ROOT / "Training/results/device-loudness.md"
STROKE = ROOT / "Samples~/HeadlessScenes/tracing.stroke.csv"
KINDS = ("motor", "parametric", "waveform")
FRAME_RATES_HZ = (72, 90, 120)
# The peaks of a waveform depend on how long one waits for them: the same time at every frame rate.
PEAK_RATE_HZ = 72
DEVICE_RATE_HZ = 8000
AUDIO_RATE_HZ = 48000
# What a device's full amplitude was assumed to be before there was a law; still the default of True Level.
PROPORTION_MPS2 = 60.0
DEFAULT_FULL_SCALE_MPS2 = 200.0
SILENT_MPS2 = 1e-3
LOUDSPEAKER_HZ = 300.0
MIDDLE_SHARE = 0.35
# What the law reaches before it bends, at the strongest label's 90th percentile.
STRONGEST_SHARE = 1.0


def wave_of(label: str, stroke: Path, rate_hz: int, *words: str, full_scale: float = FULL_SCALE_MPS2) -> np.ndarray:
    """[N], in m/s^2."""
    surface = {"name": "plane", "shape": {"plane": {}}, "material": label, "stiffness": 1000}
    scene = {"surfaces": [surface], "stylus": {"tip_radius": 0.002}}
    return render(scene, stroke, "--rate", rate_hz, *words, full_scale_mps2=full_scale).acceleration_mps2


def by_frames(values: np.ndarray, seconds: np.ndarray, rate_hz: float, reduce: str) -> np.ndarray:
    """One value a frame of the display."""
    frame = (seconds * rate_hz).astype(int)
    found = [getattr(values[frame == index], reduce)() for index in range(frame.max() + 1) if (frame == index).any()]
    return np.array(found)


def amplitudes(engine: EngineLibrary, wave: np.ndarray, rate_hz: float) -> dict[str, np.ndarray]:
    """What each kind gets in m/s^2: the motor one amplitude a frame of the display, parametric a point every 5 ms; of
    the waveform the peak of each 1/72 s. Silence is left out."""
    motor = wave_frames(engine, wave, DEVICE_RATE_HZ, 0.008, 160.0, 160.0)
    parametric = wave_frames(engine, wave, DEVICE_RATE_HZ, 0.005, 60.0, 400.0)
    seconds = np.arange(len(wave)) / DEVICE_RATE_HZ
    found = {
        "motor": by_frames(motor["amplitude_mps2"], motor["seconds"] + 0.008, rate_hz, "mean"),
        "parametric": parametric["amplitude_mps2"],
        "waveform": by_frames(np.abs(wave), seconds, PEAK_RATE_HZ, "max"),
    }
    return {kind: values[values > SILENT_MPS2] for kind, values in found.items()}


def shares(engine: EngineLibrary, kind: str, mps2: np.ndarray) -> np.ndarray:
    """The law for motor and parametric."""
    share = c_float()
    played = []
    for value in mps2:
        engine.call("haptoflow_device_share", c_int32(KINDS.index(kind)), c_float(value), byref(share))
        played.append(share.value)
    return np.array(played)


def device_wave(engine: EngineLibrary, wave_mps2: np.ndarray) -> np.ndarray:
    """The waveform as it is sent to a controller, +-1."""
    handle = c_void_p()
    samples = np.ascontiguousarray(wave_mps2 / DEFAULT_FULL_SCALE_MPS2, dtype=np.float32)
    engine.call("haptoflow_device_wave_create", c_double(DEVICE_RATE_HZ), byref(handle))
    engine.call("haptoflow_device_wave_process", handle, samples.ctypes.data_as(c_void_p), c_uint64(len(samples)),
                c_float(DEFAULT_FULL_SCALE_MPS2))  # fmt: skip
    engine.call("haptoflow_device_wave_close", byref(handle))
    return samples.astype(np.float64)


def played(engine: EngineLibrary, wave: np.ndarray, rate_hz: float) -> dict[str, np.ndarray]:
    """Parts of each kind's range that are played, 0 to 1."""
    given = amplitudes(engine, wave, rate_hz)
    sent = device_wave(engine, wave)
    peaks = by_frames(np.abs(sent), np.arange(len(sent)) / DEVICE_RATE_HZ, PEAK_RATE_HZ, "max")
    return {
        "motor": shares(engine, "motor", given["motor"]),
        "parametric": shares(engine, "parametric", given["parametric"]),
        "waveform": peaks[peaks > 1e-4],
    }


def decibels_above(wave_mps2: np.ndarray, frequency_hz: float) -> float:
    """RMS of what sounds above a frequency, dB relative to the full scale of an audio output."""
    high = sosfiltfilt(butter(4, frequency_hz, "high", fs=AUDIO_RATE_HZ, output="sos"), wave_mps2)
    sounding = np.abs(wave_mps2) > 0.0
    return 20.0 * np.log10(np.sqrt(np.mean(np.square(high[sounding]))) / DEFAULT_FULL_SCALE_MPS2)


def figures(values: np.ndarray) -> tuple[float, float]:
    return float(np.median(values)), float(np.percentile(values, 90.0))


def fitted(before: dict[str, dict[str, np.ndarray]]) -> dict[str, tuple[float, float]]:
    """For each kind the middle label's median in m/s^2, and the exponent."""
    fits = {}
    for kind in KINDS:
        medians = sorted(figures(each[kind])[0] for each in before.values())
        middle = float(np.sqrt(medians[(len(medians) - 1) // 2] * medians[len(medians) // 2]))
        strongest = max(figures(each[kind])[1] for each in before.values())
        fits[kind] = (middle, float(np.log(STRONGEST_SHARE / MIDDLE_SHARE) / np.log(strongest / middle)))
    return fits


def device_table(before: dict[str, dict[str, np.ndarray]], after: dict[str, dict[str, np.ndarray]]) -> list[str]:
    lines = ["| label | motor, before | now | parametric, before | now | waveform, before | now |",
             "|---|---|---|---|---|---|---|"]  # fmt: skip
    for label in sorted(before, key=lambda each: figures(before[each]["motor"])[0]):
        cells = []
        for kind in KINDS:
            straight = np.minimum(before[label][kind] / PROPORTION_MPS2, 1.0)
            cells += ["{:.3f} / {:.2f}".format(*figures(straight)), "{:.2f} / {:.2f}".format(*figures(after[label][kind]))]
        lines.append(f"| {label} | {' | '.join(cells)} |")
    return lines


def listen_table(levels: dict[str, tuple[float, float, float, float]]) -> list[str]:
    lines = ["| label | whole, true level | above 300 Hz | whole, Listen | above 300 Hz |", "|---|---|---|---|---|"]
    for label, row in sorted(levels.items(), key=lambda item: item[1][1]):
        lines.append(f"| {label} | {' | '.join(f'{value:.0f}' for value in row)} |")
    columns = np.array(list(levels.values())).T
    for name, reduce in (("median of the labels", np.median), ("worst label", np.min)):
        lines.append(f"| {name} | {' | '.join(f'{reduce(column):.0f}' for column in columns)} |")
    return lines


def picture(before: dict[str, dict[str, np.ndarray]], after: dict[str, dict[str, np.ndarray]]) -> plt.Figure:
    figure, panels = plt.subplots(1, 3, figsize=(11.0, 4.6), sharey=True, layout="constrained")
    labels = sorted(before, key=lambda each: figures(before[each]["motor"])[0])
    for panel, kind in zip(panels, KINDS, strict=True):
        for place, label in enumerate(labels):
            straight = figures(np.minimum(before[label][kind] / PROPORTION_MPS2, 1.0))
            now = figures(after[label][kind])
            panel.plot(straight, [place + 0.15] * 2, color="#b0b5bd", linewidth=2)
            panel.plot(straight[0], place + 0.15, "o", color="#8b919b", markersize=4)
            panel.plot(now, [place - 0.15] * 2, color="#2f7f6f", linewidth=2)
            panel.plot(now[0], place - 0.15, "o", color="#2f7f6f", markersize=5)
        panel.axvline(0.05, color="#c0504d", linestyle=":", linewidth=1)
        panel.set(title=kind, xlabel="part of the device's range", xscale="log", xlim=(0.004, 1.1))
        panel.set_xticks([0.01, 0.05, 0.1, 0.35, 1.0], ["0.01", "0.05", "0.1", "0.35", "1"])
        panel.minorticks_off()
        panel.grid(axis="x", alpha=0.3)
    panels[0].set_yticks(range(len(labels)), labels)
    panels[0].plot([], [], "o-", color="#8b919b", label="in proportion")
    panels[0].plot([], [], "o-", color="#2f7f6f", label="loudness law")
    panels[0].legend(frameon=False, loc="upper left", fontsize=8)
    return figure


def main() -> None:
    page = read_measured_page(PAGE)
    engine = default_engine(ROOT)
    labels = model_labels(ENGINE, MODEL)
    waves = {label: wave_of(label, STROKE, DEVICE_RATE_HZ) for label in labels}
    levels = {}
    for label in labels:
        pair = [
            wave_of(label, STROKE, AUDIO_RATE_HZ, *words, full_scale=DEFAULT_FULL_SCALE_MPS2)
            for words in ((), ("--listen",))
        ]
        levels[label] = tuple(decibels_above(wave, hz) for wave in pair for hz in (1.0, LOUDSPEAKER_HZ))
    goals = []
    for rate_hz in FRAME_RATES_HZ:
        before = {label: amplitudes(engine, wave, rate_hz) for label, wave in waves.items()}
        after = {label: played(engine, wave, rate_hz) for label, wave in waves.items()}
        for kind in KINDS:
            medians = sorted(figures(each[kind])[0] for each in after.values())
            strongest = max(figures(each[kind])[1] for each in after.values())
            fit = fitted(before)[kind]
            goals.append(f"| {rate_hz} | {kind} | {medians[0]:.2f} | {np.median(medians):.2f} | {strongest:.2f} |")
            print(f"{rate_hz} Hz {kind}: fit {fit[0]:.3f} m/s^2, exponent {fit[1]:.3f}; {goals[-1]}")
        if rate_hz == FRAME_RATES_HZ[0]:
            shown = (before, after)
    lines = [*device_table(*shown), "", "| display, Hz | device | weakest label | middle | strongest, 90 % |",
             "|---|---|---|---|---|", *goals, "", *listen_table(levels)]  # fmt: skip
    print("\n".join(lines))
    PAGE.write_text(with_measured_words(page, f"{model_line(sha256_of(MODEL))}\n\n" + "\n".join(lines)), encoding="utf-8")
    save(picture(*shown), ROOT / "Documentation~/images" / "device-loudness.png")


if __name__ == "__main__":
    main()
