"""The page of `snapload explore` in a real browser: what its tests share."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, sync_playwright
from windows import Window, Windows

ROOT = Path(__file__).resolve().parents[2]
CYLINDER = "docs/examples/cylinder.toml"
DESKTOP = {"width": 1440, "height": 900}
SMALLER = {"width": 1024, "height": 768}
PHONE = {"width": 390, "height": 844}
SMALLEST = {"width": 320, "height": 568}
SIDEWAYS = {"width": 740, "height": 360}
PICTURES = ["trajectory", "rotation", "snaps", "tensions", "energy"]


def served(*args: str, port: int = 0) -> Iterator[str]:
    """The address at which the program serves a page, at any free port for 0; it ends with 0 when interrupted."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    program = [target / "debug" / "snapload", "explore", "--no-browser", "--port", str(port), *args]
    with subprocess.Popen(program, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT) as server:
        assert server.stdout is not None
        line = server.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:\d+/", line)
        assert found, line
        try:
            yield found[0]
        finally:
            server.send_signal(signal.SIGINT)
        assert server.wait(timeout=10) == 0


@pytest.fixture(scope="session")
def url() -> Iterator[str]:
    """The address of a program that began with the standard case; all tests share it."""
    yield from served()


@pytest.fixture(scope="session")
def structure_url() -> Iterator[str]:
    """The address of a program that began with the manual's cylinder."""
    yield from served(CYLINDER)


@pytest.fixture
def serve() -> Iterator[Callable[..., str]]:
    """Starts programs with other cases. A test asks for it before the pages, which are closed while they answer."""
    with ExitStack() as programs:
        yield lambda *args: programs.enter_context(contextmanager(served)(*args))


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    # The shell is Chromium without windows of its own, which takes a fifth less time.
    chromium = shutil.which("chromium-headless-shell") or shutil.which("chromium")
    assert chromium, "there is no chromium on the PATH; ./test.sh installs it"
    quiet = ["--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run"]
    with sync_playwright() as playwright:
        # Chromium refuses to sandbox itself when root runs it.
        browser = playwright.chromium.launch(executable_path=chromium, args=[*quiet, "--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def windows(browser: Browser) -> Windows:
    return Windows(browser)


@pytest.fixture
def open_at(windows: Windows, request: pytest.FixtureRequest) -> Iterator[Callable[..., Page]]:
    """Opens a page at an address; afterwards nothing may have gone wrong in it, nor asked another host."""
    taken: list[Window] = []
    wrong: list[str] = []
    failed_before = request.session.testsfailed

    def visit(
        url: str,
        fragment: str = "",
        refused: int = 0,
        viewport: dict[str, int] = DESKTOP,
        has_touch: bool = False,
        **media: str,
    ) -> Page:
        window = windows.take(has_touch)
        taken.append(window)
        # A page without a link plays at once, unless nobody wants motion.
        still = {} if fragment else {"reduced_motion": "reduce"}
        page = window.load(url, fragment, wrong, refused, viewport, **{**still, **media})
        settled(page)
        return page

    yield visit
    for window in taken:
        # A test that failed may have left anything behind, such as a key that is held.
        windows.give_back(window, usable=request.session.testsfailed == failed_before)
    assert wrong == []


@pytest.fixture
def open_page(open_at: Callable[..., Page], url: str) -> Callable[..., Page]:
    """Opens the page of the thesis's model with a state."""
    return lambda fragment="", **options: open_at(url, fragment, **options)


@pytest.fixture
def open_structure(open_at: Callable[..., Page], structure_url: str) -> Callable[..., Page]:
    """Opens the page of the cylinder with a state."""
    return lambda fragment="t=0", **options: open_at(structure_url, fragment, **options)


PAINTED = """after => new Promise((done, failed) => {
    const took = document.getElementById('took');
    const look = () => Number(took.dataset.count ?? 0) > after && done();
    new MutationObserver(look).observe(took, { attributes: true });
    setTimeout(() => failed(new Error('no picture was painted in time')), 15_000);
    look();
})"""


@pytest.fixture(scope="session")
def code(windows: Windows, url: str) -> Iterator[Page]:
    """A page the modules of which are called, and to which nothing else is done: tests share it."""
    wrong: list[str] = []
    window = windows.take(has_touch=False)
    page = window.load(url, "t=0", wrong, refused=0, viewport=DESKTOP)
    settled(page)
    # Tests give its modules other answers than the server's, which is not to be asked meanwhile.
    comes_true(page, lambda: "to come" not in page.locator("#outcome").inner_text())
    yield page
    window.context.close()
    assert wrong == []


def settled(page: Page, after: int = 0) -> None:
    """Waits until a picture is painted, one later than so many."""
    page.evaluate(PAINTED, after)


def comes_true(page: Page, what: Callable[[], bool]) -> None:
    """Waits for something; the page's rules forbid what Playwright's own wait for a function needs."""
    for _ in range(1000):
        if what():
            return
        page.wait_for_timeout(15)
    raise AssertionError("it did not come true in time")


def keep_listed(snaps: dict[str, Any], keep: list[int]) -> None:
    """Leaves only some of the snaps in the list of an answer of a structure."""
    snaps["hardest"] = [keep.index(i) for i in snaps["hardest"]]
    for name in ["number", "t", "line", "jolt", "speed", "peak", "utilisation"]:
        snaps[name] = [snaps[name][i] for i in keep]


def count(page: Page) -> int:
    return int(page.locator("#took").get_attribute("data-count") or 0)


def clock(page: Page) -> float:
    return float(page.locator("#clock").inner_text().removeprefix("t = ").removesuffix(" T"))


def exact_time(page: Page) -> float:
    return float(page.locator("#clock").get_attribute("data-t") or "nan")


def times(page: Page) -> list[float]:
    """The times of the events that the table shows."""
    return page.locator("#events-body .go").evaluate_all("all => all.map(one => Number(one.dataset.t))")


def read(text: str) -> float:
    return float(re.findall(r"[−-]?\d+(?:\.\d+)?(?:e[−-]?\d+)?", text)[0].replace("−", "-"))


def shown_is(page: Page, run: dict[str, Any]) -> None:
    """The page shows the run that the command computed: impacts to the last bit, norms as far as they are printed."""
    impacts = [impact["t"] for impact in run["impacts"]]
    comes_true(page, lambda: set(impacts[:40]) <= set(times(page)))
    snaps = sum(impact["v_n"] > 0 for impact in run["impacts"])
    assert page.locator('[data-norm="impacts"]').inner_text() == str(snaps)
    for norm in ["rho1", "rho2", "rho3", "y_max", "theta_max"]:
        assert read(page.locator(f'[data-norm="{norm}"]').inner_text()) == pytest.approx(run["norms"][norm], rel=1e-4)
    page.locator("#last").click()
    assert exact_time(page) == run["end"]["t"]


def blameless(page: Page) -> None:
    """axe-core finds nothing that would keep anybody out."""
    result = Axe().run(page)
    assert result.violations_count == 0, result.generate_report()


def blameless_in_light_and_dark(page: Page) -> None:
    """The same in both schemes, between which the system changes while the page is open."""
    for scheme in ["light", "dark"]:
        # Without motion no colour is on its way to the other scheme while axe-core looks.
        page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
        assert page.evaluate("() => matchMedia('(prefers-color-scheme: dark)').matches") == (scheme == "dark")
        blameless(page)


def download(page: Page, button: str, path: Path) -> bytes:
    with page.expect_download() as event:
        page.locator(button).click()
    assert event.value.suggested_filename == path.name
    event.value.save_as(path)
    return path.read_bytes()


def drawn(page: Page) -> list[str]:
    """Every canvas, as it is painted."""
    page.wait_for_timeout(400)
    ids = ["#scene", "#strip", "#trajectory .base", "#charts .base"]
    return page.evaluate("ids => ids.map(id => document.querySelector(id).toDataURL())", ids)
