"""Compares a model with own recordings: held-out parts, rendered by the engine with their own motion.

Makes no assumption about labels, speeds or protocols. Figures are computed over windows in which the tip moves: their
level, and the spectra of all windows of one range of speed together, so that a few loud windows do not dominate.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine.engine_render import render_motion
from haptoflow_benchmark.metrics.waveform_metrics import (
    gfc_recording,
    level_error_db,
    log_spectral_distance_db,
    power_spectrum,
)
from haptoflow_training.waveform import SAMPLE_RATE_HZ

_Floats = NDArray[np.floating]

_WINDOW_SAMPLES = 400
# The engine's start from a seed, and the end of its resampler.
_SETTLING_SAMPLES = 200
_MINIMUM_SPEED_MPS = 0.005
# Spectra of fewer samples are mostly chance.
_MINIMUM_SAMPLES_OF_A_SPECTRUM = 1024
_SPEED_BORDERS_MPS = (0.02, 0.04, 0.08, 0.16, 0.32, 0.64)
_LSD_WINDOW = 256


@dataclass(frozen=True)
class HeldOutPart:
    """recorded [n] in m/s^2 at 2 kHz; motion [n, 3]: vx, vy in m/s, force in N."""

    name: str
    label: str
    recorded: _Floats
    motion: _Floats


@dataclass(frozen=True)
class RenderedPart:
    """The same motion rendered by the engine, as long as its recording."""

    part: HeldOutPart
    rendered: _Floats


@dataclass(frozen=True)
class LabelAccuracy:
    """seconds: compared. level_errors_db: of each window, positive is too strong. gfc, lsd_db: means over ranges of
    speed; None if no range has enough samples. by_speed: (lowest m/s, level error in dB) of each range."""

    label: str
    parts: int
    seconds: float
    level_errors_db: tuple[float, ...]
    gfc: float | None
    lsd_db: float | None
    by_speed: tuple[tuple[float, float], ...]

    @property
    def level_error_median_db(self) -> float:
        return float(np.median(self.level_errors_db))

    @property
    def level_error_p90_db(self) -> float:
        """The 90th percentile of the level error's magnitude."""
        return float(np.quantile(np.abs(self.level_errors_db), 0.9))

    def to_json(self) -> dict[str, Any]:
        return {
            "label": self.label,
            "parts": self.parts,
            "seconds": round(self.seconds, 2),
            "level_error_median_db": round(self.level_error_median_db, 3),
            "level_error_p90_db": round(self.level_error_p90_db, 3),
            "gfc": None if self.gfc is None else round(self.gfc, 4),
            "lsd_db": None if self.lsd_db is None else round(self.lsd_db, 3),
            "level_error_db_by_speed_mps": [[low, round(error, 2)] for low, error in self.by_speed],
        }


def render_parts(
    parts: Sequence[HeldOutPart], *, engine: Path, model: Path, folder: Path, advance: Callable[[int], object]
) -> list[RenderedPart]:
    """InputError carries the command line's own message if it fails."""
    rendered = []
    for number, part in enumerate(parts):
        made = render_motion(engine, part.label, part.motion, folder, model=model, seed=1 + number)
        rendered.append(RenderedPart(part, made.waveform_mps2))
        advance(1)
    return rendered


def label_accuracy(label: str, rendered: Sequence[RenderedPart]) -> LabelAccuracy | None:
    """None if the label's parts hold no window in which the tip moves."""
    windows: list[tuple[_Floats, _Floats, float]] = []
    for entry in rendered:
        count = min(len(entry.rendered), len(entry.part.recorded))
        speed = np.hypot(entry.part.motion[:count, 0], entry.part.motion[:count, 1])
        for start in range(_SETTLING_SAMPLES, count - _WINDOW_SAMPLES + 1, _WINDOW_SAMPLES):
            window = slice(start, start + _WINDOW_SAMPLES)
            if speed[window].mean() > _MINIMUM_SPEED_MPS:
                windows.append((entry.rendered[window], entry.part.recorded[window], float(speed[window].mean())))
    if not windows:
        return None
    classes = np.digitize([speed for _, _, speed in windows], _SPEED_BORDERS_MPS)
    gfc, lsd, by_speed = [], [], []
    for speed_class in np.unique(classes):
        own = [window for window, found in zip(windows, classes, strict=True) if found == speed_class]
        made, reference = (np.concatenate([window[side] for window in own]) for side in (0, 1))
        by_speed.append(((0.0, *_SPEED_BORDERS_MPS)[speed_class], level_error_db(made, reference)))
        if len(made) >= _MINIMUM_SAMPLES_OF_A_SPECTRUM:
            gfc.append(gfc_recording(made, reference))
            lsd.append(log_spectral_distance_db(made, reference))
    return LabelAccuracy(
        label,
        len(rendered),
        len(windows) * _WINDOW_SAMPLES / SAMPLE_RATE_HZ,
        tuple(level_error_db(made, reference) for made, reference, _ in windows),
        float(np.mean(gfc)) if gfc else None,
        float(np.mean(lsd)) if lsd else None,
        tuple(by_speed),
    )


def spectra_db(rendered: Sequence[RenderedPart]) -> tuple[_Floats, _Floats, _Floats]:
    """(Hz, recorded, rendered): mean power of a label's parts, dB over 1 (m/s^2)^2 per bin of 7.8 Hz."""
    frequency = np.fft.rfftfreq(_LSD_WINDOW, 1.0 / SAMPLE_RATE_HZ)
    waves = [(one.part.recorded, one.rendered) for one in rendered]
    sums = []
    for side in (0, 1):
        spectra = [power_spectrum(pair[side], _LSD_WINDOW) for pair in waves if len(pair[side]) >= 2 * _LSD_WINDOW]
        scale = 2.0 / (_LSD_WINDOW * np.square(np.hanning(_LSD_WINDOW + 1)[:-1]).sum())
        sums.append(10.0 * np.log10(scale * np.mean(spectra, axis=0) + 1e-9) if spectra else np.zeros(len(frequency)))
    return frequency, sums[0], sums[1]
