"""shear.png: yarns, colours and layout by exact checks, the page by what stands on it."""

import io

import numpy as np
import pytest
from made_up import made_up_drape
from PIL import Image

from geomdrap.errors import GeomdrapError
from geomdrap.export import palette, picture
from geomdrap.export.flat_map import longer, spread
from geomdrap.export.layout import Box, Panel, arrangements, best_page
from geomdrap.export.legend import position
from geomdrap.export.yarns import choose_yarns, smooth


def test_smooth_lines_pass_through_the_nodes_and_hug_a_circle():
    t = np.linspace(0, 1.5, 7)
    nodes = np.column_stack([np.cos(t), np.sin(t), 0 * t])
    line = smooth(nodes, 4)
    np.testing.assert_allclose(line[::4], nodes, atol=1e-12)
    inner = line[4:-4]  # away from the ends, where a neighbour is missing
    assert np.abs(np.hypot(inner[:, 0], inner[:, 1]) - 1).max() < 2e-3  # chords: 8e-3


def test_gaps_in_a_yarn_stay_gaps():
    nodes = np.column_stack([np.arange(8.0), np.zeros(8), np.zeros(8)])
    nodes[3] = np.nan
    line = smooth(nodes, 2)
    known = ~np.isnan(line[:, 0])
    assert known[:4].all()
    assert known[8:].all()
    assert not known[5:8].any()
    np.testing.assert_allclose(line[known][:, 0], np.arange(0, 7.5, 0.5)[known], atol=1e-12)


def test_a_dense_net_is_thinned_about_the_yarns_of_the_origin():
    drape = made_up_drape(pitch=2.0)
    yarns = choose_yarns(drape.net, 7.0)
    assert yarns.every == 5
    assert any(np.allclose(line[:, 1], 0) for line in yarns.warp)
    assert any(np.allclose(line[:, 0], 0) for line in yarns.weft)
    assert len(yarns.warp) == len(range(-35, 36, 5))


def test_shear_is_carried_to_the_cells_beside_the_net():
    shear = np.array([[-10.0, np.nan, np.nan, np.nan]])
    np.testing.assert_array_equal(spread(shear, 2)[2], [10, 10, 10, 10, 10, np.nan, np.nan, np.nan])
    np.testing.assert_array_equal(longer(np.array([0.0, 2.0, 5.0]), 2), [-4, -2, 0, 2, 5, 8, 11])


def test_classes_change_at_half_the_limit_and_at_the_limit():
    shear = np.array([0, -22.5, 22.6, -45, 45.1, -80, np.nan])
    np.testing.assert_array_equal(palette.class_of(shear, 45.0), [0, 0, 1, 1, 2, 2, np.nan])


@pytest.mark.parametrize(
    ("largest", "top"), [(0.02, 5), (5.0, 5), (5.1, 10), (52.4, 55), (89.0, 70), (np.nan, 5)]
)
def test_the_scale_ends_at_a_round_angle(largest, top):
    assert palette.top_of_scale(largest, 45.0) == top


def test_all_arrangements_fill_the_page_without_overlap():
    page = Box(0.0, 0.0, 15.0, 8.0)
    for boxes in arrangements(page):
        assert sum(box.width * box.height for box in boxes) == pytest.approx(15 * 8)
        for box in boxes:
            assert box.left >= 0
            assert box.bottom >= -1e-12
            assert box.left + box.width <= 15 + 1e-9
            assert box.bottom + box.height <= 8 + 1e-9


@pytest.mark.parametrize(("aspect", "stacked"), [(10.0, True), (0.1, False)])
def test_long_pictures_are_stacked_and_tall_ones_stand_side_by_side(aspect, stacked):
    _, boxes = best_page(15.0, (5.0, 8.0), [Panel(aspect, (0.1, 0.1, 0.1, 0.1))] * 3)
    assert (len({box.left for box in boxes}) == 1) == stacked
    assert (len({box.bottom for box in boxes}) == 1) == (not stacked)


@pytest.mark.parametrize(
    ("diagonal", "words"), [(300.0, "0, 16.7, 0"), (3.0, "0, 16.741, 0"), (0.03, "0, 16.74149, -0.00004")]
)
def test_positions_have_as_many_decimals_as_the_part_deserves(diagonal, words):
    assert position((-1e-13, 16.741494, -4e-5), diagonal) == words


def words_on(figure):
    return [text.get_text() for text in figure.texts]


def test_the_page_says_what_was_draped_and_how():
    words = " | ".join(words_on(picture.draw(made_up_drape(source="parts/x/bonnet.stl", pitch=8.0))))
    for expected in (
        "bonnet.stl",
        "warp at 0°",
        "pitch 8 mm",
        "38.0°",
        "100.0 %",
        "over 45°, the limit",
        "200 × 140 mm",
    ):
        assert expected in words
    assert "/tmp" not in words
    assert "INCOMPLETE" not in words


def test_an_incomplete_drape_and_its_warnings_stand_on_the_page():
    from types import SimpleNamespace

    bare = [SimpleNamespace(area=2800.0, center=(90.0, 0.0, 0.0), reason="the net ends at a folded cell")]
    drape = made_up_drape(coverage=0.9, bare=bare, warnings=["the pitch is below the edge length"])
    words = words_on(picture.draw(drape))
    assert "INCOMPLETE: 10.0 % of the part is not draped." in words
    assert "the pitch is below the edge length" in words
    assert any("folded cell" in line and "(90, 0, 0)" in line for line in words)


def test_many_warnings_are_cut_short_and_say_so():
    words = words_on(picture.draw(made_up_drape(warnings=[f"warning {k}" for k in range(30)])))
    assert "warning 6" in words
    assert "warning 9" not in words
    assert any("23 more" in line for line in words)


@pytest.mark.parametrize(
    "shape",
    [
        {},
        {"width": 1000.0, "height": 100.0},
        {"width": 100.0, "height": 1000.0},
        {"width": 5.0, "height": 4.0, "rise": 1.0},
        {"width": 5000.0, "height": 3000.0, "rise": 500.0},
        {"rise": 0.0},
        {"most": 300.0},
        {"coverage": 0.3},
    ],
)
def test_a_part_of_any_shape_gives_a_whole_png(tmp_path, shape):
    picture.write(made_up_drape(n=24, **shape), tmp_path / "shear.png")
    image = Image.open(io.BytesIO((tmp_path / "shear.png").read_bytes()))
    image.load()
    assert image.size[0] == picture.WIDTH * picture.DOTS
    assert len(np.unique(np.asarray(image.convert("L")))) > 50


def test_words_do_not_run_into_one_another_or_off_the_page(tmp_path):
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    for shape in ({}, {"width": 100.0, "height": 1000.0}, {"width": 5000.0, "height": 3000.0}):
        figure = picture.draw(
            made_up_drape(n=20, warnings=["one"], coverage=0.9, source="a" * 90 + ".stl", **shape)
        )
        renderer = FigureCanvasAgg(figure).get_renderer()
        places = [text.get_window_extent(renderer) for text in figure.texts]
        for k, place in enumerate(places):
            assert place.x0 >= 0
            assert place.x1 <= figure.bbox.x1
            for other in places[:k]:
                assert not place.overlaps(other), (figure.texts[k].get_text(), shape)


def test_two_writes_give_the_same_bytes_without_the_drawing_program_in_them(tmp_path):
    drape = made_up_drape(n=20)
    for name in ("a.png", "b.png"):
        picture.write(drape, tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    assert "Software" not in Image.open(tmp_path / "a.png").info


def test_a_drape_without_a_pattern_is_still_drawn(tmp_path):
    drape = made_up_drape(n=20)
    drape.flat.outer = drape.flat.inner = drape.flat.warp_lines = drape.flat.weft_lines = ()
    picture.write(drape, tmp_path / "shear.png")
    assert (tmp_path / "shear.png").stat().st_size > 10_000


def test_a_missing_folder_is_an_error_that_names_the_file(tmp_path):
    with pytest.raises(GeomdrapError, match=r"shear\.png"):
        picture.write(made_up_drape(n=20), tmp_path / "missing" / "shear.png")
