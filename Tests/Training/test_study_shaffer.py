"""Shaffer's static correction, compared with published factors and with every possible set of equal methods."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest

from haptoflow_training.studies.rating_tests import adjusted, factors, possible_true_counts


@pytest.mark.parametrize(
    ("methods", "published"),
    [
        # Shaffer (1986), table 1 and its procedure for four means.
        (4, [6, 3, 3, 3, 2, 1]),
        # Hommel (1988), Biometrika 75, page 384.
        (5, [10, 6, 6, 6, 6, 4, 4, 3, 2, 1]),
        # Holland and Copenhaver (1987), Biometrics 43, table 2.
        (6, [15, 10, 10, 10, 10, 10, 7, 7, 7, 6, 4, 4, 3, 2, 1]),
    ],
)
def test_factors_are_the_published_ones(methods: int, published: list[int]) -> None:
    assert factors(methods) == published


@pytest.mark.parametrize("methods", range(2, 7))
def test_the_possible_numbers_of_true_hypotheses_are_those_of_every_way_to_be_equal(methods: int) -> None:
    counts = {
        sum(values[first] == values[second] for first, second in combinations(range(methods), 2))
        for values in product(range(methods), repeat=methods)
    }
    assert possible_true_counts(methods) == counts


def test_adjusted_values_keep_the_order_and_stay_below_one_whatever_the_values() -> None:
    random = np.random.default_rng(4)
    for methods in range(2, 7):
        for _ in range(50):
            p_values = list(random.uniform(size=len(factors(methods))) ** 3)
            result = adjusted(p_values, methods)
            assert all(raw <= value <= 1.0 for raw, value in zip(p_values, result, strict=True))
            by_rank = [value for _, value in sorted(zip(p_values, result, strict=True))]
            assert by_rank == sorted(by_rank)


def test_a_wrong_number_of_values_is_refused() -> None:
    with pytest.raises(ValueError, match="6 pairs"):
        adjusted([0.1, 0.2], 4)
