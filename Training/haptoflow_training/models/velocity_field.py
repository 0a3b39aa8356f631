"""The velocity field: a two-level U-Net over patches of the segment, FiLM at every level.

HaptoFlow (paper, section 3.1): U-Net of two levels; the previous waveform is encoded and concatenated at each
down-sampling stage; material, motion and time modulate every level. The form is our own, shaped for ONNX Runtime
on one CPU core: patches of 8 samples are the channels, convolutions are two-dimensional with height 1, one linear
layer makes the FiLM parameters of all blocks.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import CONDITION_SIZE, MotionEncoder, TimeEncoder
from haptoflow_training.models.rib_comb import COMB_CHANNELS, LINES, RibComb


class RmsNorm(nn.Module):
    """Divides by the root mean square over channels; [B, C, 1, P]. Two nodes fewer than a group norm."""

    def forward(self, features: Tensor) -> Tensor:
        return features * torch.rsqrt(features.square().mean(dim=1, keepdim=True) + 1e-5)


def _convolution(inputs: int, outputs: int, width: int, stride: int = 1) -> nn.Conv2d:
    return nn.Conv2d(inputs, outputs, (1, width), stride=(1, stride), padding=(0, width // 2))


class PositionMixer(nn.Module):
    """A dense layer across positions, per channel group shared: what the last patch did reaches the whole segment.

    A ruled surface keeps its phase over a segment; convolutions of width 3 alone would need many layers for it.
    """

    def __init__(self, channels: int, positions: int) -> None:
        super().__init__()
        self.mix = nn.Linear(positions, positions)
        self.project = _convolution(channels, channels, 1)
        nn.init.zeros_(self.project.weight)
        nn.init.zeros_(self.project.bias)

    def forward(self, features: Tensor) -> Tensor:
        return features + self.project(nn.functional.silu(self.mix(features)))


class FilmBlock(nn.Module):
    """Residual block: norm, FiLM, SiLU, convolution, SiLU, convolution, plus position mixing."""

    def __init__(self, inputs: int, outputs: int, positions: int) -> None:
        super().__init__()
        self.channels = inputs
        self.norm = RmsNorm()
        self.first = _convolution(inputs, outputs, 3)
        self.second = _convolution(outputs, outputs, 3)
        self.shortcut = _convolution(inputs, outputs, 1) if inputs != outputs else nn.Identity()
        self.mixer = PositionMixer(outputs, positions)

    def forward(self, features: Tensor, scale: Tensor, shift: Tensor) -> Tensor:
        modulated = nn.functional.silu(self.norm(features) * (1.0 + scale) + shift)
        change = self.second(nn.functional.silu(self.first(modulated)))
        return self.mixer(self.shortcut(features) + change)


class VelocityField(nn.Module):
    """u(x_t, t | previous, embedding, motion) in unit scale.

    noisy and previous: [B, C, N] with C channels of the representation (1 for raw samples) and N its positions
    (200); time: [B, 1]; embedding: [B, 64]; motion: [B, 3]. Returns [B, C, N]. N must divide by `patch`.
    Without `hears_previous`, the previous waveform has no effect. With `average`, the field is the average velocity
    over [t, t + interval] (MeanFlow) and takes interval [B, 1]. With `ribs` (raw samples only), it hears what the ribs
    of a ruled surface would do next.
    """

    def __init__(
        self,
        *,
        channels: int = 1,
        positions: int = 200,
        patch: int = 8,
        width: int = 64,
        previous_width: int = 32,
        average: bool = False,
        hears_previous: bool = True,
        ribs: bool = False,
    ) -> None:
        super().__init__()
        self.hears_previous = hears_previous
        if positions % patch != 0:
            raise ValueError(f"{positions} positions do not divide into patches of {patch}")
        self.channels, self.positions, self.patch = channels, positions, patch
        self.patches = positions // patch
        coarse = (self.patches + 1) // 2
        patch_size = channels * patch

        self.time = TimeEncoder()
        self.interval = TimeEncoder() if average else None
        self.motion = MotionEncoder()
        self.comb = RibComb(positions) if ribs else None
        self.line_gains = nn.Linear(CONDITION_SIZE, LINES) if ribs else None
        if self.line_gains is not None:
            nn.init.zeros_(self.line_gains.weight)
            nn.init.zeros_(self.line_gains.bias)
        self.enter = _convolution(patch_size + (COMB_CHANNELS * patch if ribs else 0), width, 1)
        self.previous_fine = _convolution(patch_size, previous_width, 3)
        self.previous_coarse = _convolution(previous_width, previous_width, 3, stride=2)

        self.fine_down = FilmBlock(width + previous_width, width, self.patches)
        self.down = _convolution(width, 2 * width, 3, stride=2)
        self.coarse = FilmBlock(2 * width + previous_width, 2 * width, coarse)
        self.up = nn.ConvTranspose2d(
            2 * width, width, (1, 3), stride=(1, 2), padding=(0, 1), output_padding=(0, 1 - self.patches % 2)
        )
        self.fine_up = FilmBlock(2 * width, width, self.patches)
        self.leave = _convolution(width, patch_size, 1)
        nn.init.zeros_(self.leave.weight)
        nn.init.zeros_(self.leave.bias)

        blocks = (self.fine_down, self.coarse, self.fine_up)
        self._film_sizes = [size for block in blocks for size in (block.channels, block.channels)]
        self.film = nn.Sequential(
            nn.Linear(CONDITION_SIZE, CONDITION_SIZE), nn.SiLU(), nn.Linear(CONDITION_SIZE, sum(self._film_sizes))
        )

    def _to_patches(self, wave: Tensor, channels: int) -> Tensor:
        patches = wave.reshape(-1, channels, self.patches, self.patch)
        return patches.permute(0, 1, 3, 2).reshape(-1, channels * self.patch, 1, self.patches)

    def _from_patches(self, patches: Tensor) -> Tensor:
        wave = patches.reshape(-1, self.channels, self.patch, self.patches)
        return wave.permute(0, 1, 3, 2).reshape(-1, self.channels, self.positions)

    def forward(
        self,
        noisy: Tensor,
        time: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        interval: Tensor | None = None,
    ) -> Tensor:
        moment = self.time(time)
        if self.interval is not None and interval is not None:
            moment = moment + self.interval(interval)
        condition = torch.cat([embedding, self.motion(motion), moment], dim=1)
        film = self.film(condition).unsqueeze(-1).unsqueeze(-1).split(self._film_sizes, dim=1)

        if not self.hears_previous:
            previous = torch.zeros_like(previous)
        # Mirrored, so that the newest sample of the past lies beside the first sample of the new segment.
        past = self.previous_fine(self._to_patches(torch.flip(previous, dims=[2]), self.channels))
        past_coarse = self.previous_coarse(nn.functional.silu(past))

        patches = self._to_patches(noisy, self.channels)
        lines: Tensor | None = None
        if self.comb is not None and self.line_gains is not None:
            combed, harmonics = self.comb(noisy, previous, embedding, motion)
            patches = torch.cat([patches, self._to_patches(combed, COMB_CHANNELS)], dim=1)
            lines = self.line_gains(condition).unsqueeze(1) @ harmonics
        entered = self.enter(patches)
        fine = self.fine_down(torch.cat([entered, past], dim=1), film[0], film[1])
        coarse = self.coarse(torch.cat([self.down(fine), past_coarse], dim=1), film[2], film[3])
        merged = self.fine_up(torch.cat([self.up(coarse), fine], dim=1), film[4], film[5])
        made = self._from_patches(self.leave(merged))
        return made if lines is None else made + lines


def parameter_count(module: nn.Module) -> int:
    """Weights of a module, buffers not counted."""
    return sum(parameter.numel() for parameter in module.parameters())
