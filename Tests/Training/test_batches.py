"""Training pairs: aligned, inside their split, conditioned on the motion at the segment's beginning."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import torch
from training_fixtures import RATE_HZ, FakeStore, make_store

from haptoflow_training.errors import InputError
from haptoflow_training.training.batches import SegmentBatches
from haptoflow_training.training.config import BatchConfig

PLAIN = BatchConfig(silence_probability=0.0, switch_probability=0.0)


def _positions(store_wave: np.ndarray, segment: torch.Tensor) -> int:
    """The position of each segment in the store."""
    wave = (segment.numpy() / 10.0).astype(np.float32)
    matches = np.flatnonzero(np.isclose(store_wave[: -len(wave)], wave[0], rtol=1e-5))
    for start in matches:
        if np.allclose(store_wave[start : start + len(wave)], wave, rtol=1e-4, atol=1e-7):
            return int(start)
    raise AssertionError("the segment does not occur in the store")


def test_the_previous_waveform_is_what_was_recorded_just_before_the_segment() -> None:
    store = make_store()
    batch = SegmentBatches(store, "train", PLAIN, 1).draw(8)
    for row in range(8):
        start = _positions(store.waveform, batch.segment[row, 0])
        expected = store.waveform[start - 200 : start] * 10.0
        np.testing.assert_allclose(batch.previous[row, 0].numpy(), expected, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("split", ["train", "validation", "test"])
def test_no_training_pair_crosses_a_split(split: str) -> None:
    store = make_store()
    batch = SegmentBatches(store, split, PLAIN, 2).draw(32)
    for row in range(32):
        start = _positions(store.waveform, batch.segment[row, 0])
        owner = [r for r in store.recordings if r.start <= start - 200 and start + 200 <= r.start + r.length]
        assert [r.split for r in owner] == [split]
        assert owner[0].label_index == batch.label[row].item()


def test_the_condition_is_the_mean_motion_of_the_leading_samples() -> None:
    store = make_store()
    batch = SegmentBatches(store, "train", BatchConfig((40, 40), 0.0, 0.0), 3).draw(8)
    for row in range(8):
        start = _positions(store.waveform, batch.segment[row, 0])
        np.testing.assert_allclose(batch.motion[row].numpy(), store.motion[start : start + 40].mean(axis=0), rtol=1e-3)


def test_emphasised_labels_are_drawn_emphasis_times_as_often() -> None:
    store = make_store()
    config = BatchConfig(emphasised_labels=(store.labels[1],), emphasis=4.0)
    drawn = SegmentBatches(store, "train", config, 8).draw(3000).label
    counts = torch.bincount(drawn, minlength=len(store.labels)).float()
    assert (counts[1] / counts[0]).item() == pytest.approx(4.0, rel=0.2)


def test_an_emphasised_label_without_recordings_is_named() -> None:
    with pytest.raises(InputError, match="emphasised_labels.*'velvet'"):
        SegmentBatches(make_store(), "train", BatchConfig(emphasised_labels=("velvet",)), 8)


def test_the_machine_share_holds_where_both_protocols_exist() -> None:
    store = make_store()
    batches = SegmentBatches(store, "train", BatchConfig(machine_share=0.8), 5)
    chosen = batches._draw_recordings(2000)
    trained = [recording for recording in store.recordings if recording.split == "train"]
    machine = [index for index, recording in enumerate(trained) if recording.protocol == "machine"]
    assert np.isin(chosen, machine).mean() == pytest.approx(0.8, abs=0.05)


def test_a_pair_states_the_specimen_of_its_recording_and_minus_one_where_none_is_known() -> None:
    store = make_store()
    told = [dataclasses.replace(each, specimen=None if each.label_index else number % 2)
            for number, each in enumerate(store.recordings)]  # fmt: skip
    batch = SegmentBatches(dataclasses.replace(store, recordings=told), "train", PLAIN, 9).draw(32)
    for row in range(32):
        start = _positions(store.waveform, batch.segment[row, 0])
        owner = next(each for each in told if each.start <= start < each.start + each.length)
        assert batch.specimen[row].item() == (-1 if owner.specimen is None else owner.specimen)
    assert {-1, 0, 1} == set(batch.specimen.tolist())


def _wandering_store() -> tuple[FakeStore, np.ndarray]:
    """A store whose ribs wander by a tenth of a turn and whose tip slips up to 900 times a second; and the unwrapped
    turns [n, 3] of both."""
    store = make_store()
    time = np.arange(len(store.waveform)) / RATE_HZ
    slips_hz = 500.0 + 400.0 * np.sin(2.0 * np.pi * 1.3 * time)
    turns = np.stack([0.1 * np.sin(2.0 * np.pi * 5.0 * time), 0.0 * time, np.cumsum(slips_hz) / RATE_HZ], axis=1)
    stored = turns.astype(np.float32)
    stored[:, 2] = np.mod(turns[:, 2], 1.0)
    return dataclasses.replace(store, wander_turns=stored), turns


@pytest.mark.parametrize("hop", [1, 28, 200])
def test_wander_is_that_of_the_segment_s_first_sample_and_its_mean_rate_over_the_hop(hop: int) -> None:
    store, turns = _wandering_store()
    config = dataclasses.replace(PLAIN, hop_samples=(hop, hop))
    batch = SegmentBatches(store, "train", config, 10).draw(16)  # type: ignore[arg-type]
    fastest_hz = 0.0
    for row in range(16):
        start = _positions(store.waveform, batch.segment[row, 0])
        np.testing.assert_array_equal(batch.wander[row, :3].numpy(), store.wander_turns[start])
        rates_hz = (turns[start + hop] - turns[start]) * RATE_HZ / hop
        # A single sample's step in single precision is known to 0.1 Hz.
        np.testing.assert_allclose(batch.wander[row, 3:].numpy(), rates_hz, atol=0.3 if hop == 1 else 0.05)
        fastest_hz = max(fastest_hz, rates_hz[2])
    assert fastest_hz > 500.0, "dozens of slips in a hop of 100 ms"


def test_every_hop_of_a_chain_has_the_wander_of_its_own_place() -> None:
    store, turns = _wandering_store()
    config = dataclasses.replace(PLAIN, chain_hops=(3, 3), chain_silence_probability=0.0)
    batch = SegmentBatches(store, "train", config, 11).draw_chains(6)  # type: ignore[arg-type]
    assert batch.chain is not None and batch.chain.wander.shape == (6, 3, 6)
    hop = batch.chain.hop_samples
    for row in range(6):
        start = _positions(store.waveform, batch.segment[row, 0])
        begins = start - hop * np.arange(3, 0, -1)
        np.testing.assert_array_equal(batch.chain.wander[row, :, :3].numpy(), store.wander_turns[begins])
        rates_hz = (turns[begins + hop] - turns[begins]) * RATE_HZ / hop
        np.testing.assert_allclose(batch.chain.wander[row, :, 3:].numpy(), rates_hz, atol=0.05)
