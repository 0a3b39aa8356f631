"""Figures of what a device with one carrier plays: how far labels lie apart, how steady its amplitude is, and what is
left of impacts, ribs, starts and stops.

Steadiness alone would reward a device that plays one amplitude for ever. The depth of slow modulation, the height of
impacts and the time that a start and a stop take show what smoothing loses.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FRAME_SECONDS = 0.005
WAVE_RATE_HZ = 2000
# A just noticeable difference of frequency on the hand is 20-30 %.
JUST_NOTICEABLE_RATIO = 1.25
JUST_NOTICEABLE_SEMITONES = float(12.0 * np.log2(JUST_NOTICEABLE_RATIO))

# [N] in m/s^2 at 2 kHz to frames with frequency_hz, amplitude_mps2 and seconds, of FRAME_SECONDS each.
Frames = Callable[[NDArray[np.floating]], NDArray[np.void]]


@dataclass(frozen=True)
class CarrierCase:
    """What is played of one steady stroke. steps_db: between neighbouring frames, magnitudes."""

    label: str
    speed_mps: float
    force_newtons: float
    frequency_hz: NDArray[np.float64]
    steps_db: NDArray[np.float64]


@dataclass(frozen=True)
class Distances:
    """Between the carriers of all pairs of labels, in semitones. apart: share of pairs beyond a just noticeable
    difference. alike: the other pairs, nearest first."""

    smallest: float
    median: float
    apart: float
    alike: tuple[tuple[str, str], ...]


def case_of(label: str, speed_mps: float, force_newtons: float, frames: NDArray[np.void]) -> CarrierCase:
    """Of a stroke's frames, those that sound."""
    amplitude = frames["amplitude_mps2"]
    both = (amplitude[1:] > 0.0) & (amplitude[:-1] > 0.0)
    steps = np.abs(20.0 * np.log10(amplitude[1:][both] / amplitude[:-1][both]))
    return CarrierCase(label, speed_mps, force_newtons, frames["frequency_hz"][amplitude > 0.0], steps)


def medians_by_label(cases: Sequence[CarrierCase]) -> dict[str, float]:
    """The median carrier of each label over the frames of all its strokes, in Hz."""
    labels = dict.fromkeys(case.label for case in cases)
    return {
        label: float(np.median(np.concatenate([case.frequency_hz for case in cases if case.label == label])))
        for label in labels
    }


def distances(frequency_hz: Mapping[str, float]) -> Distances:
    """Between the carriers of labels."""
    names = list(frequency_hz)
    semitones = 12.0 * np.log2(np.array([frequency_hz[name] for name in names]))
    first, second = np.triu_indices(len(names), 1)
    apart = np.abs(semitones[first] - semitones[second])
    alike = [pair for pair in np.argsort(apart) if apart[pair] < JUST_NOTICEABLE_SEMITONES]
    return Distances(
        float(apart.min()),
        float(np.median(apart)),
        float(np.mean(apart >= JUST_NOTICEABLE_SEMITONES)),
        tuple((names[first[pair]], names[second[pair]]) for pair in alike),
    )


def distances_at_one_motion(cases: Sequence[CarrierCase]) -> list[Distances]:
    """For each speed and force: a hand compares labels at the motion that it makes."""
    motions = dict.fromkeys((case.speed_mps, case.force_newtons) for case in cases)
    return [
        distances(medians_by_label([case for case in cases if (case.speed_mps, case.force_newtons) == motion]))
        for motion in motions
    ]


def step_percentiles_db(cases: Sequence[CarrierCase]) -> tuple[float, float]:
    """Median and 95th percentile of the amplitude's steps."""
    steps = np.concatenate([case.steps_db for case in cases])
    return float(np.median(steps)), float(np.percentile(steps, 95.0))


def _noise(seconds: float, seed: int) -> NDArray[np.float64]:
    """Between 60 and 300 Hz, RMS 1."""
    count = int(seconds * WAVE_RATE_HZ)
    spectrum = np.fft.rfft(np.random.default_rng(seed).normal(size=count))
    frequency = np.fft.rfftfreq(count, 1.0 / WAVE_RATE_HZ)
    wave: NDArray[np.float64] = np.fft.irfft(np.where((frequency > 60.0) & (frequency < 300.0), spectrum, 0.0), count)
    return wave / np.sqrt(np.mean(np.square(wave)))


def step_delays_ms(frames: Frames, ratio: float, repeats: int = 40) -> tuple[float, float]:
    """Median and 95th percentile of the time from a step of the amplitude of noise (2 m/s^2 before it, `ratio` times as
    much after it) to the beginning of the first frame that is nearer to the new amplitude than to the old one, in dB."""
    found = []
    for repeat in range(repeats):
        at = WAVE_RATE_HZ // 2 + repeat % 10
        wave = 2.0 * _noise(1.0, repeat)
        before = _settled_db(frames(wave))
        wave[at:] *= ratio
        rows = frames(wave)
        decibels = _decibels(rows)
        after = _settled_db(rows)
        near = np.abs(decibels - after) < np.abs(decibels - before)
        later = np.flatnonzero(near & (rows["seconds"] + FRAME_SECONDS > at / WAVE_RATE_HZ))
        found.append(1000.0 * max(0.0, rows["seconds"][later[0]] - at / WAVE_RATE_HZ))
    return float(np.median(found)), float(np.percentile(found, 95.0))


def _decibels(rows: NDArray[np.void]) -> NDArray[np.float64]:
    """Intensity relative to the detection threshold, at least 0: comparable between carriers, unlike an amplitude."""
    found: NDArray[np.float64] = 20.0 * np.log10(np.maximum(rows["intensity"], 1.0))
    return found


def _settled_db(rows: NDArray[np.void]) -> float:
    return float(np.mean(_decibels(rows[3 * len(rows) // 4 :])))


def modulation_left(frames: Frames, modulation_hz: float) -> float:
    """Depth of a sinusoidal modulation (0.8) of noise that the amplitude still has, as a share: ribs that a hand can
    count must not be smoothed away."""
    seconds = 20.0
    times = np.arange(int(seconds * WAVE_RATE_HZ)) / WAVE_RATE_HZ
    envelope = 1.0 + 0.8 * np.sin(2.0 * np.pi * modulation_hz * times)
    rows = frames(5.0 * _noise(seconds, 1) * envelope)
    amplitude = rows["amplitude_mps2"]
    phase = np.exp(-2j * np.pi * modulation_hz * (rows["seconds"] + 0.5 * FRAME_SECONDS))
    return float(2.0 * np.abs(np.mean(amplitude * phase)) / np.mean(amplitude) / 0.8)


def peak_and_delay(tapped: NDArray[np.void], alone: NDArray[np.void], at_seconds: float) -> tuple[float, float]:
    """Of a tap on a texture: the strongest intensity within 30 ms, in dB relative to that of the same tap alone, and the
    time in ms from the tap to the beginning of that frame, 0 for the frame of the tap itself."""
    near = (tapped["seconds"] + FRAME_SECONDS > at_seconds) & (tapped["seconds"] < at_seconds + 0.03)
    rows, wanted = tapped[near], alone[near[: len(alone)]]
    strongest = int(np.argmax(rows["intensity"]))
    return float(_decibels(rows)[strongest] - _decibels(wanted).max()), float(1000.0 * max(0.0, rows["seconds"][strongest] - at_seconds))


def taps_on_noise(frames: Frames, repeats: int = 60) -> NDArray[np.float64]:
    """[repeats, 2]: `peak_and_delay` of taps of 15 m/s^2 on noise of 1 m/s^2, at every place within a frame."""
    rows = []
    times = np.arange(WAVE_RATE_HZ) / WAVE_RATE_HZ
    for repeat in range(repeats):
        frequency = (80.0, 150.0, 250.0, 350.0)[repeat % 4]
        begin = (WAVE_RATE_HZ // 2 + repeat % 10) / WAVE_RATE_HZ
        since = np.maximum(times - begin, 0.0)
        tap = 15.0 * np.exp(-80.0 * since) * np.sin(2.0 * np.pi * frequency * since)
        rows.append(peak_and_delay(frames(tap + _noise(1.0, repeat)), frames(tap), begin))
    return np.array(rows)
