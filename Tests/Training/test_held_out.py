"""Held-out motion is never used for training: checked sample by sample on a store that is full of it."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import torch
from numpy.typing import NDArray
from training_fixtures import FakeRecording, FakeStore, level_offsets_db, travelled_mm

from haptoflow_paper.codec.small_codec import read_small_codec_config
from haptoflow_paper.codec.trainer import SegmentSampler
from haptoflow_paper.rows.reference_conditions import conditions
from haptoflow_paper.runs.tier import build_seed_bank
from haptoflow_training.export.exponents import draw_windows, fit_exponents
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.recordings.synthetic import load_materials, machine_conditions, record_condition_of
from haptoflow_training.training.batches import HeldOut, SegmentBatches, clear_spans
from haptoflow_training.training.config import BatchConfig, load_config
from places import ROOT

BATCH = BatchConfig(
    silence_probability=0.0, switch_probability=0.0, chain_silence_probability=0.0,
    held_out_speed_mps=(0.25, 0.3), held_out_force_newtons=(1.2, 1.5), held_out_direction_degrees=(215.0, 235.0),
)  # fmt: skip
HELD_OUT = HeldOut.of(BATCH)


def _wandering(
    generator: np.random.Generator, time: NDArray[np.float64], every_seconds: float, low: float, high: float
) -> NDArray[np.float64]:
    knots = np.arange(0.0, time[-1] + 2.0 * every_seconds, every_seconds)
    return np.interp(time, knots, generator.uniform(low, high, len(knots)))


def _store(seconds: float = 60.0) -> FakeStore:
    """Two labels, hand and machine, whose strokes cross all bands. Each sample's value is its index, so that drawn
    samples reveal their place."""
    generator = np.random.default_rng(4)
    count = int(2000 * seconds)
    motions, recordings = [], []
    for number in range(8):
        time = np.arange(count) / 2000.0
        speed = np.exp(_wandering(generator, time, 0.8, np.log(0.02), np.log(0.9)))
        heading = _wandering(generator, time, 1.5, 0.0, 2.0 * np.pi)
        force = _wandering(generator, time, 1.1, 0.3, 2.5)
        motions.append(np.stack([speed * np.cos(heading), speed * np.sin(heading), force], axis=1))
        split = "train" if number < 6 else "validation"
        protocol = "machine" if number % 4 < 2 else "hand"
        recordings.append(FakeRecording(number % 2, protocol, split, number * count, count))
    wave = np.arange(8 * count, dtype=np.float32)
    whole = np.concatenate(motions).astype(np.float32)
    return FakeStore(wave, whole, travelled_mm(whole), 1.0, ["a", "b"], recordings)


STORE = _store()


def _count_held(places: NDArray[np.floating]) -> int:
    return int(HELD_OUT.holds(STORE.motion[places.reshape(-1).astype(np.int64)]).sum())


@pytest.mark.parametrize("split", ["train", "validation"])
def test_no_sample_of_a_training_pair_lies_in_a_held_out_band(split: str) -> None:
    batches = SegmentBatches(STORE, split, BATCH, 1)
    for _ in range(20):
        batch = batches.draw(96)
        assert _count_held(batch.previous.numpy()) == 0 and _count_held(batch.segment.numpy()) == 0


def test_no_sample_of_a_chain_lies_in_a_held_out_band() -> None:
    batches = SegmentBatches(STORE, "train", BATCH, 2)
    for _ in range(40):
        batch = batches.draw_chains(48)
        assert batch.chain is not None
        start = batch.chain.start.numpy()[:, 0, 0].astype(np.int64)
        end = batch.segment.numpy()[:, 0, -1].astype(np.int64)
        held = np.concatenate([[0], np.cumsum(HELD_OUT.holds(STORE.motion))])
        assert np.all(held[end + 1] - held[start] == 0)


def test_no_sample_of_a_codec_s_segment_lies_in_a_held_out_band() -> None:
    marked = np.where(HELD_OUT.holds(STORE.motion), 1000.0, 1.0).astype(np.float32)
    store = dataclasses.replace(STORE, waveform=marked)
    kept, free = (
        SegmentSampler(store, "train", bands).draw(np.random.default_rng(3), 2000) for bands in (HELD_OUT, HeldOut())
    )
    assert torch.all(kept.amax(dim=2) < 1.01 * kept.amin(dim=2)) and torch.any(free.amax(dim=2) > 2.0 * free.amin(dim=2))


def test_the_codec_holds_out_the_same_bands_as_networks() -> None:
    config = read_small_codec_config(ROOT / "Training" / "haptoflow_paper" / "configs" / "codec-small.toml")
    network = load_config(ROOT / "Training" / "configs" / "default" / "standard.toml")
    assert config.held_out_as is not None
    bands = HeldOut.of(load_config(config.held_out_as).batch)
    assert bands == HeldOut.of(network.batch) != HeldOut()


def test_seeds_and_exponents_use_only_windows_outside_the_bands(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[NDArray[np.float32]] = []

    def spy(*arguments: Any, **named: Any) -> Any:
        windows = draw_windows(*arguments, **named)
        read.append(windows.waves)
        return windows

    monkeypatch.setattr("haptoflow_paper.runs.tier.draw_windows", spy)
    monkeypatch.setattr("haptoflow_training.export.exponents.draw_windows", spy)
    build_seed_bank(STORE, np.zeros((len(STORE.labels), 4), np.float32), seed=1, held_out=HELD_OUT, candidates=400)
    fit_exponents(STORE, 0, periodic=False, seed=1, held_out=HELD_OUT)
    assert len(read) == 3 and sum(len(waves) for waves in read) == 3800
    assert [_count_held(waves) for waves in read] == [0, 0, 0]


def test_the_level_is_calibrated_only_on_windows_outside_the_bands() -> None:
    # Inside the bands the recording is a thousand times louder, so a single such window would be detected.
    motion = STORE.motion
    held = HELD_OUT.holds(motion)
    level = np.where(held, 1000.0, 1.0).astype(np.float32)
    noise = np.random.default_rng(1).standard_normal(len(motion)).astype(np.float32)
    store = dataclasses.replace(STORE, waveform=level * noise)

    class Right:
        pasts, noise_before = 1, 0

        def generate(self, embeddings: Any, motions: Any, previous_mps2: Any, noise: Any, phases: Any) -> Any:
            return noise

    embeddings = np.zeros((2, 64), dtype=np.float32)
    assert level_offsets_db(Right(), embeddings, store, HELD_OUT) == pytest.approx([0.0, 0.0], abs=0.2)
    assert max(level_offsets_db(Right(), embeddings, store, HeldOut())) < -20.0


def test_a_direction_band_may_include_zero_and_a_resting_tip_has_no_direction() -> None:
    held_out = HeldOut(direction_degrees=(-10.0, 10.0))
    angles = np.radians([355.0, 0.0, 9.0, 11.0, 180.0])
    motion = np.stack([np.cos(angles), np.sin(angles), np.ones(5)], axis=1)
    assert held_out.holds(motion).tolist() == [True, True, True, False, False]
    assert not held_out.holds(np.array([[1e-4, 0.0, 1.0]])).any()


def test_clear_spans_are_the_rest_of_each_recording_and_never_span_two() -> None:
    speed = np.array([0.1, 0.27, 0.1, 0.1, 0.1, 0.27, 0.27, 0.1], dtype=np.float32)
    motion = np.stack([speed, np.zeros(8), np.ones(8)], axis=1).astype(np.float32)
    spans = clear_spans(motion, np.array([0, 4]), np.array([4, 4]), HeldOut(speed_mps=(0.25, 0.3)))
    assert spans.starts.tolist() == [0, 2, 4, 7] and spans.lengths.tolist() == [1, 2, 1, 1]
    assert spans.owners.tolist() == [0, 0, 1, 1]


def _default_passes() -> Sequence[tuple[int, NDArray[np.float32]]]:
    data = load_config(ROOT / "Training" / "configs" / "default" / "base.toml").data
    material = load_materials()[0]
    found = []
    for identity in machine_conditions(
        material, directions=data.machine_directions, speeds_mmps=(60,), forces_millinewtons=(1000,), repeats=1
    ):
        recording = record_condition_of(material, identity, seed=data.recordings_seed)
        found.append((identity.direction_degrees, preprocess_recording(recording).motion))
    return found


def test_no_default_machine_pass_has_the_held_out_direction_and_the_evaluation_uses_the_same_bands() -> None:
    config = load_config(ROOT / "Training" / "configs" / "default" / "base.toml").batch
    direction = HeldOut(direction_degrees=config.held_out_direction_degrees)
    for named, motion in _default_passes():
        sliding = motion[np.hypot(motion[:, 0], motion[:, 1]) > 0.03]
        assert len(sliding) > 1000 and direction.holds(sliding).mean() < 0.01, named
    grid = conditions(load_materials())
    asked = np.array([[np.cos(np.radians(225.0)), np.sin(np.radians(225.0)), 1.0]])
    assert direction.holds(asked).all() and any(entry.direction_degrees == 225.0 for entry in grid)
    for band, values in (
        (config.held_out_speed_mps, [entry.speed_mps for entry in grid]),
        (config.held_out_force_newtons, [entry.force_newtons for entry in grid]),
    ):
        assert any(band[0] <= value < band[1] for value in values)
