"""The methods that the HaptoFlow paper compares itself with, each in our form: layer sizes are not public."""

from __future__ import annotations

from haptoflow_training.models.baselines.autoregressive import AutoregressiveBaseline
from haptoflow_training.models.baselines.baseline import Baseline, BaselineGraph
from haptoflow_training.models.baselines.dstn import DstnBaseline
from haptoflow_training.models.baselines.spsi import SpsiBaseline
from haptoflow_training.models.baselines.transformer import TransformerBaseline

_BUILDERS: dict[str, type[Baseline]] = {
    "transformer": TransformerBaseline,
    "dstn": DstnBaseline,
    "spsi": SpsiBaseline,
    "autoregressive": AutoregressiveBaseline,
}
ARCHITECTURES = tuple(_BUILDERS)

__all__ = ["ARCHITECTURES", "Baseline", "BaselineGraph", "build_baseline"]


def build_baseline(architecture: str) -> Baseline:
    """An untrained baseline. Raises ValueError with the known names if there is none of this one."""
    if architecture not in _BUILDERS:
        raise ValueError(f"unknown baseline '{architecture}': expected one of {', '.join(ARCHITECTURES)}")
    return _BUILDERS[architecture]()
