"""The SPSI rival (after Heravi et al., Transactions on Haptics 2024).

A perceptron predicts the magnitudes of a Hann-windowed DFT of 200 samples from material and motion; single-pass
spectrogram inversion (Beauregard et al. 2015) finds phases for frames 20 samples apart. It reads no previous waveform:
a segment does not continue the one before it.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_paper.rivals.rival import Rival, reads
from haptoflow_training.models.conditioning import ConditionPerceptron
from haptoflow_training.waveform import SEGMENT_SAMPLES

BINS = SEGMENT_SAMPLES // 2 + 1
HOP_SAMPLES = 20
# All frames that overlap the segment.
FRAMES = 2 * SEGMENT_SAMPLES // HOP_SAMPLES - 1
POWER_FLOOR = 1e-4
LOG_MAGNITUDE_LIMIT = 8.0
# Seven doublings cover 128 bins, more than there are.
CLIMBS = 7


def hann_window() -> Tensor:
    """[200]: periodic, so that shifted copies add up to a constant."""
    return torch.hann_window(SEGMENT_SAMPLES, periodic=True)


def magnitude_spectrum(segment: Tensor) -> Tensor:
    """|DFT| of Hann-windowed segments [B, 1, 200]; [B, 101], of RMS 8.66 for white noise of RMS 1."""
    return torch.fft.rfft(segment[:, 0] * hann_window()).abs()


class SinglePassInversion(nn.Module):
    """Magnitudes [B, 101] and uniform phases [B, 101], in turns, to a wave [B, 1, 200] of their power."""

    bins: Tensor
    synthesis: Tensor
    frames: Tensor
    power_weights: Tensor
    interior: Tensor

    def __init__(self) -> None:
        super().__init__()
        bins = torch.arange(BINS, dtype=torch.float64)
        window = hann_window().double()
        sides = torch.full((BINS,), 2.0, dtype=torch.float64)
        sides[0] = sides[-1] = 1.0
        angles = 2.0 * math.pi * bins.unsqueeze(1) * torch.arange(SEGMENT_SAMPLES) / SEGMENT_SAMPLES
        weights = sides.repeat(2).unsqueeze(1) / SEGMENT_SAMPLES
        inverse = weights * torch.cat([torch.cos(angles), -torch.sin(angles)])
        # Divide by the summed square of the analysis and synthesis windows.
        overlap = window.square().sum() / HOP_SAMPLES
        constants = {
            "bins": bins.unsqueeze(0),
            "frames": torch.arange(FRAMES, dtype=torch.float64).reshape(1, 1, FRAMES),
            "synthesis": (inverse * window / overlap).unsqueeze(1),
            # Parseval: the mean square of a wave whose windowed DFT has these magnitudes.
            "power_weights": (sides / (SEGMENT_SAMPLES * window.square().sum())).unsqueeze(1),
            "interior": ((bins > 0) & (bins < BINS - 1)).double().unsqueeze(0),
        }
        for name, value in constants.items():
            self.register_buffer(name, value.float(), persistent=False)

    def peak_bins(self, magnitudes: Tensor) -> Tensor:
        """[B, 101], integers: the peak whose slope each bin lies on, itself if no neighbour is larger."""
        edge = torch.full_like(magnitudes[:, :1], -1.0)
        below = torch.cat([edge, magnitudes[:, :-1]], dim=1)
        above = torch.cat([magnitudes[:, 1:], edge], dim=1)
        up = (above > magnitudes) & (above >= below)
        down = (below > magnitudes) & (below > above)
        target = (self.bins + up.to(magnitudes.dtype) - down.to(magnitudes.dtype)).long()
        for _ in range(CLIMBS):
            target = torch.gather(target, 1, target)
        return target

    def peak_offsets(self, magnitudes: Tensor) -> Tensor:
        """[B, 101]: p = 0.5 (a - g) / (a - 2 b + g) of every bin; a peak lies at k + p."""
        below = torch.cat([magnitudes[:, :1], magnitudes[:, :-1]], dim=1)
        above = torch.cat([magnitudes[:, 1:], magnitudes[:, -1:]], dim=1)
        curvature = below - 2.0 * magnitudes + above
        # A flat top has no curvature and is taken as it is; the first and the last bin have one neighbour only. The
        # divisor is 1 there rather than a curvature that may be zero: an infinite gradient would become NaN even if
        # masked afterwards.
        is_peaked = curvature < -1e-6 * magnitudes
        offset = 0.5 * (below - above) / torch.where(is_peaked, curvature, torch.ones_like(curvature))
        return (offset * is_peaked.to(magnitudes.dtype) * self.interior).clamp(-0.5, 0.5)

    def forward(self, magnitudes: Tensor, turns: Tensor) -> Tensor:
        peak = self.peak_bins(magnitudes)
        offset = torch.gather(self.peak_offsets(magnitudes), 1, peak)
        place = peak.to(magnitudes.dtype) + offset
        # The Hann window's main lobe changes sign from bin to bin, its side lobes keep it; the peak lies off
        # its bin to one side, and on that side the lobe reaches one bin further.
        side = 1.0 - 2.0 * (offset < 0.0).to(magnitudes.dtype)
        distance = (self.bins - peak.to(magnitudes.dtype)) * side
        opposed = ((distance < -0.5) | ((distance > 0.5) & (distance < 1.5))).to(magnitudes.dtype)
        amplitude = (magnitudes * (1.0 - 2.0 * opposed)).unsqueeze(-1)

        advance = place.unsqueeze(-1) * (HOP_SAMPLES / SEGMENT_SAMPLES) * self.frames
        angle = 2.0 * math.pi * (torch.gather(turns, 1, peak).unsqueeze(-1) + advance)
        spectra = torch.cat([amplitude * torch.cos(angle), amplitude * torch.sin(angle)], dim=1)
        # Inverse DFT, synthesis window and overlap-add are one transposed convolution.
        wave = nn.functional.conv_transpose1d(
            spectra, self.synthesis, stride=HOP_SAMPLES, padding=SEGMENT_SAMPLES - HOP_SAMPLES
        )
        # Frames with different phases lose power where they overlap (1.8 dB for a flat spectrum); restore the power
        # that the magnitudes state.
        stated = torch.matmul(magnitudes.square(), self.power_weights).unsqueeze(-1)
        found = wave.square().mean(dim=2, keepdim=True)
        return wave * torch.sqrt(stated / (found + 1e-12))


class SpsiRival(Rival):
    """Predicts magnitudes from material and motion; the noise chooses the phases of the first frame.

    As published, the squared error of log magnitudes leads to their geometric mean: for a Gaussian texture that is 2.5
    dB below the level of the recording. This belongs to the method and is not corrected. `sampled`: trained by the
    likelihood of the power spectrum instead (Whittle 1953: each bin's power is exponentially distributed about its
    mean), which leads to the mean power and has no such bias.
    """

    def __init__(self, *, ribs: bool = False, sampled: bool = False) -> None:
        super().__init__(ribs=ribs)
        self.is_sampled = sampled
        self.inputs = reads("noisy", ribs=ribs)
        self.perceptron = ConditionPerceptron(BINS)
        if sampled:
            # The level of white noise in unit scale: a likelihood that starts far below the recordings' power
            # overshoots.
            nn.init.constant_(self.perceptron.layers[-1].bias, 0.5 * math.log(float(hann_window().square().sum())))
        self.inversion = SinglePassInversion()

    def log_magnitudes(self, embedding: Tensor, motion: Tensor) -> Tensor:
        """[B, 101]: natural logarithm of the expected `magnitude_spectrum`: of the magnitude, or, if sampled, of the
        root of the mean power."""
        return self.perceptron(embedding, motion)

    def own_form(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        limited = self.log_magnitudes(embedding, motion).clamp(-LOG_MAGNITUDE_LIMIT, LOG_MAGNITUDE_LIMIT)
        # The normal distribution function turns normal noise into uniform phases.
        turns = 0.5 * torch.erf(noisy[:, 0, :BINS] * math.sqrt(0.5))
        return self.inversion(limited.exp(), turns)

    def loss(
        self,
        segment: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor,
        generator: torch.Generator,
    ) -> Tensor:
        rest, _ = self.rest(segment, previous, embedding, motion, phases)
        power = magnitude_spectrum(rest).square() + POWER_FLOOR
        stated = self.log_magnitudes(embedding, motion)
        if not self.is_sampled:
            return (stated - 0.5 * power.log()).square().mean(dim=1)
        return (2.0 * stated + power * torch.exp(-2.0 * stated)).mean(dim=1)
