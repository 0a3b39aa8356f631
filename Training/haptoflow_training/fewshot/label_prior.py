"""The prior for a material: it resembles the labels of the model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.models.label_embedding import WAVE_NUMBERS

_MINIMUM_LABELS = 4
# With few labels the spread of the exponents is unknown; these values are those of the published textures.
_FORCE_EXPONENT, _SPEED_EXPONENT = (0.25, 0.2), (0.95, 0.25)
_MINIMUM_SPREAD = 0.1


@dataclass(frozen=True)
class LabelPrior:
    """embedding_mean [n]; axes [k, n]: orthonormal principal axes of the labels' learnt numbers; spreads [k]:
    standard deviations along them, descending. force_exponent and speed_exponent of the level: mean and standard
    deviation."""

    embedding_mean: NDArray[np.float64]
    axes: NDArray[np.float64]
    spreads: NDArray[np.float64]
    force_exponent: tuple[float, float]
    speed_exponent: tuple[float, float]

    @classmethod
    def of(cls, model: ModelFile) -> LabelPrior:
        labels = model.header["labels"]
        rows = model.tensors["embedding"][[label["embedding_row"] for label in labels]].astype(np.float64)
        learnt = rows[:, :-WAVE_NUMBERS]
        mean = learnt.mean(axis=0)
        _, sizes, axes = np.linalg.svd(learnt - mean, full_matrices=False)
        kept = sizes > 1e-6 * max(sizes[0], 1e-12)
        spreads = sizes[kept] / np.sqrt(max(len(labels) - 1, 1))

        def spread_of(key: str, known: tuple[float, float]) -> tuple[float, float]:
            values = [label["level_exponents"][key] for label in labels]
            if len(values) < _MINIMUM_LABELS:
                return known
            return float(np.mean(values)), max(_MINIMUM_SPREAD, float(np.std(values)))

        return cls(
            mean,
            axes[kept],
            spreads,
            spread_of("force", _FORCE_EXPONENT),
            spread_of("speed", _SPEED_EXPONENT),
        )
