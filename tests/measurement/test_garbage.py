"""Whatever the file holds, it is read or refused with a sentence."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import geomdrap as gd

QUICK = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
HEADINGS = ["x", "y", "z", "X", "u", "v", "i", "j", "shear", "warp_x", "warp_y", "warp_z", "sigma_xyz", "replicate", "", "x [m]"]
CELL = st.one_of(
    st.floats().map(repr), st.integers().map(str), st.sampled_from(["", "nan", "1e999", "1,5", '"', "-", "−3", "abc"])
)
TABLE = st.lists(st.lists(CELL, max_size=8), max_size=6)


def _read(path, **options):
    try:
        return gd.read_measurement(path, **options)
    except gd.GeomdrapError as error:
        assert str(error)
        assert "\n" not in str(error)
        return None


@QUICK
@given(st.binary(max_size=300))
def test_any_bytes(tmp_path, content):
    path = tmp_path / "any.csv"
    path.write_bytes(content)
    _read(path)


@QUICK
@given(st.text(max_size=200))
def test_any_text_after_a_good_header(tmp_path, text):
    path = tmp_path / "any.csv"
    path.write_text("x,y,z\n" + text, encoding="utf-8", errors="surrogatepass", newline="")
    _read(path)


@QUICK
@given(st.lists(st.sampled_from(HEADINGS), min_size=1, max_size=9), TABLE, st.sampled_from(",;\t"))
def test_any_table(tmp_path, header, rows, separator):
    path = tmp_path / "any.csv"
    path.write_text("\n".join(separator.join(row) for row in [header, *rows]), encoding="utf-8")
    _read(path, mark_spacing=None)


@QUICK
@given(st.text(max_size=120))
def test_any_setup(tmp_path, text):
    path = tmp_path / "setup.toml"
    path.write_text(text, encoding="utf-8", errors="surrogatepass")
    try:
        gd.read_setup(path)
    except gd.GeomdrapError as error:
        assert "\n" not in str(error)
