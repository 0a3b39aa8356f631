"""The few-shot study as results file, tables and chart."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark import waveform_metrics as metrics
from haptoflow_paper.studies.few_shot_cases import FewShotCondition
from haptoflow_paper.report import row_metrics, temporal_metrics as temporal
from haptoflow_training.model_stamp import model_line, picture_metadata
from haptoflow_training.whole_file import write_whole

_RESAMPLES, _SEED = 400, 11
_INTERVAL = (0.025, 0.975)

Cell = Mapping[str, float]

_SUMMARIES = {
    "level_error_median_db": ("level_error_db", lambda values: np.median(np.abs(values))),
    "level_error_p90_db": ("level_error_db", lambda values: np.quantile(np.abs(values), 0.9)),
    "gfc_mean": ("gfc", np.mean),
    "gfc_min": ("gfc", np.min),
    "lsd_median_db": ("lsd_db", np.median),
    "lsd_p90_db": ("lsd_db", lambda values: np.quantile(values, 0.9)),
    "kurtosis_log_ratio": ("kurtosis_log_ratio", lambda values: np.mean(np.abs(values))),
    "crest_log_ratio": ("crest_log_ratio", lambda values: np.mean(np.abs(values))),
    "modulation_error_db": ("modulation_error_db", np.mean),
    "rib_fundamental_error_percent": ("rib_fundamental_error_percent", np.median),
    "rib_modulation_error_db": ("rib_modulation_error_db", lambda values: np.mean(np.abs(values))),
}


def summarised(cells_by_material: Sequence[Sequence[Cell]]) -> dict[str, Any]:
    """Each figure over all conditions of all materials, with a 95 % interval from resampling materials."""
    drawn = np.random.default_rng(_SEED).integers(len(cells_by_material), size=(_RESAMPLES, len(cells_by_material)))
    summary: dict[str, Any] = {}
    for name, (key, reduce) in _SUMMARIES.items():
        by_material = [np.array([cell[key] for cell in cells if key in cell]) for cells in cells_by_material]
        if not any(len(values) for values in by_material):
            continue
        values = [np.concatenate([by_material[index] for index in row]) for row in drawn]
        spread = np.quantile([reduce(each) for each in values if len(each)], _INTERVAL)
        summary[name] = {
            "value": round(float(reduce(np.concatenate(by_material))), 4),
            "interval": [round(float(edge), 4) for edge in spread],
        }
    return summary


ROWS = {
    "learn": "learnt by `haptoflow learn` or `add-material`",
    "trained": "all together, as labels, by `haptoflow-training train`",
    "autoregressive-3": "autoregressive (AR), order 20, three speed bins",
    "autoregressive-1": "autoregressive (AR), order 20, one model",
}
OTHER_DRAW = "other draw"
_MAIN_SECONDS = 10.0


def assembled(cells: Sequence[Mapping[str, Any]], header: Mapping[str, Any]) -> dict[str, Any]:
    """All rows over the recorder's materials, those with and without ribs, and over those in the published form."""
    groups = _groups(cells)
    names = list(cells[0]["rows"])
    results = {
        group: {name: summarised([cell["rows"][name] for cell in members]) for name in names}
        for group, members in groups.items()
        if members
    }
    spent = {
        name: round(sum(cell["core_seconds"][name] for cell in cells) / len(cells), 2)
        for name in cells[0]["core_seconds"]
    }
    return {
        **header,
        "materials": [
            {"name": cell["material"], "filtered": cell["filtered"], "ruled": cell["ruled"], "impacts": cell["impacts"], **cell["notes"]}
            for cell in cells
        ],
        "core_seconds_per_material": spent,
        "ahead": {group: _ahead(members, header["seconds"]) for group, members in groups.items() if members},
        "results": results,
    }


def _groups(materials: Sequence[Mapping[str, Any]]) -> dict[str, list[Mapping[str, Any]]]:
    """The recorder's materials, those of them without and with ribs, and those in the published form."""
    recorded = [each for each in materials if not each["filtered"]]
    return {
        "all": recorded,
        "without ribs": [each for each in recorded if not each["ruled"]],
        "with ribs": [each for each in recorded if each["ruled"]],
        "published form": [each for each in materials if each["filtered"]],
    }


def _ahead(cells: Sequence[Mapping[str, Any]], lengths: Sequence[float]) -> dict[str, dict[str, int]]:
    """In how many materials the learnt one's median LSD and level error are below those of AR with three bins."""

    def median(cell: Mapping[str, Any], row: str, figure: str) -> float:
        return float(np.median([abs(each[figure]) for each in cell["rows"][row]]))

    return {
        f"{seconds:g}": {
            figure: sum(
                median(cell, f"learn {seconds:g}", figure) < median(cell, f"autoregressive-3 {seconds:g}", figure)
                for cell in cells
            )
            for figure in ("lsd_db", "level_error_db")
        }
        for seconds in lengths
    }


def write_results(path: Path, results: Mapping[str, Any]) -> None:
    write_whole(path, (json.dumps(results, indent=1) + "\n").encode())


def table(results: Mapping[str, Any], seconds: float, group: str = "all") -> str:
    """Markdown: the rows of one length of recording."""
    lines = [
        f"| from {seconds:g} s | level dB, p90 | GFC, min | LSD dB, p90 | ln kurtosis | ln crest | rib f0 % | "
        "rib modulation dB |",
        "|---|---|---|---|---|---|---|---|",
    ]
    rows = results["results"][group]
    named = [(f"{key} {seconds:g}", words) for key, words in ROWS.items()]
    named += [(name, f"the same on tier `{name.split()[0]}`") for name in rows if _is_tier(name, seconds)]
    named.append((OTHER_DRAW, "another draw of the true process"))
    for name, words in named:
        if name in rows:
            lines.append(f"| {words} | " + " | ".join(_cells(rows[name])) + " |")
    return "\n".join(lines)


def curve_table(results: Mapping[str, Any], figure: str, group: str = "all") -> str:
    """Markdown: one figure for each length of recording, with the intervals."""
    rows = results["results"][group]
    lengths = results["seconds"]
    lines = ["| | " + " | ".join(f"{seconds:g} s" for seconds in lengths) + " |", "|---|" + "---|" * len(lengths)]
    for key, words in ROWS.items():
        found = [rows.get(f"{key} {seconds:g}", {}).get(figure) for seconds in lengths]
        if any(found):
            lines.append(f"| {words} | " + " | ".join(_with_interval(each) for each in found) + " |")
    return "\n".join(lines)


def page_words(results: Mapping[str, Any], chart: str) -> str:
    """Markdown: the measured part of the page, with `chart` as the picture's address."""
    main = [table(results, _MAIN_SECONDS)]
    if "without ribs" in results["results"]:
        main += ["Without the ruled materials:", table(results, _MAIN_SECONDS, "without ribs")]
    if "with ribs" in results["results"]:
        main += ["The ruled materials alone:", table(results, _MAIN_SECONDS, "with ribs")]
    if "published form" in results["results"]:
        main += [
            "Further materials in the published form, an autoregressive filter for each speed and force:",
            table(results, _MAIN_SECONDS, "published form"),
        ]
    return "\n\n".join(
        [
            model_line(results["model_sha256"]),
            *main,
            ahead_table(results),
            f"![Level, GFC and LSD from 5, 10, 20 and 60 s of recording]({chart})",
            "LSD, median, with the interval of 95 % from resampling the materials:",
            curve_table(results, "lsd_median_db"),
            *_published_curve(results),
            *_rib_table(results),
            rib_words(results),
        ]
    )


def _published_curve(results: Mapping[str, Any]) -> list[str]:
    if "published form" not in results["results"]:
        return []
    return ["The same of the materials in the published form:", curve_table(results, "lsd_median_db", "published form")]


def ahead_table(results: Mapping[str, Any]) -> str:
    """Markdown: in how many materials `learn` is ahead of AR with three bins, for each length of recording."""
    lengths = [f"{seconds:g}" for seconds in results["seconds"]]
    counts = {group: len(members) for group, members in _groups(results["materials"]).items()}
    lines = [
        "| ahead of AR with three bins in LSD / level, materials | " + " | ".join(f"{each} s" for each in lengths) + " |",
        "|---|" + "---|" * len(lengths),
    ]
    words = {"all": "of the recorder", "published form": "in the published form"}
    for group, ahead in results["ahead"].items():
        cells = [f"{ahead[each]['lsd_db']} / {ahead[each]['level_error_db']}" for each in lengths]
        lines.append(f"| {words.get(group, group)}, {counts[group]} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _rib_table(results: Mapping[str, Any]) -> list[str]:
    """Markdown: families of ribs found and wrong ones, for each length of recording; none in older results."""
    if any("ribs" not in each for each in results["materials"]):
        return []
    lengths = [f"{seconds:g}" for seconds in results["seconds"]]
    lines = [
        "| families of ribs: there / found / wrong | " + " | ".join(f"{each} s" for each in lengths) + " |",
        "|---|" + "---|" * len(lengths),
    ]
    for group, members in _groups(results["materials"]).items():
        if members and group != "all":
            there = sum(each["families"] for each in members)
            counts = [np.sum([each["ribs"][length] for each in members], axis=0) for length in lengths]
            lines.append(f"| {group}, {len(members)} | " + " | ".join(f"{there} / {a} / {b}" for a, b in counts) + " |")
    return ["\n".join(lines)]


def rib_words(results: Mapping[str, Any]) -> str:
    """One sentence: how many families of ribs were found in ten seconds, and how long learning took."""
    families, found, wrong = (
        sum(each[key] for each in results["materials"]) for key in ("families", "ribs_found", "ribs_wrong")
    )
    spent = results["core_seconds_per_material"][f"learn {_MAIN_SECONDS:g}"]
    return (
        f"In ten seconds {found} of {families} families of ribs were found within 2 %, {wrong} wrong. Learning took "
        f"{spent:.1f} s of one core a material."
    )


def write_chart(path: Path, results: Mapping[str, Any]) -> None:
    """Level, GFC and LSD over seconds of recording, PNG; intervals as bands."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    rows, lengths = results["results"]["all"], results["seconds"]
    panels = (
        ("level_error_p90_db", "level error, 90th percentile (dB)"),
        ("gfc_mean", "GFC, mean"),
        ("lsd_median_db", "LSD 20-450 Hz, median (dB)"),
    )
    figure, axes = pyplot.subplots(1, len(panels), figsize=(13.0, 4.7))
    for axis, (key, words) in zip(axes, panels, strict=True):
        for row, label in ROWS.items():
            known = [(seconds, rows[f"{row} {seconds:g}"][key]) for seconds in lengths if f"{row} {seconds:g}" in rows]
            places = [seconds for seconds, _ in known]
            (line,) = axis.plot(places, [entry["value"] for _, entry in known], marker="o", label=label)
            if row in ("learn", "autoregressive-3"):
                low, high = zip(*(entry["interval"] for _, entry in known), strict=True)
                axis.fill_between(places, low, high, color=line.get_color(), alpha=0.15, linewidth=0)
        axis.axhline(rows[OTHER_DRAW][key]["value"], color="grey", linestyle=":", label="another draw")
        axis.set_xscale("log")
        axis.set_xticks(lengths, [f"{seconds:g}" for seconds in lengths])
        axis.minorticks_off()
        axis.set_xlabel("seconds of recording")
        axis.set_title(words, fontsize=10)
        axis.grid(alpha=0.3)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=4, fontsize=8)
    figure.subplots_adjust(left=0.04, right=0.99, top=0.93, bottom=0.25, wspace=0.16)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110, metadata=picture_metadata(results["model_sha256"]))
    pyplot.close(figure)


def _is_tier(name: str, seconds: float) -> bool:
    word = name.split()[0]
    return name == f"{word} {seconds:g}" and word not in ROWS and word != "other"


def _cells(row: Mapping[str, Any]) -> list[str]:
    def value(name: str, form: str) -> str:
        return form.format(row[name]["value"]) if name in row else "-"

    def both(first: str, second: str, form: str) -> str:
        return f"{value(first, form)}, {value(second, form)}"

    return [
        both("level_error_median_db", "level_error_p90_db", "{:.2f}"),
        both("gfc_mean", "gfc_min", "{:.3f}"),
        both("lsd_median_db", "lsd_p90_db", "{:.2f}"),
        value("kurtosis_log_ratio", "{:.2f}"),
        value("crest_log_ratio", "{:.3f}"),
        value("rib_fundamental_error_percent", "{:.2f}"),
        value("rib_modulation_error_db", "{:.1f}"),
    ]


def _with_interval(entry: Mapping[str, Any] | None) -> str:
    if entry is None:
        return "-"
    low, high = entry["interval"]
    return f"{entry['value']:.3g} ({low:.3g}-{high:.3g})"


BAND_HZ = (20.0, 450.0)
SETTLING_SAMPLES = 400
_LINES_HZ = (20.0, 800.0)
_MINIMUM_DEPTH = 0.1


def condition_figures(condition: FewShotCondition, wave: NDArray[np.floating]) -> dict[str, float]:
    """The figures of one condition; those that do not apply to it are left out."""
    made, recorded = wave[SETTLING_SAMPLES:], condition.recorded[SETTLING_SAMPLES:]
    crest = [temporal.crest_factor(each) for each in (made, recorded)]
    cell = {
        "level_error_db": metrics.level_error_db(made, recorded),
        "gfc": metrics.gfc_recording(made, recorded),
        "lsd_db": metrics.log_spectral_distance_db(made, recorded, BAND_HZ),
        "kurtosis_log_ratio": temporal.log_ratio(temporal.kurtosis(made), temporal.kurtosis(recorded)),
        "crest_log_ratio": temporal.log_ratio(*crest),
        "modulation_error_db": temporal.modulation_error_db(made, recorded),
    }
    for rate in condition.rib_rates_hz[:1]:
        if _LINES_HZ[0] < rate < _LINES_HZ[1]:
            pitch = [row_metrics.fundamental_hz(each, rate) for each in (made, recorded)]
            cell["rib_fundamental_error_percent"] = 100.0 * abs(pitch[0] / pitch[1] - 1.0)
        if temporal.rib_modulation_depth(recorded, rate) >= _MINIMUM_DEPTH:
            cell["rib_modulation_error_db"] = temporal.rib_modulation_error_db(made, recorded, rate)
    return cell
