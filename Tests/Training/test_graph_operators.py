"""Every exported graph can be read by the engine: opset 16, no other domain, listed operators only."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import onnx
import pytest
import torch
from paper_samples import evaluated

from haptoflow_paper.codec.representation import CodecRepresentation, build_representation
from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecShape
from haptoflow_paper.rivals import ARCHITECTURES
from haptoflow_paper.runs.tier import export_level_model, network_graph
from haptoflow_training.export.trained_tier import tier_of
from haptoflow_training.training.config import TrainingConfig, load_config
from haptoflow_training.training.trainer import build_model

ROOT = Path(__file__).parents[2]
CONFIGS = ROOT / "Training" / "configs"
NO_RIBS: list[list[tuple[float, float]]] = [[], []]


def _allowed_operators() -> set[str]:
    text = (ROOT / "Documentation~" / "model-format.md").read_text(encoding="utf-8")
    block = re.search(r"### Operators\n+```\n(.*?)```", text, re.DOTALL)
    assert block is not None
    return set(block[1].split())


def _check(graph: bytes) -> None:
    model = onnx.load_from_string(graph)
    assert [(entry.domain, entry.version) for entry in model.opset_import] == [("", 16)]
    assert not model.functions
    used = {node.op_type for node in model.graph.node}
    assert used
    assert used <= _allowed_operators()


@pytest.mark.parametrize("kind", ["flow", "average-velocity", "direct"])
def test_every_kind_of_field_uses_only_listed_operators(kind: str) -> None:
    base = load_config(ROOT / "Training" / "haptoflow_paper" / "configs" / "field.toml")
    for levels in (1, 2):
        config = dataclasses.replace(base, model=dataclasses.replace(base.model, levels=levels))
        if kind == "average-velocity":
            config = evaluated(config, recipe={"objective": kind, "energy_steps": 0})
        model = build_model(config, NO_RIBS)
        _check(network_graph(model, kind))
    _check(export_level_model(model.level))


@pytest.mark.parametrize("size", ["draft", "standard"])
def test_the_refinements_in_shipped_sizes_use_only_listed_operators(size: str) -> None:
    config = load_config(CONFIGS / "default" / f"{size}.toml")
    (graph,) = tier_of(config, ["a", "b"], build_model(config, NO_RIBS)).graphs().values()
    _check(graph)


@pytest.mark.parametrize("architecture", ARCHITECTURES)
def test_every_rival_uses_only_listed_operators(architecture: str) -> None:
    base = load_config(ROOT / "Training" / "haptoflow_paper" / "configs" / "plain.toml")
    config: TrainingConfig = dataclasses.replace(base, model=dataclasses.replace(base.model, architecture=architecture))
    _check(network_graph(build_model(config, NO_RIBS), "direct"))


def test_every_codec_uses_only_listed_operators(tmp_path: Path) -> None:
    codec = SmallCodec(SmallCodecShape(latent_channels=12, width=8))
    codec.normaliser.fit(codec.encoder(torch.randn(64, 1, 200)).detach())
    codec.save(tmp_path / "small.pt")
    for settings in (
        {"kind": "small-codec", "checkpoint": str(tmp_path / "small.pt")},
        {"kind": "encodec", "random_weights": True},
    ):
        representation = build_representation(settings)
        assert isinstance(representation, CodecRepresentation)
        representation.export_encoder(tmp_path / "encoder.onnx")
        representation.export_decoder(tmp_path / "decoder.onnx")
        for name in ("encoder.onnx", "decoder.onnx"):
            _check((tmp_path / name).read_bytes())
