"""The seal on the page of `snapload explore`: what it says is what the command proves."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from explore import DESKTOP, PHONE, SMALLEST, blameless_in_light_and_dark, count, download, settled
from playwright.sync_api import expect


def prove(page) -> None:
    page.locator("#prove").click()
    expect(page.locator("#seal")).to_be_visible()


def test_the_seal_opens_what_is_proved(open_page, command, tmp_path: Path):
    page = open_page()
    expect(page.locator("#seal")).to_be_hidden()
    prove(page)
    expect(page.locator("#seal-title")).to_have_text(
        re.compile(r"^proved to the end; this run departs from the proof at impact \d+$")
    )
    expect(page.locator("#seal-words")).to_be_hidden()
    expect(page.locator("#prove")).to_be_hidden()
    page.locator("#seal summary").click()
    # 290 impacts and these digits of the end are those of `snapload verify`, which computes them by other code.
    words = page.locator("#seal-words")
    expect(words).to_contain_text("290 impacts, settled at t = 7.2463044710810")
    expect(words).to_contain_text("The run departs from the proof at impact ")
    certificate = tmp_path / "run.cert"
    download(page, "#seal-file", certificate)
    assert len(json.loads(certificate.read_text(encoding="utf-8"))["impacts"]) == 290
    command("certify", "--check", str(certificate))


def test_a_changed_case_has_no_seal(open_page):
    page = open_page()
    prove(page)
    # The ghost is no part of the case.
    before = count(page)
    page.keyboard.press("g")
    settled(page, before)
    expect(page.locator("#seal")).to_be_visible()
    before = count(page)
    page.locator("#field-f_o").fill("0.31")
    settled(page, before)
    expect(page.locator("#seal")).to_be_hidden()
    expect(page.locator("#prove")).to_have_text("Prove")
    prove(page)
    expect(page.locator("#seal-title")).to_have_text("proved to the end")
    page.locator("#seal summary").click()
    expect(page.locator("#seal-words")).to_contain_text("12 impacts, rotation limit at t = 3.45218521659812")
    expect(page.locator("#seal-words")).to_contain_text("The run agrees in five digits.")


def test_a_proof_that_ends_before_the_run_is_reported_as_such(open_page):
    page = open_page("e=0.5&omega=0&stop_when_settled=false&t_end=0.88&t=0")
    prove(page)
    expect(page.locator("#seal-title")).to_have_text("proved up to t = 0.86618")
    page.locator("#seal summary").click()
    expect(page.locator("#seal-words")).to_contain_text("21 impacts, sticks at t = 0.866175595")
    expect(page.locator("#seal-further")).to_contain_text("stop_when_settled=false --certify")


def test_a_proof_can_be_stopped(open_page):
    page = open_page()
    waits = []
    page.route("**/api/proof", lambda route: waits.append(route))
    page.locator("#prove").click()
    expect(page.locator("#prove")).to_have_text("Stop")
    expect(page.locator("#prove-message")).to_have_text("Proving …")
    page.locator("#prove").click()
    expect(page.locator("#prove")).to_have_text("Prove")
    expect(page.locator("#prove-message")).to_have_text("")
    assert len(waits) == 1
    expect(page.locator("#seal")).to_be_hidden()


def test_the_keyboard_focus_moves_to_the_seal(open_page):
    page = open_page("f_o=0.31&t=0")
    page.locator("#prove").focus()
    page.keyboard.press("Enter")
    expect(page.locator("#seal summary")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.locator("#seal-words")).to_be_visible()


@pytest.mark.parametrize("viewport", [DESKTOP, PHONE, SMALLEST], ids=["desktop", "phone", "smallest"])
def test_the_seal_is_for_everyone(open_page, viewport):
    page = open_page("f_o=0.31&t=0", viewport=viewport)
    prove(page)
    page.locator("#seal summary").click()
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth"), "it is wider than the window"
    blameless_in_light_and_dark(page)
