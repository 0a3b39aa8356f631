"""The native library through ctypes: the evaluation measures what the engine generates."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark.engine_library import EngineLibrary, default_engine
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.errors import InputError

ROOT = Path(__file__).parents[2]
GOLDEN = ROOT / "Tests" / "Golden" / "model"


@pytest.fixture(scope="module")
def engine() -> EngineLibrary:
    return default_engine(ROOT)


def _golden_cases() -> list[dict[str, object]]:
    cases: list[dict[str, object]] = json.loads((GOLDEN / "default.parity.json").read_text(encoding="utf-8"))["cases"]
    assert cases
    return cases


def test_the_engine_s_segments_equal_those_of_pytorch(engine: EngineLibrary) -> None:
    model = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
    for case in _golden_cases():
        with EngineGenerator(engine, model, str(case["tier"]), str(case["solver"]), int(str(case["steps"]))) as generator:
            embedding, motion, previous, noise = (
                np.array([case[key], case[key]], dtype=np.float32) for key in ("embedding", "motion", "previous", "noise")
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
