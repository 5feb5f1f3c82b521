"""Windows of the browser that tests use one after the other: to open one costs more than to load the page in it."""

from __future__ import annotations

from urllib.parse import urljoin

from playwright.sync_api import Browser, Page

# The default media of a window of Playwright.
MEDIA = {"media": "null", "color_scheme": "light", "reduced_motion": "no-preference", "forced_colors": "none"}
# Nothing moves or computes in it, and it is of the page's own address: what the browser keeps for that can be emptied.
STILL = "icon.svg"


class Window:
    """A window with a profile of its own, and the errors since it was opened at an address."""

    def __init__(self, browser: Browser, has_touch: bool) -> None:
        self.has_touch = has_touch
        self.context = browser.new_context(accept_downloads=True, has_touch=has_touch)
        self.page = self.context.new_page()
        self.tools = self.context.new_cdp_session(self.page)
        self.allowed: set[str] = set()
        self.url = ""
        self.refused = 0
        self.wrong: list[str] | None = None
        self.page.on("pageerror", lambda error: self.record_error(f"error in the page: {error}"))
        self.page.on("request", lambda request: self.check_request(request.url))
        # The browser itself logs an answer that refuses; what a test expects to be refused is not wrong.
        self.page.on(
            "console", lambda line: self.refused or self.record_error(f"console: {line.text} ({line.location['url']})")
        )

    def record_error(self, what: str) -> None:
        if self.wrong is not None:
            self.wrong.append(what)

    def check_request(self, address: str) -> None:
        if not address.startswith((self.url, "blob:" + self.url, "data:")):
            self.record_error(f"asked {address}")

    def load(
        self, url: str, fragment: str, wrong: list[str], refused: int, viewport: dict[str, int], **media: str
    ) -> Page:
        """Loads a page as a new window does; errors are recorded from now on."""
        if url not in self.allowed:
            self.context.grant_permissions(["clipboard-read", "clipboard-write"], origin=url.rstrip("/"))
            self.allowed.add(url)
        if self.page.viewport_size != viewport:
            self.page.set_viewport_size(viewport)
        self.page.emulate_media(**{**MEDIA, **media})
        self.page.set_default_timeout(15_000)
        self.url, self.wrong, self.refused = url, wrong, refused
        self.page.goto(url + (f"#{fragment}" if fragment else ""))
        # A used window may not have reported the position of the pointer to its page.
        self.page.mouse.move(0, 0)
        return self.page

    def reset(self) -> None:
        """Leaves the page, and removes everything that it stored."""
        self.wrong = None
        for other in self.context.pages:
            if other is not self.page:
                other.close()
        self.page.unroute_all(behavior="ignoreErrors")
        self.page.goto(urljoin(self.url, STILL))
        self.page.evaluate("() => { localStorage.clear(); sessionStorage.clear(); }")
        self.tools.send("Page.resetNavigationHistory")


class Windows:
    """The free windows, by whether they have touch, which can not be changed in an open window."""

    def __init__(self, browser: Browser) -> None:
        self.browser = browser
        self.free: dict[bool, list[Window]] = {True: [], False: []}

    def take(self, has_touch: bool) -> Window:
        free = self.free[has_touch]
        return free.pop() if free else Window(self.browser, has_touch)

    def give_back(self, window: Window, usable: bool) -> None:
        if usable:
            window.reset()
            self.free[window.has_touch].append(window)
        else:
            window.context.close()
