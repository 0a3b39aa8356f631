"""Documentation~/accuracy-and-time.md and its pictures, generated from accuracy-time.json."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.evaluation.goals import judge
from haptoflow_training.evaluation.metrics import power_spectrum
from haptoflow_training.evaluation.model_stamp import model_line, picture_metadata
from haptoflow_training.evaluation.reference_set import ReferencePair

_OURS = "HaptoFlow"

_WORDS = """\
Beside the tiers of the shipped model (bold) stand other recipes for the same network, and our forms of other
architectures, all trained on the same recordings. In the table:

| short | what it is |
|---|---|
| GFC | goodness of fit of the magnitude spectra: 1 is the recording's own spectrum, whatever the level |
| LSD | log-spectral distance between the power spectra, in dB: 0 is the recording's own spectrum and level |
| RMSE | root mean square error, sample by sample |
| plain | flow matching without further training, integrated by Euler's, Heun's or the midpoint rule in so many steps |
| MeanFlow, reflow | recipes that train flow matching for few steps: the mean velocity over an interval; straightened paths |
| AR | autoregressive filters, one for each condition, interpolated (after Culbertson et al. 2014) |
| SPSI | single-pass spectrogram inversion: a network names the magnitudes, the phase is found behind it (Heravi et al. 2024) |
| DSTN | deep spatial-temporal network: convolutions and a recurrent encoder and decoder (Joolee and Jeon 2022) |
| Transformer | an encoder and decoder with attention over the past waveform (Cai and Zhu 2022) |
| paper-codec | flow matching on the latents of a small codec, as in the paper; `paper-codec-size` has the sizes of the paper's networks, untrained, for the time alone |

The paper is Eguchi, Hiroi and Hiraki, *HaptoFlow: High-Fidelity Real-Time Vibrotactile Generation via Flow Matching for
Virtual Reality* (2026, to appear in an IEEE VGTC sponsored conference;
[project page](https://tamago117.github.io/HaptoFlow/)). It also names SPSI, DSTN and the Transformer as its rivals; their
sizes are not published, so ours are sensible small ones. Every figure is defined [below](#what-the-figures-mean).
"""

_DEFINITIONS = """\
## What the figures mean

Everything is measured on recordings that nobody trained on, through the C++ engine, in closed loop at 72 Hz: the
network's previous waveform is its own output, from silence on. The recordings are synthetic (`recorder-report.md`).
Conditions: every label at 0.03, 0.08, 0.15, 0.275, 0.5, 1.0 and 1.5 m/s, 0.5 to 2.5 N, three directions, 24 seconds
each, and a free hand stroke. 0.25-0.3 m/s and 1.2-1.5 N are left out of training, as is the direction of 225
degrees. Ruled surfaces are crossed in a straight line, all others on an arc of 30 degrees: straight lines of many metres
would meet the recorder's periodic surface in the same few thousand waves, lines in the spectrum that both recordings of
a pair would share and no real surface has. Where nothing else is said, a figure is the median over labels of each label's mean; the intervals in the JSON
are 95 % bootstrap intervals over recordings.

| figure | definition |
|---|---|
| level | level error, dB: 20 log10 of generated RMS over recorded RMS, signed; p90 and worst of its size over recordings |
| GFC | goodness of fit of magnitude spectra averaged over the recording, 1024-sample Hann windows: sum A B / sqrt(sum A² sum B²) |
| segment GFC | the same on single 100 ms segments made from the true previous waveform (the paper's protocol) |
| RMSE | RMS of sample differences over the recording's RMS, same protocol: 1 is silence, 1.41 an independent draw |
| LSD | log-spectral distance, dB: RMS over 20-1000 Hz of the difference of mean power spectra, 128 ms windows |
| bands | median size of the energy error in nine critical bands (Bark edges, 20-1000 Hz), dB |
| f0, harmonics | periodic labels, 20 Hz < v / wavelength < 800 Hz: error of the fundamental; share of power within 3 % of its multiples, over the recording's |
| seams | RMS of sample differences at hop boundaries over that of all others |
| drift | size of the slope of the level at 0.15 m/s and 1 N, dB a minute (ten minutes for rows marked extended in the plan, one otherwise) |
| named right | share of renders that a classifier trained on the independent recordings gives their own label |
| ms | one segment through the engine, one thread; hot: one after the other; live: one every 1/72 s. All rows in one run, in random order |

Two of these are traps, and are here because the paper reports them: segment GFC punishes correct randomness (an
independent draw of the true process scores about 0.8), and RMSE rewards silence.
"""


def write_document(table: dict[str, Any], out: Path, images: Path, picture: bool, spectra: bool) -> None:
    """Write the document; `picture` and `spectra` say which images exist beside it."""
    lines = ["# What accuracy costs in time", ""]
    lines += [f"Measured on {table['date']}: {table['machine']}. Generated by `npm run evaluate`; do not edit.", ""]
    lines += [model_line(table["model_sha256"]), ""]
    lines += [_WORDS]
    if picture:
        caption = "Level error and log-spectral distance of each tier and its rivals over milliseconds for a segment"
        lines += [f"![{caption}]({images.name}/accuracy-time.png)", ""]
    lines += _main_table(table["rows"])
    if table["not_measured"]:
        names = ", ".join(table["not_measured"])
        lines += [
            f"Not measured yet, so not judged: {names}. Each wants a training of about ten minutes of one core; "
            "`npm run evaluate` measures them and adds them here.",
            "",
        ]
    if elsewhere := [row for row in table["rows"] if row["ms_per_segment"] and row["timed_on"] != table["date"]]:
        named = ", ".join(f"{row['name']} ({row['timed_on']})" for row in elsewhere)
        lines += [f"Timed in earlier runs, so not quite comparable: {named}.", ""]
    lines += _goal_table(table)
    lines += _seed_table(table["rows"])
    lines += _fast_table(table["rows"])
    if spectra:
        lines += ["## Spectra by label", "", f"![Mean spectra of every label]({images.name}/label-spectra.png)", ""]
    lines += [_DEFINITIONS]
    out.write_text("\n".join(lines), encoding="utf-8")


def _cell(value: float | None, digits: int, signed: bool = False) -> str:
    return "" if value is None else f"{value:{'+' if signed else ''}.{digits}f}"


def _level_cell(row: dict[str, Any]) -> str:
    if row["level_error_db"] is None:
        return "time only"
    return f"{row['level_error_db']:+.2f} ({row['level_error_p90_db']:.1f}, {row['level_error_worst_db']:.1f})"


def _main_table(rows: Sequence[dict[str, Any]]) -> list[str]:
    lines = [
        "| row | evaluations | ms hot | ms live (p99) | level dB (p90, worst) | GFC (worst label) | LSD dB | bands dB "
        "| f0 % | harmonics | seams | drift dB/min | segment GFC | RMSE | named right | parameters |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        hot, live = row["ms_per_segment"], row["ms_paced"]
        cells = [
            f"**{row['name']}**" if row["family"] == _OURS else row["name"],
            str(row["evaluations"] or ""),
            "" if hot is None else _cell(hot["p50"], 3),
            "" if live is None else f"{_cell(live['p50'], 3)} ({_cell(live['p99'], 3)})",
            _level_cell(row),
            "" if row["gfc_recording"] is None else f"{row['gfc_recording']:.4f} ({row['gfc_label_worst']:.3f})",
            _cell(row["lsd_db"], 2),
            _cell(row["band_error_db"], 2),
            _cell(row["f0_error_percent"], 2),
            _cell(row["harmonic_share"], 2),
            _cell(row["continuity"], 2),
            _cell(row["drift_db_per_min"], 2),
            _cell(row["gfc_segment"], 3),
            _cell(row["rmse"], 2),
            _cell(row["label_discrimination"], 2),
            f"{row['parameters']:,}" if row["parameters"] else "",
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return [*lines, ""]


def _goal_table(table: dict[str, Any]) -> list[str]:
    goals = judge(table)
    if not goals:
        return []
    verdicts = {True: "yes", False: "**no**", None: "not judged"}
    lines = ["## What the default tier was meant to reach", "", "| figure | goal | measured | holds |", "|---|---|---|---|"]
    lines += [f"| {goal.what} | {goal.wanted} | {goal.measured} | {verdicts[goal.holds]} |" for goal in goals]
    return [*lines, ""]


def _seed_table(rows: Sequence[dict[str, Any]]) -> list[str]:
    repeated = [row for row in rows if "by_seed" in row]
    if not repeated:
        return []
    count = repeated[0]["by_seed"]["recordings"]
    lines = [
        "## How much is chance",
        "",
        f"Rows whose training was repeated with other seeds, each measured on the same {count} recordings (of every label "
        "another quarter of its conditions), so that the first seed's figures are others than above.",
        "",
        "| row | seeds | level dB | level p90 dB | GFC | LSD dB |",
        "|---|---|---|---|---|---|",
    ]
    for row in repeated:
        seeds = row["by_seed"]
        cells = [
            _values(seeds["level_error_db"], 2, True), _values(seeds["level_error_p90_db"], 1),
            _values(seeds["gfc_recording"], 3), _values(seeds["lsd_db"], 2),
        ]  # fmt: skip
        lines.append(f"| {row['name']} | {', '.join(map(str, seeds['seeds']))} | " + " | ".join(cells) + " |")
    return [*lines, ""]


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


def draw_spectra(pairs: Sequence[ReferencePair], waves: Sequence[NDArray[np.float32]], path: Path, model_sha256: str) -> None:
    """Mean power spectra of recordings and of the default tier's closed loop, one panel a label."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    labels = list(dict.fromkeys(pair.condition.label for pair in pairs))
    columns = 5
    count = -(-len(labels) // columns)
    figure, axes = pyplot.subplots(count, columns, figsize=(15.0, 2.5 * count), sharex=True, squeeze=False)
    frequency = np.fft.rfftfreq(256, 1.0 / 2000.0)
    for axis, label in zip(axes.flat, labels, strict=False):
        rows = [index for index, pair in enumerate(pairs) if pair.condition.label == label]
        for name, colour, chosen in (
            ("recorded", "#3a3a3a", [pairs[index].recorded for index in rows]),
            ("generated", "#d1495b", [waves[index] for index in rows]),
        ):
            power = np.mean([power_spectrum(wave[400:], 256) for wave in chosen], axis=0)
            axis.plot(frequency[2:], 10.0 * np.log10(power[2:] + 1e-9), color=colour, linewidth=1.2, label=name)
        axis.set_title(label, fontsize=10)
        axis.grid(alpha=0.25)
    axes[0][0].legend(fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("Hz")
    for row in axes:
        row[0].set_ylabel("dB")
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata=picture_metadata(model_sha256))
    pyplot.close(figure)
