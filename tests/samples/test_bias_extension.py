"""The bias-extension script tells the story of a real measurement and draws it."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np

SCRIPT = Path(__file__).parents[2] / "samples" / "bias_extension.py"


def test_the_story_names_the_failure_the_winner_and_the_doubt(tmp_path, capsys):
    spec = importlib.util.spec_from_file_location("bias_extension", SCRIPT)
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    script.main(tmp_path)
    text = capsys.readouterr().out
    assert "5.74   8.87" in text
    assert "0.68   0.44" in text
    assert "ambiguous: slip or saturation" in text
    from matplotlib.image import imread

    picture = imread(tmp_path / "bias-extension.png")
    assert min(picture.shape[:2]) > 500
    assert np.ptp(picture[..., :3].reshape(-1, 3), axis=0).min() > 0.5  # not blank
