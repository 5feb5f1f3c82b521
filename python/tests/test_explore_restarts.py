"""The page of a structure while its program ends, starts again, or opens another case."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urljoin, urlsplit

import pytest
import xarray
from explore import CYLINDER, ROOT, comes_true, served
from playwright.sync_api import Browser, Page, expect

SHORT = "run.duration=60&run.transient=10&elastic=false"
program = contextmanager(served)


def changed(folder: Path, name: str, before: str, after: str) -> str:
    """A copy of the cylinder with another value."""
    text = (ROOT / CYLINDER).read_text(encoding="utf-8")
    assert before in text
    file = folder / name
    file.write_text(text.replace(before, after), encoding="utf-8")
    return str(file)


@pytest.fixture
def tab(browser: Browser) -> Iterator[Page]:
    """A page of its own: those that tests share have a program until their end."""
    context = browser.new_context(reduced_motion="reduce")
    page = context.new_page()
    page.set_default_timeout(15_000)
    yield page
    context.close()


def left_alone(tab: Page) -> int:
    """Opens the cylinder, and ends its program; returns the port of that."""
    with program(CYLINDER) as url:
        tab.goto(f"{url}#{SHORT}&t=0")
        expect(tab.locator("#shell")).to_contain_text("run.duration=60", timeout=30_000)
        expect(tab.locator("#coming")).to_be_empty(timeout=60_000)
    return urlsplit(url).port or 0


def height(tab: Page, text: str) -> None:
    tab.locator('[id="field-wave.height"]').fill(text)
    tab.locator('[id="field-wave.height"]').press("Enter")


def test_a_page_does_not_show_the_answer_of_another_case(tab: Page, tmp_path: Path):
    port = left_alone(tab)
    thin = changed(tmp_path, "thin.toml", "diameter = 0.038", "diameter = 0.019")
    before = tab.locator("#message").inner_text()
    with program(thin, port=port):
        height(tab, "1.9")
        failed = tab.locator("#failed")
        expect(failed).to_contain_text(f"the program was started again, with another case, {thin}")
        expect(failed).to_contain_text("reload the page")
        assert tab.locator("#message").inner_text() == before
        tab.locator('[data-file="case.toml"]').click()
        expect(tab.locator("#export-message")).to_contain_text("with another case")
        tab.reload()
        expect(tab.locator("#file")).to_have_text(thin)
        expect(tab.locator("#note")).to_contain_text("The link belongs to cylinder.toml")


def test_a_page_does_not_show_the_answer_with_other_coefficients(tab: Page, tmp_path: Path):
    pontoon = tmp_path / "pontoon.toml"
    text = (ROOT / "docs/examples/pontoon.toml").read_text(encoding="utf-8")
    pontoon.write_text(text.replace("pontoon-10m.nc", "coefficients.nc"), encoding="utf-8")
    coefficients = tmp_path / "coefficients.nc"
    coefficients.write_bytes((ROOT / "docs/examples/pontoon-10m.nc").read_bytes())
    with program(str(pontoon)) as url:
        tab.goto(f"{url}#{SHORT}&t=0")
        expect(tab.locator("#shell")).to_contain_text("run.duration=60", timeout=30_000)
        port = urlsplit(url).port or 0
    restitution, failed = tab.locator('[id="field-run.restitution"]'), tab.locator("#failed")
    # The same ones again are no other case.
    with program(str(pontoon), port=port):
        restitution.fill("0.31")
        expect(tab.locator("#shell")).to_contain_text("restitution=0.31")
        expect(failed).to_be_hidden()
    with xarray.open_dataset(ROOT / "docs/examples/pontoon-10m.nc") as dataset:
        less = dataset.assign(radiation_damping=0.97 * dataset["radiation_damping"])
        less.to_netcdf(coefficients)
    with program(str(pontoon), port=port):
        restitution.fill("0.32")
        expect(failed).to_contain_text("or a file that this case names was changed")
        expect(failed).to_contain_text("reload the page")
        tab.reload()
        expect(tab.locator("#shell")).to_contain_text("restitution=0.3", timeout=30_000)
        restitution.fill("0.33")
        expect(tab.locator("#shell")).to_contain_text("restitution=0.33")
        expect(failed).to_be_hidden()


def test_the_same_value_is_asked_for_again_once_the_program_is_back(tab: Page):
    port = left_alone(tab)
    failed = tab.locator("#failed")
    height(tab, "1.9")
    expect(failed).to_contain_text("the program does not answer")
    tab.locator('[data-file="case.toml"]').click()
    expect(tab.locator("#export-message")).to_contain_text("the program does not answer")
    with program(CYLINDER, port=port):
        height(tab, "1.9")
        expect(failed).to_be_hidden()
        expect(tab.locator("#shell")).to_contain_text("wave.height=1.9")


def test_the_same_value_of_a_case_of_the_thesis_is_asked_for_again(open_page):
    page = open_page("t=0", refused=1)
    page.route("**/api/run", lambda route: route.abort())
    page.locator("#field-f_o").fill("0.4")
    expect(page.locator("#failed")).to_contain_text("the program does not answer")
    page.unroute("**/api/run")
    page.locator("#field-f_o").fill("0.4")
    expect(page.locator("#failed")).to_be_hidden()
    expect(page.locator("#shell")).to_contain_text("0.4")


def test_a_case_that_is_opened_is_a_step_of_the_history(open_structure, structure_url, tmp_path: Path):
    page = open_structure(f"{SHORT}&t=0")
    file, note = page.locator("#file"), page.locator("#note")
    low = changed(tmp_path, "low.toml", "height = 2", "height = 1.2")
    for _ in range(2):
        page.locator("#open-case").set_input_files(low)
        expect(file).to_have_text("low.toml")
        comes_true(page, lambda: "case=low.toml" in page.url and "window=" in page.url)
        page.go_back()
        expect(file).to_have_text(CYLINDER)
        expect(page.locator("#shell")).to_contain_text("run.duration=60")
        expect(note).to_be_hidden()
        page.go_forward()
        expect(file).to_have_text("low.toml")
        expect(page.locator('[id="field-wave.height"]')).to_have_value("1.2")
        # From here on both cases are at the same address but for their fragments.
        page.goto(urljoin(structure_url, "icon.svg"))
        page.goto(urljoin(structure_url, f"structure.html#{SHORT}&t=0"))
        expect(file).to_have_text(CYLINDER)
    # The first page of the program is that of its own case.
    page.goto(urljoin(structure_url, "icon.svg"))
    page.goto(structure_url)
    expect(file).to_have_text(CYLINDER)
    expect(note).to_be_hidden()
