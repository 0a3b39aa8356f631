"""The closed loop: hops, conditions, splices and previous waveforms as in the engine."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from haptoflow_training.training.closed_loop import ClosedLoopRun, PhaseTrack, SurfaceStatistics, run_closed_loop, spliced
from haptoflow_training.recordings.synthetic import Material, load_materials
from haptoflow_training.recordings.synthetic.features import rib_wander_turns, slips_of
from haptoflow_training.recordings.synthetic.surface import TipPath
from haptoflow_training.training.config import DataConfig
from haptoflow_training.training.recordings_source import synthetic_label_infos
from training_fixtures import still_surfaces

class Probe:
    """Records its requests and returns segments that count upwards."""

    pasts, noise_before = 1, 0

    def __init__(self) -> None:
        self.motions: list[np.ndarray] = []
        self.continued: list[np.ndarray] = []
        self.phases: list[np.ndarray] = []
        self.noises: list[np.ndarray] = []

    def generate(self, embeddings: np.ndarray, motions: np.ndarray, *others: np.ndarray) -> np.ndarray:
        previous_mps2, noise, phases = others
        self.phases.append(phases.copy())
        self.motions.append(motions.copy())
        self.continued.append(previous_mps2[:, 0].copy())
        self.noises.append(noise.copy())
        return np.tile(1000.0 * len(self.continued) + np.arange(200), (len(embeddings), 1)).astype(np.float32)


def _probed(motions: NDArray[np.floating], update_rate_hz: float) -> tuple[Probe, ClosedLoopRun]:
    """A run over still surfaces, one row for each of the motions."""
    probe, rows = Probe(), len(motions)
    embeddings, still = np.zeros((rows, 64), np.float32), still_surfaces(rows)
    moved = motions.astype(np.float32)
    return probe, run_closed_loop(
        probe, embeddings, moved, np.arange(rows), still, update_rate_hz=update_rate_hz, seed=1
    )


@pytest.mark.parametrize("rate_hz", [30.0, 72.0, 120.0])
def test_each_past_is_the_two_hundred_samples_before_the_segment(rate_hz: float) -> None:
    probe, run = _probed(np.zeros((2, 1500, 3)), rate_hz)
    padded = np.concatenate([np.zeros((2, 200), np.float32), run.waves], axis=1)
    for start, past in zip(run.hop_starts, probe.continued, strict=True):
        np.testing.assert_array_equal(past, padded[:, start : start + 200])


def test_segments_that_overlap_have_the_same_noise_because_it_belongs_to_the_place() -> None:
    probe, run = _probed(np.zeros((2, 1500, 3)), 72.0)
    hops = np.diff(run.hop_starts)
    for hop, before, after in zip(hops, probe.noises, probe.noises[1:], strict=False):
        np.testing.assert_array_equal(before[:, hop:], after[:, : 200 - hop])
        assert not np.isclose(before[0], before[1]).any(), "each row has its own"


def test_the_condition_of_a_segment_is_the_motion_before_it_and_not_the_motion_after_it() -> None:
    motions = np.zeros((1, 400, 3))
    motions[0, 200:, 0] = 1.0
    probe, run = _probed(motions, 40.0)
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
    run = run_closed_loop(probe, embeddings, motions, np.arange(2), still_surfaces(2), update_rate_hz=rate_hz, seed=1)
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


INFOS = synthetic_label_infos(DataConfig())
STATISTICS = SurfaceStatistics.of_labels(INFOS)
NAMES = [info.name for info in INFOS]
JUTE, RUBBER, WOOD = (NAMES.index(name) for name in ("jute", "rubber", "wood"))
HOP = 28


def _material(name: str) -> Material:
    return next(material for material in load_materials() if material.label == name)


def _embeddings(label: int, rows: int) -> NDArray[np.float32]:
    embeddings = np.zeros((rows, 64), dtype=np.float32)
    vectors = np.ravel(INFOS[label].known_wave_vectors)
    embeddings[:, 60 : 60 + len(vectors)] = vectors
    return embeddings


def _tracked(
    label: int, rows: int, hops: int, motion: tuple[float, float, float], seed: int = 5
) -> NDArray[np.float32]:
    """Phases [hops, rows, 6] of a straight stroke of one label."""
    track, embeddings = PhaseTrack(STATISTICS, rows, seed), _embeddings(label, rows)
    labels, motions = np.full(rows, label), np.tile(np.array(motion, dtype=np.float32), (rows, 1))
    phases = []
    for _ in range(hops):
        phases.append(track.at(embeddings, labels, motions))
        track.advance(motions, HOP)
    return np.array(phases)


def test_the_same_seed_gives_the_same_phases_and_another_seed_other_ones() -> None:
    first, again, other = (_tracked(JUTE, 3, 5, (0.1, 0.05, 1.0), seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).max() > 0.01
    assert np.abs(first[:, 0] - first[:, 1]).max() > 0.01, "every row has a surface of its own"


def test_each_rate_is_how_fast_its_phase_advances() -> None:
    for label in (JUTE, RUBBER):
        phases = _tracked(label, 40, 60, (0.05, 0.02, 1.0)).astype(np.float64)
        moved = np.diff(phases[:, :, :3], axis=0)
        told = 0.5 * (phases[1:, :, 3:] + phases[:-1, :, 3:])
        # Stick-slip has no place: it advances at the rate that was told.
        told[:, :, 2] = phases[:-1, :, 5]
        missed = moved - told * HOP / 2000.0
        assert np.abs(missed - np.rint(missed)).max() < 0.02, NAMES[label]


def _jitter(label: int, family: int, rows: int, hops: int, speed_mps: float) -> NDArray[np.float64]:
    """By how many turns [hops, rows] the ribs of a track lie ahead of evenly spaced ones."""
    phases = _tracked(label, rows, hops, (speed_mps, 0.0, 1.0))[:, :, family].astype(np.float64)
    vector = np.array(INFOS[label].known_wave_vectors[family])
    evenly = 1000.0 * speed_mps * HOP / 2000.0 * np.arange(hops)[:, None] * vector[0]
    ahead = phases - evenly
    return ahead - np.rint(ahead)


def _straight(speed_mps: float, step_mm: float, count: int) -> TipPath:
    """A recorder's path, a sample every step_mm."""
    place = np.outer(step_mm * np.arange(count), (1.0, 0.0))
    return TipPath(place, np.tile([1000.0 * speed_mps, 0.0], (count, 1)))


def test_threads_wander_as_far_and_as_fast_as_the_recorder_s() -> None:
    material, ruling = _material("jute"), _material("jute").rulings[0]
    step_mm = 0.7
    made = _jitter(JUTE, 0, 400, 12, step_mm / 1000.0 * 2000.0 / HOP)
    path = _straight(0.4, step_mm, 12 * 40)
    turns = [rib_wander_turns(material, ruling, 0, path, specimen=specimen) for specimen in range(8)]
    recorded = np.reshape(turns, (-1, 12)).T
    assert made.std() == pytest.approx(ruling.jitter, rel=0.1)
    assert recorded.std() == pytest.approx(ruling.jitter, rel=0.1)
    # As correlated over the millimetres between: the wander is as smooth.
    kept = [np.mean(each[0] * each[5]) / each.var() for each in (made, recorded)]
    assert kept[0] == pytest.approx(kept[1], abs=0.15)


@pytest.mark.parametrize(("speed_mps", "newtons"), [(0.04, 0.5), (0.1, 2.0), (0.02, 0.01)])
def test_a_tip_slips_as_often_as_the_recorder_s_on_average_and_from_place_to_place(
    speed_mps: float, newtons: float
) -> None:
    material = _material("rubber")
    rates = _tracked(RUBBER, 2000, 1, (speed_mps, 0.0, newtons))[0, :, 5]
    stretch_mm = material.stick_slip_length_mm * max(newtons, 0.05) ** 0.4
    assert np.exp(np.log(rates).mean()) == pytest.approx(1000.0 * speed_mps / stretch_mm, rel=0.03)
    path = _straight(speed_mps, step_mm=2.0, count=50)
    logs = []
    for specimen in range(20):
        slips = slips_of(material, path, np.full(50, newtons), 1.0, specimen=specimen)
        assert slips is not None
        logs.append(np.log(slips.rate_hz))
    assert np.log(rates).mean() == pytest.approx(np.mean(logs), abs=0.06)
    assert np.log(rates).std() == pytest.approx(np.std(logs), rel=0.15)


def test_stick_and_slip_goes_on_where_a_stroke_turns_back_and_stops_at_rest() -> None:
    track, embeddings, labels = PhaseTrack(STATISTICS, 1, 3), _embeddings(RUBBER, 1), np.array([RUBBER])
    there, back, rest = (np.array([[speed, 0.0, 1.0]], dtype=np.float32) for speed in (0.05, -0.05, 0.0))
    assert track.at(embeddings, labels, back)[0, 5] == track.at(embeddings, labels, there)[0, 5] > 0.0
    assert track.at(embeddings, labels, rest)[0, 5] == 0.0
