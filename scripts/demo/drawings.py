"""The drawings of the demo's page: matplotlib's SVG in the page's own colours, which follow the reader's theme."""

from __future__ import annotations

import io
import json
import re
from html import escape
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke
from renders import TOP_HZ, Render, colour_of, labels_of, outline, rest_of
from scipy.interpolate import CubicHermiteSpline
from scipy.signal import stft

# Colours of the light theme, and the variables of page.css that stand for them.
INK, SOFT, LINE, WAVE, CARD = "#22252a", "#666d77", "#dcd9d2", "#1f5f8b", "#fffffe"
VARIABLES = {INK: "ink", SOFT: "soft", LINE: "line", WAVE: "wave", CARD: "card"}
POINTS_PER_INCH = 72.0
PLAYER_HZ = 30.0
WINDOW_SAMPLES_AT_48_KHZ = 4096
COLUMNS_PER_SECOND = 100
# Room for the numbers beside a picture, in points.
LEFT, RIGHT, GAP = 66.0, 10.0, 10.0
FONT_SIZE = 10.5
# Around a scene, in metres.
MARGIN = 0.05


class Range(NamedTuple):
    """The common scales of all waveforms and spectrograms."""

    top_mps2: float
    bottom_db: int
    top_db: int


def svg_of(figure: plt.Figure, name: str, label: str) -> str:
    """A figure as an element of the page. Names of groups stay where the caller gave them."""
    file = io.StringIO()
    with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": name}):
        figure.savefig(file, format="svg", transparent=True, metadata={"Date": None})
    plt.close(figure)
    text = file.getvalue()
    text = text[text.index("<svg ") :].replace("\n", " ")
    text = re.sub(r"<metadata>.*?</metadata>|<defs>\s*<style[^>]*>.*?</style>\s*</defs>| id=\"[a-z]\w*_\d+\"", "", text)
    for colour, variable in VARIABLES.items():
        text = text.replace(colour, f"var(--{variable})")
    box = re.search(r'viewBox="[^"]*"', text)[0]
    return re.sub(r"^<svg [^>]*>", f'<svg {box} role="img" aria-label="{escape(label)}">', text).strip()


def spectrogram_levels(felt: Render) -> np.ndarray:
    """[rows, columns] in dB re 1 m/s^2 up to TOP_HZ: a sine of amplitude A has the level of A (Hann window, 85 ms)."""
    size = round(WINDOW_SAMPLES_AT_48_KHZ * felt.rate_hz / 48000)
    frequencies, _, lines = stft(
        felt.acceleration_mps2, felt.rate_hz, nperseg=size, noverlap=size - felt.rate_hz // COLUMNS_PER_SECOND
    )
    return 20.0 * np.log10(2.0 * np.abs(lines[frequencies <= TOP_HZ]) + 1e-20)


class Lanes:
    """Pictures one below the other over the same seconds."""

    def __init__(self, seconds: float, width: float, heights: list[float]) -> None:
        self.seconds, self.width = seconds, width
        self.height = sum(heights) + GAP * (len(heights) + 1) + 8.0
        self.figure = plt.figure(figsize=(width / POINTS_PER_INCH, self.height / POINTS_PER_INCH))
        self.axes = []
        top = self.height - GAP
        for height in heights:
            top -= height
            axes = self.figure.add_axes(
                (LEFT / width, top / self.height, (width - LEFT - RIGHT) / width, height / self.height)
            )
            top -= GAP
            axes.set(xlim=(0.0, seconds), xticks=[], yticks=[])
            axes.tick_params(colors=SOFT, length=0, labelsize=FONT_SIZE, pad=4)
            axes.spines[:].set_visible(False)
            axes.patch.set_visible(False)
            self.axes.append(axes)
        step = 2 if seconds > 7 else 1
        marks = np.arange(0, int(seconds) + 1, step)
        self.axes[-1].set_xticks(marks, [f"{mark} s" if mark == 0 else str(mark) for mark in marks])

    def waveform(self, axes: plt.Axes, felt: Render, top_mps2: float) -> None:
        """A band between minimum and maximum of each column."""
        columns = np.array_split(felt.acceleration_mps2, int(self.width))
        edges = np.linspace(0.0, self.seconds, len(columns))
        axes.fill_between(
            edges, [each.min() for each in columns], [each.max() for each in columns], color=WAVE, linewidth=0.6,
            clip_on=False,
        )  # fmt: skip
        axes.set_yticks([-top_mps2, 0, top_mps2], [f"\u2212{top_mps2:g}", "0", f"+{top_mps2:g}"])
        axes.set_ylim(-top_mps2, top_mps2)
        self.named(axes, "m/s²")

    def spectrogram(self, axes: plt.Axes, felt: Render, shared: Range) -> None:
        axes.imshow(
            spectrogram_levels(felt), origin="lower", aspect="auto", cmap="inferno", vmin=shared.bottom_db,
            vmax=shared.top_db, extent=(0.0, self.seconds, 0.0, TOP_HZ), interpolation="none", clip_on=False,
        )  # fmt: skip
        axes.set_yticks([0, TOP_HZ / 2, TOP_HZ])
        self.named(axes, "Hz")

    def contact(
        self, bands: plt.Axes, speed: plt.Axes, force: plt.Axes, felt: Render, names: dict[str, str] | str
    ) -> None:
        """names: the label of each surface, or one text for all."""
        for surface, begin, end in felt.touches():
            text = names if isinstance(names, str) else names[surface]
            colour = SOFT if isinstance(names, str) else colour_of(text)
            bands.axvspan(begin, end, color=colour, linewidth=0, clip_on=False)
            bands.text((begin + end) / 2, 0.45, text, color="white", fontsize=FONT_SIZE, weight="bold", ha="center",
                       va="center", path_effects=[withStroke(linewidth=1.5, foreground="black")])  # fmt: skip
        bands.set_ylim(0, 1)
        self.named(bands, "touches")
        along = [np.hypot(float(row["vx_mps"]), float(row["vy_mps"])) for row in felt.contacts]
        for axes, name, values in (
            (speed, "speed,\nm/s", along), (force, "force,\nN", [float(row["force_n"]) for row in felt.contacts]),
        ):  # fmt: skip
            axes.fill_between(felt.contact_times, 0.0, values, color=WAVE, alpha=0.3, linewidth=0, clip_on=False)
            axes.plot(felt.contact_times, values, color=WAVE, linewidth=0.8, clip_on=False)
            axes.set_ylim(0.0, max(values) or 1.0)
            axes.set_yticks([0.0, max(values) or 1.0], ["0", f"{max(values) or 1.0:.2g}"])
            axes.axhline(0.0, color=LINE, linewidth=1, clip_on=False)
            self.named(axes, name)

    def named(self, axes: plt.Axes, name: str) -> None:
        axes.annotate(name, (0, 0.5), (-LEFT + 2, 0), "axes fraction", "offset points", color=SOFT, fontsize=FONT_SIZE,
                      weight="bold", va="center")  # fmt: skip

    def element(self, name: str, label: str, is_wide: bool) -> str:
        """data-left, data-width: the part of the element's width that the seconds take, for the player."""
        shown = f'data-left="{LEFT / self.width:.5f}" data-width="{1 - (LEFT + RIGHT) / self.width:.5f}"'
        return (
            f'<div class="scroll{" wide" if is_wide else ""}"><div class="lanes" data-seconds="{self.seconds}" {shown}>'
            f'{svg_of(self.figure, name, label)}<div class="playhead" aria-hidden="true"></div></div></div>'
        )


CONTACT_HEIGHTS = [20.0, 36.0, 36.0]


def draw_render(name: str, scene: dict, felt: Render, shared: Range, is_whole: bool) -> str:
    """Waveform and spectrogram; of a whole stroke what it touches, speed and force as well."""
    contact = CONTACT_HEIGHTS if is_whole else []
    lanes = Lanes(felt.seconds, 1000.0 if is_whole else 480.0, [76.0, 104.0, *contact])
    lanes.waveform(lanes.axes[0], felt, shared.top_mps2)
    lanes.spectrogram(lanes.axes[1], felt, shared)
    if is_whole:
        lanes.contact(*lanes.axes[2:], felt, {each["name"]: labels_of(each)[0] for each in scene["surfaces"]})
    more = ", what it touches, speed and force" if is_whole else ""
    return lanes.element(name, f"Waveform and spectrogram of {name}, 0 to {TOP_HZ:g} Hz{more}", is_whole)


def draw_contact(felt: Render, text: str) -> str:
    """What the tip touches, under one name, its speed and force."""
    lanes = Lanes(felt.seconds, 1000.0, CONTACT_HEIGHTS)
    lanes.contact(*lanes.axes, felt, text)
    return lanes.element("contact", "When the tip touches, its speed in m/s and its force in N", True)


def draw_scene(scene: dict, path: np.ndarray, felt: Render) -> tuple[str, str]:
    """From above and from the front, with a stroke [n, 4] of seconds and metres. The elements of class "tip" and
    "mover" carry data-track, PLAYER_HZ places a second, for the player."""
    above = draw_view(scene, path, felt, "Seen from above", [0, 2], 1)
    return above, draw_view(scene, path, felt, "Seen from the front", [0, 1], -2)


def draw_view(scene: dict, path: np.ndarray, felt: Render, caption: str, plane_of: list[int], depth: int) -> str:
    """plane_of: the world's axes that point right and up; depth: the one along which near objects cover far ones,
    negative where far is up it. One metre is 1000 units of the picture."""
    is_top = plane_of == [0, 2]
    planes = [each for each in scene["surfaces"] if "plane" in each["shape"]]
    solids = [each for each in scene["surfaces"] if "plane" not in each["shape"]]
    solids.sort(key=lambda each: np.sign(depth) * rest_of(each)[abs(depth)])
    outlines = [outline(each, plane_of) for each in solids]
    points = np.vstack([*outlines, path[:, 1:][:, plane_of]])
    (left, low), (right, top) = points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN
    if planes and not is_top:
        # The table covers everything below it.
        low = rest_of(planes[0])[1] - MARGIN
    figure = plt.figure(figsize=(1000 * (right - left) / POINTS_PER_INCH, 1000 * (top - low) / POINTS_PER_INCH))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(left, right), ylim=(low, top))
    axes.axis("off")
    titles = {}
    for index, surface in enumerate([*planes, *solids] if is_top else [*solids, *planes]):
        colour = colour_of(labels_of(surface)[0])
        if surface in planes:
            height = top if is_top else rest_of(surface)[1]
            corners = np.array([[left, low], [right, low], [right, height], [left, height]])
            axes.add_patch(Polygon(corners, facecolor=colour, alpha=0.22 if is_top else 1.0, linewidth=0, clip_on=False,
                                   gid=f"surface-{index}"))  # fmt: skip
            if is_top:
                name = f"{surface['name']}: {labels_of(surface)[0]}"
                axes.text(left + 0.014, low + 0.014, name, color=INK, fontsize=22)
        else:
            corners = outlines[solids.index(surface)]
            axes.add_patch(Polygon(corners, facecolor=colour, edgecolor=CARD, alpha=0.82, linewidth=2, clip_on=False,
                                   gid=f"surface-{index}"))  # fmt: skip
            if is_top:
                (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
                axes.text((x0 + x1) / 2, y1 - 0.18 * (y1 - y0), " + ".join(labels_of(surface)), color=INK, fontsize=22,
                          ha="center", va="center")  # fmt: skip
        titles[f"surface-{index}"] = surface
    held = felt.touching(path[:, 0])
    places = path[:, 1:][:, plane_of]
    for touching, width, style in ((True, 5, "-"), (False, 2.5, (0, (0.8, 3.6)))):
        axes.plot(np.where(held == touching, places[:, 0], np.nan), places[:, 1], color=INK, linewidth=width,
                  linestyle=style, dash_capstyle="round", solid_capstyle="round", clip_on=False)  # fmt: skip
    axes.plot(*places[0], "o", markersize=20, markerfacecolor=CARD, markeredgecolor=INK, markeredgewidth=4,
              clip_on=False)  # fmt: skip
    axes.text(*(places[0] - [0, 0.031]), "start", color=INK, fontsize=22, ha="center", va="center")

    listed = ", ".join(f"{each['name']} ({' and '.join(labels_of(each))})" for each in scene["surfaces"])
    drawn = svg_of(figure, caption, f"{caption}: {listed}")
    seconds = np.arange(int(np.ceil(path[-1, 0] * PLAYER_HZ)) + 1) / PLAYER_HZ

    def track_of(metres: np.ndarray, origin: list[float]) -> str:
        return json.dumps(np.round(1000.0 * (metres - origin) * [1.0, -1.0], 1).tolist(), separators=(",", ":"))

    for gid, surface in titles.items():
        track = ""
        if "motion" in surface:
            moved = positions_at(surface["motion"], seconds)[:, plane_of]
            track = f' class="mover" data-track="{track_of(moved, rest_of(surface)[plane_of])}"'
        title = escape(f"{surface['name']}: {' and '.join(labels_of(surface))}")
        drawn = drawn.replace(f'<g id="{gid}">', f"<g{track}><title>{title}</title>")
    tip = np.column_stack([np.interp(seconds, path[:, 0], places[:, axis]) for axis in (0, 1)])
    track = track_of(tip, [left, top])
    tip_element = f'<circle class="tip" r="13" data-track="{track}"/></svg>'
    drawn = drawn.removesuffix("</svg>") + tip_element
    return f'<figure class="view">{drawn}<figcaption>{caption}</figcaption></figure>'


def positions_at(motion: dict, seconds: np.ndarray) -> np.ndarray:
    """[n, 3] of a moving surface, interpolated as the engine does it: a cubic with continuous velocity, at each
    keyframe the mean velocity between its neighbours; the first and last keyframe of a closed loop are the same."""
    times = np.array([each["t"] for each in motion["keyframes"]])
    places = np.array([each["position"] for each in motion["keyframes"]])
    steps = np.diff(places, axis=0) / np.diff(times)[:, None]
    between = (places[2:] - places[:-2]) / (times[2:] - times[:-2])[:, None]
    ends = [steps[0], steps[-1]]
    loops = motion.get("loop", False)
    if loops and len(times) > 2 and np.array_equal(places[0], places[-1]):
        ends = [(places[1] - places[-2]) / (times[1] - times[0] + times[-1] - times[-2])] * 2
    spline = CubicHermiteSpline(times, places, np.vstack([ends[0], between, ends[1]]))
    span = times[-1] - times[0]
    return spline(times[0] + np.mod(seconds - times[0], span) if loops else np.clip(seconds, times[0], times[-1]))
