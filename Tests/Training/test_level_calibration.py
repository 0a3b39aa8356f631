"""The closed-loop level of a network is measured and corrected, label by label."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
from numpy.typing import NDArray
from test_export import INFOS, PROVENANCE
from test_trainer import ALONE, _config
from training_fixtures import level_offsets_db, make_store

from haptoflow_training.closed_loop.level_calibration import TierSource, hops
from haptoflow_training.export.exporter import export_run
from haptoflow_training.export.level_table import MeasuredLevels
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.export.trained_tier import load_tiers
from haptoflow_training.models.level_model import LevelModel, shift_level
from haptoflow_training.training.batches import HeldOut
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.trainer import Trainer

_Floats = NDArray[np.float32]


class _KnownSource:
    """Noise at the store's own level, multiplied by `gain_db` of each label; the embedding's first value identifies
    it."""

    def __init__(self, gain_db: tuple[float, float]) -> None:
        self._gain = 10.0 ** (np.array(gain_db) / 20.0)

    def generate(
        self, embeddings: _Floats, motions: _Floats, previous_mps2: _Floats, noise: _Floats, phases: _Floats
    ) -> _Floats:
        del previous_mps2
        speed, force = np.hypot(motions[:, 0], motions[:, 1]), motions[:, 2]
        label = embeddings[:, 0].astype(int)
        level = np.where(label == 0, 2.0 * speed * force**0.3, 5.0 * np.sqrt(speed)) * self._gain[label]
        return (noise * level[:, None]).astype(np.float32)


def test_the_level_error_of_a_label_is_measured_in_closed_loop() -> None:
    store = make_store(seconds=10.0, recordings_per_split=6)
    embeddings = np.zeros((2, 64), dtype=np.float32)
    embeddings[1, 0] = 1.0
    counted = []
    found = level_offsets_db(_KnownSource((2.0, -1.0)), embeddings, store, HeldOut(), counted.append)
    assert found == pytest.approx([2.0, -1.0], abs=0.3)
    assert sum(counted) == hops(store)


def test_a_level_shift_affects_its_label_only_and_is_the_same_at_every_motion() -> None:
    torch.manual_seed(2)
    level, embedding = LevelModel(), torch.randn(20, 64)
    shift = torch.linspace(-0.3, 0.5, 20)
    motions = torch.tensor([[0.05, 0.0, 1.0], [0.9, 0.4, 0.2], [0.0, 0.0, 0.0]])
    before = torch.stack([level(embedding, motion.expand(20, 3)).squeeze(1) for motion in motions])
    shift_level(level, embedding, shift)
    after = torch.stack([level(embedding, motion.expand(20, 3)).squeeze(1) for motion in motions])
    assert torch.allclose(after - before, shift.expand(3, 20), atol=1e-4)


def test_a_level_shift_in_the_file_scales_the_closed_loop_by_the_same_factor(tmp_path: Path) -> None:
    store = make_store(seconds=6.0, recordings_per_split=4)
    Trainer(_config(), store, tmp_path / "run", ALONE).run()
    recorded, levels = Source(store, INFOS, PROVENANCE), MeasuredLevels([1.5, -0.5])
    export_run(tmp_path / "run", recorded, tmp_path / "plain.haptoflow")
    export_run(tmp_path / "run", recorded, tmp_path / "level.haptoflow", levels=levels)
    files = [read_model_file(tmp_path / f"{name}.haptoflow") for name in ("plain", "level")]
    assert files[1].header["measurements"]["level_offsets_db"] == [1.5, -0.5]
    differ = {name for name, values in files[0].tensors.items() if not np.array_equal(values, files[1].tensors[name])}
    assert differ == {"level.law.weight"}

    tier = load_tiers([tmp_path / "run"])[0]
    source = TierSource(tier)
    before = level_offsets_db(source, source.embeddings, store, HeldOut())
    shift_level(tier.model.level, tier.model.embedding.weight, torch.tensor([-1.5, 0.5]) * (np.log(10.0) / 20.0))
    after = level_offsets_db(source, source.embeddings, store, HeldOut())
    assert np.subtract(after, before) == pytest.approx([-1.5, 0.5], abs=0.05)
