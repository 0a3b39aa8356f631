"""The validation as tables for a page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from haptoflow_training.markdown import table
from haptoflow_training.studies.plans import CONDITIONS


def page_words(found: Mapping[str, Any]) -> str:
    """Markdown of what `validated` returned; every rate with the interval of 95 % that so many studies allow."""
    return "\n\n".join(
        [
            f"{found['participants']} simulated participants a study, seed {found['seed']}, SciPy {found['scipy']}.",
            *_thresholds(found),
            *_intervals(found),
            *_false_positives(found),
            *_planted(found),
            *_equivalence(found),
        ]
    )


def _rate(value: Mapping[str, float]) -> str:
    return f"{100 * value['rate']:.1f} % ({100 * value['low']:.1f}-{100 * value['high']:.1f})"


def _thresholds(found: Mapping[str, Any]) -> list[str]:
    headings = ("condition", "truth, ms", "mean threshold, ms", "spread between studies, ms", "mean standard error, ms")
    rows = [
        [
            condition, str(one["truth_ms"]), str(one["mean_ms"]), str(one["spread_ms"]),
            str(one["mean_standard_error_ms"]), _rate(one["covered"]),
        ]
        for condition, one in found["thresholds"].items()
    ]  # fmt: skip
    return [
        f"Thresholds, {found['studies']} studies written as logs, read and analysed:",
        table([*headings, "interval of 95 % holds the truth"], rows),
    ]


def _intervals(found: Mapping[str, Any]) -> list[str]:
    headings = ["correlation", "interval"]
    for condition in CONDITIONS:
        headings += [f"{condition} holds the truth", "width, ms"]
    rows = []
    for case in found["intervals"]:
        for name, by_condition in case["by_interval"].items():
            cells = [cell for one in by_condition.values() for cell in (_rate(one), f"{one['median_width_ms']:.1f}")]
            rows.append([str(case["between"]), name, *cells])
    return [
        f"Which interval, {found['simulations']} studies a row; the correlation is that of one participant's answers:",
        table(headings, rows),
    ]


_FALSE_POSITIVES = {
    "friedman": "four methods alike: Friedman's test",
    "wilcoxon": "the same: one pair by Wilcoxon's test alone",
    "any_pair_after_shaffer": "the same: any of the six pairs, after Friedman's test and correction",
    "friedman_crowded": "ratings crowded at 6 and 7: Friedman's test",
    "wilcoxon_crowded": "the same: one pair by Wilcoxon's test alone",
    "any_pair_crowded": "the same: any of the six pairs, after Friedman's test and correction",
    "any_pair_of_three_alike_beside_a_lower_one": "one method lower by d_z 1.5: any pair of the three others",
}


def _false_positives(found: Mapping[str, Any]) -> list[str]:
    rates = found["false_positives"]
    return [
        f"False findings at a level of 5 %, {found['simulations']} studies each:",
        table(("what", "found in"), ([words, _rate(rates[key])] for key, words in _FALSE_POSITIVES.items())),
    ]


def _planted(found: Mapping[str, Any]) -> list[str]:
    planted, planned = found["planted"], found["planned"]
    words = {
        "friedman": "Friedman's test",
        "pair": "the pair, after correction",
        "pair_alone": "the pair, tested alone",
    }
    headings = (
        "found by",
        f"planned by `study power`, {found['simulations']} studies",
        f"found in the logs of {found['studies']} studies, three materials each",
    )
    return [
        f"One method rated below three others by d_z {planted['difference_dz']}, before rounding to whole ratings:",
        table(headings, ([said, _rate(planned[key]), _rate(planted[key])] for key, said in words.items())),
        f"Three materials of each study had no difference; Friedman's test found one on "
        f"{_rate(planted['friedman_without_difference'])} of them. For differences that are not rounded, G*Power's "
        f"formula plans {100 * planned['formula']:.1f} %, and Wilcoxon's test found {_rate(planned['unrounded'])}.",
    ]


def _equivalence(found: Mapping[str, Any]) -> list[str]:
    by_bound = found["equivalence"]
    counts = list(next(iter(by_bound.values()))["alike"])
    studies = round(next(iter(by_bound.values()))["at_the_bound"]["of"])
    headings = ["bound, points", 'false "equal", one pair alone', "any of four such pairs of six, corrected"]
    rows = (
        [bound, *(_rate(each) for each in (one["at_the_bound"], one["any_of_four"], *one["alike"].values()))]
        for bound, one in by_bound.items()
    )
    return [
        f"Equivalence, {studies} studies each. False \"equal\": the means are just the bound apart; the last "
        "columns: a given pair of four methods that are alike is found equivalent, after Holm's correction:",
        table([*headings, *(f"found with {count} participants" for count in counts)], rows),
    ]
