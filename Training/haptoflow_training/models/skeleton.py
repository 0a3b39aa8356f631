"""The skeleton: what sounds without a network.

A small filter continues the previous waveform. It is driven by noise, which swings with the ribs, by the ribs' own
lines and by rare impulses: all that a tip meets passes through the contact's resonance. One perceptron of material,
motion and rib rates gives every coefficient. Native code computes the same (src/skeleton), so a segment costs
microseconds. Kin: autoregressive rendering of textures after Culbertson et al. 2014; as the start of a network's
refinement, PriorGrad (Lee et al. 2022) and SpecGrad (Koizumi et al. 2022).
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn

from haptoflow_training.models.all_pole_filter import AllPoleFilter, PredictedFilter, burg_distance, prediction_errors
from haptoflow_training.models.conditioning import ConditionPerceptron
from haptoflow_training.models.level_model import PREVIOUS_LIMIT
from haptoflow_training.models.tail_impulses import ATOMS, TailImpulses, TAIL_THRESHOLDS
from haptoflow_training.models.surface_waves import FAMILIES, RATE_FEATURES, SurfaceWaves, rate_features

ORDER = 24
# The likelihood's part of a segment ends here, 44 ms from its beginning. Over a whole segment a hand changes its speed so
# much that the filter would fit a mean of powers, 5 dB too strong where a surface has little power.
LIKELIHOOD_END = 88
# The longest response falls to 1/e in 33 ms, a resonance 10 Hz wide. A sharper one would be a line, and lines are made
# elsewhere; a likelihood, which hardly notices a false peak where little was recorded, would leave some.
_POLE_DAMPING = 0.985
SWING_HARMONICS = 5
LINE_HARMONICS = 14
_MAXIMUM_SWING_HZ, _MAXIMUM_LINE_HZ = 700.0, 960.0
# Bounds of what the perceptron predicts, so that no material, blend or motion drives the output out of range.
_SWING_LIMIT, _LINE_LIMIT, _IMPULSE_LIMIT = 2.0, 30.0, 8.0
SWING_GAINS = FAMILIES * 2 * SWING_HARMONICS
LINE_GAINS = FAMILIES * 2 * LINE_HARMONICS
IMPULSE_GAINS = 2 * len(TAIL_THRESHOLDS) * ATOMS
OUTPUTS = (ORDER + 1, SWING_GAINS, LINE_GAINS, IMPULSE_GAINS)


class SkeletonParts(NamedTuple):
    """segment, impulses [B, 1, 200]: the skeleton's segment, and the impulses that drove it. cosines, sines [B, 3, 5, 200]:
    the waves that swing the drive."""

    segment: Tensor
    impulses: Tensor
    cosines: Tensor
    sines: Tensor


class SkeletonGains(NamedTuple):
    """What the perceptron says of a condition. coefficients [B, 24] and log_gain [B, 1] of the filter; swing [B, 3, 2,
    5, 1], lines [B, 3, 2, 14, 1]: of cosines and sines; impulses [B, 130]; lines and impulses relative to the noise."""

    coefficients: Tensor
    log_gain: Tensor
    swing: Tensor
    lines: Tensor
    impulses: Tensor


def _limited(values: Tensor, limit: float) -> Tensor:
    return limit * torch.tanh(values / limit)


class Skeleton(nn.Module):
    """Segments in unit scale from noise, previous waveform, material, motion and phases."""

    def __init__(self, hidden: int = 160) -> None:
        super().__init__()
        self.perceptron = ConditionPerceptron(sum(OUTPUTS), hidden, RATE_FEATURES)
        self.filter = AllPoleFilter(ORDER)
        self.predicted = PredictedFilter(ORDER, _POLE_DAMPING)
        self.impulses = TailImpulses()
        self.swing_waves = SurfaceWaves(SWING_HARMONICS, _MAXIMUM_SWING_HZ)
        self.line_waves = SurfaceWaves(LINE_HARMONICS, _MAXIMUM_LINE_HZ)
        last = self.perceptron.layers[-1]
        with torch.no_grad():
            last.weight[ORDER + 1 :] = 0.0
            last.bias[ORDER + 1 :] = 0.0

    def gains(self, embedding: Tensor, motion: Tensor, phases: Tensor) -> SkeletonGains:
        predicted = self.perceptron(embedding, motion, rate_features(phases))
        filtering, swing, lines, impulses = predicted.split(list(OUTPUTS), dim=1)
        return SkeletonGains(
            *self.predicted(filtering),
            swing.reshape(-1, FAMILIES, 2, SWING_HARMONICS, 1),
            _limited(lines.reshape(-1, FAMILIES, 2, LINE_HARMONICS, 1), _LINE_LIMIT),
            _limited(impulses, _IMPULSE_LIMIT),
        )

    def parts(self, noise: Tensor, previous: Tensor, gains: SkeletonGains, phases: Tensor) -> SkeletonParts:
        """The segment of noise and previous waveform [B, 1, 200]. Only the likelihood fits the filter; the energy
        distance, which trains all else, would only blur it."""
        waves = self.swing_waves(phases)
        gain = gains.log_gain.detach().exp()
        impulses = gain.unsqueeze(2) * self.impulses(noise, gains.impulses)
        drive = gain * (noise[:, 0] * self._swung(gains, waves).exp() + self._lines(gains, phases)) + impulses[:, 0]
        filtered = self.filter(drive, gains.coefficients.detach(), previous[:, 0, -ORDER:])
        return SkeletonParts(filtered.clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT).unsqueeze(1), impulses, *waves)

    def forward(self, noise: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        return self.parts(noise, previous, self.gains(embedding, motion, phases), phases).segment

    def likelihood(self, segment: Tensor, gains: SkeletonGains, phases: Tensor) -> Tensor:
        """[B]: Gaussian negative log-likelihood per sample of the one-step prediction errors of a recorded segment [B,
        1, 200] beyond the lines, from the filter's 25th sample on, for as long as a hand's motion hardly changes. What was
        before the segment, which may be silence or another material, is no part of it: errors there would be a hundred
        times as large and flatten the filter."""
        heard = slice(ORDER, LIKELIHOOD_END)
        swing = self._swung(gains, self.swing_waves(phases))[:, heard]
        driven = prediction_errors(segment[:, 0, :LIKELIHOOD_END], gains.coefficients) * torch.exp(-gains.log_gain)
        beyond = (driven - self._lines(gains, phases)[:, heard]) * torch.exp(-swing)
        return (gains.log_gain + swing + 0.5 * beyond.square()).mean(dim=1)

    def filter_distance(self, segment: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        """[B]: of the predicted filter from Burg's of a recorded segment [B, 1, 200] (models/all_pole_filter.py)."""
        raw = self.perceptron(embedding, motion, rate_features(phases))[:, : ORDER + 1]
        return burg_distance(raw, segment[:, 0])

    def _lines(self, gains: SkeletonGains, phases: Tensor) -> Tensor:
        """[B, 200]: what the ribs themselves add to the drive, relative to its noise."""
        cosines, sines = self.line_waves(phases)
        return (gains.lines[:, :, 0] * cosines + gains.lines[:, :, 1] * sines).sum(dim=(1, 2))

    def _swung(self, gains: SkeletonGains, waves: tuple[Tensor, Tensor]) -> Tensor:
        """[B, 200]: what the ribs add to the drive's log level."""
        total = (gains.swing[:, :, 0] * waves[0] + gains.swing[:, :, 1] * waves[1]).sum(dim=(1, 2))
        return _limited(total, _SWING_LIMIT)
