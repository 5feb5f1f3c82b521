"""The axes of maps and safe basins on the page of `snapload explore`, and what is drawn over them."""

from __future__ import annotations

import json
import re

from explore import comes_true, count, settled
from playwright.sync_api import Page, expect

MAP = "t=0&map=f_o,0.2,0.4,3,e,0.7,0.95,3,reason"
BASIN = "t_end=20&t=0&basin=x,-0.4,0.4,9,y,0.02,0.72,8,f_o,0,0.4,5"


def typed(page: Page, field: str, text: str) -> None:
    """A value is written into a field as by hand."""
    page.locator(field).fill(text)
    page.locator(field).press("Tab")


def test_bounds_that_are_typed_one_after_the_other_are_an_axis(open_page):
    page = open_page(MAP)
    message, low, high = (page.locator(one) for one in ["#map-message", "#map-x-low", "#map-x-high"])
    typed(page, "#map-x-low", "1")
    expect(message).to_have_text('Horizontal: "from" must be less than "to", with 2 to 200 cells')
    for field in [low, high]:
        expect(field).to_have_attribute("aria-invalid", "true")
    # Other values are no reason to take back what was typed.
    before = count(page)
    page.locator("#field-nu").fill("0.4")
    settled(page, before)
    expect(low).to_have_value("1")
    typed(page, "#map-x-high", "2")
    comes_true(page, lambda: "map=f_o,1,2,3,e" in page.evaluate("() => location.hash"))
    expect(low).to_have_value("1")
    expect(message).to_have_text("")
    assert page.locator('#map-box [aria-invalid="true"]').count() == 0


def test_an_axis_from_elsewhere_ends_what_was_wrong(open_page):
    page = open_page(MAP)
    typed(page, "#map-y-count", "1")
    expect(page.locator("#map-message")).to_have_text('Vertical: "from" must be less than "to", with 2 to 200 cells')
    expect(page.locator("#map-y-count")).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#map-y-low")).to_have_attribute("aria-invalid", "false")
    page.locator("#map-wider").click()
    expect(page.locator("#map-y-count")).to_have_value("3")
    assert page.locator('#map-box [aria-invalid="true"]').count() == 0
    expect(page.locator("#map-message")).to_have_text("")


def test_errors_are_reported_with_the_labels_of_their_fields(open_page):
    page = open_page(BASIN)
    typed(page, "#basin-over-high", "-1")
    words = 'Third key: "from" must be less than "to", with 2 to 200 values'
    expect(page.locator("#basin-pointed")).to_have_text(words)


def test_a_pale_basin_is_copied_as_it_is_shown(open_page):
    page = open_page(BASIN)
    copied = "() => navigator.clipboard.readText()"
    shown = "snapload basin --set t_end=20 --vary x=-0.4:0.4:9 --vary y=0.02:0.72:8 --out basin.parquet"
    page.locator("#basin-run").click()
    expect(page.locator("#basin-message")).to_contain_text("legal", timeout=30_000)
    page.locator("#field-f_o").fill("0.2")
    typed(page, "#basin-x-count", "5")
    expect(page.locator("#basin")).to_have_class("cells stale")
    page.locator("#basin-copy").click()
    expect(page.locator("#basin-copy")).not_to_have_text("Copy command")
    assert page.evaluate(copied) == shown
    page.locator("#basin-run").click()
    expect(page.locator("#basin")).to_have_class("cells", timeout=30_000)
    page.locator("#basin-copy").click()
    comes_true(page, lambda: "--set f_o=0.2 --vary x=-0.4:0.4:5" in page.evaluate(copied))


def eroded(page: Page) -> None:
    """Shows an erosion in which two of five values have no legal start."""
    parts = [0.4, 0.39, None, 0.2, None]
    points = [
        {"value": k / 10, "legal": 0 if part is None else 72, "fraction": part, "interval95": [0.1, 0.5]}
        for k, part in enumerate(parts)
    ]
    answer = {"words": "table\n\nKnee      at f_o = 0.1\n", "over": "f_o", "knee": 0.1, "points": points}
    line = json.dumps({"answer": json.dumps(answer)})
    page.route("**/api/basin", lambda route: route.fulfill(body=line))
    page.locator("#erosion-run").click()
    expect(page.locator("#erosion")).to_be_visible()
    page.unroute("**/api/basin")


DRAWN = """() => {
    window.drawn = { lines: [], cleared: [], rings: [] };
    const of = CanvasRenderingContext2D.prototype;
    const watch = (name, then) => {
        const real = of[name];
        of[name] = function (...at) { then(this.canvas.id, at); return real.apply(this, at); };
    };
    watch('lineTo', (id, at) => id === 'erosion' && window.drawn.lines.push(at));
    watch('clearRect', id => window.drawn.cleared.push(id));
    watch('arc', (id, at) => window.drawn.rings.push([id, ...at]));
}"""


def test_an_erosion_has_a_text_and_gaps_without_legal_starts(open_page):
    page = open_page(BASIN)
    page.evaluate(DRAWN)
    eroded(page)
    expect(page.locator("#erosion-message")).to_have_text("Knee at fₒ = 0.1")
    expect(page.locator("#erosion")).to_have_attribute(
        "aria-label",
        "The safe part over f_o: 0: 0.4, 0.1: 0.39, 0.2: no legal start, 0.3: 0.2, 0.4: no legal start",
    )
    pieces = page.evaluate(
        """async () => {
            const { drawErosion } = await import('./erosion.js');
            const point = (value, legal) => ({ value, legal, fraction: legal ? 0.5 : null, interval95: [0.5, 0.5] });
            const tell = points => {
                window.drawn.lines = [];
                drawErosion(document.getElementById('erosion'), { points, knee: null, over: 'x' }, {}, 'x');
                return window.drawn.lines.length;
            };
            return [tell([0, 1, 2].map(k => point(k, 9))), tell([0, 1, 2].map(k => point(k, k === 1 ? 0 : 9)))];
        }"""
    )
    # A value without legal starts has neither an interval nor a line through it.
    assert pieces[1] == pieces[0] - 2, pieces


def test_a_pointer_repaints_no_more_than_has_changed(open_page):
    page = open_page(BASIN)
    page.locator("#basin-run").click()
    expect(page.locator("#basin-message")).to_contain_text("legal", timeout=30_000)
    eroded(page)
    page.locator("#basin").scroll_into_view_if_needed()
    box = page.locator("#basin").bounding_box()
    x, y = box["x"] + 56 + (box["width"] - 68) / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    expect(page.locator("#basin-pointed")).to_contain_text("x = 0, ")
    page.wait_for_timeout(200)
    page.evaluate(DRAWN)
    cleared = lambda: page.evaluate("() => window.drawn.cleared.splice(0)")  # noqa: E731
    for k in range(5):
        page.mouse.move(x + k % 2, y)
        page.wait_for_timeout(30)
    assert "basin" not in cleared(), "it is the same cell"
    page.mouse.move(x + box["width"] / 4, y)
    page.wait_for_timeout(100)
    cleared_parts = cleared()
    assert "basin" in cleared_parts and "erosion" not in cleared_parts, cleared_parts
    page.locator("#theme").click()
    page.wait_for_timeout(200)
    assert {"basin", "erosion"} <= set(cleared())


def test_the_run_is_marked_where_its_own_values_are(open_page):
    page = open_page("a=0.2&t_end=20&t=0&basin=inertia,0.001,0.1,5,y,0.02,0.72,8,f_o,0,0.4,5")
    page.evaluate(DRAWN)
    page.locator("#basin-run").click()
    expect(page.locator("#basin-message")).to_contain_text("legal", timeout=30_000)
    rings = "() => window.drawn.rings.filter(([id]) => id === 'basin').map(([, x]) => x)"
    comes_true(page, lambda: page.evaluate(rings) != [])
    box = page.locator("#basin").bounding_box()
    half = 0.5 * 0.099 / 4
    place = lambda value: 56 + (value - 0.001 + half) / (0.099 + 2 * half) * (box["width"] - 68)  # noqa: E731
    # The inertia is not given: it follows from the body, which is twice as large as usual, and from its mass.
    assert all(abs(x - place(0.04)) < 1 for x in page.evaluate(rings)), page.evaluate(rings)
    page.evaluate("() => (window.drawn.rings = [])")
    page.locator("#field-a").fill("0.25")
    comes_true(page, lambda: any(abs(x - place(0.0625)) < 1 for x in page.evaluate(rings)))


def test_an_axis_is_one_row_of_the_panel(open_page):
    page = open_page("t=0&map=f_o,0.2,0.4,3,e,0.7,0.95,3,reason&basin=x,-0.35,0.4,200,y,0.02,0.72,36,f_o,0.025,0.6,20")
    for axis in page.locator("fieldset.axis").all():
        fields = axis.locator("input").evaluate_all(
            "all => all.map(one => [one.id, one.getBoundingClientRect().top, one.scrollWidth - one.clientWidth])"
        )
        assert len({top for _, top, _ in fields}) == 1 and len(fields) == 3, fields
        assert all(cut <= 0 for _, _, cut in fields), fields


def test_zeros_of_a_logarithmic_map_have_a_colour_of_their_own(open_page):
    page = open_page("t=0&map=f_o,0,1,21,e,0,0.95,11,t_sliding")
    legend = page.locator("#map-legend")
    expect(page.locator("#map-progress")).to_have_text("231 runs", timeout=60_000)
    expect(legend).to_contain_text("logarithmic")
    expect(legend).to_contain_text(re.compile(r"0 \(\d+\)"))
    page.locator("#map").hover()
    page.locator("#map-colour").select_option("horizon_t")
    expect(page.locator("#map-message")).not_to_contain_text("taut cable")
