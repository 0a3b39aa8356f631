"""The golden model with a skeleton: what its tensors and header say, and whether PyTorch still makes its vectors."""

from __future__ import annotations

import json
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from numpy.typing import NDArray

from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.row_runner import _sizes
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file
from haptoflow_training.export.skeleton_tensors import condition_tensors, skeleton_tensors
from haptoflow_training.fewshot.add_label import with_label
from haptoflow_training.models.conditioning import MotionFeatures
from haptoflow_training.models.surface_waves import rate_features

GOLDEN = Path(__file__).parents[1] / "Golden" / "model"
sys.path.insert(0, str(GOLDEN))

import make_skeleton_model  # noqa: E402

_Floats = NDArray[np.float32]


@pytest.fixture(scope="module")
def file() -> ModelFile:
    return read_model_file(GOLDEN / "skeleton.haptoflow")


@pytest.fixture(scope="module")
def cases() -> list[dict[str, Any]]:
    golden = json.loads((GOLDEN / "skeleton.parity.json").read_text(encoding="utf-8"))
    assert golden["model_crc32"] == f"{zlib.crc32((GOLDEN / 'skeleton.haptoflow').read_bytes()):08x}"
    made: list[dict[str, Any]] = golden["cases"]
    return made


def _perceptron(file: ModelFile, name: str, given: _Floats) -> _Floats:
    """As native code computes it."""
    for layer in (0, 2, 4):
        given = given @ file.tensors[f"{name}.{layer}.weight"].T + file.tensors[f"{name}.{layer}.bias"]
        if layer < 4:
            given = given / (1.0 + np.exp(-given))
    return given


def _condition(case: dict[str, Any], harmonics: tuple[float, ...]) -> _Floats:
    features = MotionFeatures(harmonics)(torch.tensor([case["motion"]]))[0].numpy()
    return np.concatenate([np.array(case["embedding"], np.float32), features])


def _moving_condition(case: dict[str, Any]) -> _Floats:
    """With the rates of the surface's waves."""
    rates = rate_features(torch.tensor([case["phases"]]))[0].numpy()
    return np.concatenate([_condition(case, FINE), rates])


FINE, SMOOTH = (0.5, 1.0, 2.0, 4.0, 8.0), (0.5, 1.0)


def test_the_file_is_that_of_the_model_which_made_the_golden_vectors(file: ModelFile) -> None:
    sketch, refined = make_skeleton_model.build()
    assert refined.refiner is not None
    written = {
        "embedding": sketch.embedding.weight.numpy(), "pieces": sketch.embedding.offsets.numpy(),
        **skeleton_tensors(sketch.level, sketch.skeleton), **condition_tensors("standard", refined.refiner),
    }  # fmt: skip
    assert written.keys() == file.tensors.keys()
    for name, values in written.items():
        np.testing.assert_allclose(values, file.tensors[name], rtol=1e-6, atol=1e-7, err_msg=name)


def test_the_tensors_alone_give_level_filter_and_the_film_with_its_factors(
    file: ModelFile, cases: list[dict[str, Any]]
) -> None:
    for case in cases:
        embedding = np.array(case["embedding"], np.float32)
        velocity, force = np.array(case["motion"][:2]), case["motion"][2]
        logarithms = np.log([(np.hypot(*velocity) + 0.0005) / 0.06, max(force, 0.0) + 0.02])
        law = file.tensors["level.law.weight"] @ embedding + file.tensors["level.law.bias"]
        crossing = 0.25 * np.log1p(1000.0 * np.abs(embedding[-4:].reshape(2, 2) @ velocity))
        correction = _perceptron(file, "level.correction", np.concatenate([_condition(case, SMOOTH), crossing]))[0]
        level = law[0] + law[1:] @ logarithms + 0.9 * np.tanh(correction)
        assert level == pytest.approx(case["log_level"][0], abs=1e-4)

        outputs = _perceptron(file, "skeleton", _moving_condition(case))
        log_cosh = [np.log(np.cosh(argument)) for argument in np.clip(outputs[:24], -3.8, 3.8)]
        assert sum(log_cosh) < np.log(10.0**2.5), "below the limit of resonance, so that no argument is scaled"
        log_gain = 2.0 * np.tanh(outputs[24] / 2.0) - sum(log_cosh)
        assert log_gain == pytest.approx(case["log_gain"][0], abs=1e-4)

        film = _perceptron(file, "standard.condition", _moving_condition(case))
        np.testing.assert_allclose(film, case["film"], atol=1e-4)


def test_a_further_label_of_a_model_with_specimens_has_the_offsets_of_the_label_itself(file: ModelFile) -> None:
    material = {
        "name": "learnt", "space": model_space(file), "category": "own", "embedding": [0.1] * 64,
    }  # fmt: skip
    larger = with_label(file, material)
    assert larger.tensors["embedding"].shape == (3, 64)
    assert larger.tensors["pieces"].shape == (3, make_skeleton_model.SPECIMENS, 60)
    assert not larger.tensors["pieces"][2].any() and larger.tensors["pieces"].dtype == np.float32
    np.testing.assert_array_equal(larger.tensors["pieces"][:2], file.tensors["pieces"])
    assert "seeds" not in larger.tensors and "seed_bank" not in larger.header


def test_the_bytes_of_a_tier_are_its_graph_and_all_tensors_that_native_code_computes_with(file: ModelFile) -> None:
    blobs = [{"name": name, "bytes": values.nbytes} for name, values in file.tensors.items()]
    blobs += [{"name": name, "bytes": len(graph)} for name, graph in file.graphs.items()]

    class Generator:
        header = {**file.header, "blobs": blobs}

    def size(tier: str) -> int:
        row = PlannedRow(name=tier, family="HaptoFlow", block="ours", model="m.haptoflow", tier=tier)
        return _sizes(Generator(), row)["bytes"]  # type: ignore[arg-type]

    def weights(*beginnings: str) -> int:
        return sum(values.nbytes for name, values in file.tensors.items() if name.startswith(beginnings))

    assert size("sketch") == weights("skeleton.", "level.")
    assert size("standard") - size("sketch") == weights("standard.condition.") + len(file.graphs["standard.field"])
