"""Set-ups as TOML."""

import pytest

import geomdrap as gd


@pytest.fixture
def setup(tmp_path):
    def read(text):
        path = tmp_path / "setup.toml"
        path.write_text(text)
        return gd.read_setup(path)

    return read


def test_all_keys_are_read(setup):
    s = setup(
        'origin = [1, 2.5, 3]\nangle = 45\npitch = 4\nsigma_xyz = 0.2\nsigma_shear = 1\nreference = [0, 1, 0]\n'
        "mark_spacing = 16\nmark_origin = [3, 4]\n"
    )
    assert s.origin == (1.0, 2.5, 3.0)
    assert (s.angle, s.pitch, s.sigma_xyz, s.sigma_shear) == (45.0, 4.0, 0.2, 1.0)
    assert s.reference == (0.0, 1.0, 0.0)
    assert (s.mark_spacing, s.mark_origin) == ((16.0, 16.0), (3.0, 4.0))


def test_what_is_not_there_is_none_and_the_origin_may_be_a_word(setup):
    assert setup("").angle is None
    assert setup('origin = "centroid"').origin == "centroid"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("sigma = 1", "'sigma' is not a key.*sigma_xyz"),
        ("angle = 'steep'", "angle must be a finite number, not 'steep'"),
        ("angle = nan", "angle must be a finite number"),
        ("angle = true", "angle must be a finite number"),
        ("origin = [1, 2]", "origin must be 3 finite numbers"),
        ("origin = [1, 2, inf]", "origin must be 3 finite numbers"),
        ("pitch = 0", "pitch must be above 0"),
        ("sigma_xyz = -1", "sigma_xyz must be above 0"),
        ("angle = ", "cannot read setup.toml as TOML"),
    ],
)
def test_what_is_wrong_is_named(setup, text, words):
    with pytest.raises(gd.MeasurementError, match=words):
        setup(text)


def test_a_missing_file_or_a_folder_is_named(tmp_path):
    with pytest.raises(gd.MeasurementError, match="no file"):
        gd.read_setup(tmp_path / "none.toml")
    with pytest.raises(gd.MeasurementError, match="folder"):
        gd.read_setup(tmp_path)
