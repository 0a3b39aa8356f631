"""Band-limited resampling as torchaudio's `Resample` does it by default, in operations that ONNX graphs have.

Source: the documentation of torchaudio.functional.resample (windowed sinc interpolation, J. O. Smith, "Digital Audio
Resampling"): low-pass width 6, roll-off .99, window cos^2.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

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
