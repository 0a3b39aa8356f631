"""The losses of a training step on one batch, by objective: `level` or `energy`."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from haptoflow_training.models.haptoflow_model import Condition, HaptoFlowModel
from haptoflow_training.models.label_embedding import rib_frequencies_hz, surface_phases
from haptoflow_training.models.level_model import level_loss, scaled_previous
from haptoflow_training.models.rib_comb import PARTIALS
from haptoflow_training.training.batches import Chain, SegmentBatch
from haptoflow_training.training.energy_distance import energy_distance_loss, envelopes, halves_of, spectra
from haptoflow_training.training.label_balance import LabelBalance, label_features

_BALANCE_WEIGHT = 2.0
# Power of a past in unit scale, and change of the log level within a segment, beyond which the segment weighs less.
_LOUD_PAST, _UNSTEADY_LOG_LEVEL = 4.0, 0.4


@dataclass(frozen=True)
class ScaledBatch:
    """A batch in unit scale, as the model encodes it.

    log_level [B, 1]: of the condition, without gradient. segment and previous [B, *shape]; recorded_previous: [B, 1, 200], which `previous` is but for a chain of the
    network's own output; phases [B, 6]; power [B]: mean square of the segment, at least 1; unsteadiness
    [B]: the largest deviation of the log level within the segment from that of the condition.
    """

    batch: SegmentBatch
    embedding: Tensor
    log_level: Tensor
    segment: Tensor
    previous: Tensor
    recorded_previous: Tensor
    phases: Tensor
    power: Tensor
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
        return loudness.rsqrt() / (1.0 + (self.unsteadiness / _UNSTEADY_LOG_LEVEL).pow(4))


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
        return level_loss(self.model.level(embedding, batch.level_motion), batch.level_mean_square_mps2)

    def _scaled(self, batch: SegmentBatch, objective: str, generator: torch.Generator) -> ScaledBatch:
        model = self.model
        embedding = model.embedding(batch.label, batch.specimen)
        # The field works in unit scale; its loss must not move the level to make the task easier.
        log_level = model.level(embedding, batch.motion).detach()
        steady_segment, unsteadiness = self._steady_segment(batch, embedding)
        segment = model.encode(steady_segment)
        recorded_previous = scaled_previous(batch.previous, log_level)
        previous = recorded_previous
        if batch.chain is not None:
            own_previous = self.render_chain(batch.chain, embedding.detach(), objective, generator)
            previous = scaled_previous(own_previous, log_level)
        # Bursts that the level cannot predict (an impact, the first motion after a rest) are learnt, but must not
        # outweigh a hundred ordinary segments.
        power = segment.square().mean(dim=(1, 2)).clamp(min=1.0)
        return ScaledBatch(
            batch=batch,
            embedding=embedding,
            log_level=log_level,
            segment=segment,
            previous=model.encode(previous),
            recorded_previous=recorded_previous,
            phases=self.phases(batch, embedding),
            power=power,
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
        """Generates two independent segments for each row, in one step each. Returns the noise of the first, then both."""
        # Both in one pass: few large matrix products are faster than many small ones.
        noise = torch.randn(2 * len(given.segment), *given.segment.shape[1:], generator=generator)
        condition = [torch.cat([part, part]) for part in given.condition]
        first, second = self.model.one_step(noise, *condition).chunk(2)
        return noise[: len(first)], first, second

    def one_step_loss(self, given: ScaledBatch, drawn: tuple[Tensor, Tensor]) -> Tensor:
        """The energy loss of a recording and two draws, [B, 1, 200] each, in unit scale."""
        batch, embedding = given.batch, given.embedding
        weight = given.steadiness
        recorded = given.segment
        segments = [wave.squeeze(1) for wave in (recorded, *drawn)]
        true = given.recorded_previous.squeeze(1), segments[0]
        # Both draws in one pass here, too.
        own = torch.cat([given.previous, given.previous]).squeeze(1), torch.cat(segments[1:])
        all_spectra = [spectra(*true), *halves_of(spectra(*own))]
        shapes = [envelopes(*true), *zip(*(shape.chunk(2) for shape in envelopes(*own)), strict=True)]
        partials, audible = self._partials(batch, (recorded, *drawn), given.phases)
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
            label_features(spectrum, ribs_hz, partial, audible, segment)
            for spectrum, partial, segment in zip(all_spectra, partials, segments, strict=True)
        ]
        speed_mps = batch.motion[:, 0:2].norm(dim=1)
        balance = self._balance.loss(batch.label, speed_mps, features[0], (features[1], features[2]), weight)
        return loss + _BALANCE_WEIGHT * balance

    def _partials(
        self, batch: SegmentBatch, segments: tuple[Tensor, ...], phases: Tensor
    ) -> tuple[list[Tensor], Tensor]:
        """For each segment, its partials [B, 2, P] relative to the ribs; and a mask [B, P] of those that one
        segment can resolve. Both are zero for a network without ribs."""
        comb = self.model.comb
        if comb is None:
            nothing = torch.zeros(len(batch.label), 2, PARTIALS)
            return [nothing] * len(segments), nothing[:, 0]
        profiles, resolved = comb.profile(phases, torch.cat(segments, dim=1))
        recorded, *drawn = profiles.unbind(dim=1)
        return [recorded.detach(), *drawn], resolved

    @torch.no_grad()
    def render_chain(self, chain: Chain, embedding: Tensor, objective: str, generator: torch.Generator) -> Tensor:
        """The previous waveform [B, 1, 200] in m/s^2 after the chain's hops, rendered by the network itself."""
        model, previous = self.model, chain.start
        for hop in range(chain.motion.shape[1]):
            where = chain.motion[:, hop], chain.position_mm[:, hop], chain.wander[:, hop]
            segment = self.generate(previous, embedding, *where, objective, generator)
            appended = segment[:, :, : chain.hop_samples]
            previous = torch.cat([previous[:, :, appended.shape[2] :], appended], dim=2)
        return previous

    @torch.no_grad()
    def generate(
        self,
        previous_mps2: Tensor,
        embedding: Tensor,
        motion: Tensor,
        position_mm: Tensor,
        wander: Tensor,
        objective: str,
        generator: torch.Generator,
    ) -> Tensor:
        """One segment [B, 1, 200] in m/s^2, generated in the way the objective's tier is run."""
        model = self.model
        phases = surface_phases(embedding, motion, position_mm, wander)
        log_level = model.level(embedding, motion)
        previous = model.encode(scaled_previous(previous_mps2, log_level))
        noise = torch.randn(len(embedding), *model.shape, generator=generator)
        made = self.drawn(objective, noise, (previous, embedding, motion, phases))
        return model.decode(made) * torch.exp(log_level).unsqueeze(-1)

    def drawn(self, objective: str, noise: Tensor, condition: Condition) -> Tensor:
        """The segment [B, *shape] that the network of an objective makes of noise. condition: previous, embedding,
        motion, phases."""
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
