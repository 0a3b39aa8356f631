"""EnCodec's residual vector quantiser (Defossez et al. 2022, section 3.2): latents become sums of code vectors."""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

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
