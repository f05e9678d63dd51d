"""The effects that a command line names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from geomdrap.errors import DrapeError, EffectError

if TYPE_CHECKING:
    from geomdrap.fishnet import Effect


def effects_of(texts: tuple[str, ...], model: Path | None, plugins: tuple[Path, ...]) -> list[Effect]:
    """The effects of a model file and of the command line; plugins first, so that both may name theirs.

    Raises EffectError for an effect that is given more than once.
    """
    if not (texts or model or plugins):
        return []
    from geomdrap import effects

    for plugin in plugins:
        effects.load_plugin(plugin)
    acting = [*(effects.read_model(model) if model else ()), *map(effects.parse, texts)]
    names = [effect.name for effect in acting]
    for name in names:
        if names.count(name) > 1:
            where = f"--effect and the model {model.name}" if model else "--effect"
            raise EffectError(f"effect {name} is given more than once ({where}): give it once, with all its values")
    return acting


@contextmanager
def blaming(model: Path | None, taken: Sequence[str]) -> Iterator[None]:
    """Name the model in what is said against an origin or a reference that was ``taken`` from it."""
    try:
        yield
    except DrapeError as error:
        mistaken = [name for name in taken if str(error).removeprefix("the ").startswith(name)]
        if model is None or not mistaken:
            raise
        raise DrapeError(f"model {model.name}: {error}, or give another --{mistaken[0]}") from error


def said_of_model(taken: Sequence[str], model: Path) -> str:
    """That something of how the ply lies is taken from a model."""
    return f"{' and '.join(taken)} of the ply {'is that' if len(taken) == 1 else 'are those'} of {model.name}"
