"""Beyond the recorded range: a level fitted at 20-60 mm/s, extrapolated by its label's exponents, against
recordings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import torch
from synthetic_samples import record_machine
from training_fixtures import FakeRecording, FakeStore, travelled_mm

from haptoflow_training.export.exponents import LabelExponents, fit_exponents
from haptoflow_training.models.level_model import LevelModel, level_loss
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import load_materials, record_condition
from haptoflow_training.training.batches import HeldOut

LABELS = ("wood", "stone", "metal mesh", "plastic", "leather", "corduroy", "sandpaper")
EDGE_MPS = 0.06
FAST_MPS = (0.15, 0.5, 1.5)


@dataclass(frozen=True)
class Taught:
    """A level model and exponents fitted to nothing faster than 60 mm/s."""

    level: LevelModel
    embedding: torch.Tensor
    exponents: list[LabelExponents]
    edge_waves: list[np.ndarray]

    def edge_rms_mps2(self, label: int) -> float:
        with torch.no_grad():
            return self.level(self.embedding[label : label + 1], torch.tensor([[EDGE_MPS, 0.0, 1.0]])).exp().item()


def _slow_store() -> FakeStore:
    waves, motions, recordings, start = [], [], [], 0
    for index, label in enumerate(LABELS):
        slow = record_machine(
            load_materials(), seed=5, labels=(label,), directions=(0,), speeds_mmps=(20, 40, 60),
            forces_millinewtons=(500, 1000), repeats=1,
        )  # fmt: skip
        for recording in slow:
            prepared = preprocess_recording(recording, PreprocessingSettings())
            waves.append(prepared.waveform_mps2 / 10.0)
            motions.append(prepared.motion)
            recordings.append(FakeRecording(index, "machine", "train", start, len(prepared.waveform_mps2)))
            start += len(prepared.waveform_mps2)
    motion = np.concatenate(motions)
    return FakeStore(np.concatenate(waves), motion, travelled_mm(motion), 10.0, list(LABELS), recordings)


@pytest.fixture(scope="module")
def taught() -> Taught:
    store = _slow_store()
    periodic = {material.label: bool(material.rulings) for material in load_materials()}
    exponents = [
        fit_exponents(store, row, periodic=periodic[label], seed=1, held_out=HeldOut())
        for row, label in enumerate(LABELS)
    ]
    torch.manual_seed(1)
    level, embedding = LevelModel(), torch.randn(len(LABELS), 64)
    optimiser = torch.optim.AdamW(level.parameters(), lr=3e-3, weight_decay=0.01)
    generator = np.random.default_rng(1)
    for _ in range(500):
        picked = [store.recordings[place] for place in generator.integers(len(store.recordings), size=128)]
        starts = [entry.start + int(generator.integers(entry.length - 100)) for entry in picked]
        power = np.array([np.square(10.0 * store.waveform[start : start + 100]).mean() for start in starts])
        motion = np.array([store.motion[start : start + 100].mean(axis=0) for start in starts])
        labels = torch.tensor([entry.label_index for entry in picked])
        loss = level_loss(
            level(embedding[labels], torch.from_numpy(motion).float()), torch.from_numpy(power).float().unsqueeze(1)
        )
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    return Taught(level, embedding, exponents, [_recorded(label, EDGE_MPS, 77) for label in LABELS])


def _recorded(label: str, speed_mps: float, seed: int) -> np.ndarray:
    material = next(entry for entry in load_materials() if entry.label == label)
    recording = record_condition(
        material, velocity_mps=(speed_mps, 0.0), force_newtons=1.0, duration_seconds=2.6, seed=seed
    )
    return preprocess_recording(recording, PreprocessingSettings()).waveform_mps2


def _level_errors_db(taught: Taught, speed_mps: float) -> tuple[np.ndarray, np.ndarray]:
    """(with the law, clamped at the edge): magnitude of the error of each label's level, dB."""
    law, clamped = [], []
    for row, label in enumerate(LABELS):
        wave = _recorded(label, speed_mps, 78)
        truth = 20.0 * np.log10(np.sqrt(np.square(wave, dtype=np.float64).mean()))
        edge = 20.0 * np.log10(taught.edge_rms_mps2(row))
        exponent = taught.exponents[row].level_speed
        law.append(abs(edge + 20.0 * exponent * np.log10(speed_mps / EDGE_MPS) - truth))
        clamped.append(abs(edge - truth))
    return np.array(law), np.array(clamped)


@pytest.mark.parametrize("speed_mps", FAST_MPS)
def test_extrapolating_the_level_law_is_closer_to_fast_recordings_than_clamping(
    taught: Taught, speed_mps: float
) -> None:
    law, clamped = _level_errors_db(taught, speed_mps)
    assert np.median(law) < 0.6 * np.median(clamped), (law.round(1), clamped.round(1))
