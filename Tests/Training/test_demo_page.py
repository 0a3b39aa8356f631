"""The demo's page: its scales, players and drawings."""

from __future__ import annotations

import base64
import json
import re
import sys

import numpy as np
import pytest

from places import ROOT

sys.path[:0] = [str(ROOT / "scripts/pack"), str(ROOT / "scripts/demo")]

import demo  # noqa: E402
import drawings  # noqa: E402
from renders import Render  # noqa: E402

RATE_HZ = 48000
CROSSING = json.loads((ROOT / "Samples~/HeadlessScenes/crossing.scene.json").read_text(encoding="utf-8"))
PATH = np.array([[0.0, 0.0, 0.2, 0.0], [1.0, 0.1, 0.1, 0.05]])


def felt_of(amplitude: float) -> Render:
    """One second of 100 Hz, touched from 0.5 s on."""
    wave = 200.0 * amplitude * np.sin(2.0 * np.pi * 100.0 * np.arange(RATE_HZ) / RATE_HZ)
    rows = ((0.0, "", 0), (0.5, "ball", 1), (1.0, "ball", 1))
    contacts = [
        {"t": str(t), "surface": surface, "touching": str(touching), "vx_mps": "0.3", "vy_mps": "0.4", "force_n": "1"}
        for t, surface, touching in rows
    ]
    return Render(RATE_HZ, wave, contacts)


def shown(name: str, amplitude: float, model: str = "default.haptoflow") -> demo.Shown:
    ball = {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "position": [0, 0, 0], "material": "wood"}
    report = {
        "model": model, "labels": ["wood"], "seconds": 1, "rms_mps2": 200 * amplitude / np.sqrt(2), "peak": amplitude,
        "segments": 36, "inference_ms": {"p50": 0.41, "p99": 0.73, "worst": 2}, "nonfinite": 0, "underruns": 0,
    }  # fmt: skip
    return demo.Shown(name, {"surfaces": [ball]}, PATH, felt_of(amplitude), report)


def page_of(*renders: demo.Shown) -> str:
    return demo.page(list(renders), "a machine")


@pytest.fixture(scope="module")
def page() -> str:
    return page_of(shown("crossing", 0.2), shown("wood", 0.02), shown("taps and rims", 0.01), shown("boards", 0.01))


def test_the_players_share_one_gain_the_loudest_peaks_at_minus_1_dbfs(page: str) -> None:
    sounds = re.findall(r"audio/wav;base64,([^\"]+)", page)
    waves = [np.frombuffer(base64.b64decode(each), np.int16, offset=44) for each in sounds]
    loud, quiet, *_ = (np.abs(wave).max() / 32767 for wave in waves)
    assert 20.0 * np.log10(loud) == pytest.approx(-1.0, abs=0.01)
    assert loud / quiet == pytest.approx(10.0, rel=2e-3)


def test_the_page_states_gain_model_origin_scale_and_measured_figures(page: str) -> None:
    for words in (
        "+13.0 dB", "default.haptoflow", "trained on synthetic recordings", "<strong>±40 m/s²</strong>", ">28.28<", ">40.0<",
        ">0.41<", ">0.73<", "<span>wood <em>2.8 m/s² RMS</em></span>", "a machine",
    ):  # fmt: skip
        assert words in page


def test_the_page_has_no_reference_outside_itself_and_no_value_is_missing(page: str) -> None:
    assert not re.search(r'(?:src|href)="(?!data:|#)|url\(|@import|https?:', page)
    assert not re.search(r"\{\{|undefined|NaN|nan", re.sub(r'data:[^"]*', "", page))


def test_markup_in_names_is_escaped() -> None:
    made = page_of(shown("crossing", 0.2, "<u>model"), shown("<script>boom", 0.02), shown("taps and rims", 0.01), shown("boards", 0.01))
    assert "<script>boom" not in made
    assert "<u>model" not in made


def test_each_player_has_one_element_that_takes_the_keyboard_focus(page: str) -> None:
    articles = re.findall(r"<article.*?</article>", page, re.DOTALL)
    assert len(articles) == 4
    for article in articles:
        focusable = r"<(?:button|a|input|select|textarea|iframe)\b|\b(?:tabindex|controls)\b"
        assert re.findall(focusable, article) == ["<button"]


def test_the_scene_is_drawn_twice_with_labels_start_tip_and_moving_object() -> None:
    above, front = drawings.draw_scene(CROSSING, PATH, felt_of(0.1))
    for label in ("plywood", "wood", "stone", "metal mesh", "sandpaper", "corduroy", "brick + concrete"):
        assert label in above
    for view in (above, front):
        assert view.count("<svg ") == view.count('class="mover"') == view.count('class="tip"') == 1
        places = json.loads(re.search(r'class="tip"[^>]*data-track="([^"]*)"', view)[1])
        assert len(places) == 31


def test_a_looped_motion_passes_through_its_keyframes_and_begins_again() -> None:
    keyframes = [{"t": t, "position": [x, 0, 0]} for t, x in ((0, 0), (0.5, 0.1), (1, 0))]
    places = drawings.positions_at({"keyframes": keyframes, "loop": True}, np.array([0, 0.5, 1, 2.5]))
    assert places[:, 0] == pytest.approx([0, 0.1, 0, 0.1], abs=1e-9)
