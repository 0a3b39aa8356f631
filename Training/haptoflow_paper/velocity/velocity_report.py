"""The study of velocity estimators as tables and verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from haptoflow_paper.velocity.velocity_study import HEADSET_RATES_HZ, PRODUCT, TODAY, pooled_rms
from haptoflow_training.markdown import table

_SCRIBBLES = ("scribble 2 Hz", "scribble 3 Hz", "scribble 5 Hz")
_SLOW = ("slow 2 mm/s", "slow 5 mm/s", "slow 10 mm/s", "slow 20 mm/s")
_NOISE_MM = 0.1
_ALLOWED_INTERVALS = 1.5
_Cells = Sequence[Mapping[str, Any]]


def page_words(results: Mapping[str, Any]) -> str:
    """Markdown of the page's measured part."""
    rows, persons = results["rows"], results["reporting"]
    return "\n\n".join(
        [
            f"Persons {', '.join(persons)}, on whom nothing was chosen; commit `{results['commit'][:12]}`. Noise of "
            f"{_NOISE_MM} mm on each axis, 72, 90 and 120 Hz together:",
            estimators_table(rows),
            "The product beside the line over 35 ms (product / line), by rate and noise:",
            rates_table(rows),
            verdict_words(rows),
        ]
    )


def estimators_table(rows: Mapping[str, Any]) -> str:
    """A row for each estimator."""
    headings = [
        "estimator", "2, 3, 5 Hz scribble, dB", "reversals, dB", "real strokes, dB; vector, mm/s",
        "slow strokes, vector, mm/s", "rest, mm/s", "half of a step, intervals; 95th percentile",
    ]  # fmt: skip
    lines = []
    for name, row in rows.items():
        cells = [each for each in row["cells"] if each["rate_hz"] in HEADSET_RATES_HZ and _is_near(each, _NOISE_MM)]
        settings = ", ".join(f"{key} {value:g}" for key, value in row["settings"].items())
        lines.append([
            f"**{name}**" if name == PRODUCT else f"{name}{f' ({settings})' if settings else ''}",
            ", ".join(f"{_of(cells, kind, 'speed_error_db'):.1f}" for kind in _SCRIBBLES),
            f"{_of(cells, 'reversals', 'speed_error_db'):.1f}",
            f"{_of(cells, 'real', 'speed_error_db'):.1f}; {_of(cells, 'real', 'vector_error_mmps'):.0f}",
            f"{pooled_rms(_of(cells, kind, 'vector_error_mmps') for kind in _SLOW):.1f}",
            f"{_of(cells, 'rest', 'speed_mmps'):.1f}",
            f"{_mean(cells, 'half_intervals'):.1f}; {_mean(cells, 'half_intervals_p95'):.1f}",
        ])  # fmt: skip
    return table(headings, lines)


def rates_table(rows: Mapping[str, Any]) -> str:
    """The product and today's line at every rate and noise."""
    cells = rows[PRODUCT]["cells"]
    lines = []
    for rate in sorted({each["rate_hz"] for each in cells}):
        for noise in sorted({each["noise_mm"] for each in cells}):
            both = [
                [each for each in rows[name]["cells"] if each["rate_hz"] == rate and _is_near(each, noise)]
                for name in (PRODUCT, TODAY)
            ]
            lines.append([
                f"{rate:.0f} Hz, {noise:g} mm",
                *(_pair(both, kind, "speed_error_db", "{:.1f}") for kind in (*_SCRIBBLES, "reversals", "real")),
                _pair(both, "slow 5 mm/s", "bias_mmps", "{:+.1f}"),
                _pair(both, "rest", "speed_mmps", "{:.1f}"),
                _pair(both, "steps", "half_intervals", "{:.1f}"),
            ])  # fmt: skip
    headings = ["", "2 Hz, dB", "3 Hz, dB", "5 Hz, dB", "reversals, dB", "real, dB", "bias at 5 mm/s", "rest, mm/s",
                "half of a step, intervals"]  # fmt: skip
    return table(headings, lines)


def verdicts(rows: Mapping[str, Any]) -> list[tuple[str, list[tuple[float, float]]]]:
    """Goal, and by noise the product's figure and what it may be, at headset rates together."""
    cells = {
        name: [each for each in rows[name]["cells"] if each["rate_hz"] in HEADSET_RATES_HZ] for name in (PRODUCT, TODAY)
    }
    noises = sorted({float(each["noise_mm"]) for each in cells[PRODUCT]})

    def compared(kinds: Sequence[str], figure: str, share: float) -> list[tuple[float, float]]:
        def of(name: str, noise: float) -> float:
            return pooled_rms(_of(_at(cells[name], noise), kind, figure) for kind in kinds)

        return [(of(PRODUCT, noise), share * of(TODAY, noise)) for noise in noises]

    found = [
        (f"{kind}: at most half of the line's error, dB", compared([kind], "speed_error_db", 0.5))
        for kind in _SCRIBBLES
    ]
    found.append(("slow strokes: not worse than the line, vector, mm/s", compared(_SLOW, "vector_error_mmps", 1.0)))
    found.append(("rest: not worse than the line, mm/s", compared(["rest"], "speed_mmps", 1.0)))
    intervals = [(_mean(_at(cells[PRODUCT], noise), "half_intervals"), _ALLOWED_INTERVALS) for noise in noises]
    return [*found, ("half of a step, intervals", intervals)]


def verdict_words(rows: Mapping[str, Any]) -> str:
    """Markdown: a table of goals, met or missed."""
    noises = sorted({float(each["noise_mm"]) for each in rows[PRODUCT]["cells"]})
    lines = [[goal, *(_verdict(*pair) for pair in pairs)] for goal, pairs in verdicts(rows)]
    return table(["goal, 72 to 120 Hz", *(f"{noise:g} mm" for noise in noises)], lines)


def _verdict(ours: float, allowed: float) -> str:
    # Figures are kept to thousandths.
    return f"{ours:.2f} of {allowed:.2f}: {'met' if ours <= allowed + 0.001 else '**missed**'}"


def _at(cells: _Cells, noise_mm: float) -> _Cells:
    return [each for each in cells if _is_near(each, noise_mm)]


def _is_near(cell: Mapping[str, Any], noise_mm: float) -> bool:
    return abs(float(cell["noise_mm"]) - noise_mm) < 1e-9


def _of(cells: _Cells, kind: str, figure: str) -> float:
    return pooled_rms(each[figure] for each in cells if each["kind"] == kind)


def _mean(cells: _Cells, figure: str) -> float:
    found = [each[figure] for each in cells if figure in each]
    return float(sum(found) / len(found))


def _pair(both: Sequence[_Cells], kind: str, figure: str, form: str) -> str:
    return " / ".join(
        form.format(each[figure]) for cells in both for each in cells if each["kind"] == kind and figure in each
    )
