"""What went wrong on the page of `snapload explore` once, and must not again."""

from __future__ import annotations

import math
import os
import re
import signal
import socket
import subprocess
from itertools import pairwise
from pathlib import Path
from urllib.parse import quote, unquote

import pytest
from explore import DESKTOP, PHONE, ROOT, SMALLEST, comes_true, count, download, drawn, exact_time, read, settled
from playwright.sync_api import expect

SLIDE = "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }"


def test_the_verdict_is_that_of_the_picture(open_page):
    page = open_page("t=0")
    expect(page.locator("#message")).to_contain_text("Settled at t = 7.246")
    expect(page.locator("#announced")).to_contain_text("Settled at t = 7.246")
    before = count(page)
    page.locator("#slider-f_o").evaluate(SLIDE, 0.31)
    settled(page, before)
    assert "Settled" not in page.locator("#message").inner_text()
    assert "Settled" in page.locator("#announced").inner_text(), "the screen reader text follows once it rests"
    expect(page.locator("#announced")).to_have_text(page.locator("#message").inner_text())


RECORD_NOTES = """() => {
    window.notes = [];
    const note = () => window.notes.push({
        words: document.getElementById('message').textContent,
        stale: ['summary', 'message', 'seal', 'prove-message']
            .map(id => document.getElementById(id).classList.contains('stale')),
    });
    new MutationObserver(note).observe(document.getElementById('summary'), { attributes: true, childList: true });
}"""


def test_texts_of_an_earlier_run_are_pale_next_to_a_newer_picture(open_page):
    page = open_page("t=0")
    expect(page.locator("#message")).to_contain_text("Settled at t = 7.246")
    # Nobody looks at the page: it has no frames.
    page.evaluate("() => (window.requestAnimationFrame = () => 1)")
    page.evaluate(RECORD_NOTES)
    picture = "canvas => canvas.toDataURL()"
    before = page.locator("#strip").evaluate(picture)
    page.locator("#slider-f_o").evaluate(SLIDE, 0.31)
    expect(page.locator("#message")).not_to_contain_text("Settled")
    assert page.locator("#strip").evaluate(picture) != before
    notes = page.evaluate("() => window.notes")
    assert "Settled" in notes[0]["words"] and all(notes[0]["stale"]), notes
    assert not any(notes[-1]["stale"]), notes
    expect(page.locator("#summary")).to_have_css("opacity", "1")


def test_texts_keep_up_with_a_fast_drag(open_page):
    page = open_page("t=0")
    page.evaluate(RECORD_NOTES)
    # Frames that are slower than answers: one picture takes the place of the other before it is painted.
    page.evaluate("() => (window.requestAnimationFrame = f => setTimeout(f, 1500))")
    # Answers are what is counted, and no time: a machine that is busy gives them later, and the words with them.
    answers = page.evaluate(
        """async () => {
            let answers = 0;
            const ask = window.fetch;
            window.fetch = async (...what) => {
                const answer = await ask(...what);
                answers += 1;
                return answer;
            };
            const slider = document.getElementById('slider-f_o');
            const notes = [];
            for (let k = 0; answers < 60 && k < 3000; k += 1) {
                slider.value = 0.3 + (k % 100) / 1000;
                slider.dispatchEvent(new Event('input'));
                await new Promise(done => setTimeout(done, 30));
                notes.push(...window.notes.splice(0).filter(({ stale }) => !stale[0]).map(() => answers));
            }
            return notes;
        }"""
    )
    assert answers, "they wait for the end of the drag"
    assert max(later - before for before, later in pairwise([0, *answers, 60])) <= 20, answers


def test_pictures_keep_their_colours_with_forced_colours(open_page):
    usual, forced = open_page("t=1"), open_page("t=1", forced_colors="active")
    assert drawn(forced) == drawn(usual)


def test_a_file_is_written_while_the_page_stays_responsive(open_page):
    page = open_page("f_o=0.31&t=0")
    waiting = []
    page.route("**/api/export/*", lambda route: waiting.append(route))
    button = page.locator('[data-file="impacts.csv"]')
    button.click()
    expect(button).to_be_disabled()
    expect(page.locator("#export-message")).to_have_text("impacts.csv of your own values: writing")
    before = count(page)
    page.locator("#field-f_o").fill("0.29")
    settled(page, before)
    with page.expect_download():
        waiting[0].continue_()
    expect(button).to_be_enabled()
    assert waiting[0].request.post_data_json["values"] == {"f_o": 0.31}, "the values are those of the click"


def test_dragging_through_slow_runs_shows_some_of_them(code):
    answers = code.evaluate(
        """async () => {
            const { Runner } = await import('./api.js');
            const slow = signal => new Promise((done, failed) => {
                const timer = setTimeout(() => done(new Response('{}')), 300);
                signal.addEventListener('abort', () => {
                    clearTimeout(timer);
                    failed(new DOMException('', 'AbortError'));
                });
            });
            const fetch = window.fetch;
            window.fetch = (path, { signal }) => slow(signal);
            const shown = [];
            const runner = new Runner({ onAnswer: (_, since) => shown.push(since), onError() {} });
            for (let i = 0; i < 50; i += 1) {
                runner.ask({}, i);
                await new Promise(done => setTimeout(done, 40));
            }
            await new Promise(done => setTimeout(done, 800));
            window.fetch = fetch;
            return shown;
        }"""
    )
    assert len(answers) >= 4 and answers[-1] == 49, answers


def test_a_drag_with_shift_selects_no_text(open_page):
    page = open_page("t=0")
    page.locator("#caption").click()
    area = page.locator("#charts .over").first.bounding_box()
    page.keyboard.down("Shift")
    page.mouse.move(area["x"] + 100, area["y"] + 40)
    page.mouse.down()
    page.mouse.move(area["x"] + 240, area["y"] + 50, steps=5)
    page.mouse.up()
    page.keyboard.up("Shift")
    expect(page.locator("#window-words")).not_to_have_text("")
    assert page.evaluate("() => getSelection().toString()") == ""


def test_arrow_keys_are_one_step_to_go_back(open_page):
    page = open_page("t=0")
    length = page.evaluate("() => history.length")
    page.locator("#field-f_o").focus()
    for _ in range(5):
        before = count(page)
        page.keyboard.press("ArrowUp")
        settled(page, before)
    page.locator("#slider-nu").focus()
    for _ in range(3):
        before = count(page)
        page.keyboard.press("ArrowLeft")
        settled(page, before)
    assert page.evaluate("() => history.length") == length + 2
    page.go_back()
    expect(page.locator("#field-nu")).to_have_value("0.5")
    page.go_back()
    expect(page.locator("#field-f_o")).to_have_value("0.3")


def test_labels_of_axes_stay_on_the_canvas(code):
    cut = code.evaluate(
        """async () => {
            const { Frame, drawAxes, ticks } = await import('./plot.js');
            const canvas = Object.assign(document.createElement('canvas'), { width: 340, height: 120 });
            const context = canvas.getContext('2d');
            const cut = [];
            const write = context.fillText.bind(context);
            context.fillText = (text, x, y) => {
                const half = context.textAlign === 'center' ? context.measureText(text).width / 2 : 0;
                if (x - half < -0.01 || x + half > canvas.width + 0.01) cut.push(text);
                write(text, x, y);
            };
            const frame = new Frame([50, 6, 280, 80], [0, 10000], [0, 1]);
            const xTicks = ticks(0, 10000, 4);
            drawAxes(context, frame, {}, { xTicks, yTicks: ticks(0, 1, 4) });
            return { cut, labels: xTicks.values.map(xTicks.label) };
        }"""
    )
    assert "10000" in cut["labels"] and cut["cut"] == []


def test_an_axis_has_two_labels_at_the_least(code):
    values = code.evaluate(
        """async () => {
            const { ticks } = await import('./plot.js');
            return [[-0.19, 0.17], [-3.66, -3.51], [0.1, 1900]].map(([low, high]) => ticks(low, high, 3).values);
        }"""
    )
    assert values[0] == pytest.approx([-0.1, 0, 0.1])
    assert all(len(labels) >= 2 for labels in values)


def test_on_paper_nothing_lies_over_the_charts(open_page):
    page = open_page("t=2")
    page.emulate_media(media="print")
    expect(page.locator("#charts .over").first).to_be_hidden()
    expect(page.locator("#charts canvas").first).to_be_visible()
    expect(page.locator("#play")).to_be_hidden()


def test_links_keep_their_port():
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    servers = [
        subprocess.Popen(
            [target / "debug" / "snapload", "explore", "--no-browser"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        for _ in range(2)
    ]
    ports = [int(re.search(r":(\d+)/", server.stdout.readline())[1]) for server in servers]
    with socket.create_connection(("127.0.0.1", 7627), timeout=5):
        pass  # One of them has it, or whoever had it before.
    assert len(set(ports)) == 2
    for server in servers:
        server.send_signal(signal.SIGINT)
        assert server.wait(timeout=10) == 0
        server.stdout.close()


def test_the_map_opens_on_a_fresh_page(open_page):
    page = open_page("t=0")
    page.keyboard.press("m")
    expect(page.locator("#map-progress")).to_have_text("2091 runs", timeout=60_000)


def test_time_comes_back_after_a_shorter_run(open_page):
    page = open_page("t=5")
    for value, t in [("0.31", None), ("0.3", 5)]:
        before = count(page)
        page.locator("#field-f_o").fill(value)
        settled(page, before)
        assert exact_time(page) < 4 if t is None else exact_time(page) == t


def test_it_plays_the_time_that_is_shown(open_page):
    page = open_page("t=6&window=2,2.4&speed=1")
    page.locator("#play").click()
    comes_true(page, lambda: page.locator("#play").inner_text() == "Play")
    assert exact_time(page) == 2.4
    page.keyboard.press("l")
    page.locator("#play").click()
    page.wait_for_timeout(900)
    assert page.locator("#play").inner_text() == "Pause" and 2 <= exact_time(page) <= 2.4


def test_numbers_may_be_pasted_as_they_are_printed(open_page):
    page = open_page("t=0")
    for text, value in [("−0.25", "-0.25"), ("-.5", "-0.5"), ("2.5E-1", "0.25")]:
        before = count(page)
        page.locator("#field-nu").fill(text)
        page.locator("#field-nu").press("Enter")
        settled(page, before)
        expect(page.locator("#shell")).to_contain_text(f"nu={value}")


def test_what_is_no_decimal_is_refused(open_page):
    page = open_page("t=0", refused=1)
    for text in ["0x10", "Infinity", "1_0"]:
        page.locator("#field-nu").fill(text)
        page.locator("#field-nu").press("Enter")
        expect(page.locator("#error-nu")).to_contain_text(f'nu = "{text}" is not allowed')
        before = count(page)
        page.locator("#field-nu").fill("0.5")
        settled(page, before)
        expect(page.locator("#error-nu")).to_be_hidden()


def test_a_reading_between_distant_rows_is_marked_as_approximate(open_page, command_json):
    values = {"f_o": "0.05", "stop_when_settled": "false", "t_end": "600"}
    at = 433.21
    page = open_page("&".join(f"{key}={value}" for key, value in values.items()) + f"&t={at}")
    reading = page.locator("#charts .reading").first
    expect(reading).not_to_contain_text("about", timeout=10_000)
    options = [text for pair in values.items() for text in ("--set", "=".join(pair))]
    motion = command_json("run", "--ensemble", "0", *options, "--sample", "0.01")["motion"]
    near = min(motion, key=lambda row: abs(row["t"] - at))
    assert read(reading.inner_text()) == pytest.approx(near["theta"], abs=2e-4)
    coarse = page.evaluate(
        """async ([values, at]) => {
            const { Run } = await import('./run.js');
            const headers = { 'Content-Type': 'application/json' };
            const body = JSON.stringify({ values, samples: 100 });
            const run = new Run(await (await fetch('api/run', { method: 'POST', headers, body })).json());
            return run.at(at).rough;
        }""",
        [{"f_o": 0.05, "stop_when_settled": False, "t_end": 600}, at],
    )
    assert coarse


def test_a_swipe_over_a_slider_leaves_its_value(open_page):
    page = open_page("t=0", viewport=PHONE, has_touch=True)
    slider = page.locator("#slider-f_o")
    slider.dispatch_event("pointerdown")
    before = count(page)
    slider.evaluate(SLIDE, 0.5)
    settled(page, before)
    slider.dispatch_event("pointercancel")
    expect(page.locator("#field-f_o")).to_have_value("0.3")
    assert slider.input_value() == "0.3"


def test_a_refused_link_reports_what_is_shown(open_page):
    page = open_page("e=7", refused=1)
    expect(page.locator("#failed")).to_contain_text("e = 7 is not allowed")
    expect(page.locator("#failed")).to_contain_text("the first case of the page, the standard case")


def test_one_row_of_the_events_takes_the_tab_key(open_page):
    page = open_page("t=0")
    expect(page.locator('#events-body .go[tabindex="0"]')).to_have_count(1)
    page.locator('#events-body .go[tabindex="0"]').focus()
    page.keyboard.press("ArrowDown")
    assert page.evaluate("() => document.activeElement.closest('tr').dataset.event") == "1"


def test_an_animation_comes_while_another_page_is_in_front(open_page, tmp_path: Path):
    page = open_page("t=0&speed=5")
    # A browser lets the timers of a page that nobody looks at ring once a second at the most.
    page.evaluate(
        "() => { const real = window.setTimeout; window.setTimeout = (f, ms) => real(f, Math.max(ms ?? 0, 1000)); }"
    )
    page.set_default_timeout(30_000)
    assert len(download(page, "#animation", tmp_path / "run.webm")) > 10_000


@pytest.mark.parametrize("viewport", [PHONE, SMALLEST], ids=["phone", "smallest"])
def test_the_tick_of_the_loop_has_its_word_on_a_phone(open_page, viewport):
    page = open_page("t=0", viewport=viewport)
    word, speed = (page.locator(one).bounding_box() for one in [".loop span", "#speed"])
    assert word["width"] > 20 and word["x"] + word["width"] <= speed["x"]
    assert speed["x"] + speed["width"] <= viewport["width"]


def test_a_number_of_cells_is_next_to_its_label(open_page):
    page = open_page("t=0&map=f_o,0.2,0.4,3,e,0.7,0.95,3,reason")
    for side in ["x", "y"]:
        label = page.locator("label", has=page.locator(f"#map-{side}-count")).bounding_box()
        field = page.locator(f"#map-{side}-count").bounding_box()
        assert label["height"] < field["height"] * 1.3


def test_the_digits_of_the_norms_are_those_of_the_command(open_page, command):
    page = open_page("f_o=0.31&t=0")
    output = command("run", "--ensemble", "0", "--set", "f_o=0.31")
    known = dict(re.findall(r"(rho\d|y_max|theta_max) = [^(]*\((\d+ digits?)\)", output))
    assert set(known) == {"rho1", "rho2", "rho3", "y_max", "theta_max"}, output
    for norm, digits in known.items():
        term = page.locator("#summary div", has=page.locator(f'[data-norm="{norm}"]'))
        expect(term.locator("small")).to_have_text(digits)


def test_a_section_is_drawn_with_a_force_that_turns_the_other_way(code, open_page):
    sections = "async omegas => omegas.map(omega => window.sectionTimes(omega, [0, 20]))"
    code.evaluate("async () => { window.sectionTimes = (await import('./trajectory.js')).sectionTimes; }")
    there, back, none = code.evaluate(sections, [0.9, -0.9, 0])
    assert there == back == pytest.approx([k * 2 * math.pi / 0.9 for k in range(3)])
    assert none == []
    many = code.evaluate("async () => window.sectionTimes(1000, [0, 1e6]).length")
    assert 10_000 < many <= 20_000
    # With the same frequency backwards and the other sign of ν the force is the same.
    pictures = []
    for turned in ["omega=0.9&nu=0.5", "omega=-0.9&nu=-0.5"]:
        page = open_page(f"{turned}&stop_when_settled=false&t_end=40&plane=section&t=0")
        pictures.append(page.locator("#trajectory .base").evaluate("canvas => canvas.toDataURL()"))
    assert pictures[0] == pictures[1]


def test_a_changed_case_has_a_name_of_its_own(serve, open_at):
    code = "1922001000-359"
    page = open_at(serve("--case", code, "--set", "f_o=0.4"))
    chosen = page.locator("#case option:checked")
    expect(chosen).to_have_text(re.compile("f_o = 0.4"))
    page.locator("#case").select_option(code)
    expect(page.locator("#field-f_o")).to_have_value("0.3")
    expect(chosen).not_to_have_text(re.compile("f_o = 0.4"))
    page.go_back()
    expect(page.locator("#field-f_o")).to_have_value("0.4")


def test_a_pin_is_the_run_that_is_shown(open_page):
    refused, other = (quote(pin) for pin in ['{"r":0.5}', '{"f_o":0.31}'])
    page = open_page(f"pin={refused}&pin={other}&t=0", refused=1)
    pins = page.locator("#pins li")
    expect(pins).to_have_count(2)
    expect(pins.nth(0)).to_contain_text("can not be run")
    # The values of the fields are refused: the pin has those of the picture.
    page.locator("#field-r").fill("0.5")
    page.locator("#field-r").press("Enter")
    expect(page.locator("#failed")).to_be_visible()
    page.locator("#pin").click()
    expect(pins.nth(2)).to_contain_text("the run that is shown")
    pins.nth(1).locator(".unpin").click()
    expect(pins).to_have_count(2)
    expect(pins.nth(1)).to_contain_text("the run that is shown")
    comes_true(page, lambda: unquote(page.url).count("pin=") == 2 and unquote(page.url).endswith("pin={}"))


def test_a_first_case_that_takes_too_long_is_asked_for_once(serve, windows):
    long = ["body=point", "e=1", "t_end=1000000", "max_impacts=10000000", "f_o=0", "y=0.005"]
    url = serve(*(text for change in long for text in ["--set", change]))
    window = windows.take(has_touch=False)
    asked = []
    window.page.on("request", lambda request: request.url.endswith("/api/run") and asked.append(request.post_data_json))
    page = window.load(url, "", wrong=[], refused=1, viewport=DESKTOP, reduced_motion="reduce")
    settled(page)
    expect(page.locator("#failed")).to_contain_text("after 2 s of computing")
    expect(page.locator("#failed")).to_contain_text("The picture shows the standard case.")
    expect(page.locator("#message")).to_contain_text("Settled at t = 7.246")
    page.wait_for_timeout(2500)
    assert [question["values"] for question in asked] == [asked[0]["values"], {}]
    window.context.close()


def test_what_is_past_the_horizon_is_marked_wherever_it_is_shown(open_page):
    other = quote('{"f_o":0.31}')
    page = open_page(f"pin={other}&t=0")
    for norm in ["rho1", "impulse", "taut", "impacts"]:
        term = page.locator("#summary div", has=page.locator(f'[data-norm="{norm}"]'))
        expect(term.locator("small")).to_have_text("not certain")
    expect(page.locator("#pins li")).to_contain_text(re.compile(r"\((harder|softer), not certain\)"))


def test_a_ghost_is_not_drawn_after_its_end(open_page):
    page = open_page("f_o=0.463&e=0.9&omega=0.99&t_end=60&ghost=0.01&t=12")
    expect(page.locator("#message")).to_contain_text("It ends otherwise:")
    before = page.evaluate("() => document.getElementById('scene').toDataURL()")
    number = count(page)
    page.locator("#ghost").uncheck()
    settled(page, number)
    assert page.evaluate("() => document.getElementById('scene').toDataURL()") == before
