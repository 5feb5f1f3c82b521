"""What keeps the page of `snapload explore` usable by keyboard, by ear, and at every scale."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

from explore import PHONE, blameless, download, times
from playwright.sync_api import Page, expect

SHORT = "run.duration=60&run.transient=10&elastic=false"


def focused(page: Page) -> str:
    """The id of the element with the focus, or its time if it leads to an instant."""
    return page.evaluate("() => document.activeElement.id || document.activeElement.dataset.t || 'none'")


def waves(page: Page, values: tuple[float, ...] = (0.4, 0.7, 0.9)) -> None:
    """Other waves in a table with cells of these values, whose answer is not computed."""
    cells = [{"value": value, "kind": "known"} for value in values * 10]
    answer = {"periods_s": [4 + k / 3 for k in range(10)], "heights_m": [1.5, 2, 2.5], "cells": cells}
    answer = {**answer, "utilisation": True, "length": 60}
    page.route("**/api/structure/waves", lambda route: route.fulfill(json=answer))
    page.locator("#waves-run").focus()
    page.keyboard.press("Enter")
    expect(page.locator("#waves td")).to_have_count(30)


def test_the_focus_stays_where_something_was_begun(open_structure):
    page = open_structure(f"{SHORT}&window=20,30&t=25")
    waves(page)
    assert focused(page) == "waves-run"
    for name in ["case.toml", "assess.json"]:
        page.locator(f'[data-file="{name}"]').focus()
        with page.expect_download():
            page.keyboard.press("Enter")
        expect(page.locator("#export-message")).to_have_text(re.compile("is saved"))
        assert page.evaluate("() => document.activeElement.dataset.file") == name
    # A row leads to its time and moves the interval, and the table is filled again.
    words = page.locator("#window-words")
    t = next(str(t) for t in times(page) if not 20 <= t <= 30)
    before = words.inner_text()
    page.locator(f'#events-body .go[data-t="{t}"]').focus()
    page.keyboard.press("Enter")
    expect(words).not_to_have_text(before)
    assert focused(page) == t


def test_other_waves_are_readable_and_say_when_they_are_of_earlier_values(open_structure):
    page = open_structure(f"{SHORT}&t=0", viewport={"width": 1800, "height": 950}, color_scheme="dark")
    waves(page)
    blameless(page)
    message = page.locator("#waves-message")
    expect(message).to_contain_text("amber: half of the breaking load or more")
    box = page.locator(".waves-scroll")
    assert box.evaluate("one => one.scrollWidth <= one.clientWidth")
    expect(message).not_to_contain_text("scrolled")
    expect(page.locator("#waves-stale")).to_be_hidden()
    page.locator('[id="field-run.restitution"]').fill("0.51")
    expect(page.locator("#waves-stale")).to_contain_text("The table is of earlier values")
    page.set_viewport_size({"width": 1300, "height": 950})
    waves(page, (8, 6.83, 9.75))
    assert box.evaluate("one => one.scrollWidth <= one.clientWidth")
    expect(message).not_to_contain_text("scrolled")
    page.set_viewport_size({"width": 320, "height": 568})
    waves(page, (8, 6.83, 9.75))
    expect(message).to_contain_text("can be scrolled sideways")
    assert box.evaluate("one => one.scrollWidth > one.clientWidth")


def test_a_chart_keeps_its_unit_where_its_name_is_cut_off(open_structure):
    page = open_structure(f"{SHORT}&t=25", viewport={"width": 1300, "height": 950})
    for name in page.locator("#charts .chart-name").all():
        cut_off = "one => one.querySelector('.unit').getBoundingClientRect().right - one.getBoundingClientRect().right"
        assert name.evaluate(cut_off) <= 0


NEEDS = """select => {
    const clone = select.cloneNode(false);
    clone.append(new Option(select.selectedOptions[0].text));
    Object.assign(clone.style, { width: "auto", maxWidth: "none" });
    select.after(clone);
    const width = clone.offsetWidth;
    clone.remove();
    return width;
}"""


def test_the_speed_is_readable_on_a_phone(open_structure):
    page = open_structure(f"{SHORT}&t=25", viewport=PHONE)
    speed = page.locator("#speed")
    assert speed.evaluate("one => one.offsetWidth") >= speed.evaluate(NEEDS)


def test_a_field_of_all_lines_says_that_they_differ(open_structure):
    page = open_structure(f"{SHORT}&line.2.diameter=0.04&t=25")
    field = page.locator('[id="field-line.diameter"]')
    expect(field).to_have_value("")
    expect(field).to_have_attribute("placeholder", "they differ")
    expect(page.locator('[id="field-line.length"]')).to_have_value("6")


def test_the_dot_of_a_velocity_is_above_its_letter(open_page):
    page = open_page("t=0")
    heights = page.locator('label[for="field-vtheta"] .symbol i').evaluate(
        """one => {
            const context = document.createElement("canvas").getContext("2d");
            const { fontStyle, fontFamily } = getComputedStyle(one);
            context.font = `${fontStyle} 100px ${fontFamily}`;
            return [one.textContent, "θ"].map(text => context.measureText(text).actualBoundingBoxAscent);
        }"""
    )
    assert heights[0] > 1.1 * heights[1]


def test_fields_of_all_lines_and_of_one_have_different_names(open_structure):
    page = open_structure(f"{SHORT}&t=0")
    page.locator("#controls details").evaluate_all("all => all.forEach(one => (one.open = true))")
    names = page.locator('[id^="field-line."]').evaluate_all("all => all.map(one => one.labels[0].textContent)")
    assert len(names) > 8
    assert len(set(names)) == len(names)
    assert sum("all lines" in name for name in names) > 0
    assert sum("line 2 alone" in name for name in names) > 0


def test_labels_and_scale_are_readable_at_every_scale(open_page, tmp_path: Path):
    for values in ["r=1000", "r=120&a=50&b=50", "r=1.5"]:
        page = open_page(f"{values}&t=0")
        drawn = download(page, "#scene-svg", tmp_path / "scene.svg").decode()
        # The scale's line, its two ends, and its length.
        scale = re.search(r'd="M([\d.]+) ([\d.]+)L([\d.]+) \2"(?:[^<]*<path[^<]*){2}[^<]*<text[^>]*>([\d.]+) L<', drawn)
        assert scale
        assert 80 < float(scale[3]) - float(scale[1]) < 240
        assert float(scale[4]) > 0
        names = re.findall(r'<text x="([\d.]+)"[^>]*text-anchor="(\w+)"[^>]*>(cable \d|sea floor)<', drawn)
        # No name is wider than 55 pixels.
        before = {"start": 0.0, "middle": 0.5, "end": 1.0}
        begins = sorted(float(x) - 55 * before[anchor] for x, anchor, _ in names)
        assert len(begins) == 3
        assert all(right - left >= 55 for left, right in pairwise(begins))


def test_what_a_point_mass_does_not_have_takes_no_room(open_page):
    page = open_page("body=point&a=0&b=0&t=0")
    field = page.locator("#field-inertia")
    expect(field).to_be_disabled()
    expect(field).to_have_attribute("placeholder", "")
    expect(open_page("t=0").locator("#field-theta")).to_be_enabled()
