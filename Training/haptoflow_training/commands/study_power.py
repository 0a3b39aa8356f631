"""`haptoflow-training study power`: estimate the power of a study with a planned number of participants."""

from __future__ import annotations

import argparse

from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_columns import LATENCY, STUDIES

_EXAMPLES = """examples:
  haptoflow-training study power --study similarity --participants 24 --methods 4 --difference 0.67
  haptoflow-training study power --study latency --participants 24

A similarity study is one material whose last method is rated lower than all others, which are alike, by --difference
standard deviations of the differences (Cohen's d_z). A latency study follows the paper's two curves. Every figure
stands with the interval of 95 % that so many simulations allow.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = "Simulate many studies of a planned size and count what the whole analysis finds in them."
    parser.epilog = _EXAMPLES
    parser.add_argument("--study", required=True, choices=STUDIES)
    parser.add_argument("--participants", type=int, default=24, help="5 to 999 (default 24)")
    parser.add_argument("--methods", type=int, default=4, help="similarity only: 2 to 6 (default 4)")
    parser.add_argument("--difference", type=float, default=0.67, help="similarity only: d_z, 0 to 5 (default 0.67)")
    parser.add_argument(
        "--equivalence-points", type=float, default=0.5, metavar="POINTS",
        help="similarity only: differences below it count as equal, in points of rating, 0.1 to 6 (default 0.5)",
    )  # fmt: skip
    parser.add_argument("--simulations", type=int, default=500, help="studies, 10 to 100000 (default 500)")
    parser.add_argument("--seed", type=int, default=1, help="0 or more (default 1)")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    _in_range("--participants", options.participants, 5, 999)
    _in_range("--methods", options.methods, 2, 6)
    _in_range("--difference", options.difference, 0, 5)
    _in_range("--equivalence-points", options.equivalence_points, 0.1, 6)
    _in_range("--simulations", options.simulations, 10, 100_000)
    if options.seed < 0:
        raise InputError(f"--seed {options.seed}: expected 0 or more")
    return _latency(options) if options.study == LATENCY else _similarity(options)


def _similarity(options: argparse.Namespace) -> int:
    from haptoflow_training.studies.power import planned_signed_rank_power, rating_power

    with tqdm(total=options.simulations, unit="study", disable=None) as progress:
        found = rating_power(
            options.participants, options.methods, options.difference,
            simulations=options.simulations, seed=options.seed, bound=options.equivalence_points,
            advance=progress.update,
        )  # fmt: skip
    planned = planned_signed_rank_power(options.participants, options.difference)
    print(f"{options.participants} participants, {options.methods} methods, d_z {options.difference:g}:")
    if options.methods > 2:
        print(f"  Friedman's test finds a difference in        {found.friedman}")
    print(f"  the pair of first and last method differs in {found.pair}, after correction")
    print(f"  that pair tested alone differs in            {found.pair_alone}")
    print(f"  planned for it by the formula, not rounded:  {100 * planned:.1f} %")
    if found.equivalence is not None:
        print(f"  methods that are alike differ in             {found.false_pair}")
        within = f"within {options.equivalence_points:g} points"
        print(f"  the first two methods are equivalent in      {found.equivalence}, {within}, after correction")
    return 0


def _latency(options: argparse.Namespace) -> int:
    from haptoflow_training.studies.power import latency_power

    with tqdm(total=options.simulations, unit="study", disable=None) as progress:
        found = latency_power(
            options.participants, simulations=options.simulations, seed=options.seed, advance=progress.update
        )
    print(f"{options.participants} participants:")
    for condition, width in found.widths_ms.items():
        covered = found.covered[condition]
        print(f"  {condition}: the threshold's interval is {width:.1f} ms wide and holds the truth in {covered}")
    print(f"  the thresholds differ in {found.differ}")
    if found.without_interval:
        print(f"  {found.without_interval} of {options.simulations} studies have no interval")
    return 0


def _in_range(name: str, value: float, lowest: float, highest: float) -> None:
    if not lowest <= value <= highest:
        raise InputError(f"{name} {value:g}: expected {lowest:g} to {highest:g}")
