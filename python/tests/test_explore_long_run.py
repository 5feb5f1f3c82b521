"""The long run on the page of `snapload explore`: sections, and the safe part of the map's window."""

from __future__ import annotations

from explore import count, settled
from playwright.sync_api import expect

VOLLEY = "body=point&r=1.7&e=0.35&f_o=1.4&nu=0.8&omega=3.1&y=0.3&t=0"


def test_a_section_is_drawn_and_a_point_of_it_is_a_start(open_page):
    page = open_page(VOLLEY)
    page.locator("#long-box summary").click()
    expect(page.locator("#section-plot")).to_be_hidden()
    page.locator("#section-run").click()
    expect(page.locator("#section-said")).to_contain_text("Repeats itself after one period", timeout=20_000)
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
    expect(page.locator("#section-said")).to_have_text("")


def test_the_safe_part_of_the_window_of_the_map_is_told(open_page):
    page = open_page("f_o=0.3&t_end=60&t=0")
    page.locator("#long-box summary").click()
    page.locator("#map-box summary").click()
    for axis, key, low, high in [("x", "x", "-0.4", "0.4"), ("y", "y", "0.02", "0.72")]:
        page.locator(f"#map-{axis}-key").select_option(key)
        for end, value in [("low", low), ("high", high), ("count", "21")]:
            page.locator(f"#map-{axis}-{end}").fill(value)
            page.locator(f"#map-{axis}-{end}").press("Enter")
    page.locator("#basin-run").click()
    said = page.locator("#basin-said")
    expect(said).to_contain_text("legal cells", timeout=20_000)
    expect(said).to_contain_text("(LIM)")
