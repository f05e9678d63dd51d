"""report.html in a headless Chromium: it draws, it reads the right numbers, it asks for nothing."""

from __future__ import annotations

import io
import math
import re

import numpy as np
import pytest
from exact_nets import sphere_shear_at

import geomdrap as gd
from geomdrap.export import report_html
from geomdrap.surface import Surface, samples, shapes

RADIUS, PITCH = 100.0, 5.0
NAME = "käppi & <co>.stl"
COMMAND = "geomdrap drape 'käppi & <co>.stl' --blank 130x110 --pitch 5"


@pytest.fixture(scope="module")
def result():
    """A cap of a sphere under a blank that leaves a rim bare."""
    made = shapes.sphere_cap(RADIUS, 60.0, 4.0)
    surface = Surface(made.points, made.triangles, source=NAME)
    return gd.evaluate(gd.drape(surface, (0, 0, RADIUS), 20.0, PITCH, (65.0, 55.0), project=True), 15.0)


@pytest.fixture(scope="module")
def file(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    report_html.write(result, path, COMMAND)
    return path


@pytest.fixture
def opened(page, file):
    page.resize(1300, 1000)
    page.open(file)
    return page


def numbers(text):
    return [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?", text)]


def read(page):
    """What the readout says: u, v, shear, thickness, point (3,), all floats; or the words where it is not draped."""
    if page.text("read-u") == "–":
        return page.text("read-state")
    values = [numbers(page.text(f"read-{name}"))[0] for name in ("u", "v", "shear", "thickness")]
    return (*values, np.array(numbers(page.text("read-point"))))


def hover(page, view, x, y):
    """Move the mouse to a share of the width and of the height of a view."""
    left, top, width, height = page.box(f"#{view}")
    page.mouse("mouseMoved", left + x * width, top + y * height)
    page.settle()


def mark(page, view):
    """Where the mark is in a view, as shares of its size; None if it is hidden."""
    _, _, width, height = page.box(f"#{view}")
    script = "(() => {{ const m = document.querySelector('#{0} .mark'); return [m.getAttribute('visibility'), "
    script += "m.getAttribute('transform')]; }})()"
    shown, transform = page.run(script.format(view))
    if shown != "visible":
        return None
    x, y = numbers(transform)
    return x / width, y / height


def test_it_opens_without_an_error_and_asks_the_network_for_nothing(opened, file):
    assert opened.run("document.documentElement.dataset.ready") == "yes"
    for x in (0.3, 0.5, 0.6):
        hover(opened, "part-view", x, 0.5)
        hover(opened, "flat-view", x, 0.5)
    assert opened.errors == []
    assert opened.requests == [file.resolve().as_uri()]


def test_hover_on_the_part_reads_the_exact_net_of_the_sphere(opened, result):
    found = 0
    for x in np.linspace(0.2, 0.8, 7):
        for y in np.linspace(0.3, 0.7, 5):
            hover(opened, "part-view", x, y)
            values = read(opened)
            if isinstance(values, str):
                continue
            u, v, shear, thickness, point = values
            assert shear == pytest.approx(float(sphere_shear_at(u, v, RADIUS)), abs=0.35)
            assert thickness == pytest.approx(1 / math.cos(math.radians(shear)), abs=2e-3)
            assert np.linalg.norm(point) == pytest.approx(RADIUS, abs=0.4)
            there = result.net.interpolate(u, v)[0][0]
            assert np.isnan(there).all() or np.linalg.norm(there - point) < 0.4
            found += 1
    assert found > 15


def test_hover_on_the_part_marks_the_same_place_on_the_pattern_and_back(opened):
    hover(opened, "part-view", 0.55, 0.45)
    u, v, shear, _, point = read(opened)
    x, y = mark(opened, "flat-view")
    assert mark(opened, "part-view") == pytest.approx((0.55, 0.45), abs=0.004)
    hover(opened, "flat-view", x, y)
    back = read(opened)
    assert back[:2] == pytest.approx((u, v), abs=0.6)  # a pixel is half a millimetre here
    assert back[2] == pytest.approx(shear, abs=0.5)
    assert back[4] == pytest.approx(point, abs=0.7)
    assert mark(opened, "part-view") == pytest.approx((0.55, 0.45), abs=0.006)


def test_the_pattern_is_drawn_with_u_to_the_right_and_v_up(opened):
    hover(opened, "flat-view", 0.5, 0.5)
    u, v, *_ = read(opened)
    hover(opened, "flat-view", 0.6, 0.4)
    right, up, *_ = read(opened)
    assert (u, v) == pytest.approx((0.0, 0.0), abs=1.0)
    assert right > u + 5
    assert up > v + 5


def test_beside_the_ply_nothing_is_read_and_bare_facets_say_why(opened):
    hover(opened, "part-view", 0.02, 0.5)
    assert read(opened) == "point at the part or the pattern"
    opened.run("document.querySelector('button[data-bare]').click()")
    opened.settle()
    assert read(opened) == "bare: beyond the blank"
    assert mark(opened, "flat-view") is None


def test_the_wheel_zooms_about_the_mouse_and_dragging_turns_the_part(opened):
    left, top, width, height = opened.box("#part-view")
    x, y = left + 0.6 * width, top + 0.4 * height
    opened.mouse("mouseMoved", x, y)
    before = read(opened)
    for _ in range(3):
        opened.mouse("mouseWheel", x, y, deltaX=0, deltaY=-200)
    opened.settle()
    opened.mouse("mouseMoved", x, y)
    after = read(opened)
    assert after[4] == pytest.approx(before[4], abs=0.3)
    turned = opened.run("geomdrapReport.part.camera.toward")
    opened.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
    opened.mouse("mouseMoved", x + 80, y, button="left", buttons=1)
    opened.mouse("mouseReleased", x + 80, y, button="left", clickCount=1)
    opened.settle()
    now = opened.run("geomdrapReport.part.camera.toward")
    assert np.degrees(np.arccos(np.dot(turned, now))) == pytest.approx(0.4 * 80, abs=0.5)
    frame = opened.run("[geomdrapReport.part.camera.right, geomdrapReport.part.camera.up, geomdrapReport.part.camera.toward]")
    np.testing.assert_allclose(np.array(frame) @ np.array(frame).T, np.eye(3), atol=1e-9)
    assert np.linalg.det(frame) == pytest.approx(1.0)


def test_dragging_to_the_right_takes_the_near_side_of_the_part_to_the_right(opened):
    place = "geomdrapReport.part.camera.project([0, 0, 100])"
    before = opened.run(place)
    opened.run("geomdrapReport.part.camera.turn(10, 0)")
    assert opened.run(place)[0] > before[0] + 5
    before = opened.run(place)
    opened.run("geomdrapReport.part.camera.turn(0, 10)")
    assert opened.run(place)[1] > before[1] + 5


def test_the_keyboard_steps_from_yarn_to_yarn_and_turns_the_part(opened):
    opened.run("document.getElementById('flat-view').focus()")
    opened.key("ArrowRight")
    assert read(opened)[:2] == pytest.approx((0.0, 0.0), abs=0.06)
    opened.key("ArrowRight")
    opened.key("ArrowUp")
    opened.key("ArrowUp")
    assert read(opened)[:2] == pytest.approx((PITCH, 2 * PITCH), abs=0.06)
    opened.key("ArrowLeft", shift=True)
    u, v, shear, *_ = read(opened)
    assert (u, v) == pytest.approx((-9 * PITCH, 2 * PITCH), abs=0.06)
    assert shear == pytest.approx(float(sphere_shear_at(u, v, RADIUS)), abs=0.35)
    opened.run("document.getElementById('part-view').focus()")
    before = opened.run("geomdrapReport.part.camera.toward")
    opened.key("ArrowLeft")
    assert opened.run("geomdrapReport.part.camera.toward") != before
    opened.key("5")
    assert opened.run("geomdrapReport.part.camera.toward") == [0, 0, 1]
    opened.key("c")
    opened.key("w")
    assert opened.run("document.querySelector('input[name=mode]:checked').value") == "signed"
    assert opened.run("document.getElementById('show-warp').checked") is False


def pixel(page, view, x, y):
    """Colour (3,) 0 to 255 of the window at shares of the size of a view."""
    from PIL import Image

    left, top, width, height = page.box(f"#{view}")
    image = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    return np.array(image.getpixel((round(left + x * width), round(top + y * height))), float)


def test_places_have_the_colour_of_their_limit_class(opened):
    opened.run("geomdrapReport.setMode(2); ['warp', 'weft', 'limit'].forEach(n => geomdrapReport.toggle(n, false))")
    opened.settle()
    colours = {"low": (0x3B, 0x75, 0xAF), "middle": (0xF2, 0xC1, 0x4E), "high": (0xC8, 0x32, 0x2B)}
    seen = set()
    for u, v in ((20.0, 15.0), (50.0, 30.0), (60.0, 50.0), (-60.0, 50.0)):
        size = abs(float(sphere_shear_at(u, v, RADIUS)))
        name = "high" if size > 15.0 else "middle" if size > 7.5 else "low"
        x, y, _ = opened.run(f"geomdrapReport.flat.camera.project([{u}, {v}, 0])")
        _, _, width, height = opened.box("#flat-view")
        assert pixel(opened, "flat-view", x / width, y / height) == pytest.approx(colours[name], abs=3), (u, v, size)
        seen.add(name)
    assert seen == set(colours)


def test_yarns_are_drawn_where_the_fabric_coordinates_are_whole_spacings(opened):
    opened.run("geomdrapReport.setMode(2); geomdrapReport.toggle('weft', false); geomdrapReport.toggle('limit', false)")
    opened.settle()
    spacing = opened.run("geomdrapReport.flat.spacing()")
    assert spacing % PITCH == 0
    _, _, width, height = opened.box("#flat-view")
    for u, v, on in ((7.0, spacing, True), (7.0, 1.5 * spacing, False), (spacing, 0.5 * spacing, False)):
        x, y, _ = opened.run(f"geomdrapReport.flat.camera.project([{u}, {v}, 0])")
        dark = min(pixel(opened, "flat-view", x / width, (y + k) / height).sum() for k in (-1, 0, 1))
        assert (dark < 0x3B + 0x75 + 0xAF - 90) == on, (u, v)


def test_in_a_narrow_window_the_views_stand_one_above_the_other_and_nothing_is_cut_off(opened, page):
    page.resize(390, 800)
    page.settle()
    part, flat = page.box("#part-view"), page.box("#flat-view")
    assert flat[1] >= part[1] + part[3]
    assert part[2] > 300
    assert page.run("document.documentElement.scrollWidth <= window.innerWidth")
    page.run("window.scrollTo(0, document.querySelector('#part-view').offsetTop)")
    hover(page, "part-view", 0.5, 0.5)
    assert not isinstance(read(page), str)


def brightness(page, selector):
    colour = numbers(page.run(f"getComputedStyle(document.querySelector({selector!r})).backgroundColor"))
    return sum(colour[:3]) / 3


def test_it_is_dark_for_those_who_like_it_dark(opened, page):
    assert brightness(page, "body") > 200
    page.resize(1300, 1000, dark=True)
    page.settle()
    assert brightness(page, "body") < 60
    ink = page.run("getComputedStyle(document.body).color")
    assert sum(numbers(ink)[:3]) / 3 > 180
    assert page.run("geomdrapReport.look.colours.bareColour[0]") < 0.5, "the views follow"


def test_without_webgl_the_page_says_so_and_keeps_its_numbers(page, file):
    script = "HTMLCanvasElement.prototype.getContext = () => null"
    added = page.call("Page.addScriptToEvaluateOnNewDocument", source=script)["identifier"]
    page.open(file)
    page.call("Page.removeScriptToEvaluateOnNewDocument", identifier=added)
    assert page.run("document.getElementById('failed').hidden") is False
    assert "cannot be shown: this browser gives no WebGL 2." in page.text("failed")
    assert "Gauss-Bonnet" in page.run("document.body.innerText")
    assert page.errors == []


def test_without_a_flat_pattern_no_rectangle_is_named():
    empty = gd.evaluate(gd.drape(shapes.plane(200.0, 160.0, 8.0), (0, 0, 0), 25.0, 79.0))
    assert not empty.flat.outer
    words = report_html.page(empty)
    assert "<b>none</b><span>flat pattern: no fabric lies on the part</span>" in words
    assert "rectangle to cut it from" not in words


def test_an_error_of_the_page_is_not_taken_for_a_lack_of_webgl(page, file):
    script = "window.ResizeObserver = class { constructor() { throw new Error('out of order'); } }"
    added = page.call("Page.addScriptToEvaluateOnNewDocument", source=script)["identifier"]
    page.open(file)
    page.call("Page.removeScriptToEvaluateOnNewDocument", identifier=added)
    assert "cannot be shown: out of order." in page.text("failed")
    assert "WebGL" not in page.text("failed")
    assert len(page.errors) == 1, "it is on the console"


def test_it_shows_command_statistics_checks_and_bare_regions(opened, result):
    words = opened.run("document.body.innerText")
    assert opened.text("command") == COMMAND
    assert opened.run("document.querySelector('h1').textContent") == NAME
    for fact in (
        f"{100 * result.area.coverage:.2f} %",
        f"{result.statistics.max:.2f}°",
        f"{result.statistics.p95:.2f}°",
        "130 × 110 mm",
        "beyond the blank",
        f"{result.checks.curvature_residual:.2g}°",
    ):
        assert fact in words, fact


def test_warnings_come_first():
    from dataclasses import replace

    small = gd.evaluate(gd.drape(shapes.plane(60.0, 40.0, 10.0), pitch=10.0))
    text = report_html.page(replace(small, warnings=("look <here>",)))
    assert "look &lt;here&gt;" in text
    assert text.index("look &lt;here&gt;") < text.index('class="tiles"')
    assert "Look at this first" not in report_html.page(small)


def test_the_same_drape_gives_the_same_page(result):
    assert report_html.page(result, COMMAND) == report_html.page(result, COMMAND)


def test_a_part_of_55_000_facets_stays_under_3_megabytes():
    part = samples.build("hemisphere", facets=55_000)
    text = report_html.page(gd.evaluate(gd.drape(part, angle=45.0, pitch=3.0)))
    assert len(part.triangles) > 50_000
    assert len(text.encode()) < 3e6
