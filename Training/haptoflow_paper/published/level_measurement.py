"""How loud an imported model is: its labels rendered by the engine's generator, each segment the next one's past."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.export.exponents import LabelExponents, centroid_hz
from haptoflow_paper.runs.tier import SEED_SAMPLES
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

# Along one diagonal of the surface, forwards and backwards.
_DIRECTIONS = np.array([[1.0, 1.0], [-1.0, -1.0]]) / np.sqrt(2.0)
# The first segments remember the silence that they begin with.
_UNHEARD_SEGMENTS = 2
_HEARD_SEGMENTS = 4
_CHAINS_AT_A_TIME = 16
_LEAST_LEVEL = 1e-6
# Below this the reference level was not measured, and the engine sends nothing to an actuator.
_LOWEST_HZ = 24.0
# At which the measured level of the data set is known (facts of other people's measurements of it).
REFERENCE_SPEED_MPS = 0.04
REFERENCE_FORCE_NEWTONS = 0.75

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class RenderedLevels:
    """Of every label [L] at every motion [M, 3], the first of which is the reference's, the others the corners of the
    range. rms [L, M]: above 24 Hz, in the unit of the model's level. centroids [L, M] in Hz. ends [L, M, 400]: the last samples."""

    motions: _Floats
    rms: NDArray[np.float64]
    centroids: NDArray[np.float64]
    ends: _Floats

    @property
    def reference(self) -> float:
        """Median over labels at 40 mm/s and .75 N."""
        at_reference = np.square(self.rms[:, : len(_DIRECTIONS)]).mean(axis=1)
        return float(np.sqrt(np.median(at_reference)))

    def exponents(self, label: int) -> LabelExponents:
        """Least squares of log RMS and log centroid over log speed and log force at the corners of the range."""
        corners = slice(len(_DIRECTIONS), None)
        speed = np.hypot(self.motions[corners, 0], self.motions[corners, 1])
        log_level, log_centroid = (np.log(each[label, corners] + _LEAST_LEVEL) for each in (self.rms, self.centroids))
        return LabelExponents.fitted(speed, self.motions[corners, 2], log_level, log_centroid)


def segments_to_render(labels: int) -> int:
    """How many segments `render_levels` generates for so many labels."""
    return labels * 5 * len(_DIRECTIONS) * segments_a_wave()


def render_levels(
    generator: EngineGenerator,
    embeddings: _Floats,
    speed_mps: tuple[float, float],
    force_newtons: tuple[float, float],
    level_mps2: float,
    advance: Callable[[int], None] = lambda count: None,
) -> RenderedLevels:
    """Render embeddings [L, 64] at the reference and at the corners of the range; level_mps2: the model's constant one,
    in which everything is returned. advance: told of every few finished segments."""
    motions = _motions(speed_mps, force_newtons)
    waves = render_waves(generator, embeddings, motions, advance) / np.float32(level_mps2)
    flat = waves.reshape(-1, waves.shape[2])
    return RenderedLevels(
        motions,
        band_rms(flat).reshape(waves.shape[:2]),
        centroid_hz(flat, SAMPLE_RATE_HZ).reshape(waves.shape[:2]),
        waves[:, :, -SEED_SAMPLES:],
    )


def render_waves(
    generator: EngineGenerator,
    embeddings: _Floats,
    motions: _Floats,
    advance: Callable[[int], None] = lambda count: None,
) -> _Floats:
    """What embeddings [L, 64] at motions [M, 3] sound like once their first silence is forgotten, [L, M, 800] in
    m/s^2."""
    waves = np.zeros((len(embeddings), len(motions), SEGMENT_SAMPLES * _HEARD_SEGMENTS), dtype=np.float32)
    chains = [(label, motion) for label in range(len(embeddings)) for motion in range(len(motions))]
    for first in range(0, len(chains), _CHAINS_AT_A_TIME):
        labels, places = np.array(chains[first : first + _CHAINS_AT_A_TIME]).T
        noise = np.random.default_rng(first)
        previous = np.zeros((len(labels), SEGMENT_SAMPLES), dtype=np.float32)
        for segment in range(-_UNHEARD_SEGMENTS, _HEARD_SEGMENTS):
            given = noise.standard_normal((len(labels), SEGMENT_SAMPLES), dtype=np.float32)
            previous = generator.generate(embeddings[labels], motions[places], previous, given)
            if segment >= 0:
                place = slice(segment * SEGMENT_SAMPLES, (segment + 1) * SEGMENT_SAMPLES)
                waves[labels, places, place] = previous
            advance(len(labels))
    return waves


def segments_a_wave() -> int:
    """How many segments `render_waves` generates for one wave."""
    return _UNHEARD_SEGMENTS + _HEARD_SEGMENTS


def reference_motions() -> _Floats:
    """The motions [2, 3] at which the data set's level is known: both ways along one diagonal."""
    return _motions_of([(REFERENCE_SPEED_MPS, REFERENCE_FORCE_NEWTONS)])


def band_rms(waves: _Floats) -> NDArray[np.float64]:
    """RMS above 24 Hz of waves [n, samples] at 2 kHz, [n]."""
    samples = waves.shape[1]
    spectrum = np.fft.rfft(waves.astype(np.float64), axis=1)
    spectrum[:, np.fft.rfftfreq(samples, 1.0 / SAMPLE_RATE_HZ) < _LOWEST_HZ] = 0.0
    return np.sqrt(np.square(np.fft.irfft(spectrum, samples, axis=1)).mean(axis=1))


def _motions(speed_mps: tuple[float, float], force_newtons: tuple[float, float]) -> _Floats:
    conditions = [(REFERENCE_SPEED_MPS, REFERENCE_FORCE_NEWTONS)]
    return _motions_of(conditions + [(speed, force) for speed in speed_mps for force in force_newtons])


def _motions_of(conditions: list[tuple[float, float]]) -> _Floats:
    return np.array(
        [[*(speed * direction), force] for speed, force in conditions for direction in _DIRECTIONS], dtype=np.float32
    )
