"""What hand-overs add to a steady texture: the level above 300 Hz, folded at the hop."""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfiltfilt

from haptoflow_paper.place.passes import Doubles, Pass, Renderer, Table
from haptoflow_training.waveform import SAMPLE_RATE_HZ

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
