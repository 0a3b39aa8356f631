"""The picture of every label's mean spectrum, recorded and generated."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.metrics.waveform_metrics import power_spectrum
from haptoflow_paper.reference.reference_set import ReferencePair
from haptoflow_training.model_stamp import picture_metadata
from haptoflow_training.waveform import SAMPLE_RATE_HZ


def draw_spectra(
    pairs: Sequence[ReferencePair], waves: Sequence[NDArray[np.float32]], path: Path, model_sha256: str
) -> None:
    """Mean power spectra of recordings and of the default tier's closed loop, one panel a label."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    labels = list(dict.fromkeys(pair.condition.label for pair in pairs))
    columns = 5
    count = -(-len(labels) // columns)
    figure, axes = pyplot.subplots(count, columns, figsize=(15.0, 2.5 * count), sharex=True, squeeze=False)
    frequency = np.fft.rfftfreq(256, 1.0 / SAMPLE_RATE_HZ)
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
