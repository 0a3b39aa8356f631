"""haptoflow_paper/results/accuracy-and-time.md, generated from accuracy-time.json."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from haptoflow_paper.report.cell_figures import BY_KEY, JUDGED
from haptoflow_paper.report.accuracy_time import AHEAD, BEHIND, EVEN, RivalVerdict, rivals
from haptoflow_paper.report.goals import judge
from haptoflow_paper.rows.row_plan import BLOCKS, OURS, RIVAL_BLOCKS
from haptoflow_training.model_stamp import model_line

INTRODUCTION = """\
| short | what it is |
|---|---|
| GFC | goodness of fit of the magnitude spectra: 1 is the recording's own spectrum, whatever the level |
| LSD | log-spectral distance between the power spectra, dB: 0 is the recording's own spectrum and level |
| crest | 99.9th percentile over RMS: how far impacts stand out |
| RMSE | root mean square error, sample by sample |
| modulation | spectrum of the envelope from 2 to 100 Hz: how the vibration rises and falls |
| told apart | share of one-second excerpts that a trained classifier assigns correctly to recording or render: 50 % is chance |
| plain | flow matching without further training, integrated by Euler's, Heun's or the midpoint rule in so many steps |
| MeanFlow, reflow | recipes that train flow matching for few steps: the mean velocity over an interval; straightened paths |
| AR | autoregressive filters, one for each condition, interpolated (after Culbertson et al. 2014) |
| SPSI | single-pass spectrogram inversion: a network predicts the magnitudes, the phases are derived from them (Heravi et al. 2024) |
| DSTN | deep spatial-temporal network: convolutions and a recurrent encoder and decoder (Joolee and Jeon 2022) |
| Transformer | an encoder and decoder with attention over the past waveform (Cai and Zhu 2022) |
| paper-codec | flow matching on the latents of a small codec, as in the paper; `paper-codec-size` has the sizes of the paper's networks, untrained, to measure time only |

The paper is Eguchi, Hiroi and Hiraki, *HaptoFlow: High-Fidelity Real-Time Vibrotactile Generation via Flow Matching for
Virtual Reality* (ISMAR 2026, [arXiv 2608.01974](https://arxiv.org/abs/2608.01974);
[project page](https://tamago117.github.io/HaptoFlow/)). It also names SPSI, DSTN and the Transformer as its rivals; their
sizes are not published, so ours are sensible small ones. Every figure is defined [below](#what-the-figures-mean).
"""

BLOCK_TITLES = {
    "ours": "Ours",
    "as-published": "As published: each rival in its published form",
    "given-the-same": "Given the same: rivals with our inputs, level model and training time",
    "ablation": "Ablations: the skeleton's recipe without one part, and a network without the skeleton",
    "reference": "References",
}

DEFINITIONS = """\
## What the figures mean

Everything is measured on held-out recordings, through the C++ engine, in closed loop at 72 Hz: the
network's previous waveform is its own output, from silence on. The recordings are synthetic (`recorder-report.md`).

**The grid.** Every label is stroked at 0.01, 0.03, 0.08, 0.15, 0.275, 0.5, 1 and 1.5 m/s with 0.2 to 3 N, 12 to 60
seconds each, longest where impacts are rare. Ruled labels are also crossed at 15, 30, 45 and 60 degrees from the straight
direction, those with a nap along and against it. Further recordings turn back every second, start and stop, follow a free hand,
or change label every half second. 0.25-0.3 m/s, 1.2-1.5 N and directions from 215 to 235 degrees are left out of
training, level calibration, seeds and exponents. A cell is one recording.

**Medians, tails, intervals.** Where a figure has one number only, it is the median over labels of each label's mean, or
for band errors, fundamentals and harmonics the median over cells. `median`, `p90` and `worst` are of the sizes of the
errors over cells: nine cells in ten are at least as good as p90. For told apart they are over labels. Intervals in the
JSON are 95 % bootstrap intervals over recordings, drawn within labels.

**Ahead, even, behind.** Rivals and ablations are judged against `sketch-same-time`, which is the recipe of `sketch` at
their own time of one core, 500 seconds; the shipped tiers were trained longer, and are judged beside each other. Two
rows are compared on the same recordings: the size of the rival's error less that of ours, the mean over labels of each
label's mean. Ahead means that its 95 % bootstrap interval lies above zero, behind that it lies below, even that it holds
zero. Rows of one network at several numbers of steps are one rival; each figure is compared by the best of them. Rows of
more than one evaluation a segment are measured on every fourth recording (¼), and judged against ours on the same ones,
`sketch-same-time-quarter`.

| figure | definition |
|---|---|
| level | 20 log10 of generated RMS over recorded RMS, signed |
| GFC | of magnitude spectra averaged over the recording, 1024-sample Hann windows: sum A B / sqrt(sum A² sum B²) |
| LSD | RMS over 20-1000 Hz of the difference of mean power spectra in dB, 128 ms windows |
| bands | median size of the energy error in nine critical bands (Bark edges, 20-1000 Hz), dB |
| f0 | ribs passing 20 to 800 times a second: error of the fundamental, of the worse family where there are two |
| harmonics | share h of the power within 3 % of the fundamental's multiples over the recording's, folded: min(h, 1/h), so that too sharp counts as wrong |
| crest | 20 log10 of the ratio of crest factors; a crest factor is the 99.9th percentile of \\|x\\| over the RMS, 3.3 for Gaussian noise |
| kurtosis | ln of the ratio of E[x⁴]/E[x²]², 3 for Gaussian noise; `envelope kurtosis` and `envelope variation` (standard deviation over mean) are of the RMS in frames of 5 ms |
| modulation | mean over eleven bands from 2 to 100 Hz of the size of the difference, dB, of the power spectra of the envelope over its mean; 20 dB at most in a band |
| ribs | 20 log10 of the ratio of depths m at which the power swings at the rib rate k·v: x² = P (1 + m cos 2πft + ...), noise taken off; judged where the recording's m is 0.1 or more |
| coherence | of the ribs' fundamental over half a second, \\|E[z(t + 0.5 s) z*(t)]\\| / E\\|z\\|², z the wave brought down by f and averaged over half a second (below 25 Hz, where waves have no fundamental, that of the power); over the recording's, at most 1 |
| told apart | logistic regression over nine critical-band energies, crest, kurtosis and variation of the envelope and its power in five bands of modulation, of excerpts of one second; for each label, fitted to three quarters of the motions, tested on the last |
| segment GFC, RMSE | of single 100 ms segments made from the true previous waveform (the paper's protocol): GFC; RMS of sample differences over the recording's RMS |
| seams | RMS of sample differences at hop boundaries over that of all others |
| drift | size of the slope of the level at 0.15 m/s and 1 N, dB a minute (ten minutes for rows marked extended in the plan, one otherwise) |
| named right | share of renders that a classifier trained on the independent recordings assigns to their own label |
| ms | one segment through the engine, one thread; hot: one after the other; live: one every 1/72 s. All rows in one run, in random order |

Two of these are traps, and are here because the paper reports them: segment GFC punishes correct randomness (an
independent draw of the true process scores about 0.8), and RMSE rewards silence.
"""


_Row = Mapping[str, Any]
_SIGNS = {AHEAD: "ahead", EVEN: "even", BEHIND: "**behind**"}


def write_document(table: dict[str, Any], out: Path, picture: Path | None, spectra: Path | None) -> None:
    """Write the document; `picture` and `spectra` are the images that exist."""
    lines = ["# What accuracy costs in time", ""]
    lines += _outcome(table)
    lines += [f"Measured on {table['date']}: {table['machine']}. Generated by `npm run evaluate`; do not edit.", ""]
    lines += [model_line(table["model_sha256"]), "", _timing_line(table.get("timed")), ""]
    lines += [INTRODUCTION]
    if picture is not None:
        caption = "Told apart and log-spectral distance of each tier and its rivals over milliseconds for a segment"
        lines += [f"![{caption}]({_address(picture, out)})", ""]
    for block in BLOCKS:
        lines += _block_tables([row for row in table["rows"] if row["block"] == block], block)
    if table["not_measured"]:
        names = ", ".join(table["not_measured"])
        lines += [f"Not measured yet, so not judged: {names}. `npm run evaluate` trains and adds them.", ""]
    lines += _verdict_table(table["rows"])
    lines += _ablation_lines(table["rows"])
    lines += _goal_table(table)
    lines += _label_table(table["rows"])
    lines += _worst_table(table["rows"])
    lines += _seed_table(table["rows"])
    lines += _fast_table(table["rows"])
    if spectra is not None:
        lines += ["## Spectra by label", "", f"![Mean spectra of every label]({_address(spectra, out)})", ""]
    lines += [DEFINITIONS]
    out.write_text("\n".join(lines), encoding="utf-8")


def _address(picture: Path, out: Path) -> str:
    """Of a picture, relative to the document."""
    return Path(os.path.relpath(picture, out.parent)).as_posix()


def _outcome(table: Mapping[str, Any]) -> list[str]:
    """The lines at the top of the page: what the network adds to the skeleton; which rivals we are ahead of, even with
    and behind, and where a rival wins."""
    lines = _network_adds(table["rows"])
    for block in RIVAL_BLOCKS:
        title = block.replace("-", " ").capitalize()
        found = rivals(table["rows"], (block,))
        if not found:
            lines += [f"**{title}**: no rival is measured yet.", ""]
            continue
        counts = {outcome: sum(len(rival.figures(outcome)) for rival in found) for outcome in (AHEAD, EVEN, BEHIND)}
        many = f"{len(found)} rival{'s' if len(found) > 1 else ''}, {sum(counts.values())} comparisons"
        own = [row for row in table["rows"] if row["block"] == block and "against" in row and not row.get("every_fourth")]
        ours = " or ".join(sorted({f"`{row['against']}`" for row in own}))
        words = f"ahead in {counts[AHEAD]}, even in {counts[EVEN]}, behind in {counts[BEHIND]}"
        lines += [f"**{title}**, {many}: {ours} is {words}. {_wins(found)}", ""]
    return _explained(lines)


def _network_adds(rows: Sequence[_Row]) -> list[str]:
    """Two sentences on `standard` beside `sketch`, which is the same skeleton without a network."""
    by_name = {row["name"]: row for row in rows}
    standard, sketch = by_name.get("standard"), by_name.get("sketch")
    if standard is None or sketch is None or "verdict" not in sketch:
        return []
    parts = []
    for outcome in (AHEAD, EVEN, BEHIND):
        names = [BY_KEY[key].words for key, found in sketch["verdict"].items() if found == outcome]
        parts.append(f"{outcome} in {', '.join(names) or 'nothing'}")
    times = [row["ms_paced"] and row["ms_paced"]["p50"] for row in (standard, sketch)]
    cost = f" It takes {times[0] / times[1]:.0f} times as long at the pace of use." if all(times) else ""
    return [
        f"**What the network adds**: `standard`, which corrects the skeleton, is beside `sketch`, the skeleton alone, "
        f"{'; '.join(parts)}.{cost}",
        "",
    ]


_MEANINGS = {
    "AR": "autoregressive filters",
    "GFC": "goodness of fit of the spectra",
    "LSD": "log-spectral distance",
    "SPSI": "single-pass spectrogram inversion",
    "DSTN": "deep spatial-temporal network",
}


def _explained(lines: Sequence[str]) -> list[str]:
    """The lines with each abbreviation explained at its first use, because they precede the page's list of
    abbreviations."""
    text = "\n".join(lines)
    for word, meaning in _MEANINGS.items():
        text = re.sub(rf"\b{word}\b", f"{word} ({meaning})", text, count=1)
    return text.split("\n")


def _wins(found: Sequence[RivalVerdict]) -> str:
    wins = [
        f"{rival.rival} in {', '.join(BY_KEY[key].words for key in rival.figures(BEHIND))}"
        for rival in found if rival.figures(BEHIND)
    ]  # fmt: skip
    return f"Rivals that win: {'; '.join(wins)}." if wins else "No rival wins in any figure."


def _timing_line(run: Mapping[str, Any] | None) -> str:
    if run is None:
        return "Not timed yet."
    loads = " and ".join(" / ".join(f"{value:.2f}" for value in run[key]) for key in ("load_before", "load_after"))
    untrained = ", ".join(f"`{name}`" for name in run.get("untrained", []))
    stood_in = f" Untrained networks of the same sizes were timed for {untrained}." if untrained else ""
    return (
        f"Times are those of the first complete run with this model: {run['date']}, {run['machine']}, commit "
        f"`{run['commit'][:12]}`, load averages before and after {loads}. All runs are in "
        f"`Training/haptoflow_paper/results/timing-history.json`.{stood_in}"
    )


def _cell(value: float | None, digits: int, signed: bool = False) -> str:
    return "" if value is None else f"{value:{'+' if signed else ''}.{digits}f}"


def _spread(values: Mapping[str, float] | None, digits: int) -> str:
    """Median (p90) of a spread."""
    return "" if values is None else f"{values['median']:.{digits}f} ({values['p90']:.{digits}f})"


def _factor(values: Mapping[str, float] | None) -> str:
    """For a spread of logarithms: the factor by which the median (and p90) is off."""
    return "" if values is None else f"{math.exp(values['median']):.2f} ({math.exp(values['p90']):.1f})"


def _name(row: _Row) -> str:
    quarter = " ¼" if row.get("every_fourth") else ""
    return f"**{row['name']}**{quarter}" if row["block"] == OURS else f"{row['name']}{quarter}"


def _block_tables(rows: Sequence[_Row], block: str) -> list[str]:
    if not rows:
        return []
    lines = [f"## {BLOCK_TITLES[block]}", ""]
    lines += [
        "| row | ms hot | ms live (p99) | level dB (p90) | GFC (p90) | LSD dB (p90) | told apart % (worst label) "
        "| crest dB | kurtosis, factor | modulation dB | ribs dB | coherence |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    lines += ["| " + " | ".join(_accuracy_cells(row)) + " |" for row in rows]
    lines += ["", "A value in brackets is the one that 90 % of the cells reach, unless its column's heading says otherwise.", ""]
    if any(row.get("every_fourth") for row in rows):
        lines += [
            "¼: measured on every fourth recording, of each label another quarter of its conditions. A classifier that learns "
            "from so few tells less apart: compare these rows with each other.",
            "",
        ]
    lines += [
        "| row | evaluations | f0 % | harmonics | bands dB | envelope kurtosis, factor | envelope variation, factor "
        "| seams | drift dB/min | segment GFC | RMSE | named right | parameters |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    lines += ["| " + " | ".join(_further_cells(row)) + " |" for row in rows if row.get("level_error_db") is not None]
    return [*lines, ""]


def _accuracy_cells(row: _Row) -> list[str]:
    hot, live = row["ms_per_segment"], row["ms_paced"]
    times = ["" if hot is None else _cell(hot["p50"], 3)]
    times += ["" if live is None else f"{_cell(live['p50'], 3)} ({_cell(live['p99'], 3)})"]
    if row.get("level_error_db") is None:
        return [_name(row), *times, "time only", *[""] * 8]
    cells, told = row["cells"], row["told_apart_percent"]
    return [
        _name(row), *times,
        f"{row['level_error_db']:+.2f} ({row['level_error_p90_db']:.1f})",
        f"{row['gfc_recording']:.4f} ({cells['gfc_recording']['p90']:.3f})",
        f"{row['lsd_db']:.2f} ({cells['lsd_db']['p90']:.1f})",
        "" if told is None else f"{told['median']:.0f} ({told['worst']:.0f})",
        _spread(row["crest_error_db"], 1), _factor(row["kurtosis_log_ratio"]), _spread(row["modulation_error_db"], 1),
        _spread(row["rib_modulation_error_db"], 1), _spread(row["rib_coherence"], 2),
    ]  # fmt: skip


def _further_cells(row: _Row) -> list[str]:
    return [
        _name(row), str(row["evaluations"] or ""), _cell(row["f0_error_percent"], 2), _cell(row["harmonic_share"], 2),
        _cell(row["band_error_db"], 2), _factor(row["envelope_kurtosis_log_ratio"]),
        _factor(row["envelope_variation_log_ratio"]), _cell(row["continuity"], 2), _cell(row["drift_db_per_min"], 2),
        _cell(row["gfc_segment"], 3), _cell(row["rmse"], 2), _cell(row["label_discrimination"], 2),
        f"{row['parameters']:,}" if row["parameters"] else "",
    ]  # fmt: skip


def _verdict_table(rows: Sequence[_Row]) -> list[str]:
    found = rivals(rows, RIVAL_BLOCKS)
    if not found:
        return []
    lines = ["## Ahead, even, behind", "", "Of ours beside each rival that was trained as long.", ""]
    lines += ["| rival | block | " + " | ".join(figure.words for figure in JUDGED) + " |"]
    lines += ["|---|---|" + "---|" * len(JUDGED)]
    for rival in found:
        cells = [_SIGNS.get(rival.by_figure.get(figure.key, ""), "") for figure in JUDGED]
        lines.append(f"| {rival.rival} | {rival.block.replace('-', ' ')} | " + " | ".join(cells) + " |")
    lines.append("")
    for rival in found:
        if len(names := set(rival.variants.values())) > 1:
            stands = "; ".join(f"`{name}` in {', '.join(_figures_of(rival, name))}" for name in sorted(names))
            lines += [f"The figures of {rival.rival} are each compared by the best of its rows: {stands}.", ""]
    return lines


def _ablation_lines(rows: Sequence[_Row]) -> list[str]:
    """Where a recipe without one part is better than ours, the part costs accuracy: said as plainly as its merits."""
    lines = []
    for row in rows:
        if row["block"] == "ablation" and (found := row.get("verdict")):
            better, worse = (
                ", ".join(BY_KEY[key].words for key, outcome in found.items() if outcome == wanted) or "nothing"
                for wanted in (BEHIND, AHEAD)
            )
            lines.append(f"- `{row['name']}`: better in {better}; worse in {worse}.")
    if not lines:
        return []
    return ["Ablations beside the row that they are judged against, beyond chance:", "", *lines, ""]


def _figures_of(rival: RivalVerdict, row: str) -> list[str]:
    return [BY_KEY[key].words for key, best in rival.variants.items() if best == row]


def _goal_table(table: dict[str, Any]) -> list[str]:
    goals = judge(table)
    if not goals:
        return []
    verdicts = {True: "yes", False: "**no**", None: "not judged"}
    lines = ["## Goals", ""]
    lines += ["| figure | goal | measured | holds |", "|---|---|---|---|"]
    lines += [f"| {goal.what} | {goal.wanted} | {goal.measured} | {verdicts[goal.holds]} |" for goal in goals]
    return [*lines, ""]


def _label_table(rows: Sequence[_Row]) -> list[str]:
    """The table by label, of the default tier or the first of our rows that was measured."""
    row = next((row for row in rows if row.get("by_label")), None)
    if row is None:
        return []
    lines = [f"## By label: {row['name']}", "", "The 90th percentile over the label's cells; logarithms are shown as they are.", ""]
    lines += ["| label | " + " | ".join(figure.words for figure in JUDGED) + " |", "|---|" + "---|" * len(JUDGED)]
    for label, figures in row["by_label"].items():
        cells = [_cell(figures.get(figure.key), 0 if figure.over_labels else 2) for figure in JUDGED]
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return [*lines, ""]


def _worst_table(rows: Sequence[_Row]) -> list[str]:
    shown = [row for row in rows if row["block"] in (OURS, "reference") and row.get("worst_cells")]
    if not shown:
        return []
    lines = ["## The worst cells", ""]
    lines += [
        "For each row, the three cells whose error is largest relative to its limit. Nine cells in ten should keep within "
        "it.",
        "",
    ]
    lines += ["| row | label | motion | m/s | N | degrees | figure | error | times the limit |"]
    lines += ["|---|---|---|---|---|---|---|---|---|"]
    for row in shown:
        for cell in row["worst_cells"]:
            lines.append(
                f"| {_name(row)} | {cell['label']} | {cell['kind']} | {cell['speed_mps']:g} | {cell['force_newtons']:g} "
                f"| {cell['direction_degrees']:g} | {BY_KEY[cell['figure']].words} | {cell['value']:.3g} "
                f"| {cell['times_limit']:.1f} |"
            )
    return [*lines, ""]


def _seed_table(rows: Sequence[_Row]) -> list[str]:
    repeated = [row for row in rows if "by_seed" in row]
    if not repeated:
        return []
    counts = sorted({row["by_seed"]["recordings"] for row in repeated})
    lines = [
        "## Spread between trainings",
        "",
        f"Rows whose training was repeated with other seeds, each measured on the same {' or '.join(map(str, counts))} "
        "recordings (of every label another quarter of its conditions), so that the first seed's figures differ "
        "from those above.",
        "",
        "| row | seeds | level dB | level p90 dB | GFC | LSD dB | told apart % | crest dB | kurtosis, ln "
        "| modulation dB |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in repeated:
        seeds = row["by_seed"]
        cells = [
            _values(seeds["level_error_db"], 2, True), _values(seeds["level_error_p90_db"], 1),
            _values(seeds["gfc_recording"], 3), _values(seeds["lsd_db"], 2),
            *(_values(seeds["medians"][key], digits) for key, digits in _SEED_MEDIANS),
        ]  # fmt: skip
        lines.append(f"| {row['name']} | {', '.join(map(str, seeds['seeds']))} | " + " | ".join(cells) + " |")
    return [*lines, ""]


_SEED_MEDIANS = (
    ("told_apart_percent", 0), ("crest_error_db", 1), ("kurtosis_log_ratio", 2), ("modulation_error_db", 1),
)  # fmt: skip


def _values(values: Sequence[float | None], digits: int, signed: bool = False) -> str:
    return ", ".join(_cell(value, digits, signed) for value in values)


def _fast_table(rows: Sequence[dict[str, Any]]) -> list[str]:
    lines: list[str] = []
    for row in rows:
        if "fast" not in row:
            continue
        lines += [f"## Fast strokes and update rates: {row['name']}", ""]
        lines += ["| speed m/s | updates Hz | level dB | GFC | LSD dB | f0 % | seams |"]
        lines += ["|---|---|---|---|---|---|---|"]
        for entry in row["fast"]:
            lines.append(
                f"| {entry['speed_mps']:g} | {entry['update_rate_hz']:g} | {_cell(entry['level_error_db'], 2, True)} "
                f"| {_cell(entry['gfc_recording'], 3)} | {_cell(entry['lsd_db'], 2)} "
                f"| {_cell(entry['f0_error_percent'], 2)} | {_cell(entry['continuity'], 2)} |"
            )
        kinks = row["kink_db"]
        lines += [
            "",
            f"Level across speed (25 speeds from 0.02 to 1.5 m/s): sharpest corner {kinks['median']:.2f} dB for the "
            f"median label, {kinks['worst']:.2f} dB for the worst; the noise of four-second renders is part of it.",
            "",
        ]
    return lines
