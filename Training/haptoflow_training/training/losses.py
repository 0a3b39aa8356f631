"""The losses of a training step on one batch, by objective: `level` or `energy`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from haptoflow_training.models.haptoflow_model import Condition, HaptoFlowModel, SkeletonModel
from haptoflow_training.models.label_embedding import (
    FAMILIES, MINIMUM_HZ, WAVE_VECTORS, advanced, path_of, rib_frequencies_hz, surface_path, surface_phases,
    with_path, with_rates_at
)
from haptoflow_training.models.level_model import level_loss, scaled_previous
from haptoflow_training.models.all_pole_filter import prediction_errors
from haptoflow_training.models.rib_comb import PARTIALS
from haptoflow_training.models.skeleton import LIKELIHOOD_END, ORDER, SkeletonGains
from haptoflow_training.training.batches import LEVEL_WINDOW_KNOTS, Chain, SegmentBatch
from haptoflow_training.training.energy_distance import (
    LabelBalance, energy_distance_loss, energy_score, envelope_distance, envelopes, halves_of, label_features, spectra
)
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

_BALANCE_WEIGHT = 2.0
# Power of a past in unit scale, and change of the log level within a segment, beyond which the segment weighs less.
_LOUD_PAST, _UNSTEADY_LOG_LEVEL = 4.0, 0.4
# A window of the level weighs half where its log speed changes by this much. So many m/s are added to each speed first,
# because a tracker's noise alone changes a slow one.
_UNSTEADY_LOG_SPEED, _UNCERTAIN_MPS = 0.3, 0.002


@dataclass(frozen=True)
class ScaledBatch:
    """A batch in unit scale, as the model encodes it.

    log_level [B, 1]: of the condition, without gradient. segment [B, *shape]; previous: what it continues (models/
    haptoflow_model.py, `Condition`); recorded_previous [B, 1, 200], which all of `previous` is but for a chain of the
    network's own output; noise_before [2 * B, channels, before]: of the first draw and of the second; phases [B, 6];
    unsteadiness [B]: the largest deviation of the log level within the segment from that of the condition.
    """

    batch: SegmentBatch
    embedding: Tensor
    log_level: Tensor
    segment: Tensor
    previous: Tensor
    recorded_previous: Tensor
    noise_before: Tensor
    phases: Tensor
    unsteadiness: Tensor

    @property
    def condition(self) -> Condition:
        return self.previous, self.embedding, self.batch.motion, self.phases

    @property
    def steadiness(self) -> Tensor:
        """[B]: the weight of a segment, from what is known before it: near 1 where the level changes by less than a few
        decibels and the past is about as loud as the level predicts. In unit scale, a stop or a start looks like an
        impact. A weight that depended on the segment itself would bias the network towards fewer impacts than
        recorded."""
        loudness = (self.recorded_previous.square().mean(dim=(1, 2)) / _LOUD_PAST).clamp(min=1.0)
        return loudness.rsqrt() / weakening(self.unsteadiness, _UNSTEADY_LOG_LEVEL)


class Losses(nn.Module):
    """Level and field loss in one forward pass, so that several processes synchronise all gradients at once.

    train_level: False for a tier that shares another run's level. balance: running averages by label; without it, as in
    validation, the energy objective is the energy distance alone. ribs_followed: as of the store.
    """

    def __init__(
        self,
        model: HaptoFlowModel,
        *,
        train_level: bool = True,
        balance: LabelBalance | None = None,
        ribs_followed: bool = False,
    ) -> None:
        super().__init__()
        self.ribs_followed = ribs_followed
        self.model = model
        self._train_level = train_level
        self._balance = balance

    def forward(self, batch: SegmentBatch, objective: str, generator: torch.Generator) -> tuple[Tensor, Tensor]:
        level = self.level_loss(batch)
        if objective == "level":
            return level, torch.zeros(())
        return level, self.field_loss(self._scaled(batch, objective, generator), objective, generator)

    def level_loss(self, batch: SegmentBatch) -> Tensor:
        if not self._train_level:
            return torch.zeros(())
        embedding = self.model.embedding(batch.label, batch.specimen)
        losses = level_loss(self.model.level(embedding, batch.level_motion), batch.level_mean_square_mps2)
        return weighted_mean(losses.squeeze(1), steady_speed(batch.motion_path[:, :LEVEL_WINDOW_KNOTS]))

    def _scaled(self, batch: SegmentBatch, objective: str, generator: torch.Generator) -> ScaledBatch:
        model = self.model
        embedding = model.embedding(batch.label, batch.specimen)
        # The field works in unit scale; its loss must not move the level to make the task easier.
        log_level = model.level(embedding, batch.motion).detach()
        steady_segment, unsteadiness = self._steady_segment(batch, embedding)
        segment = model.encode(steady_segment)
        recorded_previous = scaled_previous(batch.previous, log_level)
        previous = recorded_previous.expand(-1, model.pasts, -1)
        noise_before = torch.randn(2 * len(embedding), model.shape[0], model.noise_before, generator=generator)
        if batch.chain is not None:
            own_previous, own_noise = self.render_chain(batch.chain, embedding.detach(), objective, generator)
            previous = scaled_previous(own_previous, log_level)
            noise_before = torch.cat([own_noise, own_noise])
        return ScaledBatch(
            batch=batch,
            embedding=embedding,
            log_level=log_level,
            segment=segment,
            previous=model.encode(previous),
            recorded_previous=recorded_previous,
            noise_before=noise_before,
            phases=self.phases(batch, embedding),
            unsteadiness=unsteadiness,
        )

    def phases(self, batch: SegmentBatch, embedding: Tensor) -> Tensor:
        """The phases of the batch's segments, as the network is given them."""
        return surface_phases(embedding, batch.motion, batch.position_mm, batch.wander)

    def field_loss(self, given: ScaledBatch, objective: str, generator: torch.Generator) -> Tensor:
        """The network's loss by one objective, a scalar."""
        _, first, second = self.two_draws(given, generator)
        return self.one_step_loss(given, (first, second))

    def two_draws(self, given: ScaledBatch, generator: torch.Generator) -> tuple[Tensor, Tensor, Tensor]:
        """Generates two independent segments for each row, in one step each. Returns the noise of the first, then both
        as of `HaptoFlowModel.one_step`."""
        # Both in one pass: few large matrix products are faster than many small ones.
        noise = self.noise_after(given.noise_before, generator)
        condition = [torch.cat([part, part]) for part in given.condition]
        first, second = self.model.one_step(noise, *condition).chunk(2)
        return noise[: len(first)], first, second

    def noise_after(self, before: Tensor, generator: torch.Generator) -> Tensor:
        """The noise of a segment [n, channels, before + positions], after the noise before it."""
        fresh = torch.randn(len(before), *self.model.shape, generator=generator)
        return torch.cat([before, fresh], dim=2)

    def one_step_loss(
        self, given: ScaledBatch, drawn: tuple[Tensor, Tensor], driving: Sequence[Tensor] | None = None
    ) -> Tensor:
        """The energy loss of a recording and two draws as of `two_draws`, in unit scale. driving: what drives a filter
        in each of the three, [B, N], if one does; moments are compared there, too."""
        batch, embedding = given.batch, given.embedding
        weight = given.steadiness
        segments = [wave[:, 0] for wave in (given.segment, *drawn)]
        true = given.recorded_previous.squeeze(1), segments[0]
        # Both draws in one pass here, too.
        own = torch.cat([given.previous[:, 0]] * 2), torch.cat(segments[1:])
        all_spectra = [spectra(*true), *halves_of(spectra(*own))]
        shapes = [envelopes(*true), *zip(*(shape.chunk(2) for shape in envelopes(*own)), strict=True)]
        partials, audible = self._partials(torch.stack(segments, dim=1), given.phases)
        loss = energy_distance_loss(
            all_spectra[0],
            (all_spectra[1], all_spectra[2]),
            weight,
            waves=None if batch.chain is not None else tuple(segments),
            lines=tuple(partials),
            envelopes=(shapes[0], list(shapes[1]), list(shapes[2])),
        )
        if self._balance is None:
            return loss
        ribs_hz = rib_frequencies_hz(embedding.detach(), batch.motion).squeeze(2)
        features = [
            label_features(spectrum, ribs_hz, partial, audible, segment, driven)
            for spectrum, partial, segment, driven in zip(
                all_spectra, partials, segments, driving or [None] * len(segments), strict=True
            )
        ]
        speed_mps = batch.motion[:, 0:2].norm(dim=1)
        balance = self._balance.loss(batch.label, speed_mps, features[0], (features[1], features[2]), weight)
        return loss + _BALANCE_WEIGHT * balance

    def _partials(self, segments: Tensor, phases: Tensor) -> tuple[list[Tensor], Tensor]:
        """For each segment of [B, S, 200], its partials [B, 2, P] relative to the ribs; and a mask [B, P] of those that
        one segment can resolve. Both are zero for a network without ribs."""
        comb = self.model.comb
        if comb is None:
            nothing = torch.zeros(len(segments), 2, PARTIALS)
            return [nothing] * segments.shape[1], nothing[:, 0]
        profiles, resolved = comb.profile(phases, segments)
        recorded, *drawn = profiles.unbind(dim=1)
        return [recorded.detach(), *drawn], resolved

    @torch.no_grad()
    def render_chain(
        self, chain: Chain, embedding: Tensor, objective: str, generator: torch.Generator
    ) -> tuple[Tensor, Tensor]:
        """What is continued after the chain's hops, [B, pasts, 200] in m/s^2, rendered by the network itself; and the
        noise before [B, channels, before]."""
        model, hop = self.model, chain.hop_samples
        previous = chain.start.expand(-1, model.pasts, -1)
        before = torch.randn(len(embedding), model.shape[0], model.noise_before, generator=generator)
        noise = self.noise_after(before, generator)
        for step in range(chain.motion.shape[1]):
            where = chain.motion[:, step], chain.position_mm[:, step], chain.wander[:, step]
            segment = self.generate(previous, noise, embedding, *where, objective)
            previous = torch.cat([previous[:, :, hop:], segment[:, :, :hop]], dim=2)
            noise = self.later_noise(noise, hop, generator)
        return previous, noise[:, :, : model.noise_before]

    def later_noise(self, noise: Tensor, samples: int, generator: torch.Generator) -> Tensor:
        """The noise of a segment that begins so many samples later."""
        return torch.randn(noise.shape, generator=generator)

    @torch.no_grad()
    def generate(
        self,
        previous_mps2: Tensor,
        noise: Tensor,
        embedding: Tensor,
        motion: Tensor,
        position_mm: Tensor,
        wander: Tensor,
        objective: str,
    ) -> Tensor:
        """One segment, and what goes on beneath it, [B, pasts, 200] in m/s^2, generated in the way the objective's tier
        is run."""
        model = self.model
        phases = surface_phases(embedding, motion, position_mm, wander)
        log_level = model.level(embedding, motion)
        previous = model.encode(scaled_previous(previous_mps2, log_level))
        made = self.drawn(objective, noise, (previous, embedding, motion, phases))
        return model.decode(made) * torch.exp(log_level).unsqueeze(-1)

    def drawn(self, objective: str, noise: Tensor, condition: Condition) -> Tensor:
        """What the network of an objective makes of noise, as `HaptoFlowModel.one_step`. condition: previous,
        embedding, motion, phases."""
        return self.model.one_step(noise, *condition)

    def _steady_segment(self, batch: SegmentBatch, embedding: Tensor) -> tuple[Tensor, Tensor]:
        """The segment in unit scale, as if the motion continued as it began: each sample is divided by the level at
        its time, because the next 100 ms of motion are unknown at run time. Also the largest deviation of the log
        level within the segment from that of the condition, [B]."""
        rows, knots, _ = batch.motion_path.shape
        path = batch.motion_path.reshape(rows * knots, 3)
        with torch.no_grad():
            log_level = self.model.level(embedding.repeat_interleave(knots, dim=0), path).reshape(rows, 1, knots)
            condition_level = self.model.level(embedding, batch.motion).unsqueeze(1)
            unsteadiness = (log_level - condition_level).abs().amax(dim=(1, 2))
        samples = batch.segment.shape[-1]
        log_level = nn.functional.interpolate(log_level, size=samples, mode="linear", align_corners=True)
        return batch.segment * torch.exp(-log_level), unsteadiness


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


def weakening(change: Tensor, limit: float) -> Tensor:
    """The number by which the weight of a window is divided: 1 where nothing changes in it, 2 where the change is as large
    as the limit. What a window with a change sounds like belongs to no single condition."""
    return 1.0 + (change / limit).pow(4)


def steady_speed(motion_path: Tensor) -> Tensor:
    """[B]: how much windows with the motions [B, K, 3] count in the level's loss: 1 at a constant speed, less where the
    speed changes. In a reversal the mean velocity is small although the tip moves fast, so that such windows would teach
    that slow motion is loud. The weight depends on the motion alone: loud and quiet windows of one motion count alike,
    and the level has no bias."""
    speed = motion_path[:, :, 0:2].norm(dim=2) + _UNCERTAIN_MPS
    change = (speed.amax(dim=1) / speed.amin(dim=1)).log()
    return 1.0 / weakening(change, _UNSTEADY_LOG_SPEED)


def weighted_mean(values: Tensor, weight: Tensor) -> Tensor:
    """Of [B] each."""
    return (weight * values).sum() / (weight.sum() + _SMALL)


# Samples by which the second pass of the shift's loss is begun later: up to the hop of an update at 72 Hz.
_MAXIMUM_SHIFT = 27
_SHIFT_WEIGHT = 1.0
# What drives the filter is compared from this sample of a segment on: errors of prediction need the samples before
# them, and envelopes whole frames.
_DRIVEN_FROM = 40
_DRIVING_WEIGHT = 1.0


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
        segment, weight = with_floor(given.segment, given.log_level, generator), audible(given.log_level)
        if objective == "filter":
            still = without_waves(given.phases[:, FAMILIES : 2 * FAMILIES])
            amid = self._condition_at(given, SEGMENT_SAMPLES // 2)
            return weighted_mean(skeleton.filter_distance(segment, *amid), weight * still)
        amid = self._condition_at(given, (ORDER + LIKELIHOOD_END) // 2)
        gains = skeleton.gains(*amid)
        likelihood = weighted_mean(skeleton.likelihood(segment, gains, given.phases), weight)
        likelihood = likelihood + weighted_mean(skeleton.tail_likelihood(segment, gains, given.phases), weight)
        if objective == "likelihood":
            return likelihood
        # The energy distance would only blur the filter and what the embedding says of it.
        gains = skeleton.gains(given.embedding.detach(), given.batch.motion, given.phases)
        drawn = tuple(
            skeleton.parts(self.noise_after(before, generator), given.previous[:, 1:], gains, given.phases).segment
            for before in given.noise_before.chunk(2)
        )
        driving = [self._driving(segment, gains) for segment in (given.segment, *drawn)]
        one_step = self.one_step_loss(given, (drawn[0], drawn[1]), driving)
        return likelihood + one_step + _DRIVING_WEIGHT * self._driving_loss(given, driving)

    @staticmethod
    def _driving(segment: Tensor, gains: SkeletonGains) -> Tensor:
        """[B, 160]: what drives the filter where it makes a segment [B, 1, 200], in unit scale. There an impulse is
        short and stands out; behind a filter that resonates, its strength hardly shows."""
        errors = prediction_errors(segment[:, 0, _DRIVEN_FROM - ORDER :], gains.coefficients.detach())
        return errors * torch.exp(-gains.log_drive.detach())

    @staticmethod
    def _driving_loss(given: ScaledBatch, driving: Sequence[Tensor]) -> Tensor:
        """The energy distance of the envelopes of what drives the filter: of the recording and of two draws."""
        recorded, first, second = (envelopes(each[:, :0], each) for each in driving)
        return weighted_mean(energy_score(recorded, (first, second), envelope_distance), given.steadiness)

    def _refinement_loss(self, given: ScaledBatch, generator: torch.Generator) -> Tensor:
        model = self.model
        noise, first, second = self.two_draws(given, generator)
        loss = self.one_step_loss(given, (first, second))
        later = int(torch.randint(1, _MAXIMUM_SHIFT + 1, (1,), generator=generator))
        again = model.one_step(
            self.later_noise(noise, later, generator),
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

    def later_noise(self, noise: Tensor, samples: int, generator: torch.Generator) -> Tensor:
        """It goes on: the noise belongs to the place."""
        fresh = torch.randn(*noise.shape[:2], samples, generator=generator)
        return torch.cat([noise[:, :, samples:], fresh], dim=2)
