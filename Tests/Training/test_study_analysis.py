"""From logs to a report: what is found, the reasons in place of numbers, and the mark of simulated studies."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path

import pytest
from study_samples import change_field, change_lines, change_sidecar, latency_study, log_of, similarity_study

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.studies.figures import brackets_of
from haptoflow_training.studies.analysis import analyse_latency, analyse_similarity
from haptoflow_training.studies.log_table import LATENCY, SIMILARITY
from haptoflow_training.studies.rating_tests import Pair
from haptoflow_training.studies.simulation import METHODS, RatingModel, planted
from haptoflow_training.studies.session_file import read_faultless


def pictures_of(page: str) -> list[str]:
    return [base64.b64decode(data).decode() for data in re.findall(r"data:image/svg\+xml;base64,([^\"]+)", page)]


def analysed(folder: Path, out: Path) -> tuple[str, dict[str, object]]:
    words = ["study", "analyse", str(folder), "--out", str(out / "report.html"), "--results", str(out / "results.json")]
    assert main(words) == 0
    return (out / "report.html").read_text(encoding="utf-8"), json.loads((out / "results.json").read_text())


def make_real(folder: Path) -> None:
    for path in folder.glob("*.csv"):
        change_sidecar(path, lambda sidecar: sidecar | {"simulated": False})


def test_one_command_reports_both_studies_and_marks_them_as_simulated_everywhere(tmp_path: Path) -> None:
    logs = similarity_study(latency_study(tmp_path / "logs", 8), 8)
    page, results = analysed(logs, tmp_path)
    assert "<title>SIMULATED: no person took part" in page
    assert page.index("SIMULATED: no person took part</p>") < page.index("<h1>")
    pictures = pictures_of(page)
    assert len(pictures) == 2 and results["simulated"] is True
    for picture in pictures:
        assert ">SIMULATED: no person took part</text>" in picture and ">simulated</text>" in picture
    for caption in re.findall(r"<figcaption>(.*?)</figcaption>", page):
        assert caption.startswith("SIMULATED: no person took part.")
    assert not re.search(r"(src|href)=\"(?!data:)", page)


def test_a_report_of_real_participants_is_not_marked_as_simulated(tmp_path: Path) -> None:
    logs = similarity_study(latency_study(tmp_path / "logs", 6), 6)
    make_real(logs)
    page, results = analysed(logs, tmp_path)
    # The names of the simulated headset and program are reported too.
    shown = re.sub(r"none: simulated", "", page)
    assert "SIMULATED" not in shown and results["simulated"] is False
    assert all("SIMULATED" not in picture and "simulated" not in picture for picture in pictures_of(page))


def test_a_report_holds_thresholds_intervals_and_errors_of_both_conditions(tmp_path: Path) -> None:
    page, results = analysed(latency_study(tmp_path / "logs", 24, 3), tmp_path)
    for condition in ("turn-on", "turn-off"):
        one = results["latency"]["conditions"][condition]  # type: ignore[index]
        low, high = one["threshold_interval_ms"]
        assert low < one["threshold_ms"] < high and one["answers"] == 264
        assert f"{low:.1f} to {high:.1f}" in page and f"{one['threshold_error_ms']:.1f}" in page
    assert "The threshold of turn-on less that of turn-off is" in page


def test_practice_is_left_out_and_delivered_delays_are_fitted_not_planned_ones(tmp_path: Path) -> None:
    logs = latency_study(tmp_path / "logs", 6)
    before = analyse_latency(read_faultless(logs).of(LATENCY))
    for path in logs.glob("*.csv"):
        change_field(path, 2, "answer", "yes")
        change_field(path, 3, "answer", "no")
    same = analyse_latency(read_faultless(logs).of(LATENCY))
    assert same.fits["turn-on"].curve == before.fits["turn-on"].curve
    for path in logs.glob("*.csv"):

        def later(lines: list[str]) -> list[str]:
            names = lines[0].split(",")
            rows = [line.split(",") for line in lines[1:]]
            for row in rows:
                row[names.index("system_delay_ms")] = str(float(row[names.index("system_delay_ms")]) + 7.0)
                row[names.index("delivered_delay_ms")] = str(float(row[names.index("delivered_delay_ms")]) + 7.0)
            return [lines[0], *(",".join(row) for row in rows)]

        change_lines(path, later)
    shifted = analyse_latency(read_faultless(logs).of(LATENCY))
    assert shifted.fits["turn-on"].curve is not None and before.fits["turn-on"].curve is not None
    assert shifted.fits["turn-on"].curve.x0 == pytest.approx(before.fits["turn-on"].curve.x0 + 7.0)
    assert shifted.points["turn-on"][0].level_ms == 50.0 and shifted.points["turn-on"][0].delivered_ms == 57.0


def test_a_planted_difference_is_found_on_its_materials_and_drawn_with_a_star(tmp_path: Path) -> None:
    model = planted(("jute", "wood"), METHODS, 1.5)
    page, results = analysed(similarity_study(tmp_path / "logs", 24, 3, model), tmp_path)
    jute, wood = (results["similarity"]["materials"][name] for name in ("jute", "wood"))  # type: ignore[index]
    assert jute["friedman"]["p"] < 0.001 and wood["friedman"]["p"] > 0.05
    differs = {(pair["first"], pair["second"]) for pair in jute["pairs"] if pair["p_shaffer"] < 0.05}
    assert differs == {("haptoflow", "spsi"), ("transformer", "spsi"), ("dstn", "spsi")}
    assert all(pair["p_shaffer"] is None for pair in wood["pairs"])
    (picture,) = pictures_of(page)
    assert picture.count(">*</text>") == 3
    equal = [pair for one in (jute, wood) for pair in one["pairs"] if pair["p_holm"] < 0.05]
    assert picture.count(">≈</text>") == len(equal)


def test_materials_and_methods_stand_in_the_order_of_the_settings_else_by_name(tmp_path: Path) -> None:
    model = RatingModel(materials=("wood", "jute"), methods=("ours", "dstn"))
    logs = similarity_study(tmp_path / "logs", 3, 1, model)

    def names() -> tuple[list[str], list[str]]:
        result = analyse_similarity(read_faultless(logs).of(SIMILARITY))
        return list(result.materials), list(result.methods)

    assert names() == (["wood", "jute"], ["ours", "dstn"])
    objects = {"materials": [{"name": "wood"}, {"name": "jute"}], "methods": [{"name": "ours"}, {"name": "dstn"}]}
    for path in logs.glob("*.csv"):
        change_sidecar(path, lambda sidecar: sidecar | {"settings": objects})
    assert names() == (["wood", "jute"], ["ours", "dstn"])
    for odd in ({}, {"materials": 3, "methods": [None]}, {"materials": ["wood"], "methods": ["ours", "ours"]}):
        for path in logs.glob("*.csv"):
            change_sidecar(path, lambda sidecar, odd=odd: sidecar | {"settings": odd})
        assert names() == (["jute", "wood"], ["dstn", "ours"])


def test_names_with_markup_are_escaped_in_the_report(tmp_path: Path) -> None:
    model = RatingModel(materials=("<script>alert(1)</script>", "ジュート"), methods=("<b>", "it's", "$\\frac$ 1$"))
    page, _ = analysed(similarity_study(tmp_path / "logs", 6, 1, model), tmp_path)
    assert "<script>" not in page and "&lt;script&gt;alert(1)&lt;/script&gt;" in page and "<b>" not in page
    (picture,) = pictures_of(page)
    assert "<script>" not in picture and ">ジュート (n = 6)</text>" in picture and ">$\\frac$ 1$</text>" in picture


def test_a_missing_rating_is_named(tmp_path: Path) -> None:
    logs = similarity_study(tmp_path / "logs", 3)
    path = log_of(logs, 2, "similarity")
    last = path.read_text(encoding="utf-8").splitlines()[-1].split(",")
    change_lines(path, lambda lines: lines[:-1])
    change_sidecar(path, lambda sidecar: sidecar | {"plan": sidecar["plan"][:-1]})
    with pytest.raises(InputError, match=f"P02-.*: no rating of {last[3]} on {last[2]}, which others rated"):
        analyse_similarity(read_faultless(logs).of(SIMILARITY))


def test_a_duplicate_rating_is_named(tmp_path: Path) -> None:
    logs = similarity_study(tmp_path / "logs", 3)
    path = log_of(logs, 1, "similarity")

    def repeat(sidecar: dict[str, object]) -> dict[str, object]:
        plan = sidecar["plan"]
        return sidecar | {"plan": [*plan, {**plan[-1], "trial": len(plan) + 1}]}  # type: ignore[misc, index]

    change_sidecar(path, repeat)
    change_lines(path, lambda lines: [*lines, ",".join(["10", *lines[-1].split(",")[1:]])])
    with pytest.raises(InputError, match="is rated twice; expected once"):
        analyse_similarity(read_faultless(logs).of(SIMILARITY))


def test_too_few_participants_are_refused_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = similarity_study(tmp_path / "logs", 2)
    assert main(["study", "analyse", str(logs), "--out", str(tmp_path / "r.html")]) == 3
    assert "2 participants of the similarity study; its tests need 3" in capsys.readouterr().err
    assert not (tmp_path / "r.html").exists()


def test_faulty_logs_make_no_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = latency_study(tmp_path / "logs")
    change_field(log_of(logs, 2), 3, "answer", "maybe")
    assert main(["study", "analyse", str(logs), "--out", str(tmp_path / "r.html")]) == 3
    assert "row 3, column answer: 'maybe' is not yes or no" in capsys.readouterr().err
    assert not (tmp_path / "r.html").exists()


def test_results_are_not_written_among_the_logs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = latency_study(tmp_path / "logs")
    words = ["study", "analyse", str(logs), "--out", str(tmp_path / "r.html"), "--results", str(logs / "r.json")]
    assert main(words) == 3
    assert "lies in the folder of the logs" in capsys.readouterr().err


def test_brackets_never_cross_and_have_the_sign_of_their_p_value() -> None:
    def pair(first: int, second: int, p: float | None, equivalent: float) -> Pair:
        # The sign follows the corrected p-value.
        return Pair(first, second, 0.0, p, p, 0.0, 0.0, 1.0, 0.0, equivalent)

    pairs = [pair(0, 1, 0.03, 0.9), pair(0, 2, 0.07, 0.9), pair(1, 2, 0.5, 0.01), pair(0, 3, 0.2, 0.2)]
    found = brackets_of([*pairs, pair(2, 3, None, 0.04)])
    signs = {(one.first, one.second, one.sign) for one in found}
    assert signs == {(0, 1, "*"), (0, 2, "†"), (1, 2, "≈"), (2, 3, "≈")}
    for one in found:
        for other in found:
            if one is not other and one.level == other.level:
                assert one.second <= other.first or other.second <= one.first


def test_a_participant_missing_in_the_middle_is_noted_with_what_to_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    logs = similarity_study(latency_study(tmp_path / "logs", 8), 4)
    for participant in (3, 5, 6):
        for path in logs.glob(f"latency-P{participant:02d}-*"):
            path.unlink()
    page, results = analysed(logs, tmp_path)
    note = (
        "latency: participants 3, 5 to 6 missing below participant 8: the order of trials is not counterbalanced; run "
        "somebody under each of these numbers before higher ones"
    )
    assert note in page and note in results["notes"]  # type: ignore[operator]
    notes: list[str] = results["notes"]  # type: ignore[assignment]
    assert not any(one.startswith("similarity: participant") for one in notes)
    assert main(["study", "check", str(logs)]) == 0 and f"note: {note}" in capsys.readouterr().out


def test_a_pilot_of_one_study_does_not_keep_back_the_report_of_the_other(tmp_path: Path) -> None:
    logs = similarity_study(latency_study(tmp_path / "logs", 1), 1)
    page, results = analysed(logs, tmp_path)
    assert "1 participant of the similarity study; its tests need 3." in page and "Delay tolerance" in page
    assert results["latency"]["participants"] == 1 and "statement" in results["similarity"]  # type: ignore[index]
    assert len(pictures_of(page)) == 1


def test_ratings_that_are_all_equal_are_a_dash_and_partly_equal_ones_are_named(tmp_path: Path) -> None:
    logs = similarity_study(tmp_path / "logs", 6)
    for path in logs.glob("*.csv"):
        rows = path.read_text(encoding="utf-8").splitlines()
        names = rows[0].split(",")
        for number, row in enumerate(rows[1:], start=2):
            fields = dict(zip(names, row.split(","), strict=True))
            if fields["material"] == "jute" or fields["method"] == "ours":
                change_field(path, number, "rating", "4")
    page, _ = analysed(logs, tmp_path)
    assert re.search(r"<td>jute</td><td>-</td>", page)
    assert re.search(r"<td>wood</td><td>rejected for \d of 2; 1 not tested, all ratings equal</td>", page)
    assert "of 0" not in page


@pytest.mark.parametrize("value", [None, 0, -1, 7, "0.5", True])
def test_logs_without_a_bound_are_tested_with_the_usual_one_and_a_note_says_so(tmp_path: Path, value: object) -> None:
    logs = similarity_study(tmp_path / "logs", 3)

    def changed(sidecar: dict[str, object]) -> dict[str, object]:
        settings = {**sidecar["settings"], "equivalence_points": value}  # type: ignore[dict-item]
        if value is None:
            del settings["equivalence_points"]
        return sidecar | {"settings": settings}

    change_sidecar(log_of(logs, 3, "similarity"), changed)
    read = read_faultless(logs)
    assert analyse_similarity(read.of(SIMILARITY)).bound == 0.5
    assert any("the bound of equivalence was not fixed before the answers" in note for note in read.notes)
