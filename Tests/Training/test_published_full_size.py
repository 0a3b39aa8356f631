"""At the authors' sizes with random weights, the engine computes what PyTorch computes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.published_file import PublishedFile
from haptoflow_paper.rows.engine_generator import EngineGenerator
from published_samples import assert_within_1e_4_of_its_rms, write_checkpoint_of_published_sizes

ROOT = Path(__file__).parents[2]


def test_a_model_of_the_published_sizes_computes_the_same_in_the_engine_as_in_pytorch(tmp_path: Path) -> None:
    checkpoint = read_checkpoint(write_checkpoint_of_published_sizes(tmp_path / "published"))
    file = PublishedFile(checkpoint)
    path = tmp_path / "published.haptoflow"
    file.write_draft(path)
    model, numbers = checkpoint.model, np.random.default_rng(5)
    labels, count = np.array([3, 117]), 2
    motions = np.array([[0.03, -0.02, 0.6], [-0.05, 0.01, 1.0]], dtype=np.float32)
    noise = numbers.standard_normal((count, 128, 8), dtype=np.float32)
    previous = 0.3 * numbers.standard_normal((count, 200), dtype=np.float32)
    with EngineGenerator(default_engine(ROOT), path, maximum_batch=count) as generator:
        rows = generator.embeddings[labels]
        unused = np.zeros_like(previous)
        for _ in range(2):
            found = generator.generate(rows, motions, previous, unused, latent_noise=noise.reshape(count, -1))
            expected = model.segment(
                torch.from_numpy(noise),
                model.network.label_embed(torch.from_numpy(labels)),
                torch.from_numpy(motions),
                torch.from_numpy(previous).unsqueeze(1),
            )
            assert_within_1e_4_of_its_rms(found, expected[:, 0])
            previous = found
