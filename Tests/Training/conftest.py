"""Makes the packages of the tree, the helpers of this folder and the makers of the golden models importable."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from haptoflow_benchmark.engine_library import EngineLibrary

# A process a core runs tests: threads of theirs would only compete. To be said before NumPy and PyTorch are imported.
for _library in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_library, "1")

_TESTS = Path(__file__).parent
sys.path[:0] = [str(_TESTS.parents[1] / "Training"), str(_TESTS), str(_TESTS.parent / "Golden" / "model")]


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "long(because): of the long form, and why the default run loses nothing by it")


@pytest.fixture(scope="session", autouse=True)
def quick_training() -> Iterator[None]:
    """A run is validated on fewer pairs, and its losses are drawn for the first run only."""
    from haptoflow_training.training import trainer

    plots = iter([trainer.plot_metrics])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(trainer, "_VALIDATION_BATCH", 96)
        patch.setattr(trainer, "plot_metrics", lambda *given: next(plots, lambda *_: None)(*given))
        yield


@pytest.fixture(scope="session")
def engine() -> EngineLibrary:
    """The built library with its ONNX Runtime."""
    from haptoflow_benchmark.engine_library import default_engine

    return default_engine(_TESTS.parents[1])
