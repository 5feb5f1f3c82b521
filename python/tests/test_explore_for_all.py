"""The page of `snapload explore` is for everyone: in any window, light or dark, read aloud, without motion."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from explore import (
    DESKTOP,
    PHONE,
    SIDEWAYS,
    SMALLER,
    SMALLEST,
    blameless,
    blameless_in_light_and_dark,
    comes_true,
    count,
    download,
    drawn,
    exact_time,
    settled,
)
from playwright.sync_api import Page, expect


@pytest.mark.parametrize("viewport", [DESKTOP, SMALLER, PHONE], ids=["desktop", "smaller", "phone"])
def test_it_is_for_everyone(open_page, viewport):
    page = open_page(
        "f_o=0.27&stop_when_settled=false&t=8.7&t_end=12&map=f_o,0,1,5,e,0.5,1,4,reason",
        viewport=viewport,
    )
    expect(page.locator("#map-progress")).to_have_text("20 runs")
    page.locator("details.group").evaluate_all("groups => groups.forEach(group => (group.open = true))")
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth"), "it is wider than the window"
    blameless_in_light_and_dark(page)


@pytest.mark.parametrize("viewport", [SMALLEST, SIDEWAYS], ids=["smallest", "sideways"])
def test_it_fits_in_a_small_window(open_page, viewport):
    page = open_page("t=0", viewport=viewport)
    before = count(page)
    page.locator("#case").select_option("1920001000-359")
    settled(page, before)
    page.locator("details.group").evaluate_all("groups => groups.forEach(group => (group.open = true))")
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth"), "it is wider than the window"
    assert page.locator("#case").bounding_box()["width"] > 200, "the case can not be read"


@pytest.mark.parametrize("height", [150, 40])
def test_a_low_window_breaks_nothing(open_page, code, height):
    open_page("t=0", viewport={"width": 900, "height": height}).screenshot(full_page=True)
    lines = code.evaluate(
        """async height => {
            const { Run } = await import('./run.js');
            const { sceneShapes } = await import('./scene.js');
            const body = JSON.stringify({ values: {}, ghost: null, samples: 100 });
            const headers = { 'Content-Type': 'application/json' };
            const run = new Run(await (await fetch('api/run', { method: 'POST', headers, body })).json());
            const colours = new Proxy({}, { get: () => 'rgb(0 0 0)' });
            const options = { width: 900, height, picture: 'real', view: 'whole', colours, speed: 1 };
            return sceneShapes(run, 1, options).filter(shape => shape.circle).map(shape => shape.circle[2]);
        }""",
        height,
    )
    assert len(lines) > 3 and min(lines) > 0


def test_a_hidden_canvas_breaks_nothing(open_page):
    page = open_page("t=3")
    page.add_style_tag(content="#trajectory, #charts { display: none }")
    page.wait_for_function("() => document.querySelector('#trajectory canvas').clientWidth === 0")
    page.keyboard.press("End")
    settled(page)


def test_the_shortcuts_are_listed_and_can_be_turned_off(open_page):
    page = open_page()
    page.keyboard.press("?")
    expect(page.locator("#help-dialog")).to_be_visible()
    assert "next event" in page.locator("#help-keys").inner_text()
    blameless(page)
    page.locator("#single-keys").uncheck()
    page.keyboard.press("Escape")
    page.keyboard.press("v")
    expect(page.get_by_label("Real")).to_be_checked()
    page.keyboard.press("ArrowRight")
    assert exact_time(page) > 0


@pytest.mark.parametrize("floor", ["Infinity", "0"])
def test_a_slack_line_is_as_long_as_its_cable(code, floor):
    lines = code.evaluate(
        """async floor => {
            const { slackLine } = await import('./slack-line.js');
            const ends = [[1, -1.2], [1.49, -0.05], [0.2, -1.3], [0, -1.1], [-0.7, -1.0], [0.9, -0.0001]];
            return ends.map(end => ({ end, points: slackLine([0, 0], end, 1.6, Number(floor)) }));
        }""",
        floor,
    )
    for line in lines:
        points = line["points"]
        assert points[0] == [0, 0] and points[-1] == pytest.approx(line["end"], abs=1e-9)
        # Forty chords of a curve are a little shorter than the curve, never longer.
        assert 1.6 * (1 - 2e-3) < sum(map(math.dist, points, points[1:])) <= 1.6 * (1 + 1e-9), line["end"]
        assert max(y for _, y in points) <= (1e-9 if floor == "0" else 1), "it hangs through the floor"


ROUNDING_PX = 1e-9


def test_a_line_of_many_points_is_drawn_in_few_that_look_the_same(code):
    pieces = code.evaluate(
        """async () => {
            const { SimplifiedLine, SEEN_PX } = await import('./simplified-line.js');
            const wave = i => [i / 3, 60 * Math.sin(i / 25) * Math.cos(i / 190)];
            const turns = i => [50 * Math.cos(i * i / 9e4), 80 * Math.sin(i / 40)];
            const jagged = i => [i / 2, i % 2 ? 5 : -5];
            const back = i => [Math.abs(50 - i), 0.01 * i];
            return [wave, turns, jagged, back].map(curve => {
                const points = Array.from({ length: 1200 }, (_, i) => curve(i));
                const drawn = [];
                const add = (x, y) => drawn.push([x, y]);
                const line = new SimplifiedLine({ moveTo: add, lineTo: add });
                points.forEach(([x, y], i) => (i ? line.lineTo(x, y) : line.moveTo(x, y)));
                line.finish();
                const apart = ([x, y], [ax, ay], [bx, by]) => {
                    const [dx, dy] = [bx - ax, by - ay];
                    const square = dx * dx + dy * dy || 1;
                    const u = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / square, 0), 1);
                    return Math.hypot(x - ax - u * dx, y - ay - u * dy);
                };
                // Each point that is left out is near the piece that was drawn in its place.
                const same = (one, other) => one[0] === other[0] && one[1] === other[1];
                const kept = drawn.map(point => points.findIndex(other => same(point, other)));
                let [most, piece] = [0, 0];
                points.forEach((point, i) => {
                    while (piece < kept.length - 2 && kept[piece + 1] <= i) piece += 1;
                    most = Math.max(most, apart(point, drawn[piece], drawn[piece + 1]));
                });
                const ends = kept[0] === 0 && kept.at(-1) === points.length - 1;
                return { count: drawn.length, most, ends, seen: SEEN_PX };
            });
        }"""
    )
    assert all(line["ends"] and line["most"] <= line["seen"] + ROUNDING_PX for line in pieces), pieces
    counts = [line["count"] for line in pieces]
    assert counts[0] < 400 and counts[2] == 1200 and counts[3] < 60, counts


def test_between_rows_the_motion_is_the_engines(code, command_json):
    exact = command_json("run", "--ensemble", "0", "--sample", "0.0317")["motion"]
    drawn = code.evaluate(
        """async times => {
            const { Motion } = await import('./run.js');
            const body = JSON.stringify({ values: {}, ghost: null, samples: 1200 });
            const headers = { 'Content-Type': 'application/json' };
            const answer = await fetch('api/run', { method: 'POST', headers, body });
            const motion = new Motion((await answer.json()).motion);
            return times.map(t => motion.at(t));
        }""",
        [row["t"] for row in exact],
    )
    for row, moment in zip(exact, drawn, strict=True):
        for name in ["x", "y", "theta", "vx", "vy", "vtheta"]:
            assert moment[name] == pytest.approx(row[name], abs=1e-8), (name, row["t"])


def test_the_theme_can_be_chosen(open_page):
    page = open_page()
    paper = "() => getComputedStyle(document.documentElement).backgroundColor"
    light = page.evaluate(paper)
    for _ in range(2):
        page.locator("#theme").click()
    assert page.locator("#theme").inner_text() == "Theme: dark" and page.evaluate(paper) != light


def without_dates(pdf: bytes) -> bytes:
    return re.sub(rb"\(D:[^)]*\)", b"", pdf)


def test_on_paper_it_is_light(open_page):
    page = open_page("t=3&map=f_o,0,1,5,e,0.5,1,4,reason")
    expect(page.locator("#map-progress")).to_have_text("20 runs")
    on_screen, on_paper = drawn(page), without_dates(page.pdf())
    page.emulate_media(color_scheme="dark")
    in_the_dark = drawn(page)
    assert in_the_dark != on_screen
    assert without_dates(page.pdf()) == on_paper
    assert drawn(page) == in_the_dark, "the screen keeps its colours"


def test_the_focus_is_never_lost(open_page):
    page = open_page("t=0")
    focused = "() => document.activeElement.id || document.activeElement.className"
    # The last page disables the button: the focus goes to its neighbour.
    while page.locator("#events-next").is_enabled():
        page.locator("#events-next").press("Enter")
    assert page.evaluate(focused) == "events-previous"
    for value in ("0.2", "0.25"):
        before = count(page)
        page.locator("#pin").click()
        page.locator("#field-f_o").fill(value)
        settled(page, before)
    for left, place in [(1, "unpin"), (0, "pin")]:
        page.locator("#pins .unpin").first.focus()
        page.keyboard.press("Enter")
        expect(page.locator("#pins li")).to_have_count(left)
        assert page.evaluate(focused) == place
    page.locator("#purpose-close").focus()
    page.keyboard.press("Enter")
    assert page.evaluate(focused) == "scene"


@pytest.mark.parametrize("viewport", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_a_rule_that_stops_a_run_has_its_condition(open_page, viewport):
    page = open_page("t=0", viewport=viewport)
    page.locator("details.group").evaluate_all("groups => groups.forEach(group => (group.open = true))")
    for name, condition in [("settled", "below y = 0.05"), ("sliding", "at y = 0.05 or above")]:
        words = page.locator(f"#meaning-stop_when_{name}")
        expect(words).to_contain_text(condition)
        assert words.bounding_box()["width"] > 100, "one word is on each line"


def test_those_who_want_no_motion_get_none(open_page):
    at_a_snap = "t=0.4721795499019612"
    moving, still = open_page(at_a_snap), open_page(at_a_snap, reduced_motion="reduce")
    assert drawn(moving)[0] != drawn(still)[0], "the flash is left out"
    assert drawn(moving)[2:] == drawn(still)[2:]
    assert exact_time(still) == 0.4721795499019612


def test_the_legend_lists_what_occurs(open_page):
    standard, sliding = open_page("f_o=0.3&t=0"), open_page("f_o=0.27&stop_when_settled=false&t=0")
    cables = {"× snap of cable 1", "○ snap of cable 2", "cable 1 taut here", "cable 2 taut here", "the same at θ = 0"}
    assert legend(standard) == cables | {"past the horizon"}, "it never slides nor rocks"
    assert legend(sliding) == cables | {"slack", "sliding", "rocking", "past the horizon"}
    expect(standard.locator("#ramp-key")).to_be_hidden()
    expect(sliding.locator("#ramp-words")).to_have_text(re.compile(r"^tension, up to about [\d.]+ F$"))
    colour = "of => getComputedStyle(document.querySelector(`.legend [data-of=${of}]`), '::before').borderTopColor"
    lines = {of: sliding.evaluate(colour, of) for of in ["taut-1", "taut-2", "slack", "sliding", "rocking"]}
    assert lines["sliding"] == lines["rocking"] and len(set(lines.values())) == 4, "a colour means one thing"
    for cable in [1, 2]:
        stroke = f"() => getComputedStyle(document.querySelector('.boundary.b{cable}')).stroke"
        assert sliding.evaluate(stroke) == lines[f"taut-{cable}"]


def legend(page: Page) -> set[str]:
    return set(page.locator(".legend [data-of]:visible").all_inner_texts())


SNAP_RED = "rgb(161, 18, 31)"


def test_a_still_picture_shows_a_snap_only_at_its_instant(open_page, command_json, tmp_path: Path):
    first = command_json("run", "--ensemble", "0")["impacts"][0]
    page = open_page(f"t={first['t']}")
    expect(page.locator("#caption")).to_have_text(f"snap of cable {first['cable']}; slack")
    assert SNAP_RED in download(page, "#scene-svg", tmp_path / "scene.svg").decode("utf-8")
    # So soon after it that the flash would not have faded if it were played.
    after = open_page(f"t={first['t'] + 0.001}")
    expect(after.locator("#caption")).to_have_text("slack")
    assert SNAP_RED not in download(after, "#scene-svg", tmp_path / "scene.svg").decode("utf-8")
    # Nor does a picture that is paused keep what was fading while it played.
    page.locator("#speed").select_option("0.01")
    page.locator("#play").click()
    comes_true(page, lambda: exact_time(page) > first["t"])
    page.locator("#play").click()
    assert SNAP_RED not in download(page, "#scene-svg", tmp_path / "scene.svg").decode("utf-8")
    assert drawn(page)[0] == drawn(open_page(f"t={exact_time(page)}&speed=0.01"))[0]


def test_a_screen_reader_gets_the_outcome(open_page):
    page = open_page("f_o=0.27&stop_when_settled=false&t=30")
    words = page.locator("#scene").get_attribute("aria-label")
    assert "rocking: cable 1 taut, tension" in words and "t = 30.000" in words
    assert "of 100.000 T, rocking" in page.locator("#scrub").get_attribute("aria-valuetext")
    for chart in page.locator("canvas.base").all():
        assert len(chart.get_attribute("aria-label")) > 40
    unnamed = page.evaluate("""() => [...document.querySelectorAll('input, select, button')]
        .filter(one => !one.labels?.length && !one.ariaLabel && !one.textContent.trim()).map(one => one.id)""")
    assert unnamed == []
