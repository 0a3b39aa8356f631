"""The report of a folder of logs: one self-contained HTML file."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from haptoflow_training.studies.figures import SIMULATED_WORDS, latency_figure, mean_interval, similarity_figure
from haptoflow_training.studies.psychometric import Fit, Interval
from haptoflow_training.studies.analysis import LatencyResult, SimilarityResult
from haptoflow_training.studies.plans import CONDITIONS
from haptoflow_training.studies.log_table import participants_words
from haptoflow_training.studies.rating_tests import Pair
from haptoflow_training.studies.session_file import Session

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 1em 0; font-size: 13px }
th, td { border-bottom: 1px solid #ddd; padding: 0.25em 0.7em; text-align: left }
th { background: #f4f4f4 }
figure { margin: 1em 0 }
figure img { max-width: 100% }
figcaption { font-size: 13px; color: #555 }
.simulated { background: #b00020; color: white; padding: 0.6em 1em; font-weight: bold }
"""


def page(title: str, banner: str, parts: Sequence[str]) -> str:
    """banner: shown above everything and before the title; none if empty."""
    head = f"{banner} - {title}" if banner else title
    shown = f'<p class="simulated" role="alert">{escape(banner)}</p>\n' if banner else ""
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(head)}</title>\n'
        f"<style>{_STYLE}</style>\n</head>\n<body>\n{shown}<h1>{escape(title)}</h1>\n"
        + "\n".join(parts)
        + "\n</body>\n</html>\n"
    )


def heading(words: str, level: int = 2) -> str:
    return f"<h{level}>{escape(words)}</h{level}>"


def paragraph(words: str) -> str:
    return f"<p>{escape(words)}</p>"


def listing(entries: Sequence[str]) -> str:
    return "<ul>\n" + "\n".join(f"<li>{escape(entry)}</li>" for entry in entries) + "\n</ul>"


def table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{escape(words)}</th>" for words in headings)
    body = "\n".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"


def picture(svg: str, caption: str) -> str:
    """The figure embedded as an image: several inline SVG trees would share their identifiers."""
    data = base64.b64encode(svg.encode()).decode()
    words = escape(caption, quote=True)
    image = f'<img src="data:image/svg+xml;base64,{data}" alt="{words}">'
    return f"<figure>{image}<figcaption>{words}</figcaption></figure>"


_NONE = "-"


@dataclass(frozen=True)
class Analysed:
    """The analyses of a report; a study without sessions is None."""

    sessions: Sequence[Session]
    notes: Sequence[str]
    latency: LatencyResult | None
    similarity: SimilarityResult | None
    # Why there is no similarity in spite of sessions; empty if there is.
    similarity_statement: str = ""

    @property
    def is_simulated(self) -> bool:
        return any(session.is_simulated for session in self.sessions)


def report(analysed: Analysed) -> str:
    """The report as HTML. It contains neither date nor machine, so that the same logs give the same report."""
    simulated = analysed.is_simulated
    parts = [paragraph(INTRODUCTION)]
    if simulated:
        parts.append(paragraph(SIMULATED))
    if analysed.latency is not None:
        parts += _latency(analysed.latency, simulated)
    if analysed.similarity is not None:
        parts += _similarity(analysed.similarity, simulated)
    elif analysed.similarity_statement:
        parts += [heading("Similarity"), paragraph(f"{analysed.similarity_statement}.")]
    parts += [heading("What was analysed"), _sessions(analysed.sessions)]
    if analysed.notes:
        parts.append(listing(analysed.notes))
    return page("Delay tolerance and similarity", SIMULATED_WORDS if simulated else "", parts)


def results(analysed: Analysed) -> dict[str, Any]:
    """The same figures as JSON."""
    found: dict[str, Any] = {"format": "haptoflow study results", "version": 1, "simulated": analysed.is_simulated}
    if analysed.latency is not None:
        found["latency"] = _latency_results(analysed.latency)
    if analysed.similarity is not None:
        found["similarity"] = _similarity_results(analysed.similarity)
    elif analysed.similarity_statement:
        found["similarity"] = {"statement": analysed.similarity_statement}
    return found | {"notes": list(analysed.notes)}


def _latency(result: LatencyResult, is_simulated: bool) -> list[str]:
    rows = [_fit_row(condition, result.fits[condition], result.answers[condition]) for condition in CONDITIONS]
    parts = [
        heading("Delay tolerance"),
        paragraph(f"{participants_words(result.participants)}. {LATENCY}"),
        picture(latency_figure(result, is_simulated=is_simulated), _marked(LATENCY_CAPTION, is_simulated)),
        table(FIT_HEADINGS, rows),
        *(
            paragraph(f"{condition}: {statement}.")
            for condition in CONDITIONS
            for statement in _statements(result.fits[condition])
        ),
    ]
    if result.difference_ms is not None:
        parts.append(paragraph(_difference_words(result.difference_ms, result.difference_interval)))
    points = [
        [
            condition, f"{point.level_ms:g}", f"{point.delivered_ms:.1f}", f"{point.percent:.1f}",
            f"{point.low_percent:.1f} to {point.high_percent:.1f}", str(point.count),
        ]
        for condition in CONDITIONS
        for point in result.points[condition]
    ]  # fmt: skip
    return [*parts, table(POINT_HEADINGS, points)]


def _fit_row(condition: str, fit: Fit, answers: int) -> list[str]:
    if fit.curve is None:
        return [condition, str(answers), *[_NONE] * 6]
    return [
        condition, str(answers), f"{fit.curve.x0:.1f}", _interval(fit.threshold_interval, 1),
        _number(fit.threshold_error, 1), f"{fit.curve.k:.4f}", _interval(fit.k_interval, 4), _number(fit.k_error, 4),
    ]  # fmt: skip


def _statements(fit: Fit) -> list[str]:
    found = [fit.statement] if fit.statement else []
    if fit.interval_statement:
        found.append(f"no interval is given, because {fit.interval_statement}")
    return [*found, *fit.notes]


def _difference_words(difference: float, interval: Interval | None) -> str:
    said = f"The threshold of turn-on less that of turn-off is {difference:.1f} ms"
    if interval is None:
        return f"{said}; no interval is given."
    verdict = "includes 0: the thresholds may be equal" if interval.covers(0.0) else "excludes 0"
    return f"{said}, with an interval of 95 % from {interval.low:.1f} to {interval.high:.1f} ms, which {verdict}."


def _similarity(result: SimilarityResult, is_simulated: bool) -> list[str]:
    parts = [
        heading("Similarity"),
        paragraph(f"{participants_words(result.participants)}. {SIMILARITY.format(bound=result.bound)}"),
        picture(similarity_figure(result, is_simulated=is_simulated), _marked(SIMILARITY_CAPTION, is_simulated)),
        table(MATERIAL_HEADINGS, [_material_row(result, name) for name in result.materials]),
        listing(EFFECT_SIZES),
    ]
    for place, name in enumerate(result.materials):
        found = result.by_material[name]
        parts += [heading(name, 3)]
        if found.friedman_statement:
            parts.append(paragraph(f"{found.friedman_statement[:1].upper()}{found.friedman_statement[1:]}."))
        ratings = result.ratings[place]
        means = [
            [method, f"{mean:.2f}", f"{low:.2f} to {high:.2f}", _p(p)]
            for method, mean, low, high, p in zip(
                result.methods, ratings.mean(axis=0), *mean_interval(ratings), found.normality_p, strict=True
            )
        ]
        parts += [
            table(METHOD_HEADINGS, means), table(PAIR_HEADINGS, [_pair_row(result, pair) for pair in found.pairs])
        ]
    return [*parts, listing(LIMITS)]


def _material_row(result: SimilarityResult, name: str) -> list[str]:
    found = result.by_material[name]
    normal = _normality_words(found.normality_p)
    if found.friedman is None:
        return [name, normal, _NONE, _NONE, _NONE]
    return [name, normal, f"{found.friedman.chi_square:.2f}", _p(found.friedman.p), f"{found.friedman.kendall_w:.2f}"]


def _normality_words(p_values: Sequence[float | None]) -> str:
    """Ratings that are all equal cannot be tested: they count neither as normal nor as not."""
    tested = [p for p in p_values if p is not None]
    if not tested:
        return _NONE
    said = f"rejected for {sum(p < 0.05 for p in tested)} of {len(tested)}"
    untested = len(p_values) - len(tested)
    return f"{said}; {untested} not tested, all ratings equal" if untested else said


def _pair_row(result: SimilarityResult, pair: Pair) -> list[str]:
    is_followed_up = pair.p_shaffer is not None
    return [
        f"{result.methods[pair.first]} - {result.methods[pair.second]}",
        f"{pair.mean_difference:+.2f}",
        _p(pair.p if is_followed_up else None),
        _p(pair.p_shaffer),
        _number(pair.rank_biserial, 2),
        _number(pair.cohen_dz, 2),
        _p(pair.p_equivalence),
        _p(pair.p_holm),
    ]


def _sessions(sessions: Sequence[Session]) -> str:
    rows = []
    for session in sessions:
        device = session.sidecar["device"]
        delay = f"{_text(device.get('device_delay_ms'))} ms, {device['device_delay_source']}"
        build, headset = session.sidecar["build"], _text(device.get("headset"))
        rows.append(
            [
                session.path.name, _text(session.sidecar["seed"]), _text(session.sidecar["resumptions"]),
                "yes" if session.is_simulated else "no", headset, delay, _text(build.get("package")),
            ]
        )  # fmt: skip
    return table(SESSION_HEADINGS, rows)


def _marked(caption: str, is_simulated: bool) -> str:
    return f"{SIMULATED_WORDS}. {caption}" if is_simulated else caption


def _text(value: object) -> str:
    return _NONE if value in (None, "") else str(value)


def _number(value: float | None, digits: int) -> str:
    return _NONE if value is None or value != value else f"{value:.{digits}f}"


def _interval(interval: Interval | None, digits: int) -> str:
    return _NONE if interval is None else f"{interval.low:.{digits}f} to {interval.high:.{digits}f}"


def _p(p: float | None) -> str:
    if p is None:
        return _NONE
    return "< 0.001" if p < 0.001 else f"{p:.3f}"


def _latency_results(result: LatencyResult) -> dict[str, Any]:
    def ends(interval: Interval | None) -> list[float] | None:
        return None if interval is None else [interval.low, interval.high]

    conditions = {}
    for condition in CONDITIONS:
        fit = result.fits[condition]
        conditions[condition] = {
            "answers": result.answers[condition],
            "threshold_ms": None if fit.curve is None else fit.curve.x0,
            "threshold_interval_ms": ends(fit.threshold_interval),
            "threshold_error_ms": fit.threshold_error,
            "k_per_ms": None if fit.curve is None else fit.curve.k,
            "k_interval_per_ms": ends(fit.k_interval),
            "k_error_per_ms": fit.k_error,
            "statements": _statements(fit),
        }
    return {
        "participants": result.participants,
        "conditions": conditions,
        "difference_ms": result.difference_ms,
        "difference_interval_ms": ends(result.difference_interval),
    }


def _similarity_results(result: SimilarityResult) -> dict[str, Any]:
    def pair_results(pair: Pair) -> dict[str, Any]:
        return {**vars(pair), "first": result.methods[pair.first], "second": result.methods[pair.second]}

    return {
        "participants": result.participants,
        "methods": list(result.methods),
        "equivalence_points": result.bound,
        "materials": {
            name: {
                "means": [float(value) for value in result.ratings[place].mean(axis=0)],
                "shapiro_p": list(result.by_material[name].normality_p),
                "friedman": None if (found := result.by_material[name].friedman) is None else vars(found),
                "statement": result.by_material[name].friedman_statement,
                "pairs": [pair_results(pair) for pair in result.by_material[name].pairs],
            }
            for place, name in enumerate(result.materials)
        },
    }


INTRODUCTION = (
    "This report was written by haptoflow-training study analyse from the logs of a folder. "
    "Documentation~/study-files.md explains every test and how it was validated."
)
SIMULATED = (
    "Every answer and rating in this report was drawn at random by a program. It shows what the analysis does, and "
    "says nothing about people."
)
LATENCY = (
    "Each participant said after each trial whether a delay was perceived. The percentage of yes is fitted by "
    "y = 100 / (1 + exp(-k (x - x0))) of the delivered delay x, by maximum likelihood on the single answers; x0 is the "
    "delay at which half of the answers are yes. Intervals are expanded percentile intervals of 95 % from 2,000 "
    "resamples of the participants; standard errors leave out one participant after the other. Practice is left "
    "out."
)
LATENCY_CAPTION = (
    "Percentage of trials in which a delay was perceived. Points are percentages at the mean delivered delay, bars "
    "their intervals of 95 % (Wilson's, which do not vanish at 0 and 100 %), dashed lines the fitted curves, thick "
    "lines about 50 % the intervals of the thresholds. A tick is a single answer: yes above, no below. The two "
    "conditions are drawn a little aside, so that neither hides the other."
)
SIMILARITY = (
    "Each participant rated from 1 to 7 how similar each method's virtual material feels to the real one. For each "
    "material, Friedman's test asks whether the methods differ at all; where p < 0.05, every pair is compared by "
    "Wilcoxon's signed-rank test with Shaffer's static correction over the material's pairs. Two one-sided Wilcoxon "
    "tests ask of every pair whether its difference lies within {bound:g} points of rating, with Holm's correction "
    "over the material's pairs. Practice is left out."
)
SIMILARITY_CAPTION = (
    "Similarity ratings: a dot is one participant's rating, a dash the mean, bars its interval of 95 % (Student's t; "
    "each participant rated every method, so that intervals that overlap say little about a difference). Brackets: "
    "† p < 0.1 and * p < 0.05 for a difference after Shaffer's correction, green ≈ p < 0.05 for equivalence after Holm's."
)
EFFECT_SIZES = (
    "Kendall's W: how far participants agree on the order of the methods, from 0 (not at all) to 1 (fully).",
    "Rank-biserial r: the share of the ranked differences that favours the first method less the share that favours "
    "the second; 0 means balance, 1 and -1 that every difference points the same way.",
    "Cohen's d_z: the mean difference in standard deviations of the differences; the paper planned for 0.67.",
)
LIMITS = (
    "No correction is made over materials: with six of them and no difference anywhere, one in four such studies "
    "finds a difference on some material.",
    "A pair without * and without ≈ is undecided: no difference was found, and none was excluded.",
)
FIT_HEADINGS = (
    "condition", "answers", "threshold x0 (ms)", "95 % interval", "standard error", "k (1/ms)", "95 % interval",
    "standard error",
)  # fmt: skip
POINT_HEADINGS = ("condition", "planned (ms)", "delivered (ms)", "yes (%)", "95 % interval", "answers")
MATERIAL_HEADINGS = ("material", "normality (Shapiro-Wilk, p < 0.05)", "Friedman chi-square", "p", "Kendall's W")
METHOD_HEADINGS = ("method", "mean rating", "95 % interval", "Shapiro-Wilk p")
PAIR_HEADINGS = (
    "pair", "mean difference", "Wilcoxon p", "p after Shaffer", "rank-biserial r", "d_z", "equivalence p",
    "p after Holm",
)  # fmt: skip
SESSION_HEADINGS = ("session", "seed", "resumptions", "simulated", "headset", "device delay", "HaptoFlow")
