"""Simulated participants with known thresholds and ratings, so that tests can check whether the analysis recovers
them. Their logs are marked as simulated and are never mixed with real ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import special
from scipy.stats import norm

from haptoflow_training.studies.plans import TURN_OFF, TURN_ON
from haptoflow_training.studies.psychometric import Curve

# Section 4.2 of the paper.
PAPER_CURVES: Mapping[str, Curve] = {TURN_ON: Curve(0.0214, 130.25), TURN_OFF: Curve(0.0311, 107.74)}
LEVELS_MS = tuple(float(level) for level in range(50, 251, 20))
MATERIALS = ("ceramic", "jute", "wood", "plastic", "fur", "metal")
METHODS = ("haptoflow", "transformer", "dstn", "spsi")
# The effect size for which the paper's number of participants was planned.
PLANNED_DZ = 0.67


@dataclass(frozen=True)
class AnswerModel:
    """between: correlation, 0 to below 1, of a participant's answers with each other through the participant's own
    threshold. Whatever its value, the share of yes over all participants follows the curve exactly (a Gaussian
    copula of logistic thresholds), so that a fit should recover the curve."""

    curves: Mapping[str, Curve] = field(default_factory=lambda: dict(PAPER_CURVES))
    between: float = 0.3

    def answers(
        self, random: np.random.Generator, condition: str, delays_ms: np.ndarray, own: np.ndarray
    ) -> np.ndarray:
        """Yes (True) to each delay. own: a standard normal number for each participant, broadcast against delays_ms."""
        curve = self.curves[condition]
        noise = random.standard_normal(np.broadcast_shapes(delays_ms.shape, own.shape))
        quantile = norm.cdf(np.sqrt(self.between) * own + np.sqrt(1.0 - self.between) * noise)
        return np.asarray(delays_ms > curve.x0 + special.logit(quantile) / curve.k)


@dataclass(frozen=True)
class RatingModel:
    """Ratings from 1 to 7: mean, a participant's own offset, noise, rounded; in points of rating.

    lowered: for (material, method), by how many standard deviations of the differences (Cohen's d_z, before rounding)
    the method is rated below the others.
    """

    materials: Sequence[str] = MATERIALS
    methods: Sequence[str] = METHODS
    lowered: Mapping[tuple[str, str], float] = field(default_factory=dict)
    mean: float = 4.2
    between: float = 0.7
    noise: float = 1.1

    def ratings(self, random: np.random.Generator, participants: int) -> np.ndarray:
        """Ratings, materials by participants by methods."""
        shape = (len(self.materials), participants, len(self.methods))
        own = random.normal(0.0, self.between, (1, participants, 1))
        values = self.mean + own + random.normal(0.0, self.noise, shape)
        for (material, method), standard_deviations in self.lowered.items():
            shift = standard_deviations * np.sqrt(2.0) * self.noise
            values[list(self.materials).index(material), :, list(self.methods).index(method)] -= shift
        return np.asarray(np.clip(np.round(values), 1, 7))


def planted(materials: Sequence[str], methods: Sequence[str], difference_dz: float) -> RatingModel:
    """The last method is rated lower on every second material, beginning with the first; 0 lowers none."""
    lowered = {(material, methods[-1]): difference_dz for material in materials[::2]} if difference_dz else {}
    return RatingModel(materials, methods, lowered)
