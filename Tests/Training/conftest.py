"""Makes the packages of the tree, the helpers of this folder and the makers of the golden models importable."""

from __future__ import annotations

import sys
from pathlib import Path

_TESTS = Path(__file__).parent
sys.path[:0] = [str(_TESTS.parents[1] / "Training"), str(_TESTS), str(_TESTS.parent / "Golden" / "model")]
