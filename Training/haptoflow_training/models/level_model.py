"""The level model: log RMS from embedding and motion, fitted by Gaussian likelihood.

The network works in unit scale: target and previous waveform are divided by the level, and its output is multiplied by
it. Quiet materials are therefore learnt as well as loud ones, and the level falls to zero with the speed.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import (
    EMBEDDING_SIZE, SMOOTH_LOG_SPEED_HARMONICS, MotionFeatures, speed_and_force
)
from haptoflow_training.models.label_embedding import WAVE_VECTORS, rate_sizes, rib_frequencies_hz

_CORRECTION_LIMIT = 0.9
# Vibration below 0.01 m/s^2 cannot be felt. Without a floor, digital silence at rest would pull the law towards minus
# infinity.
LEVEL_FLOOR_MPS2 = 0.01
# Limit of a previous waveform, so that a burst that the level did not predict cannot drive the network out of its
# range.
PREVIOUS_LIMIT = 16.0


class LevelModel(nn.Module):
    """log level [B, 1] (natural log of the RMS in m/s^2) from embedding [B, 64] and motion [B, 3].

    A power law of speed and force for each material, RMS = k v^p F^q (as measured on the published textures), plus a
    bounded learnt correction. The law's three coefficients are linear in the embedding, so labels can be blended. The
    correction also knows how fast the tip crosses ribs: along a mesh's thread or aslant, the same speed sounds otherwise.
    """

    def __init__(self, hidden: int = 96) -> None:
        super().__init__()
        self.power_law = nn.Linear(EMBEDDING_SIZE, 3)
        self.features = MotionFeatures(SMOOTH_LOG_SPEED_HARMONICS)
        self.correction = nn.Sequential(
            nn.Linear(EMBEDDING_SIZE + self.features.size + WAVE_VECTORS, hidden),
            nn.SiLU(),
            nn.Linear(hidden, hidden),
            nn.SiLU(),
            nn.Linear(hidden, 1),
        )
        with torch.no_grad():
            self.power_law.bias.copy_(torch.tensor([-1.0, 0.9, 0.2]))

    def forward(self, embedding: Tensor, motion: Tensor) -> Tensor:
        law = self.power_law(embedding)
        crossing = rate_sizes(rib_frequencies_hz(embedding, motion).squeeze(2))
        correction = self.correction(torch.cat([embedding, self.features(motion), crossing], dim=1))
        return (
            law[:, 0:1]
            + (law[:, 1:3] * self.features.logarithms(speed_and_force(motion))).sum(dim=1, keepdim=True)
            + _CORRECTION_LIMIT * torch.tanh(correction)
        )


@torch.no_grad()
def shift_level(level: LevelModel, embedding: Tensor, shift: Tensor) -> None:
    """Add shift [L] to the log level of each row of embedding [L, 64], the same at every motion.

    Computed as the smallest change of the power law's factor: it stays linear in the embedding, so blends are shifted
    in proportion.
    """
    # In double precision: for labels that resemble each other, small differences carry the whole shift.
    solution = torch.linalg.lstsq(embedding.double(), shift.double().unsqueeze(1), driver="gelsd").solution
    level.power_law.weight[0] += solution.squeeze(1).float()


def level_loss(log_level: Tensor, mean_square_mps2: Tensor) -> Tensor:
    """[B, 1]: negative log-likelihood of a zero-mean Gaussian wave over a floor of 0.01 m/s^2 RMS,
    s + 0.5 meansquare exp(-2 s)."""
    power = mean_square_mps2 + LEVEL_FLOOR_MPS2**2
    return log_level + 0.5 * power * torch.exp(-2.0 * log_level)


def unit_scale(wave_mps2: Tensor, log_level: Tensor) -> Tensor:
    """[B, 1, N] in m/s^2 divided by the level exp(log_level) [B, 1]."""
    return wave_mps2 * torch.exp(-log_level).unsqueeze(-1)


def scaled_previous(previous_mps2: Tensor, log_level: Tensor) -> Tensor:
    """The previous waveform [B, 1, N] as the network's input: in unit scale, limited."""
    return unit_scale(previous_mps2, log_level).clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT)
