"""Our modules compute what the authors' compute: golden arrays of their own code, stage by stage."""

from __future__ import annotations

import pytest
import torch

from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.published_model import PublishedModel
from published_samples import PUBLISHED, SOLVERS, GoldenChain, assert_within_1e_4_of_its_rms


@pytest.fixture(scope="module", params=SOLVERS)
def solver(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def model(solver: str) -> PublishedModel:
    return read_checkpoint(PUBLISHED / solver).model


@pytest.fixture(scope="module")
def golden(solver: str) -> GoldenChain:
    return GoldenChain(solver)


def _row(model: PublishedModel, golden: GoldenChain, segment: int) -> torch.Tensor:
    return model.network.label_embed(torch.tensor([golden.label(segment)]))


@pytest.mark.parametrize("segment", range(GoldenChain.segments))
class TestEachStage:
    """Every stage from the golden input of that stage, so that an error is named where it arises."""

    def test_the_past_is_resampled_to_24_khz(self, model: PublishedModel, golden: GoldenChain, segment: int) -> None:
        found = model.upwards(golden.tensor(segment, "previous"))
        assert_within_1e_4_of_its_rms(found, golden.tensor(segment, "previous_24k"))

    def test_the_past_is_encoded(self, model: PublishedModel, golden: GoldenChain, segment: int) -> None:
        found = model.encode(golden.tensor(segment, "previous"))
        assert_within_1e_4_of_its_rms(found, golden.tensor(segment, "latent"))

    def test_the_past_has_a_feature_for_each_level(
        self, model: PublishedModel, golden: GoldenChain, segment: int
    ) -> None:
        for level, found in enumerate(model.past_features(golden.tensor(segment, "latent"))):
            assert_within_1e_4_of_its_rms(found, golden.tensor(segment, f"feature{level}"))

    def test_label_and_motion_are_the_condition(
        self, model: PublishedModel, golden: GoldenChain, segment: int
    ) -> None:
        found = model.condition(_row(model, golden, segment), golden.motion(segment))
        assert_within_1e_4_of_its_rms(found, golden.tensor(segment, "cond"))

    @pytest.mark.parametrize("time", [1.0, 0.5, 0.125])
    def test_the_velocity_is_that_of_its_time_with_guidance(
        self, model: PublishedModel, golden: GoldenChain, segment: int, time: float
    ) -> None:
        past = [golden.tensor(segment, f"feature{level}") for level in range(2)]
        noise, condition = golden.tensor(segment, "noise"), golden.tensor(segment, "cond")
        found = model.velocity(noise, torch.tensor([[time]]), condition, past, model.meta.guidance)
        assert_within_1e_4_of_its_rms(found, golden.tensor(segment, f"velocity_t{time}"))

    def test_noise_becomes_a_latent(self, model: PublishedModel, golden: GoldenChain, segment: int) -> None:
        past = [golden.tensor(segment, f"feature{level}") for level in range(2)]
        found = model.generate(golden.tensor(segment, "noise"), golden.tensor(segment, "cond"), past)
        assert_within_1e_4_of_its_rms(found, golden.tensor(segment, "generated"))

    def test_the_latent_is_quantised_to_the_same_codes(
        self, model: PublishedModel, golden: GoldenChain, segment: int
    ) -> None:
        generated = golden.tensor(segment, "generated")
        assert torch.equal(model.quantiser.codes(generated), golden.tensor(segment, "codes"))
        assert_within_1e_4_of_its_rms(model.quantiser(generated), golden.tensor(segment, "quantized"))

    def test_code_vectors_are_decoded(self, model: PublishedModel, golden: GoldenChain, segment: int) -> None:
        found = model.codec.decoder(golden.tensor(segment, "quantized"))
        assert_within_1e_4_of_its_rms(found, golden.tensor(segment, "waveform_24k"))

    def test_the_latent_becomes_a_segment(self, model: PublishedModel, golden: GoldenChain, segment: int) -> None:
        found = model.decode(golden.tensor(segment, "generated"))
        assert_within_1e_4_of_its_rms(found, golden.tensor(segment, "waveform"))


def test_three_segments_that_follow_each_other_are_the_golden_ones(model: PublishedModel, golden: GoldenChain) -> None:
    previous = golden.tensor(0, "previous")
    for segment in range(golden.segments):
        noise, row = golden.tensor(segment, "noise"), _row(model, golden, segment)
        previous = model.segment(noise, row, golden.motion(segment), previous)
        assert_within_1e_4_of_its_rms(previous, golden.tensor(segment, "waveform"))
