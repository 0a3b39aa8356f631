"""Rare events from Gaussian noise: samples beyond four thresholds, each passed through a kernel of its own.

A network of smooth layers turns Gaussian noise into something nearly Gaussian, but an asperity that strikes the tip a
few times a second is not Gaussian. Such events are made here from the tails of the same noise. How often a threshold is
exceeded is fixed (4.6, 0.9, 0.2 and 0.05 % of the samples); their strength and ringing depend on the condition.
"""

from __future__ import annotations

import math
from typing import ClassVar

import torch
from torch import Tensor, nn

from haptoflow_training.waveform import SAMPLE_RATE_HZ

THRESHOLDS = (2.0, 2.6, 3.1, 3.5)
# The skeleton's: the last one is exceeded every eight seconds.
TAIL_THRESHOLDS = (*THRESHOLDS, 4.0)
TAPS = 64
_RINGS_HZ = (50.0, 90.0, 160.0, 280.0, 500.0, 800.0)
_RING_DECAY = 0.4
# A delta, then cosine and sine of each ring.
ATOMS = 1 + 2 * len(_RINGS_HZ)
# The convolution is a product of matrices, one window of the segment at a time.
_WINDOW = 25
# A kernel of 64 taps reaches into three windows before a window.
_WINDOWS_BEFORE = 3


def _excess_deviation(threshold: float) -> float:
    """Standard deviation of sign(n) max(|n| - threshold, 0) of standard normal n: E = 2 [(1 + t^2) Q(t) - t p(t)]."""
    tail = 0.5 * math.erfc(threshold / math.sqrt(2.0))
    density = math.exp(-0.5 * threshold * threshold) / math.sqrt(2.0 * math.pi)
    return math.sqrt(2.0 * ((1.0 + threshold * threshold) * tail - threshold * density))


def _atoms() -> Tensor:
    """[13, 64] of unit energy."""
    time = torch.arange(TAPS) / SAMPLE_RATE_HZ
    delta = torch.zeros(TAPS)
    delta[0] = 1.0
    atoms = [delta]
    for ring_hz in _RINGS_HZ:
        turn = 2.0 * math.pi * ring_hz * time
        decay = torch.exp(-_RING_DECAY * turn)
        atoms += [decay * torch.cos(turn), decay * torch.sin(turn)]
    return torch.stack([atom / atom.norm() for atom in atoms])


class TailImpulses(nn.Module):
    """noise [B, 1, N] and gains [B, 2 * thresholds * 13], of positive noise first, to impulses [B, 1, N]: asperities that push
    the tip up need not resemble those that push it down. The output is zero where all gains are zero.
    """

    thresholds: ClassVar[tuple[float, ...]] = TAIL_THRESHOLDS
    tails: ClassVar[int] = 2

    heights: Tensor
    scales: Tensor
    atoms: Tensor
    read: Tensor
    placed_atoms: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__()
        heights = self.thresholds
        self.samples, self.windows = samples, samples // _WINDOW
        self.kernels = len(heights) * self.tails
        self.register_buffer("heights", torch.tensor(heights).reshape(1, -1, 1), persistent=False)
        scales = torch.tensor([1.0 / _excess_deviation(threshold) for threshold in heights])
        self.register_buffer("scales", scales.repeat(self.tails).reshape(1, -1, 1), persistent=False)
        self.register_buffer("atoms", _atoms(), persistent=False)
        reach = _WINDOWS_BEFORE * _WINDOW
        windows_read = torch.arange(self.windows).unsqueeze(1) + torch.arange(_WINDOWS_BEFORE + 1)
        self.register_buffer("read", windows_read, persistent=False)
        source = torch.arange(reach + _WINDOW)
        # The weight of each atom for each output sample of a window and each input sample that it depends on, [13, 100
        # * 25].
        tap = torch.arange(_WINDOW) + reach - source.unsqueeze(1)
        shifted = nn.functional.pad(self.atoms, (0, 1))[:, torch.where((tap >= 0) & (tap < TAPS), tap, TAPS)]
        self.register_buffer("placed_atoms", shifted.reshape(ATOMS, -1), persistent=False)
        self.reach, self.sources = reach, len(source)

    def forward(self, noise: Tensor, gains: Tensor) -> Tensor:
        # Gather whole windows, and do so before the thresholds split one signal into four: in ONNX Runtime, copying a single
        # sample takes as long as copying a window.
        padded = nn.functional.pad(noise, (self.reach, 0)).reshape(-1, self.windows + _WINDOWS_BEFORE, _WINDOW)
        gathered = padded[:, self.read].reshape(-1, self.windows, 1, self.sources)
        excess = (self._excess(gathered) * self.scales).reshape(-1, self.windows, self.kernels * self.sources)
        kernels = (gains.reshape(-1, ATOMS) @ self.placed_atoms).reshape(-1, self.kernels * self.sources, _WINDOW)
        return (excess @ kernels).reshape(-1, 1, self.samples)

    def _excess(self, gathered: Tensor) -> Tensor:
        """[B, windows, kernels, sources]: by how much the noise exceeds each threshold."""
        up, down = (gathered - self.heights).clamp(min=0.0), (gathered + self.heights).clamp(max=0.0)
        return torch.stack([up, down], dim=2).flatten(2, 3)
