"""The phases of the surface's waves from Python through the C interface into a graph."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_paper.rows.engine_generator import EngineGenerator

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "Tests" / "Golden" / "model"))

import make_tiny_model  # noqa: E402
import tiny_graphs  # noqa: E402

from haptoflow_writer import write_model  # noqa: E402

WEIGHTS = np.array([[0.5], [-0.25], [0.125], [0.01], [0.02], [-0.005]], dtype=np.float32)


def _phase_graph() -> bytes:
    """segment = phases @ WEIGHTS, the same at every sample."""
    graph = tiny_graphs._Graph()
    weighted = graph.apply("MatMul", "phases", graph.constant(np.repeat(WEIGHTS, tiny_graphs.SAMPLES, axis=1)))
    graph.apply("Reshape", weighted, graph.constant([-1, 1, tiny_graphs.SAMPLES]), output="segment")
    return graph.finish({"phases": ["B", 6]}, {"segment": ["B", 1, tiny_graphs.SAMPLES]})


def test_each_row_of_a_batch_has_its_own_phases_and_none_means_those_of_its_motion(tmp_path: Path) -> None:
    model = tmp_path / "ribs.haptoflow"
    write_model(model, make_tiny_model.header(), {**make_tiny_model.blobs(), "direct_field": _phase_graph()})
    random = np.random.default_rng(1)
    embedding = random.normal(size=(3, 64)).astype(np.float32)
    motion = np.array([[0.1, 0.0, 1.0], [0.0, 0.2, 2.0], [-0.1, 0.1, 0.5]], dtype=np.float32)
    waves = np.zeros((3, 200), dtype=np.float32)
    phases = np.random.default_rng(2).normal(size=(3, 6)).astype(np.float32)
    level = np.exp(tiny_graphs.log_level(embedding, motion))
    with EngineGenerator(default_engine(ROOT), model, "direct") as generator:
        with_phase = generator.generate(embedding, motion, waves, waves, phases)
        without = generator.generate(embedding, motion, waves, waves)
    np.testing.assert_allclose(with_phase / level, np.repeat(phases @ WEIGHTS, 200, axis=1), atol=1e-5)
    vectors = embedding[:, -4:].reshape(3, 2, 2)
    crossed = np.einsum("rkc,rc->rk", vectors, 1000.0 * motion[:, :2]) @ WEIGHTS[3:5]
    np.testing.assert_allclose(without / level, np.repeat(crossed, 200, axis=1), rtol=1e-4, atol=1e-4)
