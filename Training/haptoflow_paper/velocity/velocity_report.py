"""The study of velocity estimators as tables and verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from haptoflow_paper.velocity.velocity_figures import pooled_rms
from haptoflow_paper.velocity.velocity_study import HEADSET_RATES_HZ, PRODUCT, TODAY
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


def verdicts(rows: Mapping[str, Any]) -> list[tuple[str, float, float, bool]]:
    """Goal, the product's figure, what it may be, and whether it is met: at headset rates, with every noise."""
    cells = {
        name: [each for each in rows[name]["cells"] if each["rate_hz"] in HEADSET_RATES_HZ] for name in (PRODUCT, TODAY)
    }
    found = []
    for kind in _SCRIBBLES:
        ours, theirs = (_of(cells[name], kind, "speed_error_db") for name in (PRODUCT, TODAY))
        found.append((f"{kind}: half of the line's error, dB", ours, theirs / 2.0, ours <= theirs / 2.0))
    ours, theirs = (
        pooled_rms(_of(cells[name], kind, "vector_error_mmps") for kind in _SLOW) for name in (PRODUCT, TODAY)
    )
    found.append(("slow strokes: not worse, mm/s", ours, theirs, ours <= theirs))
    ours, theirs = (_of(cells[name], "rest", "speed_mmps") for name in (PRODUCT, TODAY))
    found.append(("rest: not worse, mm/s", ours, theirs, ours <= theirs))
    for rate in HEADSET_RATES_HZ:
        at_rate = [each for each in cells[PRODUCT] if each["rate_hz"] == rate]
        ours = _mean(at_rate, "half_intervals")
        found.append((f"half of a step at {rate:.0f} Hz, intervals", ours, _ALLOWED_INTERVALS, ours <= _ALLOWED_INTERVALS))
    return found


def verdict_words(rows: Mapping[str, Any]) -> str:
    """Markdown: a table of goals, met or missed."""
    lines = [
        [goal, f"{ours:.2f}", f"{allowed:.2f}", "met" if is_met else "**missed**"]
        for goal, ours, allowed, is_met in verdicts(rows)
    ]
    return table(["goal, all noises together", "product", "may be", ""], lines)


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
