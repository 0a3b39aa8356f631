"""The closed loop: hops, conditions, splices and previous waveforms as in the engine."""

from __future__ import annotations

import numpy as np
import pytest

from training_fixtures import still_surfaces

from haptoflow_training.closed_loop.render import run_closed_loop, spliced


class Probe:
    """Records its requests and returns segments that count upwards."""

    def __init__(self) -> None:
        self.motions: list[np.ndarray] = []
        self.pasts: list[np.ndarray] = []
        self.phases: list[np.ndarray] = []
        self.noises: list[np.ndarray] = []

    def generate(
        self,
        embeddings: np.ndarray,
        motions: np.ndarray,
        previous_mps2: np.ndarray,
        noise: np.ndarray,
        phases: np.ndarray,
    ) -> np.ndarray:
        self.phases.append(phases.copy())
        self.motions.append(motions.copy())
        self.pasts.append(previous_mps2.copy())
        self.noises.append(noise.copy())
        return np.tile(1000.0 * len(self.pasts) + np.arange(200), (len(embeddings), 1)).astype(np.float32)


@pytest.mark.parametrize("rate_hz", [30.0, 72.0, 120.0])
def test_each_past_is_the_two_hundred_samples_before_the_segment(rate_hz: float) -> None:
    probe = Probe()
    run = run_closed_loop(
        probe, np.zeros((2, 64), np.float32), np.zeros((2, 1500, 3), np.float32), np.arange(2), still_surfaces(2),
        update_rate_hz=rate_hz, seed=1,
    )  # fmt: skip
    padded = np.concatenate([np.zeros((2, 200), np.float32), run.waves], axis=1)
    for start, past in zip(run.hop_starts, probe.pasts, strict=True):
        np.testing.assert_array_equal(past, padded[:, start : start + 200])


def test_segments_that_overlap_have_the_same_noise_because_it_belongs_to_the_place() -> None:
    probe = Probe()
    run = run_closed_loop(
        probe, np.zeros((2, 64), np.float32), np.zeros((2, 1500, 3), np.float32), np.arange(2), still_surfaces(2),
        update_rate_hz=72.0, seed=1,
    )  # fmt: skip
    hops = np.diff(run.hop_starts)
    for hop, before, after in zip(hops, probe.noises, probe.noises[1:], strict=False):
        np.testing.assert_array_equal(before[:, hop:], after[:, : 200 - hop])
        assert not np.isclose(before[0], before[1]).any(), "each row has its own"


def test_the_condition_of_a_segment_is_the_motion_before_it_and_not_the_motion_after_it() -> None:
    probe = Probe()
    motions = np.zeros((1, 400, 3), dtype=np.float32)
    motions[0, 200:, 0] = 1.0
    run = run_closed_loop(
        probe, np.zeros((1, 64), np.float32), motions, np.zeros(1, np.int64), still_surfaces(1),
        update_rate_hz=40.0, seed=1,
    )  # fmt: skip
    told = np.array([motion[0, 0] for motion in probe.motions])
    np.testing.assert_array_equal(told, (run.hop_starts > 200).astype(np.float32))


def test_the_level_is_constant_across_a_splice_of_uncorrelated_segments() -> None:
    generator = np.random.default_rng(2)
    old, new = (generator.standard_normal((20000, 200)).astype(np.float32) for _ in range(2))
    power = np.square(spliced(old, new)).mean(axis=0)
    # The correlation is estimated from 32 samples and never negative, which biases it by a few per cent.
    np.testing.assert_allclose(power[:8], 1.0, atol=0.1)


@pytest.mark.parametrize("rate_hz", [30.0, 72.0, 120.0])
def test_the_phase_of_even_ribs_is_the_travelled_distance_along_each_wave_vector_modulo_one(rate_hz: float) -> None:
    probe = Probe()
    embeddings = np.zeros((2, 64), np.float32)
    embeddings[0, -4:], embeddings[1, -4:] = (0.4, 0.0, 0.0, 0.8), (-1.1, 0.3, 0.0, 0.0)
    # There and back at the same speed: the phase must return to its start.
    motions = np.zeros((2, 4000, 3), np.float32)
    motions[:, :2000, 0], motions[:, :2000, 1] = 0.7, -0.2
    motions[:, 2000:, :2] = -motions[:, :2000, :2]
    run = run_closed_loop(
        probe, embeddings, motions, np.arange(2), still_surfaces(2), update_rate_hz=rate_hz, seed=1
    )
    for row, vectors in enumerate(embeddings[:, -4:].astype(float).reshape(2, 2, 2)):
        for hop in range(len(run.hop_starts)):
            travelled_mm = np.zeros(2)
            for before in range(hop):
                samples = run.hop_starts[before + 1] - run.hop_starts[before]
                travelled_mm += probe.motions[before][row, :2] * samples / 2.0
            phases = probe.phases[hop][row]
            turns = phases[:2] - vectors @ travelled_mm
            np.testing.assert_allclose(turns, np.round(turns), atol=1e-4)
            rates_hz = vectors @ (1000.0 * probe.motions[hop][row, :2])
            np.testing.assert_allclose(phases[[2, 3, 4, 5]], [0.0, *rates_hz, 0.0], atol=1e-3)
        turns = np.array(probe.phases)[:, row, :3]
        assert np.all((turns >= 0.0) & (turns < 1.0))
