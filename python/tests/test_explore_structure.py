"""The page of `snapload explore` for a structure: in metres and kilonewtons, in the words of `snapload assess`."""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Callable
from itertools import groupby
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from urllib.parse import quote

import pytest
import snapload
from explore import CYLINDER, DESKTOP, PHONE, ROOT, blameless, comes_true, count, download, exact_time, settled
from playwright.sync_api import Page, expect

SHORT = "run.duration=120"


@pytest.fixture
def assessed(command_json: Callable[..., Any]) -> Callable[..., Any]:
    """The command's answer for the cylinder with changes."""

    def ask(*changes: str, verb: str = "assess") -> Any:
        sets = [text for change in changes for text in ("--set", change)]
        return command_json(verb, str(ROOT / CYLINDER), *sets)

    return ask


def row(page: Page, line: int) -> list[str]:
    """The cells of a line in the table of lines."""
    return page.locator(f"#lines tbody tr:nth-child({line}) td").all_inner_texts()


def shows_answer(page: Page, answer: dict[str, Any]) -> None:
    """The page shows the texts and digits of the command."""
    expect(page.locator("#message")).to_have_text(answer["verdict"]["words"], timeout=30_000)
    expect(page.locator("#verdict")).to_have_attribute("data-standing", answer["verdict"]["standing"])
    for line in answer["lines"]:
        cells = row(page, line["line"])
        assert cells[0].strip() == f"{line['utilisation']:.2f}"
        assert cells[1] == f"{1 / line['utilisation']:.2f}"
        assert float(cells[2]) == pytest.approx(line["breaking_load_n"] / 1e3, rel=1e-3)
        assert float(cells[3]) == pytest.approx(line["held_tension_n"] / 1e3, rel=1e-3)


def test_a_structure_is_shown_as_by_assess(open_structure, assessed):
    page = open_structure(f"{SHORT}&t=0")
    answer = assessed(SHORT)
    shows_answer(page, answer)
    expect(page.locator("#trust")).to_have_text(answer["trust"]["words"], timeout=30_000)
    assert [line.split("\n")[0] for line in page.locator("#warnings li b").all_inner_texts()] == [
        warning["rule"] for warning in answer["warnings"]
    ]
    page.locator(".printed summary").click()
    assert answer["verdict"]["words"].split(". ")[0] in re.sub(r"\s+", " ", page.locator("#summary").inner_text())


def test_what_is_not_judged_is_shown_as_such(open_structure):
    page = open_structure("t=0&wave.height=12")
    expect(page.locator("#lines-words")).to_contain_text("so that nothing is judged")
    row = page.locator("#lines tbody tr").first
    # Held, snap peak, slack, fastest, snaps and least: of none of them is anything known.
    cells = row.locator("td").all_text_contents()
    assert [cells[k] for k in (3, 4, 5, 6, 7, 9)] == ["–"] * 6, cells
    page.locator("#pin").click()
    expect(page.locator("#pins li").first).to_contain_text("nothing judged")


def test_a_slider_changes_the_wave_and_a_link_holds_it(open_structure, assessed):
    page = open_structure(f"{SHORT}&t=0")
    before = count(page)
    page.locator('[id="slider-wave.height"]').evaluate(
        "(slider) => { slider.value = 2.6; slider.dispatchEvent(new Event('input')); "
        "slider.dispatchEvent(new Event('change')); }"
    )
    settled(page, before)
    answer = assessed(SHORT, "wave.height=2.6")
    shows_answer(page, answer)
    expect(page.locator("#shell")).to_have_text(
        f"snapload assess {CYLINDER} --set '{SHORT}' --set 'wave.height=2.6'",
    )
    comes_true(page, lambda: "wave.height=2.6" in page.evaluate("() => location.hash"))
    linked = open_structure(page.evaluate("() => location.hash").removeprefix("#"))
    shows_answer(linked, answer)


RANGES = """inputs => inputs.map(({ id, min, max, step, value }) => {
    const field = document.getElementById(id.replace('slider-', 'field-'));
    return { id, ends: [min, max, step, value].map(Number), field: field.value };
})"""


def has_sliders(page: Page) -> None:
    """Every slider has finite ends, shows the value of its field to half a step, and keeps it when it is focused."""
    page.locator("details.group").evaluate_all("groups => groups.forEach(group => (group.open = true))")
    ranges = page.locator("input.slider").evaluate_all(RANGES)
    assert len(ranges) > 5
    for one in ranges:
        low, high, step, value = one["ends"]
        assert low <= value <= high and low < high and 0 < step < high - low, one
        if one["field"]:
            assert abs(value - float(one["field"])) <= step / 2 * (1 + 1e-9), one


@pytest.mark.parametrize("case", ["docs/examples/pontoon.toml", "docs/examples/cylinder-sea.toml"])
def test_the_sliders_of_other_structures_have_ends(serve, open_at, case):
    has_sliders(open_at(serve(case), f"{SHORT}&t=0&elastic=false"))


def test_all_sliders_have_ends(open_structure, open_page):
    has_sliders(open_structure(f"{SHORT}&t=0&elastic=false"))
    has_sliders(open_page("t=0"))


def test_the_slider_of_added_mass_begins_at_its_value(open_structure, assessed):
    page = open_structure(f"{SHORT}&t=0&elastic=false")
    page.locator("summary", has_text="Body").click()
    slider = page.locator('[id="slider-body.added_mass"]')
    field = page.locator('[id="field-body.added_mass"]')
    for end, least, most in [("Home", 0.49, 0.51), ("End", 1.49, 1.53)]:
        before = count(page)
        slider.press(end)
        settled(page, before)
        assert least < float(field.input_value()) / 144_904 < most
        shows_answer(page, assessed(SHORT, f"body.added_mass={field.input_value()}"))
    three = "[144904, 144904, 0]"
    field.fill(three)
    field.press("Enter")
    shows_answer(page, assessed(SHORT, f"body.added_mass={three}"))
    # No place on a slider is that of three numbers.
    expect(slider).to_be_hidden()
    field.fill("144904")
    expect(slider).to_be_visible()
    expect(page.locator("#shell")).not_to_contain_text("added_mass")


def test_lists_can_be_edited_in_their_fields(open_structure, assessed):
    page = open_structure(f"{SHORT}&t=0&elastic=false")
    page.locator("summary", has_text="Line 1 alone").click()
    anchor = page.locator('[id="field-line.1.anchor"]')
    expect(anchor).to_have_value("[3.593, -10]")
    anchor.fill("[3.6, -10]")
    anchor.press("Enter")
    shows_answer(page, assessed(SHORT, "line.1.anchor=[3.6, -10]"))


def test_the_lines_to_copy_run_as_they_are(serve, open_at, tmp_path: Path):
    name = tmp_path / "my pier's; $(touch bad) \\ x.toml"
    name.write_text((ROOT / CYLINDER).read_text(encoding="utf-8"), encoding="utf-8")
    url = serve(str(name), "--set", "wave.height=2.5", "--set", SHORT)
    text = 'O\'Brien & "Sons"; $(touch bad)'
    page = open_at(url, f"project.name={quote(text)}&line.1.anchor={quote('[3.6, -10]')}&t=0&elastic=false")
    expect(page.locator("#verdict")).to_have_attribute("data-standing", re.compile("."), timeout=30_000)
    words = page.locator("#message").inner_text()
    program = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"
    path = f"{program}{os.pathsep}{os.environ['PATH']}"
    copied = page.locator("#shell").inner_text()
    line = f"{copied} --neighbours 0 --json -"
    run = subprocess.run(["sh", "-c", line], capture_output=True, text=True, cwd=tmp_path, env={"PATH": path})
    assert run.returncode == 0, run.stderr
    answer = json.loads(run.stdout)
    assert answer["verdict"]["words"] == words
    given: list[tuple[str, dict[str, Any]]] = []
    structure = SimpleNamespace(
        from_toml=lambda path, changes: given.append((path, changes)) or SimpleNamespace(assess=list)
    )
    copied = page.locator("#python").inner_text().removeprefix("import snapload\n")
    eval(copied, {"snapload": SimpleNamespace(Structure=structure)})
    [(path, changes)] = given
    assert path == str(name)
    again = snapload.Structure.from_toml(path, changes)
    assert again.assess(neighbours=0, progress=False).verdict == words
    # A text of a link is shown as it is, in the pins too.
    page.locator("#pin").click()
    expect(page.locator("#pins .back")).to_contain_text(text)
    assert not (tmp_path / "bad").exists() and not (ROOT / "bad").exists()


def test_a_utilisation_next_to_1_is_written_on_its_side_of_1(open_structure, assessed):
    tension = max(line["utilisation"] * line["breaking_load_n"] for line in assessed(SHORT)["lines"])
    for part, written, factor in [(0.998, "0.998", "1.00"), (1.002, "1.00", "0.998")]:
        change = f"line.breaking_load={tension / part:.8g}"
        largest = max(line["utilisation"] for line in assessed(SHORT, change)["lines"])
        assert largest == pytest.approx(part, rel=1e-6)
        page = open_structure(f"{SHORT}&{change}&t=0&elastic=false")
        cells = page.locator("#lines tbody tr").filter(has_text=written).first.locator("td")
        expect(cells.nth(0)).to_have_text(written)
        expect(cells.nth(1)).to_have_text(factor)
        expect(page.locator("#message")).to_contain_text(written)
        page.locator("#pin").click()
        expect(page.locator("#pins li")).to_contain_text(f"utilisation {written}")


def test_numbers_on_either_side_of_1_are_told_apart(code):
    values = [k * 10.0**-e + 1 for e in range(2, 7) for k in (-7, -2, 0, 2, 7)] + [0.0, 0.63, 12.34]
    module = "import('./formatting.js')"
    written = code.evaluate(f"async values => values.map((await {module}).ratio)", values)
    for value, text in zip(values, written, strict=True):
        assert (float(text) < 1) == (value < 1), (value, text)
        # No more decimals than it takes.
        shorter = text[:-1] if len(text.split(".")[1]) > 2 else None
        assert shorter is None or float(f"{value:.{len(shorter.split('.')[1])}f}") >= 1 > value
        assert float(text) == pytest.approx(value, abs=0.005)


def test_rigid_and_elastic_lines_stand_side_by_side(open_structure, assessed):
    page = open_structure(f"{SHORT}&t=0")
    answer = assessed(SHORT, verb="elastic")
    expect(page.locator("#lines thead")).to_contain_text("elastic", timeout=30_000)
    for line in answer["lines"]:
        cells = row(page, line["line"])
        assert float(cells[5]) == pytest.approx(line["peak_n"] / 1e3, rel=1e-3)
        assert float(cells[7]) == pytest.approx(100 * line["slack_fraction"], abs=0.06)
    scene = page.locator("#scene")
    with_them = scene.evaluate("canvas => canvas.toDataURL()")
    page.keyboard.press("g")
    expect(page.locator("#lines thead")).not_to_contain_text("elastic")
    comes_true(page, lambda: scene.evaluate("canvas => canvas.toDataURL()") != with_them)


def test_the_motion_on_elastic_lines_has_a_horizon_of_its_own(open_structure, assessed):
    changes = ["wave.height=2.5", "wave.period=5", "run.duration=150", "run.transient=10"]
    horizon = assessed(*changes, verb="elastic")["trust"]["horizon_s"]
    assert 20 < horizon < 145
    for window, past in [([0, horizon - 10], False), ([horizon - 5, horizon + 5], True)]:
        page = open_structure(f"{'&'.join(changes)}&window={window[0]},{window[1]}&t={window[1]}")
        expect(page.locator("#elastic-key")).to_be_visible(timeout=30_000)
        expect(page.locator("#elastic-past")).to_be_visible(visible=past)


def test_a_sea_takes_the_place_of_the_wave(open_structure, command_json, tmp_path: Path):
    page = open_structure("run.duration=330&elastic=false&t=0")
    page.locator("#waters label", has_text="Sea").click()
    expect(page.locator('[id="field-sea.hs"]')).to_have_value("1.1")
    expect(page.locator("#preview")).to_contain_text("first 300 s", timeout=20_000)
    expect(page.locator("#preview")).not_to_contain_text("first 300 s", timeout=60_000)
    download(page, '[data-file="case.toml"]', tmp_path / "case.toml")
    shows_answer(page, command_json("assess", str(tmp_path / "case.toml"), "--neighbours", "0"))
    first = page.locator("#message").inner_text()
    page.locator(".another-sea").click()
    expect(page.locator('[id="field-sea.seed"]')).to_have_value("2")
    comes_true(page, lambda: page.locator("#message").inner_text() != first)


def test_a_verdict_before_its_neighbours_says_that_they_are_to_come(open_structure):
    page = open_structure(f"{SHORT}&t=0&elastic=false")
    expect(page.locator("#coming")).to_have_text("", timeout=60_000)
    page.evaluate(
        """() => {
            window.seen = [];
            const [message, coming] = ['message', 'coming'].map(id => document.getElementById(id));
            new MutationObserver(() => window.seen.push(coming.textContent)).observe(message, { childList: true });
        }"""
    )
    page.locator('[id="field-wave.height"]').fill("2.4")
    comes_true(page, lambda: page.evaluate("() => window.seen.length > 0"))
    assert page.evaluate("() => window.seen[0]") == "neighbours to come"
    expect(page.locator("#coming")).to_have_text("", timeout=60_000)


def test_a_note_reports_its_progress(open_structure, tmp_path: Path):
    # Long enough that the page asks more than once during each stage.
    page = open_structure("run.duration=360&elastic=false&t=0")
    page.evaluate(
        """() => {
            window.messages = [];
            const message = document.getElementById('export-message');
            new MutationObserver(() => window.messages.push(message.textContent)).observe(message, { childList: true });
        }"""
    )
    page.set_default_timeout(60_000)
    note = download(page, '[data-file="note.html"]', tmp_path / "note.html")
    assert note.startswith(b"<!") and b"</html>" in note
    progress = [re.search(r"of \S+: ([a-z ]+), (\d+) %$", words) for words in page.evaluate("() => window.messages")]
    # Each stage is reported from its start to its end.
    stages = [list(stage) for _, stage in groupby((found for found in progress if found), key=lambda found: found[1])]
    assert len({stage[0][1] for stage in stages}) == len(stages) > 1, page.evaluate("() => window.messages")
    for stage in stages:
        percent = [int(found[2]) for found in stage]
        assert len(set(percent)) > 1 and percent == sorted(percent), percent
    expect(page.locator("#export-message")).to_contain_text("is saved")
    for one in ["#file-progress", "#file-cancel"]:
        expect(page.locator(one)).to_be_hidden()
    page.locator('[id="field-wave.height"]').fill("2.4")
    page.locator('[data-file="note.html"]').click()
    page.locator("#file-cancel").click()
    expect(page.locator("#export-message")).to_contain_text("was cancelled")
    expect(page.locator('[data-file="note.html"]')).to_be_enabled()


def test_an_anchor_is_moved_by_hand(open_structure, assessed):
    page = open_structure(f"{SHORT}&t=0")
    box = page.locator("#scene").bounding_box()
    x, y = page.evaluate(
        """async ([width, height, duration]) => {
            const { StructureRun } = await import('./structure-run.js');
            const { structureCamera } = await import('./structure-scene.js');
            const headers = { 'Content-Type': 'application/json' };
            const body = JSON.stringify({ case: { set: [duration] } });
            const answer = await fetch('api/structure/run', { method: 'POST', headers, body });
            const run = new StructureRun(await answer.json());
            return structureCamera(run, { width, height, zoom: null }).place(run.geometry.lines[0].anchor);
        }""",
        [box["width"], box["height"], SHORT],
    )
    page.mouse.move(box["x"] + x, box["y"] + y - 2)
    page.mouse.down()
    page.mouse.move(box["x"] + x - 12, box["y"] + y - 2, steps=4)
    page.mouse.up()
    moved = page.locator('[id="field-line.1.anchor"]').input_value()
    change = f"line.1.anchor={moved}"
    assert change != "line.1.anchor=[3.593, -10]"
    comes_true(page, lambda: change in page.locator("#shell").inner_text())
    shows_answer(page, assessed(SHORT, change))


def test_a_refusal_is_shown_at_its_field(open_structure, command):
    page = open_structure(f"{SHORT}&t=0", refused=1)
    page.locator('[id="field-wave.height"]').fill("60")
    refused = command("assess", str(ROOT / CYLINDER), "--set", "wave.height=60", fails=True)
    message = page.locator('[id="error-wave.height"]')
    expect(message).to_contain_text("60")
    assert message.inner_text().split("allowed", 1)[1].strip() in refused
    expect(page.locator("#failed")).to_contain_text("the last values that could be run")
    expect(page.locator("#failed")).to_contain_text("Not run: wave.height = 60 ")


def test_the_hardest_snaps_and_the_record_lead_to_their_time(open_structure):
    page = open_structure("t=0&elastic=false")
    first = page.locator("#events-body tr").first
    first.locator(".go").click()
    comes_true(page, lambda: exact_time(page) == float(first.get_attribute("data-t")))
    expect(page.locator("#caption")).to_contain_text("snap of line")
    before = count(page)
    page.locator("#interval-start").evaluate("one => { one.value = 500; one.dispatchEvent(new Event('input')); }")
    settled(page, before)
    expect(page.locator("#window-words")).to_have_text("500.0 to 536.0 s")
    assert 500 <= exact_time(page) <= 536
    # The motion of this interval alone is here.
    for key, t in [("End", 536), ("Home", 500)]:
        page.keyboard.press(key)
        assert exact_time(page) == t


def test_other_waves_are_a_table_whose_cells_are_run(open_structure):
    page = open_structure(f"{SHORT}&t=0&elastic=false")
    kinds = ["known", "at least", "fails", "not judged", "known", "known"]
    values = [0.4, 0.6, None, None, 0.7, 1.2]
    cells = [{"value": value, "kind": kind} for value, kind in zip(values, kinds, strict=True)]
    waves = {"periods_s": [5, 6], "heights_m": [1.5, 2, 2.5], "cells": cells}
    answer = {**waves, "utilisation": True, "length": 60}
    page.route("**/api/structure/waves", lambda route: route.fulfill(json=answer))
    page.locator("#waves-run").click()
    cells = page.locator("#waves td")
    expect(cells).to_have_text(["×", "1.20", "≥ 0.60", "0.70", "0.40", "–"])
    expect(page.locator("#waves td[aria-current]")).to_have_text("0.70")
    page.locator('#waves td[tabindex="0"]').focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    expect(page.locator('[id="field-wave.height"]')).to_have_value("2.5")
    expect(page.locator("#waves td[aria-current]")).to_have_text("1.20")


def test_answers_are_pinned_and_compared_in_words(open_structure):
    page = open_structure(f"{SHORT}&t=0&elastic=false")
    page.keyboard.press("p")
    expect(page.locator("#pins li")).to_contain_text("the same as now")
    before = count(page)
    page.locator('[id="field-wave.height"]').fill("3")
    settled(page, before)
    expect(page.locator("#pins li")).to_contain_text("less than now")
    page.locator("#pins .back").click()
    expect(page.locator('[id="field-wave.height"]')).to_have_value("2")


def test_case_files_find_their_page(open_page, structure_url, open_at, tmp_path: Path):
    mine = tmp_path / "mine.toml"
    mine.write_text((ROOT / CYLINDER).read_text().replace("height = 2\n", "height = 1.2\n"), encoding="utf-8")
    page = open_page("t=0")
    page.locator("#open-case").set_input_files(mine)
    expect(page.locator("#file")).to_have_text("mine.toml", timeout=30_000)
    expect(page.locator('[id="field-wave.height"]')).to_have_value("1.2")
    thesis = tmp_path / "thesis.toml"
    thesis.write_text("f_o = 0.42\n", encoding="utf-8")
    page.locator("#open-case").set_input_files(thesis)
    expect(page.locator("#field-f_o")).to_have_value("0.42", timeout=30_000)


BARGE = (ROOT / "crates/snapload-explore/tests/data/barge.toml").read_text(encoding="utf-8")


def test_a_body_that_floats_is_opened_unless_it_names_a_file(open_at, url, tmp_path: Path, command_json):
    named = tmp_path / "pontoon.toml"
    named.write_text(BARGE.replace("[float]\n", '[float]\nfile = "pontoon.nc"\n'), encoding="utf-8")
    page = open_at(url, "t=0", refused=1)
    page.locator("#open-case").set_input_files(named)
    note = page.locator("#note")
    expect(note).to_contain_text('float.file = "pontoon.nc" is not allowed')
    expect(note).to_contain_text("snapload explore pontoon.toml")
    barge = tmp_path / "barge.toml"
    barge.write_text(BARGE, encoding="utf-8")
    page.locator("#open-case").set_input_files(barge)
    expect(page.locator("#file")).to_have_text("barge.toml", timeout=30_000)
    answer = command_json("assess", str(barge))
    expect(page.locator("#message")).to_have_text(answer["verdict"]["words"], timeout=30_000)


@pytest.mark.parametrize(("viewport", "scheme"), [(DESKTOP, "light"), (PHONE, "dark")], ids=["desktop", "phone"])
def test_the_page_of_a_structure_is_for_everyone(open_structure, viewport, scheme):
    long_number = "line.breaking_load=911809.536&line.stiffness=82667200"
    page = open_structure(f"{SHORT}&{long_number}&t=30&elastic=false", viewport=viewport, color_scheme=scheme)
    page.locator("details.group:visible").evaluate_all("groups => groups.forEach(group => (group.open = true))")
    shown = page.locator(".key .field[type=text]:visible")
    cut_off = shown.evaluate_all("all => all.filter(one => one.scrollWidth > one.clientWidth).map(one => one.value)")
    assert "911809.536" in shown.evaluate_all("all => all.map(one => one.value)")
    assert not cut_off
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth"), "it is wider than the window"
    blameless(page)
    page.emulate_media(forced_colors="active")
    assert page.locator("#scene").evaluate("one => getComputedStyle(one).forcedColorAdjust") == "none"
    assert "m, turned by" in page.locator("#scene").get_attribute("aria-label")
