"""A model file's graphs in PyTorch reproduce the golden vectors, with correct gradients."""

from __future__ import annotations

import json
from pathlib import Path

import onnx
import pytest
import torch
from onnx import TensorProto, helper
from paper_samples import evaluated

from haptoflow_paper.runs.tier import network_graph
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile, read_model_file
from haptoflow_training.models.file_model import FileModel
from haptoflow_training.models.graph_module import GraphModule
from haptoflow_training.training.config import load_config
from haptoflow_training.training.trainer import build_model

ROOT = Path(__file__).parents[2]
GOLDEN = ROOT / "Tests" / "Golden" / "model"
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
NO_RIBS: list[list[tuple[float, float]]] = [[], []]


@pytest.fixture(scope="module")
def default() -> FileModel:
    return FileModel(read_model_file(DEFAULT))


def tensor(case: dict[str, object], key: str, *shape: int) -> torch.Tensor:
    return torch.tensor(case[key]).reshape(*shape)


def test_level_and_every_tier_of_the_default_model_agree_with_the_golden_vectors(default: FileModel) -> None:
    cases = json.loads((GOLDEN / "default.parity.json").read_text(encoding="utf-8"))["cases"]
    assert {case["tier"] for case in cases} == {entry["name"] for entry in default.file.header["tiers"]}
    for case in cases:
        embedding, motion = tensor(case, "embedding", 1, 64), tensor(case, "motion", 1, 3)
        log_level = default.log_level(embedding, motion, case["tier"])
        assert log_level.item() == pytest.approx(case["log_level"], abs=1e-5)
        gain = log_level.exp().unsqueeze(-1)
        previous = (tensor(case, "previous", 1, 1, 200) / gain).clamp(-16.0, 16.0)
        made = default.tier(case["tier"]).segment(
            tensor(case, "noise", 1, 1, 200), previous, embedding, motion, tensor(case, "rib_phase", 1, 2)
        )
        assert torch.allclose(made * gain, tensor(case, "segment", 1, 1, 200), atol=1e-4)


def test_a_batch_gives_the_results_of_its_rows_whatever_batch_size_came_before(default: FileModel) -> None:
    tier, generator = default.tier("draft"), torch.Generator().manual_seed(1)
    waves = torch.randn(2, 5, 1, 200, generator=generator)
    embedding, motion = default.label_embeddings[:5], torch.rand(5, 3, generator=generator)
    phase = torch.rand(5, 2, generator=generator)
    together = tier.segment(waves[0], waves[1], embedding, motion, phase)
    for row in range(5):
        each = [part[row : row + 1] for part in (waves[0], waves[1], embedding, motion, phase)]
        assert torch.allclose(tier.segment(*each), together[row : row + 1], atol=1e-4)


@pytest.mark.parametrize("name", ["draft", "standard"])
def test_the_gradient_with_respect_to_the_embedding_equals_finite_differences(default: FileModel, name: str) -> None:
    tier, generator = default.tier(name), torch.Generator().manual_seed(2)
    waves = torch.randn(2, 1, 1, 200, generator=generator)
    motion, phase = torch.tensor([[0.08, 0.02, 1.0]]), torch.tensor([[0.3, 0.7]])

    def loss(embedding: torch.Tensor) -> torch.Tensor:
        return tier.segment(waves[0], waves[1], embedding, motion, phase).square().sum()

    embedding = default.label_embeddings[9:10].clone().requires_grad_()
    gradient = torch.autograd.grad(loss(embedding), embedding)[0]
    direction = torch.randn(1, 64, generator=generator)
    direction[:, -4:] = 0.0
    step = 1e-2
    with torch.no_grad():
        difference = (loss(embedding + step * direction) - loss(embedding - step * direction)) / (2.0 * step)
    assert (gradient * direction).sum().item() == pytest.approx(difference.item(), rel=0.03)


@pytest.mark.parametrize("kind", ["flow", "average-velocity", "direct"])
def test_every_exported_kind_of_tier_computes_what_its_network_computes(kind: str) -> None:
    config = load_config(ROOT / "Training" / "configs" / "default" / "standard.toml")
    if kind == "average-velocity":
        config = evaluated(config, recipe={"objective": kind, "energy_steps": 0})
    torch.manual_seed(3)
    model = build_model(config, NO_RIBS).eval()
    for parameter in model.parameters():
        torch.nn.init.normal_(parameter, std=0.05)
    graph = GraphModule(network_graph(model, kind))
    noise, previous = torch.randn(3, 1, 200), torch.randn(3, 1, 200)
    embedding, motion, phase = torch.randn(3, 64), torch.rand(3, 3), torch.rand(3, 2)
    time = torch.full((3, 1), 0.25)
    given = {"previous": previous, "embedding": embedding, "motion": motion, "rib_phase": phase}
    made = graph({"noisy": noise, "time": time, "interval": time, **given})
    if kind == "direct":
        expected = model.one_step(noise, previous, embedding, motion, phase)
    else:
        interval = [time] if kind == "average-velocity" else []
        expected = model.field(noise, time, previous, embedding, motion, phase, *interval)
    assert torch.allclose(made, expected, atol=1e-4)


def test_an_unknown_operator_is_named() -> None:
    node = helper.make_node("LSTM", ["noisy", "w", "r"], ["velocity"])
    value = helper.make_tensor_value_info("noisy", TensorProto.FLOAT, [1, 1, 200])
    weights = [helper.make_tensor(name, TensorProto.FLOAT, [1], [0.0]) for name in ("w", "r")]
    graph = onnx.helper.make_model(helper.make_graph([node], "g", [value], [value], weights)).SerializeToString()
    with pytest.raises(InputError, match="tier 'x': operator LSTM"):
        GraphModule(graph, "tier 'x'")


def test_a_missing_tier_and_a_latent_tier_are_refused() -> None:
    file = read_model_file(GOLDEN / "tiny.haptoflow")
    graphs = {name: graph for name, graph in file.graphs.items() if "field" in name}
    model = FileModel(ModelFile(file.header, file.tensors, graphs))
    with pytest.raises(InputError, match="no tier 'best'; it has draft, standard"):
        model.tier("best")
    with pytest.raises(InputError, match="'latent' is latent"):
        model.tier("latent")


def test_every_solver_gives_the_engine_s_expected_results() -> None:
    """tiny.expected.json holds the results of the tiny model's tiers, computed by hand."""
    file = read_model_file(GOLDEN / "tiny.haptoflow")
    usable = {name: graph for name, graph in file.graphs.items() if not name.startswith(("wrong", "not_finite"))}
    document = json.loads((GOLDEN / "tiny.expected.json").read_text(encoding="utf-8"))
    embedding, motion, previous, noise = (
        torch.tensor(document["requests"][name]) for name in ("embedding", "motion", "previous", "noise")
    )
    checked = 0
    for case in document["cases"]:
        if case["tier"] == "latent":
            continue
        tiers = [{**tier, "solver": case["solver"], "steps": case["steps"]} for tier in file.header["tiers"]]
        model = FileModel(ModelFile({**file.header, "tiers": tiers}, file.tensors, usable))
        gain = model.log_level(embedding, motion, case["tier"]).exp()
        assert torch.allclose(gain.squeeze(1), torch.tensor(case["levels_mps2"]), rtol=1e-4)
        past = (previous / gain).clamp(-16.0, 16.0).unsqueeze(1)
        made = model.tier(case["tier"]).segment(noise.unsqueeze(1), past, embedding, motion, torch.zeros(3, 2))
        assert torch.allclose(made.squeeze(1) * gain, torch.tensor(case["segments_mps2"]), rtol=1e-3, atol=1e-3)
        checked += 1
    assert checked == len(document["cases"]) - 1
