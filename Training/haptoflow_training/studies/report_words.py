"""The explanations in a report, for readers who did not run the study."""

from __future__ import annotations

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
_SIMILARITY = (
    "Each participant rated from 1 to 7 how similar each method's virtual material feels to the real one. For each "
    "material, Friedman's test asks whether the methods differ at all; where p < 0.05, every pair is compared by "
    "Wilcoxon's signed-rank test with Shaffer's static correction over the material's pairs. Two one-sided Wilcoxon "
    "tests ask of every pair whether its difference lies within {bound:g} points of rating, with Holm's correction "
    "over the material's pairs. Practice is left out."
)


def similarity(bound: float) -> str:
    """bound: of equivalence, in points of rating."""
    return _SIMILARITY.format(bound=bound)


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
