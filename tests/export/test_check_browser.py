"""The page of a check opened, turned and clicked in a real browser."""

import numpy as np
import pytest

from bladecad.export.check.files import export_check
from tests.export.browser import (
    browser,
    click,
    complaints,
    opened,
    picture,
    requests,
    seen,
    settled,
    until,
)
from tests.export.inspections import checked, inspection


@pytest.fixture(scope="module")
def chrome(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    with browser(folder / "profile") as found:
        page = export_check(checked(inspection(count=3000)), folder / "out")["page"]
        found.get("about:blank")
        requests(found)
        found.opening_ms = opened(found, page)
        found.page = page
        yield found


def fresh(chrome):
    """All zones, whole section, first view, as when the page was opened."""
    for selector in (press("zones", ""), press("parts", 0), press("views", "suction side")):
        chrome.execute_script("document.querySelector(arguments[0]).click()", selector)
    settled(chrome)
    return chrome


def whiskers(chrome):
    return chrome.execute_script(
        "const {data, layout} = document.getElementById('whiskers');"
        "return [data.filter((t) => t.name === 'measured').map((t) => [...t.y]), layout.title.text]"
    )


def press(group, value):
    return f'#{group} button[data-{group.rstrip("s").replace("station", "section")}="{value}"]'


def test_the_page_opens_soon_without_complaint_and_asks_for_nothing_else(chrome):
    assert chrome.opening_ms < 30_000  # in software, beside other work; the benchmark is sharper
    assert requests(chrome) == [chrome.page.as_uri()]
    click(chrome, press("zones", "leading edge"))
    click(chrome, press("stations", 0))
    assert complaints(chrome) == []
    assert requests(chrome) == []
    names = "return performance.getEntriesByType('resource').map((entry) => entry.name)"
    assert [name for name in chrome.execute_script(names) if "://" in name] == []


def test_nothing_stands_beyond_the_right_border(chrome):
    wide, seen = fresh(chrome).execute_script(
        "return [document.documentElement.scrollWidth, document.documentElement.clientWidth]"
    )
    assert wide <= seen


def red(image):
    return int((image[..., 0] - image[..., 2] > 0.35).sum())


def blue(image):
    return int((image[..., 2] - image[..., 0] > 0.15).sum())


def opening_scene(chrome):
    """The blade from its suction side, where the bump is."""
    return seen(fresh(chrome), "#scene", lambda image: red(image) > 200)


def test_the_blade_is_drawn_in_the_colours_of_its_deviation(chrome):
    image = opening_scene(chrome)
    drawn = np.abs(image - 1.0).max(axis=2) > 0.02
    assert 0.05 < drawn.mean() < 0.95
    assert red(image) > 200
    assert blue(image) > 200


def test_a_view_from_the_other_side_hides_the_bump(chrome):
    assert red(opening_scene(chrome)) > 200
    click(chrome, press("views", "pressure side"))
    image = seen(chrome, "#scene", lambda image: red(image) < 20 and blue(image) > 100)
    assert red(image) < 20
    assert blue(image) > 100


def test_the_blade_turns_under_the_mouse(chrome):
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.by import By

    before = opening_scene(chrome)
    scene = chrome.find_element(By.CSS_SELECTOR, "#scene")
    drag = ActionChains(chrome).move_to_element(scene).click_and_hold().pause(0.3)
    for _ in range(5):
        drag = drag.move_by_offset(30, 4).pause(0.2)  # the scene looks once a frame
    drag.release().perform()

    def turned(image):
        return np.abs(image - before).max(axis=2).mean() > 0.01 and red(image) + blue(image) > 100

    assert turned(seen(chrome, "#scene", turned))
    assert complaints(chrome) == []


def test_a_zone_that_is_picked_leaves_the_others_pale(chrome):
    bump = red(opening_scene(chrome))
    click(chrome, press("zones", "leading edge"))
    image = seen(chrome, "#scene", lambda image: red(image) < 0.05 * bump and blue(image) > 100)
    assert red(image) < 0.05 * bump  # the bump is on the suction side
    assert blue(image) > 100  # the worn leading edge stays
    click(chrome, press("zones", ""))
    assert red(seen(chrome, "#scene", lambda image: red(image) > 0.9 * bump)) > 0.9 * bump


def test_a_zone_that_is_picked_has_its_own_histogram(chrome):
    script = (
        "const g = document.getElementById('histogram');"
        "return [g.data[0].y.reduce((a, b) => a + b), g.layout.shapes.map((s) => s.x0)]"
    )
    found = {zone.name: zone for zone in inspection(count=3000).zones}
    before = fresh(chrome).execute_script(script)
    click(chrome, press("zones", "leading edge"))
    total, bounds = chrome.execute_script(script)
    assert total == found["leading edge"].points < before[0]
    assert bounds == pytest.approx([-0.03, 0.04])


def test_a_section_that_is_picked_shows_its_own_whiskers_and_numbers(chrome):
    shown = "return [...document.querySelectorAll('.station.shown h3')].map((h) => h.innerText)"
    click(fresh(chrome), press("stations", 0))
    first, image = whiskers(chrome), picture(chrome, "#whiskers")
    assert "Section S1" in first[1]
    assert chrome.execute_script(shown)[0].startswith("Section S1")
    click(chrome, press("stations", 2))
    last = whiskers(chrome)
    assert "Section S3" in last[1]
    assert last[0] != first[0]
    assert np.abs(picture(chrome, "#whiskers") - image).max(axis=2).mean() > 0.005
    assert [text[:10] for text in chrome.execute_script(shown)] == ["Section S3"]


def test_an_edge_is_shown_large_with_its_own_magnification(chrome):
    click(fresh(chrome), press("stations", 1))
    whole = whiskers(chrome)[1]
    click(chrome, press("parts", 1))
    wide = chrome.execute_script("return document.getElementById('whiskers').layout.xaxis.range")
    assert wide[1] - wide[0] < 12.0
    assert whiskers(chrome)[1] != whole


@pytest.mark.parametrize(("height", "name"), [(0.15, "S3"), (0.9, "S1")])
def test_a_click_on_the_blade_picks_the_section_nearest_to_it(chrome, height, name):
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.by import By

    image = opening_scene(chrome)
    click(chrome, press("stations", 1))
    image = picture(chrome, "#scene")
    filled = np.abs(image - 1.0).max(axis=2) > 0.02
    rows = np.flatnonzero(filled.mean(axis=1) > 0.12)  # of the blade, its axes are thin
    row = int(rows[0] + height * (rows[-1] - rows[0]))
    column = int(np.median(np.flatnonzero(filled[row])))
    scene = chrome.find_element(By.CSS_SELECTOR, "#scene")
    x, y = column - image.shape[1] // 2, row - image.shape[0] // 2
    ActionChains(chrome).move_to_element_with_offset(scene, x, y).pause(1.0).click().perform()
    until(lambda: f"Section {name}" in whiskers(chrome)[1])
    assert f"Section {name}" in whiskers(chrome)[1]
    assert complaints(chrome) == []


def test_on_paper_every_section_is_there_and_no_pane_that_needs_a_mouse(chrome):
    fresh(chrome).execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    try:
        seen = chrome.execute_script(
            "const seen = (s) => [...document.querySelectorAll(s)]"
            ".filter((e) => e.getClientRects().length).length;"
            "return [seen('.live'), seen('.static img'), seen('.station'), seen('#blade .static')]"
        )
    finally:
        chrome.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    assert seen == [0, 5, 3, 1]


def test_without_scripts_pictures_and_tables_are_seen(chrome, tmp_path):
    with browser(tmp_path / "profile", scripts=False) as bare:
        bare.get(chrome.page.as_uri())
        bare.execute_cdp_cmd("DOM.enable", {})
        tree = bare.execute_cdp_cmd("DOMSnapshot.captureSnapshot", {"computedStyles": ["display"]})
    words = set(tree["strings"])
    assert "Out of tolerance" in words
    assert "leading edge thickness at 0.5 mm" in words
