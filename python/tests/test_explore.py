"""The page of `snapload explore` in a real browser: it shows the command's numbers, by mouse, by keyboard, to all."""

from __future__ import annotations

import re
import struct
import tomllib
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from explore import (
    PICTURES,
    clock,
    comes_true,
    count,
    download,
    drawn,
    exact_time,
    read,
    settled,
    shown_is,
    times,
)
from playwright.sync_api import expect


def test_it_opens_with_the_standard_case(open_page, command_json):
    page = open_page()
    assert page.title() == "snapload explore"
    assert "standard case" in page.locator("#case option:checked").inner_text()
    shown_is(page, command_json("run", "--ensemble", "0"))
    assert "Settled at t = 7.246" in page.locator("#message").inner_text()


def test_a_slider_answers_with_the_numbers_of_the_command(open_page, command_json, capsys):
    page = open_page()
    slider = page.locator("#slider-f_o")
    slider.focus()
    took = []
    for key in ["ArrowRight"] * 3 + ["PageUp", "ArrowLeft"]:
        before = count(page)
        page.keyboard.press(key)
        settled(page, before)
        took.append(float(page.locator("#took").get_attribute("data-ms")))
    value = page.locator("#field-f_o").input_value()
    assert float(value) > 0.3 and value == slider.input_value()
    expect(page.locator("#shell")).to_contain_text(f"f_o={value}")
    shown_is(page, command_json("run", "--ensemble", "0", "--set", f"f_o={value}"))
    with capsys.disabled():
        print(f"\nfrom a change to the painted picture (debug build): {', '.join(f'{ms:.0f}' for ms in took)} ms")


def test_a_field_takes_what_a_slider_does_not(open_page, command_json):
    page = open_page()
    before = count(page)
    page.locator("#field-e").fill("0.123456789")
    settled(page, before)
    shown_is(page, command_json("run", "--ensemble", "0", "--set", "e=0.123456789"))
    page.locator("#field-e").focus()
    before = count(page)
    page.get_by_role("button", name="e: back to the default").click()
    settled(page, before)
    assert page.locator("#field-e").input_value() == "0.9"


BAD_VALUES = [
    ("e", "1.2", "e = 1.2 is not allowed; allowed: a number, 0 <= e <= 1"),
    ("f_o", "much", 'f_o = "much" is not allowed'),
    ("a", "5", "r = 1.5 is not allowed; allowed: r > |1 - a| = 4 (a = 5)"),
]


def test_a_bad_value_is_refused_in_the_words_of_the_command(open_page):
    page = open_page(refused=1)
    for field, text, words in BAD_VALUES:
        comes_true(page, lambda: times(page) != [])
        expect(page.locator("#events-body")).not_to_have_class("stale")
        kept = times(page)
        usual = page.locator(f"#field-{field}").input_value()
        page.locator(f"#field-{field}").fill(text)
        page.locator(f"#field-{field}").press("Enter")
        named = words.split(" ")[0]
        expect(page.locator(f"#error-{named}")).to_contain_text(words)
        expect(page.locator("#failed")).to_contain_text("last values that could be run")
        assert page.locator(f"#field-{named}").get_attribute("aria-invalid") == "true"
        assert times(page) == kept
        # The last one is as it was before; where the first is that, it is the only one.
        for good in dict.fromkeys(["0.1", usual]):
            before = count(page)
            page.locator(f"#field-{field}").fill(good)
            settled(page, before)
            expect(page.locator("#failed")).to_be_hidden()
            expect(page.locator(f"#error-{named}")).to_be_hidden()


def test_a_point_mass_has_neither_size_nor_rotation(open_page):
    page = open_page("t=0")
    assert page.locator("#slider-inertia").get_attribute("aria-valuetext") == "0.01 m\u2009L²"
    before = count(page)
    page.locator("#field-body").select_option("point")
    settled(page, before)
    for key in ["a", "b", "inertia", "theta", "vtheta"]:
        expect(page.locator(f"#field-{key}")).to_be_disabled()
        expect(page.locator(f"#slider-{key}")).to_be_disabled()
        assert "a point mass has no" in page.locator(f"#why-{key}").inner_text()
    expect(page.locator("#field-x")).to_be_enabled()
    expect(page.locator("#failed")).to_be_hidden()
    before = count(page)
    page.locator("#field-body").select_option("rigid")
    settled(page, before)
    expect(page.locator("#field-a")).to_be_enabled()
    # A rotation that was given before is refused, and can be corrected in its field.
    given = open_page("t=0&theta=0.2&body=point", refused=1)
    expect(given.locator("#error-theta")).to_contain_text("theta = 0.2 is not allowed")
    given.locator("#field-theta").fill("0")
    given.locator("#field-theta").press("Enter")
    expect(given.locator("#error-theta")).to_be_hidden()
    expect(given.locator("#field-theta")).to_be_disabled()


def test_built_in_cases_are_there(open_page, command_json):
    page = open_page()
    before = count(page)
    page.locator("#case").select_option("1920001000-359")
    settled(page, before)
    assert page.locator("#field-a").input_value() == "0.2"
    shown_is(page, command_json("run", "--ensemble", "0", "--case", "1920001000-359"))
    codes = set(page.locator("#case option").evaluate_all("all => all.map(one => one.value)"))
    assert {"sliding-example", "rocking-example", "2921001000-359"} <= codes


def test_time_advances_while_it_plays(open_page, command_json):
    page = open_page()
    page.keyboard.press("Space")
    expect(page.locator("#play")).to_have_text("Pause")
    comes_true(page, lambda: exact_time(page) > 0.3)
    page.keyboard.press("Space")
    expect(page.locator("#play")).to_have_text("Play")
    paused = exact_time(page)
    page.wait_for_timeout(150)
    assert exact_time(page) == paused > 0.3
    page.locator("#speed").select_option("20")
    page.locator("#play").click()
    expect(page.locator("#play")).to_have_text("Play", timeout=5000)
    assert exact_time(page) == command_json("run", "--ensemble", "0")["end"]["t"]


def test_the_keyboard_steps_from_event_to_event(open_page, command_json):
    run = command_json("run", "--ensemble", "0")
    page = open_page()
    for impact in run["impacts"][:5]:
        page.keyboard.press("ArrowRight")
        assert exact_time(page) == impact["t"]
        expect(page.locator("#events-body tr[aria-current] .go")).to_have_attribute("data-t", str(impact["t"]))
    page.keyboard.press("ArrowLeft")
    assert exact_time(page) == run["impacts"][3]["t"]
    page.keyboard.press("Shift+ArrowRight")
    assert run["impacts"][3]["t"] < exact_time(page) < run["impacts"][4]["t"]
    page.locator("#scrub").focus()
    page.keyboard.press("ArrowRight")
    assert exact_time(page) == run["impacts"][4]["t"]
    page.keyboard.press("End")
    assert exact_time(page) == run["end"]["t"]
    page.keyboard.press("Home")
    assert exact_time(page) == 0
    page.keyboard.press("+")
    assert page.locator("#speed").input_value() == "2"


def test_scrubbing_and_hovering_read_the_motion(open_page, command_json):
    motion = command_json("run", "--ensemble", "0", "--sample", "0.001")["motion"]
    page = open_page()
    box = page.locator("#scrub").bounding_box()
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + box["height"] / 2)
    assert clock(page) == pytest.approx(7.2464 / 2, abs=0.05)
    over = page.locator("#charts .over").first
    area = over.bounding_box()
    page.mouse.move(area["x"] + 0.4 * area["width"], area["y"] + area["height"] / 2)
    reading = page.locator("#trajectory .reading")
    expect(reading).not_to_have_text(re.compile(f"^t {clock(page):.3f} "))
    t, x, y = (read(part) for part in reading.inner_text().split("  "))
    near = motion[round(t / 0.001)]
    assert (x, y) == pytest.approx((near["x"], near["y"]), abs=1e-3)
    theta = read(page.locator("#charts .reading").first.inner_text())
    assert theta == pytest.approx(near["theta"], abs=5e-3)
    page.mouse.down()
    page.mouse.up()
    assert clock(page) == pytest.approx(t, abs=1e-3)


def test_a_click_on_a_mark_or_a_row_jumps_to_its_impact(open_page, command_json):
    run = command_json("run", "--ensemble", "0")
    hardest = max(run["impacts"], key=lambda impact: impact["v_n"])
    page = open_page()
    chart = page.locator("#charts .over").nth(1)
    area = chart.bounding_box()
    # The hardest snap is as high as the axis goes, less the air above it.
    x = 50 + hardest["t"] / run["end"]["t"] * (area["width"] - 60)
    mark = {"x": x, "y": 6 + (area["height"] - 14) * (1 - 1 / 1.06)}
    chart.hover(position=mark)
    expect(page.locator("#charts .reading").nth(1)).to_contain_text("impact 2, cable 1")
    chart.click(position=mark)
    assert exact_time(page) == hardest["t"]
    page.locator("#events-body .go").nth(4).focus()
    page.keyboard.press("Enter")
    assert exact_time(page) == run["impacts"][3]["t"]
    path = page.locator("#trajectory > .stack")
    area = path.bounding_box()
    path.click(position={"x": 0.5 * area["width"], "y": 0.5 * area["height"]})
    assert exact_time(page) != run["impacts"][3]["t"]


def test_the_map_fills_and_a_cell_is_its_run(open_page, command_json):
    page = open_page()
    page.evaluate("""() => {
        window.seen = new Set();
        const look = () => window.seen.add(document.getElementById('map-progress').textContent);
        new MutationObserver(look).observe(document.getElementById('map-progress'), { childList: true });
    }""")
    page.locator("#map-box summary").click()
    expect(page.locator("#map-progress")).to_have_text(re.compile("^2091 runs$"), timeout=60_000)
    assert len(page.evaluate("() => [...window.seen]")) > 3, "it did not fill in little by little"
    expect(page.locator("#map-legend")).to_contain_text("rotation limit")
    area = page.locator("#map").bounding_box()
    before = count(page)
    # The cell of f_o = 0.5 in the middle of 51 from 0 to 1, and the uppermost but one of e.
    place = {"x": 56 + 0.5 * (area["width"] - 68), "y": 10 + 1.5 / 41 * (area["height"] - 50)}
    page.locator("#map").click(position=place)
    # The message belongs to the clicked cell, not to that of the run before.
    expect(page.locator("#map-message")).to_contain_text("f_o = 0.5, ")
    settled(page, before)
    assert page.locator("#field-f_o").input_value() == "0.5"
    e = page.locator("#field-e").input_value()
    run = command_json("run", "--ensemble", "0", "--set", "f_o=0.5", "--set", f"e={e}")
    shown_is(page, run)
    page.locator("#map").focus()
    message = page.locator("#map-message")
    expect(message).to_contain_text(f"f_o = 0.5, e = {e}: {run['end']['reason'].replace('_', ' ')}")
    expect(message).to_contain_text(f"{len(run['impacts'])} impacts")
    page.keyboard.press("ArrowRight")
    expect(message).to_contain_text("f_o = 0.52")
    before = count(page)
    page.keyboard.press("Enter")
    settled(page, before)
    assert page.locator("#field-f_o").input_value() == "0.52"


def test_the_ghost_is_a_neighbour_that_parts(open_page):
    page = open_page()
    before = count(page)
    page.keyboard.press("g")
    settled(page, before)
    expect(page.locator("#message")).to_contain_text("The ghost, started 1e−6 away in x, is 1e−3 away at t =")
    parts_at = read(page.locator("#message").inner_text().split("is 1e−3 away at t = ")[1])
    assert 0.5 < parts_at < 7.25
    before = count(page)
    page.locator("#ghost-size").fill("1e-12")
    page.locator("#ghost-size").press("Enter")
    settled(page, before)
    expect(page.locator("#message")).to_contain_text("1e−12")
    later = read((page.locator("#message").inner_text() + " is 1e−3 away at t = 99").split("is 1e−3 away at t = ")[1])
    assert later > parts_at


WRONG_GHOSTS = [
    ("5", "ghost = 5 is not allowed; allowed: a number, 0 < ghost <= 0.1"),
    ("-1", "ghost = -1 is not allowed; allowed: a number, 0 < ghost <= 0.1"),
    ("abc", 'ghost = "abc" is not allowed; allowed: a number'),
]


def test_a_wrong_ghost_is_refused_in_words(open_page):
    page = open_page(refused=1)
    size = page.locator("#ghost-size")
    page.locator("#ghost").check()
    for text, words in WRONG_GHOSTS:
        expect(page.locator("#message")).to_contain_text("The ghost, started 1e−6 away")
        size.fill(text)
        size.press("Enter")
        expect(page.locator("#error-ghost")).to_contain_text(words)
        assert size.get_attribute("aria-invalid") == "true"
        for good, shown in [("1e-5", "1e−5"), ("1e-6", "1e−6")]:
            size.fill(good)
            size.press("Enter")
            expect(page.locator("#error-ghost")).to_be_hidden()
            expect(page.locator("#message")).to_contain_text(f"The ghost, started {shown} away")
            assert size.get_attribute("aria-invalid") is None


def test_a_wrong_ghost_in_a_link_is_reported_and_the_run_is_shown(open_page, command_json):
    page = open_page("f_o=0.31&t=0&ghost=5", refused=1)
    expect(page.locator("#error-ghost")).to_contain_text("ghost = 5 is not allowed")
    shown_is(page, command_json("run", "--ensemble", "0", "--set", "f_o=0.31"))
    before = count(page)
    page.locator("#field-f_o").fill("0.29")
    settled(page, before)
    shown_is(page, command_json("run", "--ensemble", "0", "--set", "f_o=0.29"))
    expect(page.locator("#error-ghost")).to_contain_text("ghost = 5 is not allowed")
    unread = open_page("f_o=0.31&t=0&ghost=abc")
    expect(unread.locator("#note")).to_contain_text("ghost=abc")


def test_files_are_those_of_the_command(open_page, command, tmp_path: Path):
    page = open_page("f_o=0.27&stop_when_settled=false&t_end=9")
    case = tmp_path / "case.toml"
    download(page, '[data-file="case.toml"]', case)
    assert tomllib.loads(case.read_text(encoding="utf-8"))["f_o"] == 0.27
    command(*page.locator("#shell").inner_text().split()[1:], "--out", str(tmp_path / "out"))
    pictures = [f"{name}.{kind}" for name in PICTURES for kind in ["svg", "png"]]
    for name in ["impacts.csv", "modes.csv", "run.json", *pictures]:
        download(page, f'[data-file="{name}"]', tmp_path / name)
        assert (tmp_path / name).read_bytes() == (tmp_path / "out" / name).read_bytes(), name
    # The command gets the number of samples; the page samples a thousand times.
    motion = download(page, '[data-file="motion.csv"]', tmp_path / "motion.csv")
    command(
        *page.locator("#shell").inner_text().split()[1:], "--out", str(tmp_path / "fine"), "--sample", str(9 / 1000)
    )
    assert motion == (tmp_path / "fine" / "motion.csv").read_bytes()


def test_the_scene_and_the_animation_are_saved(open_page, tmp_path: Path):
    page = open_page("t=0.4721795499019612&speed=20")
    drawing = download(page, "#scene-svg", tmp_path / "scene.svg").decode("utf-8")
    assert drawing.startswith("<svg") and drawing.count("<path") > 20 and "NaN" not in drawing
    picture = download(page, "#scene-png", tmp_path / "scene.png")
    assert picture[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", picture[16:24]) == (1920, 1352)
    animation = download(page, "#animation", tmp_path / "run.webm")
    assert animation[:4] == b"\x1a\x45\xdf\xa3" and b"webm" in animation[:128] and len(animation) > 10_000
    page.locator("#speed").select_option("0.1")
    page.locator("#animation").click()
    page.locator("#animation-cancel").click()
    expect(page.locator("#export-message")).to_have_text("The animation was cancelled.")


def test_lines_to_copy_make_the_same_run(open_page, command_json):
    page = open_page("f_o=0.31&nu=-0.25&body=rigid")
    page.locator("#copy-shell").click()
    expect(page.locator("#copy-shell")).to_have_text("Copied")
    line = page.evaluate("() => navigator.clipboard.readText()")
    assert line.startswith("snapload run ")
    copied = command_json(*line.split()[1:], "--ensemble", "0")
    assert (copied["case"]["f_o"], copied["case"]["nu"]) == (0.31, -0.25)
    shown_is(page, copied)
    page.locator("#copy-python").click()
    assert "snapload.Case(f_o=0.31, nu=-0.25)" in page.evaluate("() => navigator.clipboard.readText()")


def test_the_link_holds_everything(open_page):
    page = open_page()
    before = count(page)
    page.locator("#case").select_option("sliding-example")
    settled(page, before)
    before = count(page)
    page.get_by_text("Stops").click()
    page.locator("#field-t_end").fill("12")
    page.locator("#ghost").check()
    settled(page, before)
    page.get_by_text("Thesis", exact=True).click()
    page.get_by_text("Close", exact=True).first.click()
    page.locator("#speed").select_option("0.1")
    for _ in range(6):
        page.keyboard.press("ArrowRight")
    page.locator("#zoom-in").click()
    page.wait_for_timeout(300)
    page.locator("#copy-link").click()
    expect(page.locator("#copy-link")).to_have_text("Copied")
    link = page.evaluate("() => navigator.clipboard.readText()")
    other = open_page(urlsplit(link).fragment)
    for selector in ["#speed", "#field-f_o", "#field-t_end", "#ghost-size"]:
        assert other.locator(selector).input_value() == page.locator(selector).input_value(), selector
    assert exact_time(other) == exact_time(page)
    expect(other.locator("#window-words")).to_have_text(page.locator("#window-words").inner_text())
    assert drawn(other) == drawn(page)


def test_back_and_forward_go_through_the_values(open_page):
    page = open_page()
    for value in ["0.2", "0.4"]:
        before = count(page)
        page.locator("#field-f_o").fill(value)
        page.locator("#field-f_o").press("Enter")
        settled(page, before)
    page.go_back()
    expect(page.locator("#field-f_o")).to_have_value("0.2")
    page.go_forward()
    expect(page.locator("#field-f_o")).to_have_value("0.4")


def test_back_takes_the_place_of_what_is_typed_and_of_a_slider(open_page):
    page = open_page("t=0")
    field, slider = page.locator("#field-f_o"), page.locator("#slider-f_o")
    # Both keep the focus.
    field.fill("0.45")
    comes_true(page, lambda: "f_o=0.45" in page.url)
    page.go_back()
    expect(field).to_have_value("0.3")
    slider.focus()
    slider.press("ArrowRight")
    expect(field).not_to_have_value("0.3")
    stepped = field.input_value()
    comes_true(page, lambda: f"f_o={stepped}" in page.url)
    page.go_back()
    expect(field).to_have_value("0.3")
    expect(slider).to_have_value("0.3")
    slider.press("ArrowRight")
    expect(field).to_have_value(stepped)


def test_the_link_to_the_scene_leaves_the_state_alone(open_page):
    page = open_page("f_o=0.31&t=1.5")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert page.evaluate("() => document.activeElement.id") == "scene"
    assert (page.locator("#field-f_o").input_value(), exact_time(page)) == ("0.31", 1.5)


def test_a_broken_link_is_reported_and_left_out(open_page):
    page = open_page("f_o=0.31&omega=fast&foo=1&picture=sideways&t=%E0%A4%A&speed=1e400")
    expect(page.locator("#note")).to_contain_text("omega=fast, foo=1, picture=sideways")
    assert page.locator("#field-f_o").input_value() == "0.31"
    assert page.locator("#field-omega").input_value() == "0.9"
