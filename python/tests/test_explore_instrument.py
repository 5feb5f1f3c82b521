"""The page of `snapload explore` as an instrument: handles, runs compared, the map, animations, case files."""

from __future__ import annotations

import base64
import csv
import io
import re
from pathlib import Path

import numpy as np
import pytest
from explore import comes_true, count, download, drawn, exact_time, read, settled, shown_is
from PIL import Image
from playwright.sync_api import Page, expect


def place(page: Page, what: str) -> tuple[float, float]:
    """Where something of the scene is on the page."""
    box = page.locator("#scene").bounding_box()
    found = page.evaluate(
        """async ([what, width, height]) => {
            const { Run } = await import('./run.js');
            const { camera, turned } = await import('./scene.js');
            const values = Object.fromEntries(location.hash.slice(1).split('&').map(one => one.split('='))
                .filter(([name]) => ['f_o', 'nu', 'x', 'y'].includes(name))
                .map(([name, value]) => [name, Number(value)]));
            const headers = { 'Content-Type': 'application/json' };
            const body = JSON.stringify({ values, samples: 1200 });
            const run = new Run(await (await fetch('api/run', { method: 'POST', headers, body })).json());
            const cam = camera(run, { width, height, picture: 'real', view: 'whole', zoom: null });
            const moment = run.at(0);
            return {
                body: cam.place([moment.x, moment.y]),
                fairlead: cam.place(turned(run.geometry.cables[0].arm, moment)),
                anchor: cam.place(run.geometry.cables[0].anchor),
                scale: [cam.scale, cam.up],
            }[what];
        }""",
        [what, box["width"], box["height"]],
    )
    return (found[0], found[1]) if what == "scale" else (box["x"] + found[0], box["y"] + found[1])


def drag(page: Page, start: tuple[float, float], by: tuple[float, float]) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(start[0] + by[0], start[1] + by[1], steps=6)
    page.mouse.up()


def test_the_body_is_pulled_and_let_go(open_page, command_json):
    page = open_page("t=0")
    scale, up = place(page, "scale")
    drag(page, place(page, "body"), (-50, 40))
    comes_true(page, lambda: page.locator("#field-x").input_value() != "0")
    x, y = (float(page.locator(f"#field-{key}").input_value()) for key in ["x", "y"])
    assert (x, y) == pytest.approx((-50 / scale, 0.1 + up * 40 / scale), abs=2e-3)
    comes_true(page, lambda: exact_time(page) > 0)
    shown_is(page, command_json("run", "--ensemble", "0", "--set", f"x={x}", "--set", f"y={y}"))


def test_the_body_is_pulled_no_further_than_its_cables_reach(open_page):
    page = open_page("t=0")
    drag(page, place(page, "body"), (250, -160))
    comes_true(page, lambda: page.locator("#field-x").input_value() != "0")
    comes_true(page, lambda: exact_time(page) > 0)
    expect(page.locator("#failed")).to_be_hidden()


@pytest.mark.parametrize(("what", "by", "key"), [("fairlead", (20, 0), "a"), ("anchor", (0, 40), "r")])
def test_the_mooring_is_pulled(open_page, what, by, key):
    page = open_page("t=0")
    before = float(page.locator(f"#field-{key}").input_value())
    drag(page, place(page, what), by)
    comes_true(page, lambda: float(page.locator(f"#field-{key}").input_value()) > before)
    expect(page.locator("#failed")).to_be_hidden()


def test_the_wheel_zooms_about_the_pointer(open_page):
    page = open_page("t=0")
    whole = drawn(page)[0]
    page.mouse.move(*place(page, "body"))
    page.keyboard.down("Control")
    page.mouse.wheel(0, -500)
    page.keyboard.up("Control")
    comes_true(page, lambda: "zoom=" in page.evaluate("() => location.hash"))
    linked = open_page(page.evaluate("() => location.hash").removeprefix("#"))
    assert drawn(linked)[0] == drawn(page)[0] != whole
    page.locator("#scene").dblclick(position={"x": 20, "y": 20})
    comes_true(page, lambda: drawn(page)[0] == whole)


def test_a_pinned_run_is_compared_in_words(open_page, command_json):
    page = open_page("t=1")
    page.keyboard.press("p")
    expect(page.locator("#pins li")).to_contain_text("the run that is shown")
    before = count(page)
    page.locator("#field-f_o").fill("0.31")
    settled(page, before)
    pinned = command_json("run", "--ensemble", "0")
    line = page.locator("#pins li")
    expect(line).to_contain_text("f_o = 0.3: settled at t = 7.246")
    assert read(line.inner_text().split("hardest snap ")[1]) == pytest.approx(pinned["norms"]["rho1"], rel=1e-3)
    comes_true(page, lambda: "pin=" in page.evaluate("() => location.hash"))
    linked = open_page(page.evaluate("() => location.hash").removeprefix("#"))
    expect(linked.locator("#pins li")).to_have_text(line.inner_text())
    assert drawn(linked) == drawn(page)
    page.locator("#pins .back").click()
    expect(page.locator("#field-f_o")).to_have_value("0.3")
    page.locator("#pins .unpin").click()
    expect(page.locator("#pins li")).to_have_count(0)


def test_a_case_file_is_opened(open_page, command_json, tmp_path: Path):
    page = open_page("t=0")
    case = tmp_path / "mine.toml"
    case.write_text("f_o = 0.42\nr = 1.7\n", encoding="utf-8")
    before = count(page)
    page.locator("#open-case").set_input_files(case)
    settled(page, before)
    shown_is(page, command_json("run", str(case), "--ensemble", "0"))
    case.write_text("f_o = 0.42\nrr = 1.7\n", encoding="utf-8")
    wrong = open_page("t=0", refused=1)
    wrong.locator("#open-case").set_input_files(case)
    expect(wrong.locator("#note")).to_contain_text("mine.toml, line 2")
    expect(wrong.locator("#note")).to_contain_text("rr")


def test_what_is_on_the_axes_is_chosen(open_page):
    page = open_page("t=2")
    path = drawn(page)[2]
    pictures = {path}
    for plane in ["x", "y", "theta", "section"]:
        page.locator("#axes").select_option(plane)
        pictures.add(drawn(page)[2])
    assert len(pictures) == 5
    comes_true(page, lambda: "plane=section" in page.evaluate("() => location.hash"))
    page.locator("#axes").select_option("theta")
    expect(page.locator("#trajectory .reading")).to_contain_text("vtheta")


def test_the_ends_of_a_slider_can_be_typed(open_page):
    page = open_page("t=0")
    row = page.locator(".key", has=page.locator("#field-f_o"))
    row.locator(".end.high").fill("3")
    row.locator(".end.high").press("Enter")
    assert page.locator("#slider-f_o").get_attribute("max") == "3"
    assert page.locator("#slider-f_o").input_value() == "0.3"
    row.locator(".end.low").fill("9")
    row.locator(".end.low").press("Enter")
    assert row.locator(".end.low").input_value() == "0", "no range"


def test_cases_are_called_by_what_happens(open_page, command_json):
    names = open_page("t=0").locator("#case option").all_inner_texts()
    snaps = len(command_json("run", "--case", "1910001000-359", "--ensemble", "0")["impacts"])
    assert any(re.match(rf"1910001000-359: settles after (about )?{snaps} snaps \(", name) for name in names), names


def test_the_line_of_purpose_is_closed_for_good(open_page):
    page = open_page("t=0")
    expect(page.locator("#purpose")).to_contain_text("go slack and snap taut")
    page.locator("#purpose-close").click()
    page.reload()
    expect(page.locator("#purpose")).to_be_hidden()


def test_it_moves_at_once_unless_that_is_not_wanted(open_page):
    moving = open_page(reduced_motion="no-preference")
    comes_true(moving, lambda: exact_time(moving) > 0.2)
    still = open_page(reduced_motion="reduce")
    still.wait_for_timeout(300)
    assert exact_time(still) == 0


def test_an_animation_lasts_as_long_as_it_is_played_and_can_be_sought(open_page, tmp_path: Path):
    page = open_page("t=0&speed=5")
    animation = download(page, "#animation", tmp_path / "run.webm")
    player = page.context.new_page()
    player.goto("about:blank")
    video = player.evaluate(
        """async data => {
            const bytes = Uint8Array.from(atob(data), c => c.charCodeAt(0));
            const video = document.createElement('video');
            video.muted = true;
            video.src = URL.createObjectURL(new Blob([bytes], { type: 'video/webm' }));
            await new Promise((done, failed) => { video.onloadedmetadata = done; video.onerror = failed; });
            const sought = [];
            for (const t of [1.2, 0.3]) {
                video.currentTime = t;
                await new Promise(done => video.onseeked = done);
                sought.push(video.currentTime);
            }
            return { duration: video.duration, width: video.videoWidth, sought };
        }""",
        base64.b64encode(animation).decode(),
    )
    # 7.2463 T at 5 T/s, thirty pictures a second, and the end is shown for 0.7 s.
    assert video["duration"] == pytest.approx(round(30 * 7.2463 / 5) / 30 + 0.7, abs=0.05)
    assert video["width"] == 960 and video["sought"] == [1.2, 0.3]


MAP = "f_o,0.2,0.4,11,e,0.7,0.95,6"


def test_the_map_is_next_to_the_scene_and_marks_what_is_certain(open_page, command_json):
    page = open_page(f"t=0&map={MAP},reason")
    expect(page.locator("#map-progress")).to_have_text("66 runs", timeout=60_000)
    boxes = [page.locator(one).bounding_box() for one in ["#scene", "#map"]]
    assert all(box["y"] + 200 < 900 for box in boxes) and boxes[0]["x"] + boxes[0]["width"] < boxes[1]["x"]
    page.locator("#map").focus()
    message, certainties = page.locator("#map-message"), set()
    for _ in range(11):
        words = message.inner_text()
        f_o, e = (re.search(rf"{key} = ([\d.]+)", words)[1] for key in ["f_o", "e"])
        run = command_json("run", "--ensemble", "0", "--set", f"f_o={f_o}", "--set", f"e={e}")
        certain = run["trust"]["t"] is None
        assert ("not certain" not in words) == certain, words
        certainties.add(certain)
        page.keyboard.press("ArrowRight")
        if f_o == "0.4":
            page.keyboard.press("Home")
    assert certainties == {True, False}
    expect(page.locator("#map-legend")).to_contain_text("not certain: rounding may decide how they end")


def test_the_map_has_a_logarithmic_scale_for_values_over_decades(open_page):
    page = open_page(f"t=0&map={MAP},rho1")
    expect(page.locator("#map-progress")).to_have_text("66 runs", timeout=60_000)
    expect(page.locator("#map-legend")).not_to_contain_text("logarithmic")
    page.locator("#map-colour").select_option("impacts")
    values = [int(row["impacts"]) for row in csv.DictReader(io.StringIO(map_table(page)))]
    by_decades = max(values) > 100 * min(value for value in values if value > 0)
    assert by_decades == ("logarithmic" in page.locator("#map-legend").inner_text())


def map_table(page: Page) -> str:
    with page.expect_download() as event:
        page.locator("#map-csv").click()
    return Path(event.value.path()).read_text(encoding="utf-8")


def test_the_map_is_taken_away(open_page, command, tmp_path: Path):
    page = open_page(f"t=0&map={MAP},reason")
    expect(page.locator("#map-progress")).to_have_text("66 runs", timeout=60_000)
    rows = list(csv.DictReader(io.StringIO(map_table(page))))
    page.locator("#map-sweep").click()
    expect(page.locator("#map-sweep")).to_have_text("Copied")
    line = page.evaluate("() => navigator.clipboard.readText()")
    assert line == "snapload sweep --vary f_o=0.2:0.4:11 --vary e=0.7:0.95:6 --out map.parquet"
    pq = pytest.importorskip("pyarrow.parquet")
    command("sweep", *line.split()[2:-1], str(tmp_path / "map.parquet"))
    study = pq.read_table(tmp_path / "map.parquet").to_pylist()
    swept = {(row["f_o"], row["e"]): (row["end"], row["t"], row["certain"]) for row in study}
    mapped = {
        (float(row["f_o"]), float(row["e"])): (row["reason"], float(row["t"]), row["certain"] == "true") for row in rows
    }
    assert mapped == swept


def legend_of(page: Page, path: Path) -> set[tuple[int, int, int]]:
    """The colours beneath the map in its saved picture, which has two pixels per point."""
    download(page, "#map-png", path)
    with Image.open(path) as picture:
        width, height = (2 * round(page.locator("#map").bounding_box()[side]) for side in ("width", "height"))
        assert picture.width == width and picture.height > height
        pixels = np.asarray(picture.convert("RGB"))[height:]
    return set(map(tuple, pixels.reshape(-1, 3).tolist()))


def test_a_saved_map_says_what_its_colours_mean(open_page, tmp_path: Path):
    page = open_page(f"t=0&map={MAP},reason")
    expect(page.locator("#map-progress")).to_have_text("66 runs", timeout=60_000)
    swatches = page.locator("#map-legend .swatch:not(.hatched)")
    fills = swatches.evaluate_all(
        "all => all.map(one => getComputedStyle(one).backgroundColor.match(/\\d+/g).map(Number))"
    )
    expect(page.locator("#map-legend .hatched")).to_be_visible()
    legend = legend_of(page, tmp_path / "map.png")
    assert len(fills) > 1 and set(map(tuple, fills)) <= legend
    # Numbers have a bar from the first to the last colour.
    page.locator("#map-colour").select_option("rho1")
    expect(page.locator("#map-legend .bar-key")).to_be_visible()
    legend = legend_of(page, tmp_path / "map.png")
    for end in (0x00224E, 0xFEE838):
        colour = np.array([end >> 16, end >> 8 & 255, end & 255])
        assert min(np.abs(np.array(one) - colour).max() for one in legend) <= 3


def test_a_box_in_the_map_becomes_the_map(open_page):
    page = open_page(f"t=0&map={MAP},reason")
    expect(page.locator("#map-progress")).to_have_text("66 runs", timeout=60_000)
    box = page.locator("#map").bounding_box()
    width, height = box["width"] - 68, box["height"] - 50
    cell = lambda i, j: (box["x"] + 56 + (i + 0.5) / 11 * width, box["y"] + 10 + (5.5 - j) / 6 * height)  # noqa: E731
    start, end = cell(2, 1), cell(7, 4)
    drag(page, start, (end[0] - start[0], end[1] - start[1]))
    expect(page.locator("#map-x-low")).to_have_value("0.24")
    expect(page.locator("#map-x-high")).to_have_value("0.34")
    expect(page.locator("#map-y-low")).to_have_value("0.75")
    expect(page.locator("#map-y-high")).to_have_value("0.9")
    expect(page.locator("#map-progress")).to_have_text("66 runs", timeout=60_000)
    page.locator("#map-wider").click()
    expect(page.locator("#map-x-low")).to_have_value("0.19")


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"inertia": 0.2, "y": 1, "vx": -0.21},
        {"f_o": 0.31},
        {"t_end": 2},
        {"t_end": 100, "stop_when_settled": False, "e": 0.95},
    ],
)
def test_the_end_and_the_outcome_are_those_of_the_command(open_page, command, keys):
    """Neighbours are run once the values rest; what the command calls not certain, the page does too."""
    settings = {key: str(value).lower() for key, value in keys.items()}
    page = open_page("&".join([*(f"{key}={value}" for key, value in settings.items()), "t=0"]))
    summary = command("run", *(part for key, value in settings.items() for part in ("--set", f"{key}={value}")))
    rows = re.split(r"\n(?=\S)", summary)
    end, outcome = (
        next(row for row in rows if row.startswith(label))[10:].strip().replace("theta", "θ").replace("pi/2", "π/2")
        for label in ["End", "Outcome"]
    )
    end = end.split("\n")[0]
    expect(page.locator("#message")).to_contain_text(end[0].upper() + end[1:])
    words = re.sub(r"\n +", ", ", outcome)
    expect(page.locator("#outcome")).to_have_text(f"Outcome: {words}.", timeout=60_000)


def test_a_reading_at_rest_is_that_of_the_command(open_page, command_json):
    # A light body that rocks quickly: the rows of the first answer are far too few for its tensions.
    values = {"b": "0.1", "e": "0.3", "inertia": "0.001", "stop_when_settled": "false", "t_end": "100"}
    at = 94.97
    page = open_page("&".join(f"{key}={value}" for key, value in values.items()) + f"&t={at}", refused=1)
    options = [text for pair in values.items() for text in ("--set", "=".join(pair))]
    motion = command_json("run", "--ensemble", "0", *options, "--sample", "0.01")["motion"]
    exact = min(motion, key=lambda row: abs(row["t"] - at))
    readings = page.locator("#charts .reading")
    tensions, energy, caption = readings.nth(2), readings.nth(3), page.locator("#caption")
    expect(tensions).not_to_contain_text("about")
    shown = [read(text.removeprefix("T₁ ")) for text in re.split("T₂ ", tensions.inner_text())]
    assert shown == pytest.approx([exact["T1"], exact["T2"]], abs=6e-4)
    assert read(energy.inner_text()) == pytest.approx(exact["energy"], abs=6e-6)
    expect(caption).to_have_text(re.compile(r"^rocking, [\d.]+ and [\d.]+ F"))
    # Without an answer everything that is read there stays approximate.
    page.route("**/api/instant", lambda route: route.abort())
    page.keyboard.press("Shift+ArrowRight")
    for text in [tensions, energy, caption]:
        expect(text).to_contain_text("about")
    page.unroute("**/api/instant")


def test_past_the_listed_events_nothing_is_said_of_them(open_page):
    # Without loss and forcing the body bounces for ever.
    page = open_page("body=point&e=1&f_o=0&y=1e-4&t_end=200&t=199.5")
    expect(page.locator("#message")).to_contain_text("Events are shown up to t = ")
    expect(page.locator("#counted")).to_have_text(re.compile(r"^past impact 10000 of \d+$"))
    expect(page.locator("#charts .reading").nth(1)).to_have_text("latest not known")
    # What is taut at an instant is known there.
    expect(page.locator("#caption")).to_have_text(re.compile("^slack"))
    # A point mass has no rotation.
    expect(page.locator('[data-norm="theta_max"]')).to_have_count(0)


def test_what_is_rounded_to_zero_has_no_sign(code):
    texts = """async () => {
        const { fixed } = await import('./formatting.js');
        return [fixed(-1e-9, 5), fixed(-0.1, 1)];
    }"""
    assert code.evaluate(texts) == ["0.00000", "\u22120.1"]


def test_the_time_at_which_impacts_accumulate_is_told(open_page, command):
    values = {"e": "0.7", "f_o": "0.1"}
    page = open_page("&".join(f"{key}={value}" for key, value in values.items()) + "&t=0")
    options = [text for pair in values.items() for text in ("--set", "=".join(pair))]
    told = re.search(r"the impacts accumulate at t = \S+", command("run", *options))
    assert told
    expect(page.locator("#message")).to_contain_text(told[0].replace("the", "The", 1))
