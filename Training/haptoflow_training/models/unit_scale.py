"""Unit scale: waveforms divided by their level, in which all networks work."""

from __future__ import annotations

import torch
from torch import Tensor

# Limit of a previous waveform, so that a burst that the level did not predict cannot drive the network out of its
# range.
PREVIOUS_LIMIT = 16.0


def unit_scale(wave_mps2: Tensor, log_level: Tensor) -> Tensor:
    """[B, 1, N] in m/s^2 divided by the level exp(log_level) [B, 1]."""
    return wave_mps2 * torch.exp(-log_level).unsqueeze(-1)


def scaled_previous(previous_mps2: Tensor, log_level: Tensor) -> Tensor:
    """The previous waveform [B, 1, N] as the network's input: in unit scale, limited."""
    return unit_scale(previous_mps2, log_level).clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT)
