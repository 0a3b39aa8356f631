"""The published network in modules of our own: label, control, time, features of the past, U-Net with FiLM.

Names of parameters are those of the checkpoint, so that it loads as it is. Layers and their order are facts of the
published model (arXiv 2608.01974 and its repository); sizes come from the tensors of a checkpoint.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor, nn

_SCALES = (0.5, 1.0, 2.0, 4.0)
_LONGEST_PERIOD = 10_000.0
_KERNEL = 3
_UP_KERNEL = 4


@dataclass(frozen=True)
class NetworkSizes:
    """channels: of each level of the U-Net. latent: channels of the codec's latent. position: of the code of a place in
    the past. label, control, time: of the three parts of the condition. hidden: of the control's perceptron."""

    classes: int
    latent: int
    channels: tuple[int, ...]
    label: int
    control: int
    hidden: int
    time: int
    position: int
    groups: int
    past_groups: int


def group_norm(channels: int, groups: int) -> nn.GroupNorm:
    """Of the most groups, at most `groups`, that divide the channels."""
    return nn.GroupNorm(max(count for count in range(1, groups + 1) if channels % count == 0), channels)


class LabelEmbedding(nn.Module):
    """Rows of the classes, [B] to [B, label]."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        self.emb = nn.Embedding(sizes.classes, sizes.label)

    def forward(self, labels: Tensor) -> Tensor:
        return self.emb(labels)


class ControlEmbedding(nn.Module):
    """z-scores of force, velocity x, velocity y, [B, 3], with their sines and cosines to [B, control]."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        inputs = 3 * (1 + 2 * len(_SCALES))
        self.net = nn.Sequential(
            nn.Linear(inputs, sizes.hidden), nn.SiLU(), nn.Linear(sizes.hidden, sizes.control)
        )

    def forward(self, scores: Tensor) -> Tensor:
        angles = [2.0 * math.pi * scale * scores for scale in _SCALES]
        waves = [wave for angle in angles for wave in (torch.sin(angle), torch.cos(angle))]
        return self.net(torch.cat([scores, *waves], dim=-1))


class TimeCode(nn.Module):
    """Times [B, 1] to sines and cosines at geometric rates, [B, size]."""

    rates: Tensor

    def __init__(self, size: int) -> None:
        super().__init__()
        half = size // 2
        exponents = torch.arange(half, dtype=torch.float32) / max(1, half - 1)
        self.register_buffer("rates", torch.exp(-math.log(_LONGEST_PERIOD) * exponents), persistent=False)

    def forward(self, time: Tensor) -> Tensor:
        angles = time * self.rates
        return torch.cat([torch.sin(angles), torch.cos(angles)], dim=-1)


class PastFeatures(nn.Module):
    """Latent of the past [B, L, P] to a feature for each level of the U-Net: [B, C0, P / 2], [B, C1, P / 4], ..."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        self.pos_proj = nn.Linear(sizes.position, sizes.latent)
        inputs = (sizes.latent, *sizes.channels[:-1])
        self.encoder = nn.ModuleList(
            nn.Sequential(
                nn.Conv1d(before, after, _KERNEL, stride=2, padding=1), group_norm(after, sizes.past_groups), nn.SiLU()
            )
            for before, after in zip(inputs, sizes.channels, strict=True)
        )

    def forward(self, latent: Tensor) -> list[Tensor]:
        multiple = 2 ** len(self.encoder)
        feature = nn.functional.pad(latent, (0, -int(latent.shape[-1]) % multiple))
        feature = feature + self.pos_proj(self._positions(int(feature.shape[-1]))).transpose(0, 1)
        features = []
        for layer in self.encoder:
            feature = layer(feature)
            features.append(feature)
        return features

    def _positions(self, count: int) -> Tensor:
        """The code of `count` places from 0 (oldest) to 1, [count, position]."""
        size = self.pos_proj.in_features
        place = torch.arange(size)
        periods = _LONGEST_PERIOD ** (2.0 * torch.div(place, 2, rounding_mode="floor") / size)
        values = torch.linspace(0.0, 1.0, count)[:, None] / periods
        return torch.where(place % 2 == 0, torch.sin(values), torch.cos(values))


class FeatureScaling(nn.Module):
    """FiLM (Perez et al. 2018): h (1 + scale) + shift, both from the condition."""

    def __init__(self, condition: int, channels: int) -> None:
        super().__init__()
        self.to_scale_shift = nn.Linear(condition, 2 * channels)

    def forward(self, feature: Tensor, condition: Tensor) -> Tensor:
        scale, shift = self.to_scale_shift(condition).unsqueeze(-1).chunk(2, dim=1)
        return feature * (1.0 + scale) + shift


class ConditionedBlock(nn.Module):
    """Residual block of two convolutions, each before FiLM and behind norm and SiLU."""

    def __init__(self, inputs: int, outputs: int, condition: int, groups: int) -> None:
        super().__init__()
        self.norm1 = group_norm(inputs, groups)
        self.conv1 = nn.Conv1d(inputs, outputs, _KERNEL, padding=1)
        self.cond1 = FeatureScaling(condition, outputs)
        self.norm2 = group_norm(outputs, groups)
        self.conv2 = nn.Conv1d(outputs, outputs, _KERNEL, padding=1)
        self.cond2 = FeatureScaling(condition, outputs)
        self.skip = nn.Conv1d(inputs, outputs, 1) if inputs != outputs else nn.Identity()

    def forward(self, feature: Tensor, condition: Tensor) -> Tensor:
        inner = self.cond1(self.conv1(nn.functional.silu(self.norm1(feature))), condition)
        inner = self.cond2(self.conv2(nn.functional.silu(self.norm2(inner))), condition)
        return inner + self.skip(feature)


class _Down(nn.Module):
    def __init__(self, inputs: int, outputs: int, condition: int, groups: int) -> None:
        super().__init__()
        self.block = ConditionedBlock(inputs, outputs, condition, groups)
        self.pool = nn.Conv1d(outputs, outputs, _KERNEL, stride=2, padding=1)


class _Up(nn.Module):
    def __init__(self, inputs: int, skipped: int, outputs: int, condition: int, groups: int) -> None:
        super().__init__()
        self.up = nn.ConvTranspose1d(inputs, inputs, _UP_KERNEL, stride=2, padding=1)
        self.block = ConditionedBlock(inputs + skipped, outputs, condition, groups)


class FlowUNet(nn.Module):
    """Latent [B, L, P], condition [B, label + control + time] and features of the past to a velocity [B, L, P].

    P must be a multiple of 2 to the number of levels; a segment's latent has 8 positions.
    """

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        channels, groups = sizes.channels, sizes.groups
        condition = sizes.label + sizes.control + sizes.time
        self.in_conv = nn.Conv1d(sizes.latent, channels[0], _KERNEL, padding=1)
        self.downs = nn.ModuleList(
            _Down(before, after, condition, groups) for before, after in zip((channels[0], *channels), channels)
        )
        self.mid = ConditionedBlock(channels[-1], channels[-1], condition, groups)
        upwards = tuple(reversed(channels))
        self.ups = nn.ModuleList(
            _Up(before, after, after, condition, groups) for before, after in zip((upwards[0], *upwards), upwards)
        )
        self.out_norm = group_norm(channels[0], groups)
        self.out_conv = nn.Conv1d(channels[0], sizes.latent, _KERNEL, padding=1)
        self.fuse = nn.ModuleList(nn.Conv1d(2 * count, count, 1) for count in channels)

    def forward(self, point: Tensor, condition: Tensor, past: Sequence[Tensor]) -> Tensor:
        feature = self.in_conv(point)
        skipped = []
        for down, fuse, remembered in zip(self.downs, self.fuse, past, strict=True):
            feature = down.block(feature, condition)
            skipped.append(feature)
            feature = fuse(torch.cat([down.pool(feature), remembered], dim=1))
        feature = self.mid(feature, condition)
        for up in self.ups:
            feature = up.block(torch.cat([up.up(feature), skipped.pop()], dim=1), condition)
        return self.out_conv(nn.functional.silu(self.out_norm(feature)))


class PublishedNetwork(nn.Module):
    """All weights of a checkpoint, under the checkpoint's names."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        self.model = nn.ModuleDict({"backbone": FlowUNet(sizes)})
        self.label_embed = LabelEmbedding(sizes)
        self.prev_segment_encoder = PastFeatures(sizes)
        self.control_embedding = ControlEmbedding(sizes)


_WIDTH = 6
_ROLL_OFF = 0.99


class SincResampler(nn.Module):
    """[B, 1, N] at one rate to [B, 1, ceil(N new / old)] at another; what lies outside is taken as zero.

    One output phase for each of `new / gcd` fractions of an input sample, computed as channels of one convolution.
    """

    kernels: Tensor

    def __init__(self, old_hz: int, new_hz: int) -> None:
        super().__init__()
        divisor = math.gcd(old_hz, new_hz)
        self.old, self.new = old_hz // divisor, new_hz // divisor
        corner = min(self.old, self.new) * _ROLL_OFF
        self.reach = math.ceil(_WIDTH * self.old / corner)
        inputs = torch.arange(-self.reach, self.reach + self.old, dtype=torch.float64) / self.old
        outputs = -torch.arange(self.new, dtype=torch.float64)[:, None] / self.new
        place = ((outputs + inputs) * corner).clamp(-_WIDTH, _WIDTH)
        window = torch.cos(place * math.pi / _WIDTH / 2) ** 2
        kernels = torch.sinc(place) * window * corner / self.old
        self.register_buffer("kernels", kernels.float().unsqueeze(1), persistent=False)

    def forward(self, waveform: Tensor) -> Tensor:
        samples = int(waveform.shape[-1])
        padded = nn.functional.pad(waveform, (self.reach, self.reach + self.old))
        phases = nn.functional.conv1d(padded, self.kernels, stride=self.old)
        steps = int(phases.shape[-1])
        interleaved = phases.transpose(1, 2).reshape(-1, 1, steps * self.new)
        return interleaved[..., : -(-samples * self.new // self.old)]


FRAME_RATE_HZ = 75


def codebooks_of(bandwidth_kbps: float, available: int, bins: int) -> int:
    """How many codebooks a bandwidth pays for: log2(bins) bits from each, 75 times a second; at least one."""
    bits_per_second = FRAME_RATE_HZ * math.log2(bins)
    return min(available, max(1, math.floor(bandwidth_kbps * 1000 / bits_per_second)))


class ResidualQuantiser(nn.Module):
    """Each codebook takes the code vector nearest to what those before it left.

    codebooks: [Q, bins, C], the used ones. The nearest is chosen by comparing distances with their least, because model
    files have no operator that returns a place; of equal code vectors the mean is the vector itself.
    """

    codebooks: Tensor
    squares: Tensor

    def __init__(self, codebooks: Tensor) -> None:
        super().__init__()
        self.register_buffer("codebooks", codebooks.float())
        self.register_buffer("squares", self.codebooks.square().sum(dim=-1))

    def forward(self, latent: Tensor) -> Tensor:
        """[B, C, P] to the sum of its code vectors, [B, C, P]."""
        left = latent.transpose(1, 2)
        total = torch.zeros_like(left)
        for level in range(len(self.codebooks)):
            distances = self._distances(left, level)
            chosen = (distances <= distances.amin(dim=-1, keepdim=True)).to(left.dtype)
            nearest = (chosen / chosen.sum(dim=-1, keepdim=True)) @ self.codebooks[level]
            total, left = total + nearest, left - nearest
        return total.transpose(1, 2)

    def codes(self, latent: Tensor) -> Tensor:
        """[B, C, P] to the places of the chosen vectors in their codebooks, [B, Q, P]."""
        left = latent.transpose(1, 2)
        places = []
        for level in range(len(self.codebooks)):
            places.append(self._distances(left, level).argmin(dim=-1))
            left = left - self.codebooks[level][places[-1]]
        return torch.stack(places, dim=1)

    def _distances(self, points: Tensor, level: int) -> Tensor:
        """Squared distances [B, P, bins] without the point's own square, which all of them share."""
        return self.squares[level] - 2.0 * points @ self.codebooks[level].transpose(0, 1)
