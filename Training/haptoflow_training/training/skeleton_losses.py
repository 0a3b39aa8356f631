"""The losses of a skeleton and of its refinement: `filter`, `likelihood` and `energy`."""

from __future__ import annotations

import math

import torch
from torch import Tensor

from haptoflow_training.models.label_embedding import WAVE_VECTORS, surface_path
from haptoflow_training.models.skeleton import LIKELIHOOD_END, ORDER
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.models.surface_waves import FAMILIES, MINIMUM_HZ, advanced, path_of, with_path, with_rates_at
from haptoflow_training.training.batches import SegmentBatch
from haptoflow_training.training.losses import Losses, ScaledBatch
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

_SMALL = 1e-6
# Noise added to recordings before a filter is fitted. Where nothing is felt, a filter has better uses for its poles.
_FLOOR_MPS2 = 0.005
# In unit scale at most this: 45 dB below the level.
_LARGEST_FLOOR = 10.0 ** (-45.0 / 20.0)
# A vibration of this RMS weighs half.
_FAINT_MPS2 = 0.03


def with_floor(segment: Tensor, log_level: Tensor, generator: torch.Generator) -> Tensor:
    """Segments [B, 1, 200] in unit scale, of the level exp(log_level) [B, 1] in m/s^2, over the noise floor."""
    floor = (_FLOOR_MPS2 * torch.exp(-log_level.detach())).clamp(max=_LARGEST_FLOOR).unsqueeze(2)
    return segment + floor * torch.randn(segment.shape, generator=generator)


def motion_at(motion_path: Tensor, sample: int) -> Tensor:
    """[B, 3]: the motion at about a sample of segments whose motions are known at evenly spaced samples [B, K, 3], from
    the first to the last."""
    return motion_path[:, round(sample * (motion_path.shape[1] - 1) / (SEGMENT_SAMPLES - 1))]


def audible(log_level: Tensor) -> Tensor:
    """[B]: near 1 where the expected level exp(log_level) [B, 1] in m/s^2 can be felt, 0 at rest, where nothing is
    recorded. All other segments weigh alike: weighting down unpredictable ones would bias a likelihood towards too little
    variance."""
    power = log_level.detach().squeeze(1).mul(2.0).exp()
    return power / (power + _FAINT_MPS2**2)


def without_waves(rates_hz: Tensor) -> Tensor:
    """[B]: 1 where all families of the surface's waves [B, F] stand still, else 0. Burg's method takes their lines for
    resonances."""
    return (rates_hz.abs() <= MINIMUM_HZ).all(dim=1).to(rates_hz.dtype)


def weighted_mean(values: Tensor, weight: Tensor) -> Tensor:
    """Of [B] each."""
    return (weight * values).sum() / (weight.sum() + _SMALL)


# Samples by which the second pass of the shift's loss is begun later: up to the hop of an update at 72 Hz.
_MAXIMUM_SHIFT = 27
_SHIFT_WEIGHT = 1.0


class SkeletonLosses(Losses):
    """In the energy phases a skeleton keeps its likelihood, because the embedding would drift away from the filter
    without it. A refinement, for which the skeleton is given, also learns that a segment begun later says the same of
    the same samples: a network of patches would else depend on where its patches lie, and be heard at every hop."""

    model: SkeletonModel

    def field_loss(self, given: ScaledBatch, objective: str, generator: torch.Generator) -> Tensor:
        if self.model.refiner is None:
            return self._skeleton_loss(given, objective, generator)
        return self._refinement_loss(given, generator)

    def phases(self, batch: SegmentBatch, embedding: Tensor) -> Tensor:
        path = surface_path(embedding, batch.position_path_mm, batch.wander_path)
        phases = with_path(super().phases(batch, embedding), path)
        return self._aligned(phases, embedding, batch.motion) if self.ribs_followed else phases

    @torch.no_grad()
    def _aligned(self, phases: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        """Phases of a vibration's fundamental as those of the ribs that drive it: without the phase that the skeleton's
        own fundamental has at this rate behind its filter."""
        gains = self.model.skeleton.gains(embedding, motion, phases)
        rates = phases[:, FAMILIES : 2 * FAMILIES]
        angle = (2.0 * math.pi / SAMPLE_RATE_HZ) * rates.abs().unsqueeze(2) * torch.arange(1.0, ORDER + 1.0)
        delayed = (gains.coefficients.unsqueeze(1) * torch.polar(torch.ones_like(angle), -angle)).sum(dim=2)
        first = torch.complex(gains.lines[:, :, 0, 0, 0], -gains.lines[:, :, 1, 0, 0]) / (1.0 + delayed)
        turns = torch.sign(rates) * torch.angle(first) / (2.0 * math.pi)
        # Of stick and slip nothing was followed.
        turns[:, WAVE_VECTORS:] = 0.0
        path = path_of(phases) - turns.unsqueeze(2)
        return with_path(torch.cat([phases[:, :FAMILIES] - turns, rates], dim=1), path)

    def _skeleton_loss(self, given: ScaledBatch, objective: str, generator: torch.Generator) -> Tensor:
        skeleton = self.model.skeleton
        condition = given.embedding, given.batch.motion, given.phases
        segment, weight = with_floor(given.segment, given.log_level, generator), audible(given.log_level)
        if objective == "filter":
            still = without_waves(given.phases[:, FAMILIES : 2 * FAMILIES])
            amid = self._condition_at(given, SEGMENT_SAMPLES // 2)
            return weighted_mean(skeleton.filter_distance(segment, *amid), weight * still)
        amid = self._condition_at(given, (ORDER + LIKELIHOOD_END) // 2)
        likelihood = weighted_mean(skeleton.likelihood(segment, skeleton.gains(*amid), given.phases), weight)
        if objective == "likelihood":
            return likelihood
        gains = skeleton.gains(*condition)
        drawn = tuple(
            skeleton.parts(self._noise(given, generator), given.previous, gains, given.phases).segment for _ in range(2)
        )
        return likelihood + self.one_step_loss(given, (drawn[0], drawn[1]))

    def _refinement_loss(self, given: ScaledBatch, generator: torch.Generator) -> Tensor:
        model = self.model
        noise, first, second = self.two_draws(given, generator)
        loss = self.one_step_loss(given, (first, second))
        later = int(torch.randint(1, _MAXIMUM_SHIFT + 1, (1,), generator=generator))
        again = model.one_step(
            torch.cat([noise[:, :, later:], self._noise(given, generator)[:, :, :later]], dim=2),
            torch.cat([given.previous[:, :, later:], first[:, :, :later]], dim=2),
            given.embedding, given.batch.motion, advanced(given.phases, later),
        )  # fmt: skip
        difference = again[:, 0, : again.shape[2] - later] - first[:, 0, later:]
        shift = weighted_mean((difference.square().mean(dim=1) + _SMALL).sqrt(), given.steadiness)
        return loss + _SHIFT_WEIGHT * shift

    @staticmethod
    def _condition_at(given: ScaledBatch, sample: int) -> tuple[Tensor, Tensor, Tensor]:
        """Embedding, motion and phases as they are at a sample of the segment."""
        return given.embedding, motion_at(given.batch.motion_path, sample), with_rates_at(given.phases, sample)

    @staticmethod
    def _noise(given: ScaledBatch, generator: torch.Generator) -> Tensor:
        return torch.randn(given.segment.shape, generator=generator)
