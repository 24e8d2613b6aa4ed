"""A browser without a window: opens a page from the disk, tells what it logs and what it loads."""

from __future__ import annotations

import io
import json
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib.image
import numpy as np
import pytest

OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--window-size=1280,1100",
)
LEVELS = ("SEVERE", "WARNING")
HINTS = ("GPU stall due to ReadPixels", "willReadFrequently")  # of speed, and of no fault


@contextmanager
def browser(profile: Path, *, scripts: bool = True) -> Iterator[Any]:
    """Chromium with a new profile; a test without it is skipped."""
    binary, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not (binary and driver):
        pytest.skip("no chromium and chromedriver: apt-get install chromium chromium-driver")
    webdriver = pytest.importorskip("selenium.webdriver", reason="pip install selenium")
    options = webdriver.ChromeOptions()
    options.binary_location = binary
    for option in (*OPTIONS, f"--user-data-dir={profile}"):
        options.add_argument(option)
    if not scripts:
        options.add_experimental_option(
            "prefs", {"profile.managed_default_content_settings.javascript": 2}
        )
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    service = webdriver.ChromeService(executable_path=driver)
    chrome = webdriver.Chrome(options=options, service=service)
    try:
        yield chrome
    finally:
        chrome.quit()


def opened(chrome: Any, page: Path, patience: float = 60.0) -> float:
    """Open a page and wait until all is drawn; milliseconds it took, by its own clock."""
    chrome.get(page.as_uri())
    end = time.monotonic() + patience
    while time.monotonic() < end:
        ready = chrome.execute_script("return document.documentElement.dataset.ready")
        if ready:
            return float(ready)
        time.sleep(0.05)
    raise AssertionError(f"the page was not ready after {patience} s: {complaints(chrome)}")


def complaints(chrome: Any) -> list[str]:
    """What the page logged since it was last asked, of warnings and errors."""
    found = [e["message"] for e in chrome.get_log("browser") if e["level"] in LEVELS]
    return [message for message in found if not any(hint in message for hint in HINTS)]


def requests(chrome: Any) -> list[str]:
    """Addresses that the page asked for, the data in itself left out."""
    found = []
    for entry in chrome.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            found.append(message["params"]["request"]["url"])
    return [url for url in found if not url.startswith(("data:", "blob:"))]


def picture(chrome: Any, selector: str) -> np.ndarray:
    """What is seen of an element, (rows, columns, 3) of 0 to 1."""
    from selenium.webdriver.common.by import By

    element = chrome.find_element(By.CSS_SELECTOR, selector)
    chrome.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
    settled(chrome)
    return matplotlib.image.imread(io.BytesIO(element.screenshot_as_png))[..., :3]


def seen(
    chrome: Any, selector: str, condition: Callable[[np.ndarray], bool], patience: float = 30.0
) -> np.ndarray:
    """The picture of an element as soon as it is as expected; the last one if it never is."""
    image = picture(chrome, selector)

    def again() -> bool:
        nonlocal image
        image = picture(chrome, selector)
        return condition(image)

    until(again, patience)
    return image


def until(condition: Callable[[], bool], patience: float = 30.0) -> None:
    """Wait until something holds, or patience ends."""
    end = time.monotonic() + patience
    while not condition() and time.monotonic() < end:
        time.sleep(0.2)


def click(chrome: Any, selector: str) -> None:
    """Click on an element, and wait for the frame after."""
    from selenium.webdriver.common.by import By

    element = chrome.find_element(By.CSS_SELECTOR, selector)
    chrome.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
    element.click()
    settled(chrome)


def settled(chrome: Any) -> None:
    """Wait until what was asked for is drawn."""
    chrome.execute_async_script(
        "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame("
        "() => setTimeout(done, 60)))"
    )
