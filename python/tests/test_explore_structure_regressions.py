"""What went wrong on the page of a structure once, and must not again."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import urljoin

from explore import CYLINDER, ROOT, comes_true, exact_time, keep_listed
from playwright.sync_api import expect

SHORT = "run.duration=60&run.transient=10&elastic=false"


def test_a_link_of_another_structure_is_not_applied(open_structure, structure_url, tmp_path: Path):
    page = open_structure(f"{SHORT}&t=0")
    restitution = page.locator('[id="field-run.restitution"]')
    own = restitution.input_value()
    other = tmp_path / "other.toml"
    other.write_text((ROOT / CYLINDER).read_text().replace("height = 2\n", "height = 1.2\n"), encoding="utf-8")
    page.locator("#open-case").set_input_files(other)
    expect(page.locator("#file")).to_have_text("other.toml", timeout=30_000)
    restitution.fill("0.3")
    comes_true(page, lambda: "run.restitution=0.3" in page.url)
    link = page.url
    page.reload()
    expect(restitution).to_have_value("0.3")
    expect(page.locator("#note")).to_be_hidden()
    # Nothing of the file is in another window, whose program has the cylinder open.
    page.evaluate("() => sessionStorage.clear()")
    page.reload()
    expect(page.locator("#file")).to_have_text(CYLINDER)
    expect(page.locator("#note")).to_contain_text("The link belongs to other.toml")
    expect(restitution).to_have_value(own)
    expect(page.locator("#shell")).not_to_contain_text("restitution")
    # A link of the cylinder itself is applied there.
    page.goto(urljoin(structure_url, "icon.svg"))
    page.goto(link.split("#")[0] + "#run.restitution=0.4")
    expect(restitution).to_have_value("0.4")
    comes_true(page, lambda: "case=cylinder.toml" in page.url)
    page.reload()
    expect(restitution).to_have_value("0.4")
    expect(page.locator("#note")).to_be_hidden()


def test_a_pinned_answer_is_the_one_that_is_shown(open_structure):
    page = open_structure(f"{SHORT}&line.length=6.05&t=0", refused=1)
    page.locator('[id="field-line.length"]').fill("2.9")
    page.locator('[id="field-line.length"]').press("Enter")
    expect(page.locator("#failed")).to_contain_text("2.9 is not allowed")
    page.locator("#pin").click()
    pin = page.locator("#pins li")
    expect(pin).to_contain_text("line.length = 6.05")
    expect(pin).not_to_contain_text("2.9")
    page.locator("#pins .back").click()
    expect(page.locator('[id="field-line.length"]')).to_have_value("6.05")
    expect(page.locator("#failed")).to_be_hidden()


def test_neighbours_and_elastic_lines_follow_a_drag_of_the_body(open_structure):
    page = open_structure("run.duration=12&run.transient=2&t=0")
    expect(page.locator("#lines thead")).to_contain_text("elastic", timeout=60_000)
    box = page.locator("#scene").bounding_box()
    middle = (box["x"] + box["width"] / 2, box["y"])
    # The body is where the pointer takes hold of something.
    grabs = "() => document.getElementById('scene').style.cursor === 'grab'"
    y = next(
        y for y in range(20, int(box["height"]), 6) if page.mouse.move(middle[0], middle[1] + y) or page.evaluate(grabs)
    )
    y += middle[1]
    # The answers wait for the end of the drag: the last values are asked for before the answer to those before them.
    page.evaluate(
        """() => {
            const ask = window.fetch;
            const end = new Promise(done => (window.endOfDrag = done));
            window.fetch = async (path, options) => {
                const answer = await ask(path, { ...options, signal: undefined });
                await end;
                return answer;
            };
        }"""
    )
    page.mouse.move(middle[0], y + 4)
    page.mouse.down()
    for k in range(5):
        page.mouse.move(middle[0] + 3 * k, y + 4 + k)
    page.mouse.up()
    page.evaluate("() => window.endOfDrag()")
    comes_true(page, lambda: "run.start" in page.locator("#shell").inner_text())
    expect(page.locator("#lines thead")).not_to_contain_text("elastic")
    expect(page.locator("#trust")).to_contain_text("neighbours", timeout=60_000)
    expect(page.locator("#lines thead")).to_contain_text("elastic", timeout=60_000)
    expect(page.locator("#coming")).to_be_empty()


def test_back_leaves_the_page_of_a_structure(open_structure, structure_url):
    page = open_structure(f"{SHORT}&t=0")
    page.goto(urljoin(structure_url, "index.html#t=0"))
    page.goto(structure_url)
    comes_true(page, lambda: "window=" in page.url)
    page.locator('[id="field-wave.height"]').fill("1.7")
    page.locator('[id="field-wave.height"]').press("Enter")
    comes_true(page, lambda: "wave.height=1.7" in page.url)
    page.go_back()
    expect(page.locator('[id="field-wave.height"]')).to_have_value("2")
    page.go_back()
    assert page.url.startswith(urljoin(structure_url, "index.html"))
    expect(page.locator("#field-f_o")).to_have_value("0.3")


# The motion on elastic lines is known to its end, so that the time of it does not depend on rounding.
EARLY = (
    "wave.height=3&wave.period=6&run.duration=150&run.transient=10&run.restitution=0.6&line.length=6.1"
    "&window=15,45&t=40"
)


def test_a_run_on_elastic_lines_that_ends_early_is_shown_as_such(open_structure):
    page = open_structure(EARLY)
    words = page.locator("#elastic-words")
    expect(words).to_contain_text("the run stopped where the body had turned by 90 degrees at 24.3 s", timeout=60_000)
    expect(words).to_contain_text("Integrated in shorter steps, the motion stays within")
    expect(page.locator("#lines thead")).to_contain_text("Slack to")
    picture = "canvas => canvas.toDataURL()"
    # After its end nothing of it is in the scene: the picture is that without elastic lines.
    ended = page.locator("#scene").evaluate(picture)
    page.locator("#elastic").uncheck()
    expect(words).to_be_empty()
    comes_true(page, lambda: page.locator("#elastic-key").is_hidden())
    page.wait_for_timeout(100)
    assert page.locator("#scene").evaluate(picture) == ended


def test_elastic_lines_of_a_long_record_are_left_to_the_command(open_structure):
    page = open_structure("run.duration=1300&run.transient=10&t=0")
    words = page.locator("#elastic-words")
    expect(words).to_contain_text("are run by the command: snapload elastic", timeout=60_000)
    expect(page.locator("#elastic-message")).to_be_empty()


def test_all_of_a_long_sea_can_be_shown(open_structure):
    sea = "water=sea&sea.hs=1.1&sea.tp=6&run.duration=345&run.transient=20&elastic=false"
    page = open_structure(f"{sea}&window=310,330&t=320")
    words, slider = page.locator("#window-words"), page.locator("#interval-start")
    # Its first minutes are shown before, with an interval of their own.
    expect(words).to_have_text("310.0 to 330.0 s", timeout=60_000)
    assert exact_time(page) == 320
    slider.evaluate("one => { one.value = 320; one.dispatchEvent(new Event('input')); }")
    expect(words).to_have_text("320.0 to 340.0 s")
    rows = page.locator("#events-body tr").evaluate_all(
        "all => all.map(row => [Number(row.dataset.t), Number(row.cells[3].textContent)])"
    )
    page.locator("#zoom-all").click()
    hardest = max((row for row in rows if row[0] >= 20), key=lambda row: row[1])[0]
    comes_true(page, lambda: contains(words.inner_text(), hardest))
    slider.evaluate("one => { one.value = 305; one.dispatchEvent(new Event('input')); }")
    comes_true(page, lambda: contains(words.inner_text(), 306))
    chosen = words.inner_text()
    page.locator('[id="field-run.restitution"]').fill("0.52")
    expect(page.locator("#shell")).to_contain_text("case.toml")
    expect(slider).to_be_disabled()
    expect(page.locator("#preview")).to_contain_text("the choice of an interval")
    expect(slider).to_be_enabled(timeout=60_000)
    expect(words).to_have_text(chosen)


def contains(interval: str, t: float) -> bool:
    start, end = (float(text) for text in interval.removesuffix(" s").split(" to "))
    return start <= t <= end


def test_a_refused_value_leaves_no_verdict_without_its_neighbours(open_structure):
    page = open_structure("run.duration=12&run.transient=2&elastic=false&t=0", refused=1)
    expect(page.locator("#coming")).to_be_empty(timeout=60_000)
    page.evaluate(
        """() => {
            const ask = window.fetch;
            const wait = new Promise(done => (window.goOn = done));
            window.fetch = async (path, options) => {
                if (options?.body?.includes('"neighbours":true')) await wait;
                return ask(path, options);
            };
        }"""
    )
    page.locator('[id="field-run.restitution"]').fill("0.52")
    expect(page.locator("#coming")).to_have_text("neighbours to come")
    page.locator("#pin").click()
    page.locator('[id="field-wave.period"]').fill("abc")
    page.locator('[id="field-wave.period"]').press("Enter")
    expect(page.locator("#failed")).to_contain_text('wave.period = "abc" is not allowed')
    expect(page.locator("#coming")).to_have_text("neighbours to come")
    expect(page.locator("#pins li")).to_contain_text(", without neighbours,")
    page.evaluate("() => window.goOn()")
    expect(page.locator("#trust")).to_contain_text("neighbours", timeout=60_000)
    expect(page.locator("#coming")).to_be_empty()
    expect(page.locator("#pins li")).not_to_contain_text("without neighbours")


def test_nothing_is_to_come_in_still_water_once_the_other_restitutions_are_run(open_structure):
    page = open_structure("water=still&run.duration=12&run.transient=2&elastic=false&t=0")
    expect(page.locator("#checks")).to_contain_text("with a restitution of", timeout=60_000)
    expect(page.locator("#coming")).to_be_empty()
    page.locator("#pin").click()
    expect(page.locator("#pins li")).to_have_count(1)
    expect(page.locator("#pins li")).not_to_contain_text("without neighbours")


def test_what_is_read_between_rows_is_exact_once_the_cursor_rests(open_structure):
    page = open_structure("run.duration=60&run.transient=10&elastic=false&window=0,60&t=41.3", refused=1)
    reading = page.locator("#charts .reading").last
    expect(reading).not_to_contain_text("about")
    wide = reading.inner_text()
    # The rows of a short interval are so close that its readings are exact to the digits shown.
    page.route("**/api/structure/instant", lambda route: route.abort())
    page.evaluate("() => (location.hash = location.hash.replace('window=0,60', 'window=41.29,41.31'))")
    expect(page.locator("#window-words")).to_have_text("41.3 to 41.3 s")
    assert reading.inner_text().removeprefix("about ") == wide
    page.unroute("**/api/structure/instant")


EXACT = """t => fetch("api/structure/instant", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ case: { set: ["run.duration=60", "run.transient=10"] }, t }),
}).then(answer => answer.json())"""


def test_a_step_out_of_the_interval_moves_it(open_structure):
    page = open_structure(f"{SHORT}&window=20,30&t=25")
    words, surge = page.locator("#window-words"), page.locator("#charts .reading").nth(1)
    for button, way in [("#last", "#next"), ("#first", "#previous")]:
        for step in [way, "shift"]:
            page.locator(button).click()
            before = words.inner_text()
            if step == way:
                page.locator(way).click()
            else:
                page.locator("#scene").focus()
                page.keyboard.press("Shift+ArrowRight" if way == "#next" else "Shift+ArrowLeft")
            expect(words).not_to_have_text(before)
            comes_true(page, lambda: contains(words.inner_text(), exact_time(page)))
            expect(surge).not_to_contain_text("about")
            exact = page.evaluate(EXACT, exact_time(page))
            x = f"{exact['motion']['x'][0]:.3f} m".replace("-", "−")
            expect(surge).to_have_text(x)


def test_no_reading_is_of_another_time_than_the_clock_says(open_structure):
    page = open_structure(f"{SHORT}&window=20,30&t=25", refused=1)
    surge = page.locator("#charts .reading").nth(1)
    before = surge.inner_text()
    page.locator("#last").click()
    comes_true(page, lambda: exact_time(page) == 30 and surge.inner_text() != before)
    read = surge.inner_text()
    page.route("**/api/structure/**", lambda route: route.abort())
    page.locator("#next").click()
    expect(page.locator("#failed")).to_contain_text("the program does not answer")
    # The next interval does not come: what is shown is still the end of the one before.
    assert exact_time(page) == 30
    assert surge.inner_text() == read
    page.unroute("**/api/structure/**")


def test_a_first_answer_that_is_refused_leaves_a_page_that_can_be_used(open_structure):
    page = open_structure("line.length=2.9&elastic=false&t=0", refused=1)
    expect(page.locator("#failed")).to_contain_text("2.9 is not allowed")
    expect(page.locator("#failed")).to_contain_text("The page shows the case without changes")
    expect(page.locator("#shell")).to_have_text(f"snapload assess {CYLINDER}")
    for button in ["#first", "#next", "#previous", "#last", "#scene-svg"]:
        page.locator(button).click()


def test_nothing_that_is_pressed_before_the_first_answer_goes_wrong(open_structure, structure_url):
    page = open_structure(f"{SHORT}&t=0")
    page.goto(urljoin(structure_url, "icon.svg"))
    page.route("**/api/structure/run", lambda route: None)
    page.goto(structure_url)
    for button in ["#first", "#next", "#previous", "#last", "#play", "#zoom-in", "#zoom-all", "#scene-svg"]:
        page.locator(button).click()
    page.locator("#interval-start").evaluate("one => { one.value = 0.5; one.dispatchEvent(new Event('input')); }")
    expect(page.locator("#export-message")).to_contain_text("Nothing is shown yet")
    page.unroute("**/api/structure/run")


def test_of_many_snaps_the_page_says_which_it_does_not_have(open_structure):
    page = open_structure(f"{SHORT}&window=40,50&t=45")
    left_out = {}

    def without_some(route):
        answer = route.fetch()
        json = answer.json()
        snaps = json["snaps"]
        # As if only the first four, those of the interval and the hardest were listed.
        keep = [i for i, t in enumerate(snaps["t"]) if i < 4 or i in snaps["hardest"] or 39 <= t <= 51]
        left_out["until"] = snaps["t"][3]
        left_out["before"] = sum(t <= 45 for t in snaps["t"])
        left_out["at"] = next(t for i, t in enumerate(snaps["t"]) if i not in keep)
        keep_listed(snaps, keep)
        route.fulfill(response=answer, json=json)

    page.route("**/api/structure/run", without_some)
    page.locator('[id="field-run.restitution"]').fill("0.51")
    words = page.locator("#record-words")
    expect(words).to_contain_text("only the hardest and those of the interval are drawn")
    assert f"after {left_out['until']:.3g} s" in words.inner_text()
    expect(page.locator("#counted")).to_contain_text(f"snap {left_out['before']} of ")
    expect(page.locator("#counted")).not_to_contain_text("past")
    expect(page.locator("#events-body tr")).to_have_count(13)
    page.unroute("**/api/structure/run")


def test_a_film_says_what_it_is_of(code):
    caption = """async ([set, water, speed]) => {
        const { filmCaption } = await import("./structure-key-groups.js");
        const valuesOf = set => Object.fromEntries(set.map(change => change.split("=")));
        return filmCaption({ caseName: "/home/me/cylinder.toml", valuesOf }, { ofCase: { set, water } }, 5, speed);
    }"""
    assert code.evaluate(caption, [[], None, 1]) == "cylinder.toml · t = 5.00 s · real time"
    changed = ["wave.height=2.4", "line.length=6.1"]
    expected = "cylinder.toml, wave.height = 2.4, line.length = 6.1 · t = 5.00 s · 20 times"
    assert code.evaluate(caption, [changed, None, 20]) == expected
    many = [f"line.{number}.length=6.1" for number in range(1, 7)]
    assert code.evaluate(caption, [many, "sea", 1]) == "cylinder.toml, 7 changes · t = 5.00 s · real time"
