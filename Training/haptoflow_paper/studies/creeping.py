"""Slow motion: what a creeping tip feels, and that a held tip feels nothing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.signal import butter, resample_poly, sosfilt, sosfiltfilt

from haptoflow_paper.report.temporal_metrics import kurtosis
from haptoflow_paper.studies.place_study import Doubles, Pass, Renderer, Table
from haptoflow_training.recordings.synthetic import HELD_OUT_SPECIMEN, Material, load_materials
from haptoflow_training.recordings.synthetic.carriers import path_from_velocity
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ, tool_vibration
from haptoflow_training.waveform import SAMPLE_RATE_HZ

SPEEDS_MPS = (0.002, 0.003, 0.005)
CREEPING_LABELS = ("stone", "brick", "concrete", "sandpaper", "wood", "glass")
_SECONDS = 6.0
# A millimetre passes before a creeping tip is heard.
_SETTLING_SECONDS = 1.0
_QUIET_RADIUS_METRES, _QUIET_SECONDS = 0.0006, 0.25
_HOLD_SECONDS = 5.0


@dataclass(frozen=True)
class Hold:
    """The tremor of a pen that is held at one place: times [n] in seconds from 0 on, and positions [n, 2] in metres
    relative to that place."""

    times: Doubles
    places_metres: Doubles

    def points(self) -> tuple[Doubles, Doubles, Doubles]:
        return self.times, self.places_metres[:, 0], self.places_metres[:, 1]

    @property
    def diameter_metres(self) -> float:
        between = self.places_metres[:, None] - self.places_metres[None]
        return float(np.hypot(between[..., 0], between[..., 1]).max())


def creeping(renderer: Renderer, label: str) -> dict[str, dict[str, float]]:
    """{speed in mm/s: figures} of the render."""
    found = {}
    for speed in SPEEDS_MPS:
        wave = renderer.wave(Table(label), Pass(0.0, _SECONDS * speed, speed))
        found[f"{1e3 * speed:g}"] = _figures(wave[round(_SETTLING_SECONDS * SAMPLE_RATE_HZ) :])
    return found


def recorder_without_noise(label: str) -> dict[str, dict[str, float]]:
    """The same of the recorder's surface, without its sensors' noise."""
    material = _material(label)
    highpass = butter(2, 10.0, "high", fs=SAMPLE_RATE_HZ, output="sos")
    found = {}
    for speed in SPEEDS_MPS:
        count = round(_SECONDS * SIMULATION_RATE_HZ)
        velocity = np.zeros((count, 2))
        velocity[:, 0] = 1e3 * speed
        path = path_from_velocity(np.array([10.0, 12.0]), velocity)
        vibration = tool_vibration(material, path, np.ones(count), specimen=HELD_OUT_SPECIMEN)
        normal = vibration.acceleration_mps2[:, 2]
        wave = sosfilt(highpass, resample_poly(normal, 1, round(SIMULATION_RATE_HZ / SAMPLE_RATE_HZ)))
        found[f"{1e3 * speed:g}"] = _figures(wave[round(_SETTLING_SECONDS * SAMPLE_RATE_HZ) :])
    return found


def _material(label: str) -> Material:
    return next(each for each in load_materials() if each.label == label)


def _figures(wave: Doubles) -> dict[str, float]:
    peak = float(np.abs(wave).max())
    return {
        "rms_mps2": float(np.sqrt(np.mean(np.square(wave)))), "peak_mps2": peak,
        "kurtosis": float(kurtosis(wave)) if peak > 0.0 else 0.0,
    }  # fmt: skip


def holds(strokes: Mapping[str, Doubles]) -> list[Hold]:
    """The tremor of every stretch in which a recorded pen stays within 0.6 mm for 0.25 s, less its straight drift,
    played to and fro for five seconds. strokes: [n, 4] each, seconds and metres."""
    found = []
    for rows in strokes.values():
        moved = np.r_[True, np.any(np.diff(rows[:, 1:3], axis=0) != 0.0, axis=1)]
        times, places = rows[moved, 0], rows[moved, 1:3]
        begin = 0
        while begin < len(times):
            end = begin + 1
            while end < len(times) and (
                np.linalg.norm(places[end] - places[begin:end].mean(axis=0)) < _QUIET_RADIUS_METRES
            ):
                end += 1
            if times[end - 1] - times[begin] > _QUIET_SECONDS:
                # With its last places the pen leaves.
                found.append(_tremor(times[begin : end - 2], places[begin : end - 2]))
                begin = end
            else:
                begin += 1
    return found


def _tremor(times: Doubles, places: Doubles) -> Hold:
    since = times - times[0]
    drift = np.stack([np.polyval(np.polyfit(since, places[:, axis], 1), since) for axis in (0, 1)], axis=1)
    tremor = places - drift
    steps = np.diff(since)
    turns = int(np.ceil(_HOLD_SECONDS / since[-1]))
    rows = np.concatenate([tremor[1:] if turn % 2 == 0 else tremor[::-1][1:] for turn in range(turns)])
    passed = np.concatenate([steps if turn % 2 == 0 else steps[::-1] for turn in range(turns)])
    return Hold(np.r_[0.0, np.cumsum(passed)], np.concatenate([tremor[:1], rows]))


def held_silent(renderer: Renderer, tremors: Sequence[Hold]) -> list[dict[str, Any]]:
    """For each tremor: its size, and the largest output while the pen is held on sandpaper."""
    return [
        {
            "diameter_mm": 1e3 * hold.diameter_metres,
            "peak_mps2": float(np.abs(renderer.wave(Table("sandpaper"), hold)).max()),
        }
        for hold in tremors
    ]


HOP_SAMPLES = 28
_OTHER_PERIODS = (26, 27, 29, 31)
_BURST_SAMPLES = 10
_SETTLING_SAMPLES = 600
_LONG = Pass(0.0, 2.0, 0.1)


def hand_overs(renderer: Renderer, label: str) -> dict[str, float]:
    """In dB. swing: highest less lowest level of the 28 samples of a hop; chance: the same at four other periods.
    burst: the loudest 5 ms of a hop over its mean; burst_chance: the same at the other periods."""
    wave = renderer.wave(Table(label), _LONG)
    high = sosfiltfilt(butter(4, 300.0, "high", fs=SAMPLE_RATE_HZ, output="sos"), wave)[_SETTLING_SAMPLES:]
    others = [_folded(high, period) for period in _OTHER_PERIODS]
    hop = _folded(high, HOP_SAMPLES)
    return {
        "swing": float(np.ptp(_decibels(hop))), "chance": float(np.mean([np.ptp(_decibels(each)) for each in others])),
        "burst": _burst(hop), "burst_chance": float(np.mean([_burst(each) for each in others])),
    }  # fmt: skip


def _folded(wave: Doubles, period: int) -> Doubles:
    """Power at each place of a period, relative to the mean."""
    whole = len(wave) // period * period
    power: Doubles = np.square(wave[:whole]).reshape(-1, period).mean(axis=0)
    return power / power.mean()


def _burst(power: Doubles) -> float:
    around = np.concatenate([power, power[: _BURST_SAMPLES - 1]])
    windows = np.convolve(around, np.full(_BURST_SAMPLES, 1.0 / _BURST_SAMPLES), "valid")
    return float(_decibels(windows).max())


def _decibels(power: Doubles) -> Doubles:
    decibels: Doubles = 10.0 * np.log10(power)
    return decibels
