"""Rivals: the methods that the HaptoFlow paper compares itself with. The sizes of their layers were not published."""

from __future__ import annotations

from collections.abc import Callable

from haptoflow_paper.rivals.autoregressive import AutoregressiveRival
from haptoflow_paper.rivals.transformer import DstnRival, TransformerRival
from haptoflow_paper.rivals.rival import Rival
from haptoflow_paper.rivals.spsi import SpsiRival

_BUILDERS: dict[str, Callable[..., Rival]] = {
    "transformer": TransformerRival,
    "dstn": DstnRival,
    "spsi": SpsiRival,
    "autoregressive": AutoregressiveRival,
}
ARCHITECTURES = tuple(_BUILDERS)
# Those that predict the mean as published; with `sampled` they draw a segment.
REGRESSING = ("transformer", "dstn", "spsi")
__all__ = ["ARCHITECTURES", "REGRESSING", "Rival", "build_rival"]


def build_rival(architecture: str, *, ribs: bool = False, sampled: bool = False) -> Rival:
    """An untrained rival. Raises ValueError with the known names if there is none of this name.

    ribs: it adds rib lines, as the velocity field does. sampled: it draws a segment even where its published form
    predicts the mean.
    """
    if architecture not in _BUILDERS:
        raise ValueError(f"unknown rival '{architecture}': expected one of {', '.join(ARCHITECTURES)}")
    if architecture in REGRESSING:
        return _BUILDERS[architecture](ribs=ribs, sampled=sampled)
    return _BUILDERS[architecture](ribs=ribs)
