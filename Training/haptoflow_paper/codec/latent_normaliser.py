"""Scales latents to unit variance, channel by channel, to match the flow's standard normal noise."""

from __future__ import annotations

from pathlib import Path

import torch
from torch import Tensor, nn

from haptoflow_paper.codec.checkpoint_file import load_state, read_tensors

# A channel that the codec does not use must not be amplified to unit variance: only its noise would remain.
_MINIMUM_RELATIVE_DEVIATION = 1e-3


class LatentNormaliser(nn.Module):
    """(latent - mean) / standard deviation per channel of [B, C, P]; the identity until `fit` or `load`."""

    mean: Tensor
    standard_deviation: Tensor

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(1, channels, 1))
        self.register_buffer("standard_deviation", torch.ones(1, channels, 1))

    def forward(self, latent: Tensor) -> Tensor:
        return (latent - self.mean) / self.standard_deviation

    def inverse(self, normalised: Tensor) -> Tensor:
        return normalised * self.standard_deviation + self.mean

    @torch.no_grad()
    def fit(self, latents: Tensor) -> None:
        """Take mean and deviation over items and positions of latents [K, C, P] as they are; K P >= 2."""
        deviation = latents.std(dim=(0, 2), keepdim=True)
        floor = (deviation.max() * _MINIMUM_RELATIVE_DEVIATION).clamp(min=torch.finfo(deviation.dtype).tiny)
        self.mean.copy_(latents.mean(dim=(0, 2), keepdim=True))
        self.standard_deviation.copy_(deviation.clamp(min=floor))

    def save(self, path: Path | str) -> None:
        """Write the statistics as a PyTorch state dict."""
        torch.save(self.state_dict(), path)

    def load(self, path: Path | str) -> None:
        """Read what `save` wrote; InputError names what does not fit."""
        path = Path(path)
        load_state(self, read_tensors(path), path)
