"""Training pairs: aligned, inside their split, conditioned on the motion at the segment's beginning."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from training_fixtures import make_store

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
        np.testing.assert_allclose(
            batch.motion[row].numpy(), store.motion[start : start + 40].mean(axis=0), rtol=1e-3
        )


def test_emphasised_labels_are_drawn_emphasis_times_as_often() -> None:
    store = make_store()
    config = BatchConfig(emphasised_labels=(store.labels[1],), emphasis=4.0)
    drawn = SegmentBatches(store, "train", config, 8).draw(3000).label
    counts = torch.bincount(drawn, minlength=len(store.labels)).float()
    assert (counts[1] / counts[0]).item() == pytest.approx(4.0, rel=0.2)


def test_an_emphasised_label_without_recordings_is_named() -> None:
    with pytest.raises(InputError, match="emphasised_labels.*'velvet'"):
        SegmentBatches(make_store(), "train", BatchConfig(emphasised_labels=("velvet",)), 8)


def test_silence_and_label_switches_appear_as_often_as_asked() -> None:
    store = make_store()
    silent = SegmentBatches(store, "train", BatchConfig(silence_probability=0.3, switch_probability=0.0), 4).draw(2000)
    share = (silent.previous.abs().amax(dim=(1, 2)) == 0).float().mean().item()
    assert share == pytest.approx(0.3, abs=0.05)


def test_the_machine_share_holds_where_both_protocols_exist() -> None:
    store = make_store()
    batches = SegmentBatches(store, "train", BatchConfig(machine_share=0.8), 5)
    chosen = batches._draw_recordings(2000)
    trained = [recording for recording in store.recordings if recording.split == "train"]
    machine = [index for index, recording in enumerate(trained) if recording.protocol == "machine"]
    assert np.isin(chosen, machine).mean() == pytest.approx(0.8, abs=0.05)


def test_a_restored_generator_draws_the_same_pairs() -> None:
    store = make_store()
    first = SegmentBatches(store, "train", BatchConfig(), 6)
    first.draw(4)
    state = first.state()
    expected = first.draw(4)
    second = SegmentBatches(store, "train", BatchConfig(), 99)
    second.restore(state)
    torch.testing.assert_close(second.draw(4).segment, expected.segment)


def test_a_split_without_long_recordings_is_named() -> None:
    with pytest.raises(ValueError, match="'validation'"):
        SegmentBatches(make_store(seconds=0.15), "validation", PLAIN, 1)
