"""Exponential moving average of a module's weights. The average is validated and exported, not the last step."""

from __future__ import annotations

import copy

import torch
from torch import nn


class MovingAverage:
    """average <- decay average + (1 - decay) weights, with the decay ramped up over the first steps."""

    def __init__(self, module: nn.Module, decay: float) -> None:
        self.module = copy.deepcopy(module).eval().requires_grad_(False)
        self._decay = decay
        self._updates = 0

    @torch.no_grad()
    def update(self, module: nn.Module) -> None:
        self._updates += 1
        decay = min(self._decay, (1.0 + self._updates) / (10.0 + self._updates))
        for average, weight in zip(self.module.parameters(), module.parameters(), strict=True):
            average.lerp_(weight.detach(), 1.0 - decay)

    def state(self) -> dict[str, object]:
        return {"module": self.module.state_dict(), "updates": self._updates}

    def restore(self, state: dict[str, object]) -> None:
        self.module.load_state_dict(state["module"])  # type: ignore[arg-type]
        self._updates = int(state["updates"])  # type: ignore[call-overload]
