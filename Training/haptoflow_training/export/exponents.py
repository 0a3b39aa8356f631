"""Level and frequency exponents of each label for speeds and forces beyond the recordings, fitted to the recordings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.training.batches import HeldOut, clear_spans
from haptoflow_training.waveform import SAMPLE_RATE_HZ

@dataclass(frozen=True)
class RecordedWindows:
    """waves [n, samples] in m/s^2; motion [n, 3]: mean vx, vy (m/s) and force (N); unsteadiness [n]: standard
    deviation of log speed over the window; position_mm [n, 2]: the place on the surface at the window's middle
    sample."""

    waves: NDArray[np.float32]
    motion: NDArray[np.float32]
    unsteadiness: NDArray[np.float32]
    position_mm: NDArray[np.float32]

    @property
    def speed_mps(self) -> NDArray[np.float32]:
        return np.hypot(self.motion[:, 0], self.motion[:, 1])

    @property
    def rms_mps2(self) -> NDArray[np.float32]:
        return np.sqrt(np.square(self.waves).mean(axis=1))


def draw_windows(
    store: SegmentStore, label_index: int, *, samples: int, count: int, seed: int, held_out: HeldOut
) -> RecordedWindows:
    """`count` random windows of the label's training recordings, each within one recording and outside the held-out
    bands."""
    recordings = [
        recording
        for recording in store.recordings
        if recording.split == "train" and recording.label_index == label_index and recording.length > samples
    ]
    if not recordings:
        raise ValueError(f"label '{store.labels[label_index]}' has no training recording of {samples} samples")
    spans = clear_spans(
        store.motion,
        np.array([recording.start for recording in recordings], dtype=np.int64),
        np.array([recording.length for recording in recordings], dtype=np.int64),
        held_out,
    )
    room = np.maximum(spans.lengths - samples, 0)
    if not room.any():
        raise ValueError(f"label '{store.labels[label_index]}' has no {samples} samples outside the held-out bands")
    generator = np.random.default_rng([seed, label_index])
    chosen = generator.choice(len(room), size=count, p=room / room.sum())
    starts = spans.starts[chosen] + (generator.random(count) * room[chosen]).astype(np.int64)
    windows = starts[:, None] + np.arange(samples)[None, :]
    motion = store.motion[windows]
    speed = np.hypot(motion[..., 0], motion[..., 1])
    return RecordedWindows(
        waves=(store.waveform[windows] * np.float32(store.peak_mps2)).astype(np.float32),
        motion=motion.mean(axis=1).astype(np.float32),
        unsteadiness=np.log(speed + 0.002).std(axis=1).astype(np.float32),
        position_mm=store.position_mm[starts + samples // 2],
    )


_SLIDING_MPS = 0.008
_ENOUGH_WINDOWS = 60


@dataclass(frozen=True)
class LabelExponents:
    """level ~ speed^level_speed force^level_force; frequency ~ speed^frequency."""

    level_speed: float
    level_force: float
    frequency: float

    @classmethod
    def fitted(
        cls, speed_mps: np.ndarray, force_newtons: np.ndarray, log_level: np.ndarray, log_centroid: np.ndarray | None
    ) -> LabelExponents:
        """Fit the logarithms of level and centroid by least squares over the logarithms of speed and force, and clip the
        exponents to the limits of the model format. log_centroid: None for a periodic label, whose frequency exponent is
        1 because its frequency is the speed divided by the wavelength."""
        speed = np.log(speed_mps)
        design = np.stack([np.ones_like(speed), speed, np.log(force_newtons)], axis=1)
        level, *_ = np.linalg.lstsq(design, log_level, rcond=None)
        frequency = 1.0
        if log_centroid is not None:
            centroid, *_ = np.linalg.lstsq(design, log_centroid, rcond=None)
            frequency = float(np.clip(centroid[1], 0.0, 1.0))
        return cls(float(np.clip(level[1], 0.0, 2.0)), float(np.clip(level[2], -0.5, 1.5)), frequency)


def centroid_hz(waves: np.ndarray, rate_hz: float) -> np.ndarray:
    """Power-weighted mean frequency between 20 Hz and 900 Hz, per window."""
    spectrum = np.abs(np.fft.rfft(waves * np.hanning(waves.shape[1]), axis=1)) ** 2
    frequencies = np.fft.rfftfreq(waves.shape[1], 1.0 / rate_hz)
    band = (frequencies >= 20.0) & (frequencies <= 900.0)
    power = spectrum[:, band]
    return (power * frequencies[band]).sum(axis=1) / (power.sum(axis=1) + 1e-12)


def fit_exponents(
    store: SegmentStore, label_index: int, *, periodic: bool, seed: int, held_out: HeldOut
) -> LabelExponents:
    """Least squares of log RMS over log speed and log force in the fastest octave of the recordings, or in the upper half
    of their windows where that is faster or holds too few: the law is extrapolated from there, and coarse surfaces, whose
    vibration leaves the band, level off at high speeds. The frequency exponent of a periodic label is 1 (frequency = v / wavelength); for
    other labels it is the slope of the log spectral centroid."""
    windows = draw_windows(store, label_index, samples=400, count=3000, seed=seed, held_out=held_out)
    sliding = (windows.speed_mps > _SLIDING_MPS) & (windows.unsteadiness < 0.35) & (windows.motion[:, 2] > 0.05)
    if sliding.sum() >= 40:
        octave, half = (0.5 * np.max(windows.speed_mps[sliding]), np.median(windows.speed_mps[sliding]))
        fastest = windows.speed_mps >= max(octave, half)
        is_enough = (sliding & fastest).sum() >= _ENOUGH_WINDOWS
        sliding &= fastest if is_enough else windows.speed_mps >= half
    if sliding.sum() < 20:
        return LabelExponents(0.0, 0.0, 1.0 if periodic else 0.0)
    log_centroid = None if periodic else np.log(centroid_hz(windows.waves[sliding], SAMPLE_RATE_HZ))
    log_level = np.log(windows.rms_mps2[sliding] + 1e-9)
    return LabelExponents.fitted(windows.speed_mps[sliding], windows.motion[sliding, 2], log_level, log_centroid)
