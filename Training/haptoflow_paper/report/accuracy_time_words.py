"""The fixed text of haptoflow_paper/results/accuracy-and-time.md: what the rows are, and the definition of every figure."""

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
network's previous waveform is its own output, from silence on. The recordings are synthetic.

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
