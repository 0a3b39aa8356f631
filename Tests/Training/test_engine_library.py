"""The native library through ctypes: the evaluation measures what the engine generates."""

from __future__ import annotations

import json
from pathlib import Path

import make_tiny_model
import numpy as np
import pytest
import tiny_graphs

from haptoflow_benchmark.engine_library import EngineLibrary, default_engine
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.errors import InputError
from haptoflow_writer import write_model
from places import ROOT

GOLDEN = ROOT / "Tests" / "Golden" / "model"


def _golden_cases() -> list[dict[str, object]]:
    cases: list[dict[str, object]] = json.loads((GOLDEN / "default.parity.json").read_text(encoding="utf-8"))["cases"]
    assert cases
    return cases


def test_the_engine_s_segments_of_a_skeleton_equal_those_of_pytorch(engine: EngineLibrary) -> None:
    model = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
    # A batch holds one past; what a network makes of two is tested natively.
    for case in (case for case in _golden_cases() if case["tier"] == "sketch"):
        with EngineGenerator(engine, model, str(case["tier"]), str(case["solver"]), int(str(case["steps"]))) as generator:
            embedding, motion, previous, noise = (
                np.array([case[key], case[key]], dtype=np.float32) for key in ("embedding", "motion", "own", "noise")
            )
            phases = np.array([case["phases"], case["phases"]], dtype=np.float32)
            made = generator.generate(embedding, motion, previous, noise, phases)
        tolerance = 1e-4 * float(np.exp(float(str(case["log_level"]))))
        np.testing.assert_allclose(made[0], np.array(case["segment"]), atol=tolerance)
        np.testing.assert_allclose(made[1], made[0], atol=1e-6)


def test_a_refused_model_is_reported_with_the_reason(engine: EngineLibrary, tmp_path: Path) -> None:
    damaged = bytearray((GOLDEN / "tiny.haptoflow").read_bytes())
    damaged[-1] ^= 1
    (tmp_path / "damaged.haptoflow").write_bytes(bytes(damaged))
    with pytest.raises(InputError, match="haptoflow_model_open: .+"):
        EngineGenerator(engine, tmp_path / "damaged.haptoflow")


def test_a_library_that_is_not_built_names_the_command_that_builds_it(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="npm run build"):
        default_engine(tmp_path)


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
