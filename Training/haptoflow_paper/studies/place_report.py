"""Writes the measured part of results/place.md: tables of the study's figures, and which goals are met."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_render import FULL_SCALE_MPS2, read_wav, render_motion
from haptoflow_paper.report.cell_figures import BY_KEY, JUDGED, measure_cell, spread
from haptoflow_paper.report.told_apart import told_apart_percent
from haptoflow_paper.studies.place_study import bumps_found, second_passes, summary
from haptoflow_paper.rows.reference_set import ReferencePair
from haptoflow_paper.report.accuracy_time import verdict
from haptoflow_training.model_stamp import model_line, table

# Goals: the least median over random labels; None where likeness is not wanted and chance is.
GOALS: dict[str, float | None] = {
    "same direction and speed": 0.97, "20 % faster": 0.9, "twice as fast": 0.68, "half as fast": 0.68, "backwards": 0.68,
    "object moved and turned": 0.97, "second round of a circle": 0.65, "0.1 mm beside": 0.4, "1 mm beside": None,
    "another object": None,
}  # fmt: skip
_RULED_GOAL = 0.9
# Two passes of other objects have this correlation at the best of 81 shifts; a path beside is as unlike as that.
_CHANCE_MARGIN = 0.05


def page_words(results: Mapping[str, Any]) -> str:
    likeness = results["likeness"]
    now, before = likeness["now"], likeness.get("before")
    chance = summary(now, "another object")["median"]
    rows = [
        _row(name, summary(now, name), None if before is None else summary(before, name), chance)
        for name in [*second_passes(), "second round of a circle"]
    ]
    parts = [
        model_line(results["model_sha256"]), table(_head(before is not None), rows), _bump_words(now),
        _accuracy_words(results.get("accuracy")), _hand_over_words(results["hand_overs"]),
        _creeping_words(results["creeping"]), _held_words(results.get("held", ())),
    ]  # fmt: skip
    return "\n\n".join(parts)


def _head(has_baseline: bool) -> list[str]:
    columns = ["second pass", "random labels: median (least to most)", "goal", "shift, mm"]
    columns += ["mesh, corduroy, jute, without a shift"]
    return columns + (["before: median"] if has_baseline else [])


def _row(name: str, found: Mapping[str, Any], before: Mapping[str, Any] | None, chance: float) -> list[str]:
    goal = GOALS[name]
    met = found["median"] <= chance + _CHANCE_MARGIN if goal is None else found["median"] >= goal
    aim = "chance" if goal is None else f"{goal:g}"
    ruled = ", ".join(f"{value:.2f}" for value in found["ruled"].values())
    if name == "same direction and speed":
        missed = [label for label, value in found["ruled"].items() if value < _RULED_GOAL]
        ruled += f" (goal {_RULED_GOAL:g}: " + (f"missed by {', '.join(missed)})" if missed else "met)")
    cells = [name, f"{found['median']:.2f} ({found['least']:.2f} to {found['most']:.2f})"]
    cells += [f"{aim}: {'met' if met else 'missed'}", f"{found['shift_mm']:.2f}", ruled]
    return cells + ([] if before is None else [f"{before['median']:.2f}"])


def _bump_words(now: Mapping[str, Any]) -> str:
    found = bumps_found(now)
    if found["bumps"] == 0:
        return "No bumps: none of the labels measured has outsized asperities."
    missed = "" if found["again"] >= 0.9 * found["bumps"] else " Goal missed: the same millimetre should have them again."
    return (
        f"Of {found['bumps']} peaks above 4.5 times the RMS (stone, concrete and brick, half a metre at 30 mm/s), the "
        f"next pass has {found['again']} within a millimetre; another object would have {found['by_chance']} by "
        f"chance.{missed}"
    )


def _hand_over_words(by_label: Mapping[str, Sequence[Mapping[str, float]]]) -> str:
    """Rows of one engine, or of two beside each other: now, before."""
    names = ["now", "before"][: len(next(iter(by_label.values())))]
    table_rows = []
    for words, key, chance in (("loudest 5 ms", "burst", "burst_chance"), ("swing", "swing", "chance")):
        cells = [_median_and_most([rows[index][key] for rows in by_label.values()]) for index in range(len(names))]
        cells.append(_median_and_most([rows[0][chance] for rows in by_label.values()]))
        table_rows.append([words, *cells])
    return table(["above 300 Hz, folded at the hop, dB: median (most)", *names, "by chance"], table_rows)


def _median_and_most(values: Sequence[float]) -> str:
    return f"{np.median(values):.2f} ({max(values):.2f})"


def _creeping_words(creeping: Mapping[str, Any]) -> str:
    speeds = list(next(iter(creeping.values()))["now"])
    table_rows = []
    for label, rows in creeping.items():
        cells = [
            "; ".join(f"{rows[name][speed]['peak_mps2']:.2f} ({rows[name][speed]['kurtosis']:.0f})" for name in rows)
            for speed in speeds
        ]
        table_rows.append([label, *cells])
    headings = [f"{speed} mm/s; recorder" for speed in speeds]
    return table(["creeping, peak in m/s² (kurtosis)", *headings], table_rows)


def _held_words(held: Sequence[Mapping[str, float]]) -> str:
    if not held:
        return ""
    silent = [each["diameter_mm"] for each in held if each["peak_mps2"] == 0.0]
    heard = [each["diameter_mm"] for each in held if each["peak_mps2"] > 0.0]
    words = f"Of {len(held)} stretches in which a recorded pen was held, {len(silent)} are exactly silent"
    words += f", with tremor of up to {max(silent):.2f} mm across" if silent else ""
    return words + (f"; heard are {', '.join(f'{size:.2f} mm' for size in heard)} (goal missed)." if heard else ".")


def _accuracy_words(accuracy: Mapping[str, Any] | None) -> str:
    if accuracy is None or "before" not in accuracy:
        return ""
    table_rows = []
    for key, outcome in accuracy["verdict"].items():
        now, before = (accuracy[name].get(key) for name in ("now", "before"))
        if now is not None and before is not None:
            shown = [f"{each['median']:.3g}, {each['p90']:.3g}" for each in (now, before)]
            table_rows.append([BY_KEY[key].words, *shown, outcome])
    headings = ["accuracy of whole renders", "now: median, p90", "before: median, p90", "now is"]
    return table(headings, table_rows)


_Cell = dict[str, Any]
_Floats = NDArray[np.float32]

_CONTINUOUS_SHARE = 0.98


def steady_pairs(pairs: Sequence[ReferencePair]) -> list[ReferencePair]:
    """All pairs but those that change the label under the tip, which a plane of one label cannot."""
    return [pair for pair in pairs if pair.condition.kind != "change"]


def measure_cells(
    engine: Path, model: Path, pairs: Sequence[ReferencePair], workers: int, advance: Callable[[], object]
) -> list[_Cell]:
    """The cells of every pair, rendered with contact model and voice."""

    def rendered(pair: ReferencePair) -> _Floats:
        wave = _rendered(engine, model, pair)
        advance()
        return wave

    with ThreadPoolExecutor(workers) as pool:
        waves = list(pool.map(rendered, pairs))
    none = np.zeros(0, dtype=np.float32)
    cells = [
        measure_cell(pair, wave, none, np.zeros(0, dtype=np.int64)) for pair, wave in zip(pairs, waves, strict=True)
    ]
    for cell, percent in zip(cells, told_apart_percent(pairs, waves), strict=True):
        cell["told_apart_percent"] = percent
    return cells


def _rendered(engine: Path, model: Path, pair: ReferencePair) -> _Floats:
    """The voice's own 2 kHz waveform, from the onset on; where the pen stops in between, the output brought back to
    2 kHz, whose highest 100 Hz depend on where its samples lie between the waveform's."""
    length = len(pair.recorded)
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "waveform.wav"
        options = ("--waveform", str(path))
        render = render_motion(engine, pair.condition.label, pair.motion, Path(name), model=model, options=options)
        waveform = read_wav(path) * FULL_SCALE_MPS2
    has_pauses = len(waveform) < _CONTINUOUS_SHARE * length
    if has_pauses:
        wave = render.waveform_mps2[:length].astype(np.float32)
        return np.pad(wave, (0, length - len(wave)))
    return np.pad(waveform, (max(0, length - len(waveform)), 0))[-length:].astype(np.float32)


def accuracy_report(now: Sequence[_Cell], before: Sequence[_Cell] | None) -> dict[str, Any]:
    """Spread of every judged figure of each engine, and the verdict between them: ahead, even or behind."""
    report: dict[str, Any] = {"now": _spreads(now)}
    if before is not None:
        report |= {"before": _spreads(before), "verdict": verdict(now, before)}
    return report


def _spreads(cells: Sequence[_Cell]) -> dict[str, Any]:
    return {figure.key: found for figure in JUDGED if (found := spread(cells, figure)) is not None}
