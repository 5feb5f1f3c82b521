"""How long it takes on the page of `snapload explore` from the change of a value to the painted picture.

    cargo build --release
    python bench/explore/latency.py target/release/snapload

Needs Chromium on the PATH and Playwright for Python (python/requirements.txt). Sliders are dragged in the thesis's
cases, and in the manual's cylinder, as a hand does it: the next step comes once the picture of the last is painted.
The time is the page's own, from the browser's event to after the paint.
"""

from __future__ import annotations

import re
import shutil
import signal
import statistics
import subprocess
import sys
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).resolve().parents[2]
CASES = ["1910001000-359", "1920001000-359", "1922001000-359", "sliding-example", "rocking-example"]
STEPS = 30
SET_SLIDER = "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input', { bubbles: true })); }"


def main() -> None:
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "target" / "release" / "snapload"
    with sync_playwright() as playwright:
        browser = shutil.which("chromium") or shutil.which("chromium-headless-shell")
        chromium = playwright.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        print(f"{'case':<24}{'value':<14}{'median':>9}{'90 %':>9}{'slowest':>9}   ms, {STEPS} steps each")
        thesis_times = []
        for case in CASES:
            for key in ["f_o", "e"]:
                thesis_times += measure_drag(chromium, [program, "explore", "--case", case], case, key)
        print_row("the thesis's cases", "", thesis_times)
        cylinder = [program, "explore", "docs/examples/cylinder.toml"]
        measure_drag(chromium, cylinder, "cylinder.toml", "wave.height")
        chromium.close()


def measure_drag(chromium, command: list[str | Path], case: str, key: str) -> list[float]:
    """Drags a slider over a tenth of its range, and tells how long each picture took."""
    command = [*command, "--no-browser", "--port", "0"]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        assert server.stdout is not None
        address = re.search(r"http://\S+", server.stdout.readline())
        assert address, "the program serves no page"
        context = chromium.new_context(viewport={"width": 1440, "height": 900}, reduced_motion="reduce")
        page = context.new_page()
        page.goto(address[0])
        wait_for_picture(page, 0)
        slider = page.locator(f'[id="slider-{key}"]')
        low, high, value = (float(slider.evaluate(f"one => one.{name}")) for name in ["min", "max", "value"])
        page.wait_for_timeout(500)
        milliseconds = []
        for step in range(STEPS):
            before = picture_count(page)
            slider.evaluate(SET_SLIDER, min(max(value + (high - low) * 0.1 * (step / STEPS - 0.5), low), high))
            wait_for_picture(page, before)
            milliseconds.append(float(page.locator("#took").get_attribute("data-ms") or "nan"))
        context.close()
        server.send_signal(signal.SIGINT)
    print_row(case, key, milliseconds)
    return milliseconds


def picture_count(page: Page) -> int:
    return int(page.locator("#took").get_attribute("data-count") or 0)


def wait_for_picture(page: Page, after: int) -> None:
    """Waits for the next picture; a value that is where it was makes none."""
    for _ in range(400):
        if picture_count(page) > after:
            return
        page.wait_for_timeout(5)


def print_row(case: str, key: str, milliseconds: list[float]) -> None:
    ordered = sorted(milliseconds)
    percentile_90 = ordered[round(0.9 * (len(ordered) - 1))]
    print(f"{case:<24}{key:<14}{statistics.median(milliseconds):>9.1f}{percentile_90:>9.1f}{ordered[-1]:>9.1f}")


if __name__ == "__main__":
    main()
