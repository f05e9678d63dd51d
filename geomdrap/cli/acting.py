"""The effects that a command line names."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geomdrap.fishnet import Effect


def effects_of(texts: tuple[str, ...], model: Path | None, plugins: tuple[Path, ...]) -> list[Effect]:
    """The effects of a model file and of the command line; plugins first, so that both may name theirs."""
    if not (texts or model or plugins):
        return []
    from geomdrap import effects

    for plugin in plugins:
        effects.load_plugin(plugin)
    return [*(effects.read_model(model) if model else ()), *map(effects.parse, texts)]


def said_of_model(taken: Sequence[str], model: Path) -> str:
    """That something of how the ply lies is taken from a model."""
    return f"{' and '.join(taken)} of the ply {'is that' if len(taken) == 1 else 'are those'} of {model.name}"
