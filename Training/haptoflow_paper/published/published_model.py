"""What a published checkpoint computes, stage by stage (units: the peak of its data set, and 2 kHz)."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from haptoflow_paper.codec.causal_layers import fold_weight_norm
from haptoflow_paper.codec.encodec import ENCODEC_RATE_HZ, FRAME_SAMPLES, EnCodec
from haptoflow_paper.published.meta_file import CONTROLS, PublishedMeta
from haptoflow_paper.published.network import NetworkSizes, PublishedNetwork, TimeCode
from haptoflow_paper.published.residual_quantiser import ResidualQuantiser
from haptoflow_paper.published.sinc_resampler import SincResampler
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

LATENT_POSITIONS = -(-SEGMENT_SAMPLES * ENCODEC_RATE_HZ // SAMPLE_RATE_HZ // FRAME_SAMPLES)


class PublishedModel(nn.Module):
    """Encoder, velocity field and decoder. Time runs from 1, noise, to 0, data, as the checkpoint's own does."""

    means: Tensor
    deviations: Tensor

    def __init__(
        self,
        meta: PublishedMeta,
        sizes: NetworkSizes,
        network: PublishedNetwork,
        codec: EnCodec,
        quantiser: ResidualQuantiser,
    ) -> None:
        super().__init__()
        fold_weight_norm(codec)
        self.meta, self.sizes = meta, sizes
        self.network, self.codec, self.quantiser = network, codec, quantiser
        self.time_code = TimeCode(sizes.time)
        self.upwards = SincResampler(SAMPLE_RATE_HZ, ENCODEC_RATE_HZ)
        self.downwards = SincResampler(ENCODEC_RATE_HZ, SAMPLE_RATE_HZ)
        statistics = [meta.controls[name] for name in CONTROLS]
        self.register_buffer("means", torch.tensor([each.mean for each in statistics]), persistent=False)
        self.register_buffer("deviations", torch.tensor([each.deviation for each in statistics]), persistent=False)
        self.requires_grad_(False).eval()

    @property
    def latent_shape(self) -> tuple[int, int]:
        return self.sizes.latent, LATENT_POSITIONS

    def encode(self, waveform: Tensor) -> Tensor:
        """A segment [B, 1, 200] to its latent before quantisation, [B, L, 8]."""
        return self.codec.encode(self.upwards(waveform))

    def past_features(self, latent: Tensor) -> list[Tensor]:
        """The past's latent [B, L, 8] to [B, C0, 4], [B, C1, 2], ..."""
        return self.network.prev_segment_encoder(latent)

    def condition(self, labels: Tensor, motion: Tensor) -> Tensor:
        """Rows of the label embedding [B, label] and motions [B, 3] (vx, vy in m/s, force in N) to [B, label +
        control]."""
        controls = torch.cat([motion[:, 2:], motion[:, :2]], dim=1)
        scores = (controls - self.means) / self.deviations
        return torch.cat([labels, self.network.control_embedding(scores)], dim=1)

    def velocity(
        self, point: Tensor, time: Tensor, condition: Tensor, past: Sequence[Tensor], guidance: float
    ) -> Tensor:
        """Noise minus data at a point [B, L, 8] and times [B, 1], with classifier-free guidance (Ho and Salimans 2022):
        v0 + w (v1 - v0), where v0 does not know label and motion.

        Both are evaluated in one batch.
        """
        unet, code = self.network.model["backbone"], self.time_code(time)
        if guidance == 1.0:
            return unet(point, torch.cat([condition, code], dim=1), past)
        conditions = torch.cat([torch.cat([torch.zeros_like(condition), condition]), torch.cat([code, code])], dim=1)
        both = unet(torch.cat([point, point]), conditions, [torch.cat([each, each]) for each in past])
        # A fixed number of halves instead of a fixed batch, so that an exported graph takes any batch.
        halves = both.reshape(2, -1, *self.latent_shape)
        return halves[0] + guidance * (halves[1] - halves[0])

    def decode(self, latent: Tensor) -> Tensor:
        """A generated latent [B, L, 8] to its segment [B, 1, 200]."""
        frames = self.codec.decoder(self.quantiser(latent))
        return self.downwards(frames)[..., :SEGMENT_SAMPLES]

    def generate(self, noise: Tensor, condition: Tensor, past: Sequence[Tensor]) -> Tensor:
        """Noise [B, L, 8] to a latent, with the solver, the steps and the guidance of the checkpoint."""
        point, steps = noise, self.meta.steps
        length = 1.0 / steps

        def field(at: Tensor, moment: float) -> Tensor:
            return self.velocity(at, torch.full((len(at), 1), moment), condition, past, self.meta.guidance)

        for step in range(steps):
            begin = 1.0 - step / steps
            if self.meta.solver == "heun":
                first = field(point, begin)
                second = field(point - length * first, 1.0 - (step + 1) / steps)
                point = point - 0.5 * length * (first + second)
            else:
                # The checkpoint's "euler" takes the middle's time at the beginning's point.
                point = point - length * field(point, begin - 0.5 * length)
        return point

    def segment(self, noise: Tensor, labels: Tensor, motion: Tensor, previous: Tensor) -> Tensor:
        """Noise [B, L, 8], rows of labels, motions and previous segments [B, 1, 200] to segments [B, 1, 200]."""
        past = self.past_features(self.encode(previous))
        return self.decode(self.generate(noise, self.condition(labels, motion), past))
