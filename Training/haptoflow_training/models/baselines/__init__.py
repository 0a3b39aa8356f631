"""The methods that the HaptoFlow paper compares itself with, each in our form: layer sizes are not public."""

from __future__ import annotations

from collections.abc import Callable

from haptoflow_training.models.baselines.autoregressive import AutoregressiveBaseline
from haptoflow_training.models.baselines.baseline import Baseline, BaselineGraph
from haptoflow_training.models.baselines.dstn import DstnBaseline
from haptoflow_training.models.baselines.spsi import SpsiBaseline
from haptoflow_training.models.baselines.transformer import TransformerBaseline

_BUILDERS: dict[str, Callable[..., Baseline]] = {
    "transformer": TransformerBaseline,
    "dstn": DstnBaseline,
    "spsi": SpsiBaseline,
    "autoregressive": AutoregressiveBaseline,
}
ARCHITECTURES = tuple(_BUILDERS)
# What regresses as published, and can be asked to draw.
REGRESSING = ("transformer", "dstn", "spsi")

__all__ = ["ARCHITECTURES", "REGRESSING", "Baseline", "BaselineGraph", "build_baseline"]


def build_baseline(architecture: str, *, ribs: bool = False, sampled: bool = False) -> Baseline:
    """An untrained baseline: as published, or given the same as our network. Raises ValueError with the known names if
    there is none of this one.

    ribs: it adds the lines of ribs. sampled: it draws a segment even where its published form regresses one.
    """
    if architecture not in _BUILDERS:
        raise ValueError(f"unknown baseline '{architecture}': expected one of {', '.join(ARCHITECTURES)}")
    if architecture in REGRESSING:
        return _BUILDERS[architecture](ribs=ribs, sampled=sampled)
    return _BUILDERS[architecture](ribs=ribs)
