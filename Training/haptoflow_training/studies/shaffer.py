"""Shaffer's static correction of the p-values of all pairs of k methods.

Shaffer (1986), Modified sequentially rejective multiple test procedures, J. Am. Stat. Assoc. 81, 826-831. The
hypotheses depend on each other: once one pair of three methods differs, at most one of the other two can be equal.
(SciPy has no such correction.)
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import comb

import numpy as np


@cache
def possible_true_counts(methods: int) -> frozenset[int]:
    """The possible numbers of the k (k - 1) / 2 hypotheses of equality that are true at once.

    A group of j equal methods makes j (j - 1) / 2 hypotheses true; the remaining methods divide in the same way.
    """
    if methods < 2:
        return frozenset({0})
    return frozenset(
        comb(group, 2) + rest for group in range(1, methods + 1) for rest in possible_true_counts(methods - group)
    )


def factors(methods: int) -> list[int]:
    """The factors of the smallest p-value, the next one, and so on: the largest number that can be true at that
    step."""
    pairs = comb(methods, 2)
    counts = possible_true_counts(methods)
    return [max(count for count in counts if count <= pairs - rejected) for rejected in range(pairs)]


def adjusted(p_values: Sequence[float], methods: int) -> list[float]:
    """Adjusted p-values in the given order: at most 1, and monotonic in the p-values.

    ValueError if their number is not that of the pairs.
    """
    by_rank = factors(methods)
    if len(p_values) != len(by_rank):
        raise ValueError(f"{len(p_values)} p-values; {methods} methods have {len(by_rank)} pairs")
    return stepped_down(p_values, by_rank)


def stepped_down(p_values: Sequence[float], factors_by_rank: Sequence[int]) -> list[float]:
    """The p-values, in the given order, times the factor of their rank; at most 1, and monotonic in the p-values."""
    order = np.argsort(p_values, kind="stable")
    result = np.empty(len(p_values))
    result[order] = np.maximum.accumulate(np.minimum(1.0, np.asarray(factors_by_rank) * np.asarray(p_values)[order]))
    return [float(p) for p in result]
