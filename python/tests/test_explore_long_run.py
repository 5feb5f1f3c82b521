"""The long run on the page of `snapload explore`: sections, safe basins and their erosion."""

from __future__ import annotations

import re

from explore import count, settled
from playwright.sync_api import expect

VOLLEY = "body=point&r=1.7&e=0.35&f_o=1.4&nu=0.8&omega=3.1&y=0.3&t=0"


def test_a_section_is_drawn_and_a_point_of_it_is_a_start(open_page):
    page = open_page(VOLLEY)
    page.locator("#long-box summary").click()
    expect(page.locator("#section-plot")).to_be_hidden()
    page.locator("#section-run").click()
    expect(page.locator("#section-message")).to_contain_text("Repeats itself after one period", timeout=20_000)
    points = page.locator("#section-plot .point")
    expect(points.first).to_be_visible()
    assert points.count() == 401
    before = count(page)
    points.last.click(force=True)
    settled(page, before)
    # 50 digits by an independent program, rounded.
    assert page.locator("#field-x").input_value().startswith("-0.2688102191814")
    # What is shown is that of the case: another one has another section.
    expect(page.locator("#section-plot")).to_be_hidden()
    expect(page.locator("#section-message")).to_have_text("")


WINDOW = "x,-0.4,0.4,21,y,0.02,0.72,18,f_o,0,0.6,5"


def test_a_safe_basin_is_that_of_the_command_and_a_cell_a_start(open_page, command_json):
    page = open_page(f"f_o=0.29&t_end=60&t=0&basin={WINDOW}")
    page.locator("#basin-run").click()
    expect(page.locator("#basin-message")).to_contain_text("(LIM)", timeout=30_000)
    page.locator("#basin-copy").click()
    line = page.evaluate("() => navigator.clipboard.readText()")
    assert line == (
        "snapload basin --set f_o=0.29 --set t_end=60 --vary x=-0.4:0.4:21 --vary y=0.02:0.72:18 --out basin.parquet"
    )
    expected = command_json(*line.removesuffix(" --out basin.parquet").split()[1:])
    legend = page.locator("#basin-legend")
    expect(legend).to_contain_text(f"safe ({expected['safe']})")
    expect(legend).to_contain_text(f"reaches a limit ({expected['legal'] - expected['safe']})")
    expect(legend).to_contain_text(f"no legal start ({21 * 18 - expected['legal']})")
    assert expected["undecided"] > 0
    expect(legend).to_contain_text(f"undecided: some neighbours are safe, some not ({expected['undecided']})")
    low, high = expected["interval95"]
    expect(page.locator("#basin-message")).to_contain_text(f"{expected['fraction']:.4f} ({low:.4f} to {high:.4f})")
    # What is not certain, not safe and no start differs from cell to cell; the words are those of the run.
    page.locator("#basin").focus()
    for _ in range(9):
        page.keyboard.press("ArrowUp")
    for _ in range(10):
        page.keyboard.press("ArrowRight")
    words = page.locator("#basin-pointed").inner_text()
    before = count(page)
    page.keyboard.press("Enter")
    settled(page, before)
    x, y = (page.locator(f"#field-{key}").input_value() for key in ["x", "y"])
    assert words.startswith(f"x = {x}, y = {float(y):.6g}: ")
    run = command_json("run", "--ensemble", "0", *line.split()[2:6], "--set", f"x={x}", "--set", f"y={y}")
    assert run["end"]["reason"].replace("_", " ") in words
    # Along its own keys a window stays what it is; of another force it is not.
    expect(page.locator("#basin")).not_to_have_class("cells stale")
    page.locator("#field-f_o").fill("0.2")
    expect(page.locator("#basin")).to_have_class("cells stale")
    for words in ["#basin-message", "#basin-legend"]:
        expect(page.locator(words)).to_have_class(re.compile(r"\bstale\b"))


def test_a_smaller_basin_has_no_cell_of_the_one_before(open_page, command_json):
    page = open_page("t_end=20&t=0&basin=x,-0.4,0.4,9,y,0.02,0.72,9,f_o,0.1,0.6,3")
    page.locator("#basin-run").click()
    expect(page.locator("#basin-message")).to_contain_text("(LIM)", timeout=30_000)
    # The work ends a moment after its words appear; keys are pressed once it has.
    expect(page.locator("#basin-stop")).to_be_hidden()
    page.locator("#basin").focus()
    for _ in range(9):
        page.keyboard.press("ArrowUp")
        page.keyboard.press("ArrowRight")
    expect(page.locator("#basin-pointed")).to_contain_text("x = 0.4, y = 0.72: ")
    for side in ["x", "y"]:
        page.locator(f"#basin-{side}-count").fill("4")
        page.locator(f"#basin-{side}-count").press("Tab")
    page.locator("#basin-run").click()
    smaller = ["--set", "t_end=20", "--vary", "x=-0.4:0.4:4", "--vary", "y=0.02:0.72:4"]
    legal = command_json("basin", *smaller, "--no-trust")["legal"]
    expect(page.locator("#basin-message")).to_contain_text(f" of {legal} legal", timeout=30_000)
    expect(page.locator("#basin-pointed")).to_have_text("")
    page.locator("#basin").focus()
    expect(page.locator("#basin-pointed")).to_contain_text("x = \u22120.4, y = 0.02: ")


def test_keys_of_a_basin_change_places(open_page):
    page = open_page("t_end=20&t=0&basin=x,-0.4,0.4,9,y,0.02,0.72,8,f_o,0.1,0.6,3")
    page.locator("#basin-x-key").select_option("f_o")
    for side, key in {"x": "f_o", "y": "y", "over": "x"}.items():
        expect(page.locator(f"#basin-{side}-key")).to_have_value(key)
    expect(page.locator("#basin-over-count")).to_have_value("9")
    page = open_page("t_end=20&t=0&basin=x,-0.4,0.4,9,x,0.02,0.72,8,f_o,0.1,0.6,3")
    expect(page.locator("#note")).to_contain_text("Not understood in the link")


def test_the_erosion_agrees_with_that_of_the_command(open_page, command):
    page = open_page(f"t_end=60&t=0&basin={WINDOW}")
    page.locator("#erosion-run").click()
    expect(page.locator("#erosion-message")).to_contain_text("Knee at fₒ", timeout=60_000)
    page.locator("#erosion-copy").click()
    line = page.evaluate("() => navigator.clipboard.readText()")
    expected = command(*line.split()[1:]).replace("f_o", "fₒ").split()
    message = page.locator("#erosion-message").inner_text()
    assert message.split() == expected[-len(message.split()) :] and "neighbours were not run" in message
    expect(page.locator("#erosion")).to_be_visible()


def test_work_on_a_basin_can_be_stopped(open_page):
    page = open_page("t_end=200&t=0&basin=x,-0.4,0.4,200,y,0.02,0.72,200,f_o,0,0.6,200")
    page.locator("#erosion-run").click()
    page.locator("#basin-stop").click()
    expect(page.locator("#basin-progress")).to_have_text("stopped")
    expect(page.locator("#basin-stop")).to_be_hidden()
