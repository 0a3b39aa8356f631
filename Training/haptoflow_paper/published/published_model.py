"""What a published checkpoint computes, stage by stage (units: the peak of its data set, and 2 kHz)."""

from __future__ import annotations

from collections.abc import Sequence

import onnx
import torch
from torch import Tensor, nn

from haptoflow_paper.codec.encodec import ENCODEC_RATE_HZ, FRAME_SAMPLES, EnCodec, fold_weight_norm
from haptoflow_paper.published.labels import EmbeddingRows
from haptoflow_paper.published.meta_file import CONTROLS, PublishedMeta
from haptoflow_paper.published.network import NetworkSizes, PublishedNetwork, ResidualQuantiser, SincResampler, TimeCode
from haptoflow_training.export.trained_tier import export_graph
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
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


_BATCH = 2


class _Encoder(nn.Module):
    def __init__(self, model: PublishedModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, waveform: Tensor) -> Tensor:
        return self.model.encode(waveform)


class _Decoder(nn.Module):
    def __init__(self, model: PublishedModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, latent: Tensor) -> Tensor:
        return self.model.decode(latent)


class _Field(nn.Module):
    """The velocity with the file's time, embedding and past; the order of the arguments is the graph's."""

    def __init__(self, model: PublishedModel, rows: EmbeddingRows, guidance: float) -> None:
        super().__init__()
        self.model, self.rows, self.guidance = model, rows, guidance

    def forward(
        self,
        noisy: Tensor,
        time: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        interval: Tensor | None = None,
    ) -> Tensor:
        left = 1.0 - time if interval is None else 1.0 - time - 0.5 * interval
        condition = self.model.condition(self.rows(embedding), motion)
        past = self.model.past_features(previous)
        return -self.model.velocity(noisy, left, condition, past, self.guidance)


class _ConstantLevel(nn.Module):
    """The same level for every label: the network's output has one unit for all materials, and this is that unit."""

    def __init__(self, log_level: float) -> None:
        super().__init__()
        self.log_level = log_level

    def forward(self, motion: Tensor) -> Tensor:
        return torch.full_like(motion[:, :1], self.log_level)


def encoder_graph(model: PublishedModel) -> bytes:
    """`waveform` [B, 1, 200] to `latent`."""
    waveform = torch.zeros(_BATCH, 1, SEGMENT_SAMPLES)
    return _with_shape(export_graph(_Encoder(model), {"waveform": waveform}, "latent"), model.latent_shape)


def decoder_graph(model: PublishedModel) -> bytes:
    """`latent` to `waveform` [B, 1, 200]."""
    latent = torch.zeros(_BATCH, *model.latent_shape)
    return _with_shape(export_graph(_Decoder(model), {"latent": latent}, "waveform"), (1, SEGMENT_SAMPLES))


def field_graph(model: PublishedModel, rows: EmbeddingRows, guidance: float) -> bytes:
    """The velocity field of a tier whose solver is the checkpoint's."""
    latent = torch.zeros(_BATCH, *model.latent_shape)
    moment = torch.zeros(_BATCH, 1)
    inputs = {
        "noisy": latent,
        "time": moment,
        "previous": latent.clone(),
        "embedding": torch.zeros(_BATCH, EMBEDDING_SIZE),
        "motion": torch.full((_BATCH, 3), 0.1),
        **({"interval": moment.clone()} if model.meta.solver == "euler" else {}),
    }
    return _with_shape(export_graph(_Field(model, rows, guidance), inputs, "velocity"), model.latent_shape)


def _with_shape(graph: bytes, shape: tuple[int, int]) -> bytes:
    """The graph with its output's shape, which the exporter does not infer after slices."""
    model = onnx.load_from_string(graph)
    for dimension, size in zip(model.graph.output[0].type.tensor_type.shape.dim[1:], shape, strict=True):
        dimension.dim_value = size
    onnx.checker.check_model(model, full_check=True)
    return model.SerializeToString()


def level_graph(log_level: float) -> bytes:
    """`motion` [B, 3] to `log_level` [B, 1], the same for every motion and label."""
    return export_graph(_ConstantLevel(log_level), {"motion": torch.full((_BATCH, 3), 0.1)}, "log_level")
