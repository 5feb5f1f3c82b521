"""The interval of the record that the page of a structure shows, while the answer for it is on its way."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Any

import pytest
from explore import comes_true, exact_time, keep_listed
from playwright.sync_api import Page, expect

SHORT = "run.duration=60&run.transient=10&elastic=false"

HOLD = """() => {
    const ask = window.fetch;
    const end = new Promise(done => (window.goOn = done));
    window.fetch = async (path, options) => {
        if (path === "api/structure/run") await end;
        return ask(path, options);
    };
}"""


def hold(page: Page) -> None:
    """Runs are answered after `go_on` only."""
    page.evaluate(HOLD)


def go_on(page: Page) -> None:
    page.evaluate("() => window.goOn()")


def press(page: Page, *keys: str) -> None:
    page.locator("#scene").focus()
    for key in keys:
        page.keyboard.press(key)


def shown(page: Page) -> list[float]:
    """The ends of the interval that is shown, which are rounded to the millisecond."""
    scrub = page.locator("#scrub")
    return [float(scrub.get_attribute(name) or "nan") for name in ["min", "max"]]


def is_shown(page: Page, interval: list[float], t: float) -> None:
    comes_true(page, lambda: shown(page) == pytest.approx(interval, abs=1e-3))
    assert exact_time(page) == t
    # No other answer takes its place.
    page.wait_for_timeout(200)
    assert shown(page) == pytest.approx(interval, abs=1e-3)


def asked(page: Page) -> list[float]:
    """The interval of the address, which is that of the last question."""
    found = re.search(r"window=([\d.]+),([\d.]+)", page.url)
    return [float(end) for end in found.groups()] if found else []


def move(page: Page, start: float) -> None:
    """Moves the interval by its slider."""
    slider = page.locator("#interval-start")
    slider.evaluate(f"one => {{ one.value = {start}; one.dispatchEvent(new Event('input')); }}")


@pytest.mark.parametrize(("key", "t"), [("Home", 40), ("End", 50)])
def test_home_and_end_are_of_the_interval_that_was_moved_last(open_structure, key, t):
    page = open_structure(f"{SHORT}&window=20,30&t=25")
    hold(page)
    move(page, 40)
    press(page, key)
    go_on(page)
    is_shown(page, [40, 50], t)


def test_the_slider_of_the_interval_stays_where_it_is_moved_to(open_structure):
    page = open_structure(f"{SHORT}&window=20,30&t=25")
    hold(page)
    move(page, 40)
    page.wait_for_timeout(100)
    assert float(page.locator("#interval-start").input_value()) == 40
    go_on(page)
    is_shown(page, [40, 50], 40)


@pytest.mark.parametrize("keys", ["[ ArrowRight [", "ArrowRight [ ["])
def test_zooms_and_steps_count_before_their_answers(open_structure, keys):
    page = open_structure(f"{SHORT}&window=20,30&t=30")
    hold(page)
    press(page, *keys.split())
    go_on(page)
    # A quarter of ten seconds, about the first snap after 30 s.
    comes_true(page, lambda: exact_time(page) > 30)
    t = exact_time(page)
    is_shown(page, [t - 1.25, t + 1.25], t)


def test_all_of_the_record_is_shown_when_it_is_zoomed_out(open_structure):
    page = open_structure(f"{SHORT}&window=10,50&t=20")
    press(page, "]")
    is_shown(page, [0, 60], 20)


def test_an_interval_does_not_become_an_instant(open_structure):
    page = open_structure(f"{SHORT}&window=20,30&t=25")
    press(page, *["["] * 25)
    comes_true(page, lambda: shown(page)[1] - shown(page)[0] < 0.01)
    page.wait_for_timeout(300)
    start, end = shown(page)
    assert 0.001 <= end - start + 1e-9
    assert start <= exact_time(page) <= end


def steps_on(page: Page) -> None:
    """A step from the end of the interval leads to another one."""
    page.locator("#last").click()
    end = shown(page)[1]
    assert exact_time(page) == end
    press(page, "ArrowRight")
    comes_true(page, lambda: exact_time(page) > end)
    assert shown(page)[0] <= exact_time(page) <= shown(page)[1]


def test_steps_go_on_where_the_first_answer_was_refused(open_structure):
    page = open_structure("line.length=2.9&elastic=false&window=20,30&t=25", refused=1)
    expect(page.locator("#failed")).to_contain_text("The page shows the case without changes")
    is_shown(page, [20, 30], 25)
    press(page, "ArrowRight")
    comes_true(page, lambda: exact_time(page) != 25)
    assert 25 < exact_time(page) < 30
    steps_on(page)
    expect(page.locator("#failed")).to_contain_text("2.9 is not allowed")
    expect(page.locator("#coming")).to_have_text("neighbours to come")


def test_steps_go_on_where_a_change_was_refused(open_structure):
    page = open_structure("run.duration=12&run.transient=2&elastic=false&window=4,6&t=5", refused=1)
    expect(page.locator("#coming")).to_be_empty(timeout=60_000)
    field = page.locator('[id="field-line.length"]')
    field.fill("2.9")
    field.press("Enter")
    expect(page.locator("#failed")).to_contain_text("2.9 is not allowed")
    steps_on(page)
    expect(page.locator("#failed")).to_contain_text("2.9 is not allowed")


def test_a_step_can_be_repeated_once_the_program_answers(open_structure):
    page = open_structure(f"{SHORT}&window=20,30&t=30", refused=1)
    page.route("**/api/structure/run", lambda route: route.abort())
    press(page, "ArrowRight")
    expect(page.locator("#failed")).to_contain_text("the program does not answer")
    comes_true(page, lambda: asked(page) == [20, 30])
    page.unroute("**/api/structure/run")
    steps_on(page)
    expect(page.locator("#failed")).to_be_hidden()


def test_a_step_leads_to_a_snap_that_is_not_listed(open_structure):
    page = open_structure(f"{SHORT}&window=40,50&t=45")
    every: list[float] = []

    def few(route: Any) -> None:
        # Its neighbours, which would come in lines, do not come.
        if '"progress"' in route.request.post_data:
            return
        answer = route.fetch()
        json = answer.json()
        snaps = json["snaps"]
        every[:] = snaps["t"]
        # As if all others were one of too many in the interval.
        keep = sorted({0, 1, 2, 3, *snaps["hardest"]})
        keep_listed(snaps, keep)
        route.fulfill(response=answer, json=json)

    page.route("**/api/structure/run", few)
    page.locator('[id="field-run.restitution"]').fill("0.51")
    expect(page.locator("#record-words")).to_contain_text("only the hardest and those of the interval are drawn")
    after = sorted({t for t in every if t > 45})
    assert len(after) > 3
    press(page, "ArrowRight")
    comes_true(page, lambda: exact_time(page) == after[0])
    press(page, "ArrowRight", "ArrowRight")
    comes_true(page, lambda: exact_time(page) == after[2])
    for t, before in pairwise(after[2::-1]):
        assert exact_time(page) == t
        press(page, "ArrowLeft")
        comes_true(page, lambda before=before: exact_time(page) == before)
    page.unroute("**/api/structure/run")
