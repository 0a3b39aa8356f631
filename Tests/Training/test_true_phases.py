"""The phases that a recording states of wandering ribs and of stick and slip are those of its vibration."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dataset_samples import small_recording
from numpy.typing import NDArray

from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_parts, preprocess_recording
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import Material, load_materials, record_condition
from haptoflow_training.recordings.landing import RibWander, StickSlip
from haptoflow_training.training.config import DataConfig
from haptoflow_training.training.recordings_source import synthetic_label_infos

SETTINGS = PreprocessingSettings()
MATERIALS = {material.label: material for material in load_materials()}


def _prepared(material: Material, velocity: tuple[float, float], seed: int, seconds: float = 6.0) -> PreparedRecording:
    recording = record_condition(
        material, velocity_mps=velocity, force_newtons=1.0, duration_seconds=seconds, seed=seed,
        accelerometer_noise=False,
    )  # fmt: skip
    return preprocess_recording(recording, SETTINGS)


def _line(prepared: PreparedRecording, turns: NDArray[np.float64]) -> float:
    """The share of the vibration's amplitude that keeps its phase relative to `turns`, 0 to 0.7."""
    wave = prepared.waveform_mps2.astype(np.float64)
    return float(abs(np.mean(wave * np.exp(-2j * np.pi * turns))) / np.std(wave))


@pytest.mark.parametrize(("family", "velocity"), [(0, (0.15, 0.0)), (1, (0.0, 0.15)), (0, (-0.9, 0.0))])
def test_the_phase_of_jute_s_threads_is_that_of_the_place_and_their_wander(
    family: int, velocity: tuple[float, float]
) -> None:
    jute = MATERIALS["jute"]
    for seed in range(2):
        prepared = _prepared(jute, velocity, seed)
        along = prepared.position_mm.astype(np.float64) @ np.array(jute.wave_vectors_per_mm[family])
        wander = prepared.wander_turns[:, family]
        assert np.std(wander) == pytest.approx(jute.rulings[family].jitter, rel=0.25)
        straight, with_wander, against = (_line(prepared, along + factor * wander) for factor in (0.0, 1.0, -1.0))
        assert with_wander > 1.2 * straight and with_wander > 2.0 * against
        # As strong as the line of threads that do not wander.
        even = replace(jute, rulings=tuple(replace(ruling, jitter=0.0) for ruling in jute.rulings))
        assert with_wander == pytest.approx(_line(_prepared(even, velocity, seed), along), rel=0.1)


@pytest.mark.parametrize("speed", [0.04, 0.08])
def test_rubber_s_slips_come_at_the_stated_phase_and_not_at_any_other_rate(speed: float) -> None:
    prepared = _prepared(MATERIALS["rubber"], (speed, 0.0), seed=3)
    turns = prepared.wander_turns[:, 2]
    assert np.all(np.diff(turns) > 0.0)
    at_phase = _line(prepared, turns)
    assert at_phase > 0.1
    for factor in (0.5, 0.9, 1.1):
        assert at_phase > 3.0 * _line(prepared, factor * turns)
    assert at_phase > 3.0 * _line(prepared, np.linspace(turns[0], turns[-1], len(turns)))
    length_mm = 1e3 * speed * len(turns) / SETTINGS.sample_rate_hz / (turns[-1] - turns[0])
    assert length_mm == pytest.approx(MATERIALS["rubber"].stick_slip_length_mm, rel=0.1)


def test_the_parts_between_gaps_keep_the_phases_of_their_times() -> None:
    recording = record_condition(
        MATERIALS["rubber"], velocity_mps=(0.05, 0.0), force_newtons=1.0, duration_seconds=4.0, seed=1
    )
    time = recording.acceleration_time_seconds
    kept = (time < 1.9) | (time > 2.1)
    gapped = replace(
        recording, acceleration_time_seconds=time[kept], acceleration_g=recording.acceleration_g[kept]
    )
    first, second = preprocess_parts(gapped, SETTINGS)
    assert recording.wander is not None
    for part, begin, end in ((first, 0.0, 1.9), (second, 2.1, 4.0)):
        first_turn, last_turn = np.interp(
            [begin + SETTINGS.trim_seconds, end - SETTINGS.trim_seconds],
            recording.wander.time_seconds, recording.wander.turns[:, 2],
        )  # fmt: skip
        assert part.wander_turns[0, 2] == pytest.approx(first_turn, abs=1.0)
        assert part.wander_turns[-1, 2] == pytest.approx(last_turn, abs=1.0)


def test_a_store_keeps_wander_specimen_and_the_fraction_of_the_slip_s_phase(tmp_path: Path) -> None:
    recordings = [
        record_condition(
            MATERIALS[label], velocity_mps=(0.12, 0.05), force_newtons=1.0, duration_seconds=3.0, seed=seed,
            specimen=specimen,
        )
        for label, seed, specimen in (("rubber", 1, 3), ("jute", 2, 9), ("rubber", 4, 0))
    ]  # fmt: skip
    store = prepare_store([*recordings, small_recording()], ["rubber", "jute", "wood"], tmp_path / "store", progress=False)
    assert [one.specimen for one in store.recordings] == [3, 9, 0, None]
    assert store.wander_turns.shape == (len(store.waveform), 3) and store.wander_turns.dtype == np.float32
    for recording, stored in zip(recordings, store.recordings, strict=False):
        turns = preprocess_recording(recording, SETTINGS).wander_turns
        found = store.wander_turns[stored.recorded_samples]
        np.testing.assert_allclose(found[:, :2], turns[:, :2], atol=1e-6)
        apart = found[:, 2] - turns[:, 2]
        assert np.abs(apart - np.round(apart)).max() < 1e-6
        before = store.wander_turns[stored.start : stored.recorded_samples.start]
        assert np.all(before == found[0])
    assert store.wander_turns[:, 2].min() >= 0.0 and store.wander_turns[:, 2].max() < 1.0
    assert not np.any(store.wander_turns[store.recordings[-1].samples])


def test_labels_that_slip_or_wander_say_so_and_no_others() -> None:
    infos = {info.name: info for info in synthetic_label_infos(DataConfig())}
    assert infos["rubber"].stick_slip == StickSlip(0.0011, 0.25, 0.004)
    assert {name for name, info in infos.items() if info.stick_slip is not None} == {"rubber", "leather"}
    first, second = infos["jute"].rib_wander
    assert first == RibWander(0.12, pytest.approx(0.014)) and second == RibWander(0.12, pytest.approx(0.0119))
    assert {name for name, info in infos.items() if info.rib_wander} == {"jute", "corduroy", "metal mesh"}
    for info in infos.values():
        assert len(info.rib_wander) in (0, len(info.known_wave_vectors))
