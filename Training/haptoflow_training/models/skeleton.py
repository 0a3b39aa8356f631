"""The skeleton: what sounds without a network.

A small filter continues its own past. It is driven by noise, which swings with the ribs, by the ribs' own lines and by
rare impulses: all that a tip meets passes through the contact's resonance. One perceptron of material, motion and rib
rates gives the filter, another one all that drives it; a model file holds both as one. Native code computes the same
(src/skeleton) sample by sample, in microseconds. Kin: autoregressive rendering of textures after Culbertson et al.
2014; as the start of a network's refinement, PriorGrad (Lee et al. 2022) and SpecGrad (Koizumi et al. 2022).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import ClassVar, NamedTuple

import torch
from torch import Tensor, nn

from haptoflow_training.models.all_pole_filter import (
    AllPoleFilter, PredictedFilter, burg_distance, log_level, prediction_errors
)
from haptoflow_training.models.conditioning import ConditionPerceptron
from haptoflow_training.models.label_embedding import FAMILIES, RATE_FEATURES, SurfaceWaves, rate_features
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# Rare events from Gaussian noise: samples beyond four thresholds, each passed through a kernel of its own.
# A network of smooth layers turns Gaussian noise into something nearly Gaussian, but an asperity that strikes the tip
# a few times a second is not Gaussian. Such events are made here from the tails of the same noise. How often a
# threshold is exceeded is fixed (4.6, 0.9, 0.2 and 0.05 % of the samples); their strength and ringing depend on the
# condition.
THRESHOLDS = (2.0, 2.6, 3.1, 3.5)
# The skeleton's: the last one is exceeded every eight seconds.
TAIL_THRESHOLDS = (*THRESHOLDS, 4.0)
TAPS = 64
_RINGS_HZ = (50.0, 90.0, 160.0, 280.0, 500.0, 800.0)
_RING_DECAY = 0.4
# A delta, then cosine and sine of each ring.
ATOMS = 1 + 2 * len(_RINGS_HZ)
# Limit of the output in unit scale. A slow tip on concrete is struck with 62 times its level.
SKELETON_LIMIT = 64.0
# The convolution is a product of matrices, one window of the segment at a time.
_WINDOW = 25
# A kernel of 64 taps reaches into three windows before a window.
_WINDOWS_BEFORE = 3
# Samples of the noise before a segment whose impulses may still ring in it.
NOISE_BEFORE = _WINDOWS_BEFORE * _WINDOW


def _excess_deviation(threshold: float) -> float:
    """Standard deviation of sign(n) max(|n| - threshold, 0) of standard normal n: E = 2 [(1 + t^2) Q(t) - t p(t)]."""
    tail = 0.5 * math.erfc(threshold / math.sqrt(2.0))
    density = math.exp(-0.5 * threshold * threshold) / math.sqrt(2.0 * math.pi)
    return math.sqrt(2.0 * ((1.0 + threshold * threshold) * tail - threshold * density))


# An impulse's slope says how fast it grows with its noise. Without this factor, one step of training at 1e-3 would change
# a slope by about 4, and many slopes are no larger than that.
_IMPULSE_FACTOR = 0.125


def impulse_factors() -> Tensor:
    """[130]: with them, a step of training changes a rare impulse by as much as a frequent one, and not by 30 times."""
    deviations = torch.tensor([_excess_deviation(threshold) for threshold in TAIL_THRESHOLDS])
    return (_IMPULSE_FACTOR * deviations / deviations[0]).repeat(2).repeat_interleave(ATOMS)


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
    """noise [B, 1, 75 + N] and gains [B, 2 * thresholds * 13], of positive noise first, to impulses [B, 1, N]:
    asperities that push the tip up need not resemble those that push it down. Those of the first 75 samples, before the
    segment, ring on in it. The output is zero where all gains are zero.
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
        windows_read = torch.arange(self.windows).unsqueeze(1) + torch.arange(_WINDOWS_BEFORE + 1)
        self.register_buffer("read", windows_read, persistent=False)
        source = torch.arange(NOISE_BEFORE + _WINDOW)
        # The weight of each atom for each output sample of a window and each input sample that it depends on, [13, 100
        # * 25].
        tap = torch.arange(_WINDOW) + NOISE_BEFORE - source.unsqueeze(1)
        shifted = nn.functional.pad(self.atoms, (0, 1))[:, torch.where((tap >= 0) & (tap < TAPS), tap, TAPS)]
        self.register_buffer("placed_atoms", shifted.reshape(ATOMS, -1), persistent=False)
        self.sources = len(source)

    def forward(self, noise: Tensor, gains: Tensor) -> Tensor:
        # Gather whole windows, and do so before the thresholds split one signal into four: in ONNX Runtime, copying a single
        # sample takes as long as copying a window.
        windows = noise.reshape(-1, self.windows + _WINDOWS_BEFORE, _WINDOW)
        gathered = windows[:, self.read].reshape(-1, self.windows, 1, self.sources)
        excess = (self._excess(gathered) * self.scales).reshape(-1, self.windows, self.kernels * self.sources)
        kernels = (gains.reshape(-1, ATOMS) @ self.placed_atoms).reshape(-1, self.kernels * self.sources, _WINDOW)
        return (excess @ kernels).reshape(-1, 1, self.samples)

    def explained(self, driven: Tensor, gains: Tensor) -> tuple[Tensor, Tensor]:
        """The noise behind what drives a filter, [B, N]: its size, and the log of the slope by which a sample grows with it,
        which is constant between two thresholds; [B, N] each. A sample is its noise, the impulse which that excites, and
        what rings on from impulses before. What rings on depends on the noise before, so each round computes it from the
        noise of the round before."""
        kernels = gains.reshape(len(gains), self.kernels, ATOMS) @ self.atoms
        noise, log_slope = self._unstretched(driven, kernels)
        fresh = driven
        for _ in range(_ROUNDS):
            likely = torch.copysign(noise.detach().clamp(max=_LARGEST_LIKELY_NOISE), fresh)
            fresh = driven - self._ringing_on(likely, kernels)
            noise, log_slope = self._unstretched(fresh, kernels)
        return noise, log_slope

    def _unstretched(self, fresh: Tensor, kernels: Tensor) -> tuple[Tensor, Tensor]:
        """As `explained`, of samples on which nothing rings on. kernels [B, 2 * thresholds, 64]."""
        steps = (kernels[..., 0] * self.scales[0, :, 0]).reshape(len(kernels), self.tails, -1)
        grown = torch.cat([torch.ones_like(steps[..., :1]), 1.0 + steps.cumsum(dim=2)], dim=2)
        # Below zero, one sample could come from several of the noise. Slopes fall towards zero instead, so that a gradient
        # always leads back.
        slopes = torch.where(grown < 1.0, 1.0 / (2.0 - grown.clamp(max=1.0)), grown)
        edges = torch.cat([torch.zeros_like(self.heights[:, :1, 0]), self.heights[:, :, 0]], dim=1)
        spans = (edges[:, 1:] - edges[:, :-1]).unsqueeze(1) * slopes[..., :-1]
        reached = torch.cat([torch.zeros_like(spans[..., :1]), spans.cumsum(dim=2)], dim=2)
        tail = (fresh < 0.0).long()
        size = fresh.abs()
        rows = torch.arange(len(fresh)).unsqueeze(1)
        piece = (size.unsqueeze(2) >= reached[rows, tail]).sum(dim=2) - 1
        slope = slopes[rows, tail, piece]
        noise = edges[0][piece] + (size - reached[rows, tail, piece]) / slope
        return noise, slope.log()

    def _ringing_on(self, noise: Tensor, kernels: Tensor) -> Tensor:
        """[B, N]: at each sample, the sum of the impulses that earlier samples of the noise [B, N] excited and that still
        ring."""
        excess = self._excess(noise[:, None, None])[:, 0] * self.scales
        size = noise.shape[1] + TAPS
        later = nn.functional.pad(kernels[..., 1:], (1, 0))
        spectrum = (torch.fft.rfft(excess, size) * torch.fft.rfft(later, size)).sum(dim=1)
        return torch.fft.irfft(spectrum, size)[:, : noise.shape[1]]

    def _excess(self, gathered: Tensor) -> Tensor:
        """[B, windows, kernels, sources]: by how much the noise exceeds each threshold."""
        up, down = (gathered - self.heights).clamp(min=0.0), (gathered + self.heights).clamp(max=0.0)
        return torch.stack([up, down], dim=2).flatten(2, 3)


# Each round is right about one more in a row of impulses that ring into one another. Longer rows are rare.
_ROUNDS = 3
# One in two million samples is larger. Without a limit, kernels that fit nothing yet would let it grow from round to
# round.
_LARGEST_LIKELY_NOISE = 5.0

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
    """What the perceptrons say of a condition. coefficients [B, 24] of the filter; log_gain [B, 1] of the noise that
    drives it; swing [B, 3, 2, 5, 1], lines [B, 3, 2, 14, 1]: of cosines and sines; impulses [B, 130]; lines and
    impulses relative to the noise. log_drive [B, 1]: log RMS of noise and impulses together, as the likelihood knows
    it."""

    coefficients: Tensor
    log_gain: Tensor
    swing: Tensor
    lines: Tensor
    impulses: Tensor
    log_drive: Tensor


def _limited(values: Tensor, limit: float) -> Tensor:
    return limit * torch.tanh(values / limit)


class Skeleton(nn.Module):
    """Segments in unit scale from noise, the skeleton's own past, material, motion and phases.

    impulse_factors [130]: on what the perceptron says of impulses; a file's last layer holds them.
    hidden: widths of the filter's perceptron and of that which says what drives it; or of one for all, as a model file
    has it. The second also says how much weaker the noise is than all that drives the filter, which is all that a
    likelihood of single samples sees: between impulses there is less. Its share of the noise's gain begins at zero.
    """

    impulse_factors: Tensor

    def __init__(self, hidden: Sequence[int] = (128, 192)) -> None:
        super().__init__()
        reads = torch.ones(sum(OUTPUTS), len(hidden))
        if len(hidden) > 1:
            reads[:ORDER, 1], reads[ORDER + 1 :, 0] = 0.0, 0.0
        self.filters = hidden[0]
        self.perceptron = ConditionPerceptron(sum(OUTPUTS), hidden, RATE_FEATURES, reads)
        self.filter = AllPoleFilter(ORDER)
        self.predicted = PredictedFilter(ORDER, _POLE_DAMPING)
        self.register_buffer("impulse_factors", impulse_factors(), persistent=False)
        self.impulses = TailImpulses()
        self.swing_waves = SurfaceWaves(SWING_HARMONICS, _MAXIMUM_SWING_HZ)
        self.line_waves = SurfaceWaves(LINE_HARMONICS, _MAXIMUM_LINE_HZ)
        last = self.perceptron.layers[-1]
        with torch.no_grad():
            last.weight[ORDER, self.filters :] = 0.0
            last.weight[ORDER + 1 :] = 0.0
            last.bias[ORDER + 1 :] = 0.0

    def gains(self, embedding: Tensor, motion: Tensor, phases: Tensor) -> SkeletonGains:
        filtering, weaker, (swing, lines, impulses) = self._predictions(embedding, motion, phases)
        coefficients, log_drive = self.predicted(filtering)
        level = filtering[:, ORDER:].detach()
        return SkeletonGains(
            coefficients,
            log_drive.detach() + log_level(level + weaker) - log_level(level),
            swing.reshape(-1, FAMILIES, 2, SWING_HARMONICS, 1),
            _limited(lines.reshape(-1, FAMILIES, 2, LINE_HARMONICS, 1), _LINE_LIMIT),
            _limited(impulses * self.impulse_factors, _IMPULSE_LIMIT),
            log_drive,
        )

    def _predictions(
        self, embedding: Tensor, motion: Tensor, phases: Tensor
    ) -> tuple[Tensor, Tensor, tuple[Tensor, ...]]:
        """Raw: filter and log level [B, 25] of the first perceptron; what the second adds to the noise's log level,
        [B, 1]; swing, lines and impulses."""
        hidden, last = self.perceptron.hidden(embedding, motion, rate_features(phases)), self.perceptron.layers[-1]
        filtering, *driving = last(hidden).split(list(OUTPUTS), dim=1)
        weaker = hidden[:, self.filters :] @ last.weight[ORDER, self.filters :].unsqueeze(1)
        return torch.cat([filtering[:, :ORDER], filtering[:, ORDER:] - weaker], dim=1), weaker, tuple(driving)

    def parts(self, noise: Tensor, own: Tensor, gains: SkeletonGains, phases: Tensor) -> SkeletonParts:
        """The segment of noise [B, 1, 275], which begins 75 samples before it, after the skeleton's own past [B, 1,
        200]. Only the likelihood fits the filter; the energy distance, which trains all else, would only blur it."""
        waves = self.swing_waves(phases)
        gain = gains.log_gain.exp()
        impulses = gain.unsqueeze(2) * self.impulses(noise, gains.impulses)
        swung = noise[:, 0, NOISE_BEFORE:] * self._swung(gains, waves).exp()
        drive = gain * (swung + self._lines(gains, phases)) + impulses[:, 0]
        filtered = self.filter(drive, gains.coefficients.detach(), own[:, 0, -ORDER:])
        return SkeletonParts(filtered.clamp(-SKELETON_LIMIT, SKELETON_LIMIT).unsqueeze(1), impulses, *waves)

    def likelihood(self, segment: Tensor, gains: SkeletonGains, phases: Tensor) -> Tensor:
        """[B]: Gaussian negative log-likelihood per sample of the one-step prediction errors of a recorded segment [B,
        1, 200] beyond the lines, from the filter's 25th sample on, for as long as a hand's motion hardly changes. What was
        before the segment, which may be silence or another material, is no part of it: errors there would be a hundred
        times as large and flatten the filter."""
        heard = slice(ORDER, LIKELIHOOD_END)
        swing = self._swung(gains, self.swing_waves(phases))[:, heard]
        driven = prediction_errors(segment[:, 0, :LIKELIHOOD_END], gains.coefficients) * torch.exp(-gains.log_drive)
        noise = torch.exp(gains.log_gain - gains.log_drive).detach()
        beyond = (driven - noise * self._lines(gains, phases)[:, heard]) * torch.exp(-swing)
        return (gains.log_drive + swing + 0.5 * beyond.square()).mean(dim=1)

    def tail_likelihood(self, segment: Tensor, gains: SkeletonGains, phases: Tensor) -> Tensor:
        """[B]: negative log-likelihood per sample of what drives the filter in a recorded segment, taken for noise and the
        impulses that this noise excites. It trains the impulses and the noise's share of the gain. Filter, lines and
        swing get no gradient, because `likelihood` fits them."""
        heard = slice(ORDER, LIKELIHOOD_END)
        swing = self._swung(gains, self.swing_waves(phases))[:, heard].detach()
        errors = prediction_errors(segment[:, 0, :LIKELIHOOD_END], gains.coefficients.detach())
        driven = errors * torch.exp(-gains.log_gain) - self._lines(gains, phases)[:, heard].detach()
        noise, log_slope = self.impulses.explained(driven * torch.exp(-swing), gains.impulses)
        return (gains.log_gain - gains.log_drive.detach() + log_slope + 0.5 * noise.square()).mean(dim=1)

    def filter_distance(self, segment: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        """[B]: of the predicted filter from Burg's of a recorded segment [B, 1, 200] (models/all_pole_filter.py)."""
        return burg_distance(self._predictions(embedding, motion, phases)[0], segment[:, 0])

    def _lines(self, gains: SkeletonGains, phases: Tensor) -> Tensor:
        """[B, 200]: what the ribs themselves add to the drive, relative to its noise."""
        cosines, sines = self.line_waves(phases)
        return (gains.lines[:, :, 0] * cosines + gains.lines[:, :, 1] * sines).sum(dim=(1, 2))

    def _swung(self, gains: SkeletonGains, waves: tuple[Tensor, Tensor]) -> Tensor:
        """[B, 200]: what the ribs add to the drive's log level."""
        total = (gains.swing[:, :, 0] * waves[0] + gains.swing[:, :, 1] * waves[1]).sum(dim=(1, 2))
        return _limited(total, _SWING_LIMIT)
