"""Networks of evaluated runs: rivals and latents in a model, and the average velocity."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from haptoflow_paper.codec.representation import Representation
from haptoflow_paper.rivals.rival import SegmentNetwork
from haptoflow_paper.runs.velocity_field import FieldModel, TimeEncoder, VelocityField


class EvaluatedModel(FieldModel):
    """A model whose network may be a rival, or work on the latents of a codec."""

    field: VelocityField | SegmentNetwork  # type: ignore[assignment]

    def __init__(
        self,
        *,
        wave_vectors: Sequence[Sequence[tuple[float, float]]],
        representation: Representation,
        level: nn.Module,
        field: VelocityField | SegmentNetwork,
        specimens: int = 0,
    ) -> None:
        super().__init__(
            wave_vectors=wave_vectors, level=level, field=field, specimens=specimens  # type: ignore[arg-type]
        )
        self.representation = representation
        self.shape = representation.shape

    def encode(self, waveform: Tensor) -> Tensor:
        return self.representation.encode(waveform)

    def decode(self, encoded: Tensor) -> Tensor:
        return self.representation.decode(encoded)

    def start(self, noise: Tensor) -> Tensor:
        # A latent has another shape than a waveform, so its noise is drawn here.
        return torch.randn(len(noise), *self.shape) if self.representation.is_latent else noise

    def one_step(
        self, noise: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor
    ) -> Tensor:
        if isinstance(self.field, SegmentNetwork):
            return self.field(noise, previous, embedding, motion, phases)
        return super().one_step(noise, previous, embedding, motion, phases)


class AverageVelocityField(VelocityField):
    """The average velocity over [t, t + interval] (MeanFlow), interval [B, 1]; without interval, the velocity."""

    def _encode_time(self) -> None:
        super()._encode_time()
        self.interval = TimeEncoder()

    def forward(
        self,
        noisy: Tensor,
        time: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor | None = None,
        interval: Tensor | None = None,
    ) -> Tensor:
        moment = self.time(time)
        if interval is not None:
            moment = moment + self.interval(interval)
        return self.velocity(noisy, moment, previous, embedding, motion, phases)
