"""The windows in which the page is tested: one that was used before is as a new one."""

from __future__ import annotations

from explore import DESKTOP, PHONE, drawn, settled
from windows import Window

LEFT_BEHIND = """() => ({
    hovered: document.querySelectorAll(':hover').length,
    steps: history.length,
    kept: [{ ...localStorage }, { ...sessionStorage }],
    size: [innerWidth, innerHeight, screen.width, screen.height, scrollX, scrollY],
    media: ['(prefers-color-scheme: dark)', '(prefers-reduced-motion: reduce)', '(forced-colors: active)', 'print']
        .map(query => matchMedia(query).matches),
    focused: [document.hasFocus(), document.activeElement.id],
})"""


def test_a_window_that_was_used_is_as_a_new_one(browser, url):
    reused, new = Window(browser, has_touch=False), Window(browser, has_touch=False)
    wrong = []
    page = reused.load(url, "f_o=0.31&t=1", wrong, refused=0, viewport=PHONE, color_scheme="dark")
    settled(page)
    page.emulate_media(media="print")
    page.emulate_media(media="screen", forced_colors="active")
    page.route("**/api/run", lambda route: route.abort())
    page.evaluate("() => sessionStorage.setItem('something', 'kept')")
    page.locator("#theme").click()
    page.locator("#field-f_o").focus()
    page.mouse.move(200, 300)
    page.mouse.wheel(0, 200)
    page.context.new_page()
    after_use = page.evaluate(LEFT_BEHIND)
    reused.reset()
    states = []
    for window in [reused, new]:
        page = window.load(url, "t=1", wrong, refused=0, viewport=DESKTOP)
        settled(page)
        pictures = drawn(page)
        states.append((page.evaluate(LEFT_BEHIND), pictures))
        window.context.close()
    assert states[0] == states[1]
    assert states[0][0]["size"][:2] == [DESKTOP["width"], DESKTOP["height"]]
    assert all(after_use[what] != states[1][0][what] for what in after_use if what != "steps"), after_use
    assert wrong == []
