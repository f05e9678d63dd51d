"""Effects of the user's own, from a Python file."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from pathlib import Path

from geomdrap.effects.guard import guard
from geomdrap.effects.registry import register
from geomdrap.errors import EffectError
from geomdrap.fishnet import Effect


def load_plugin(path: str | Path) -> tuple[str, ...]:
    """Run a Python file and register every effect with a name that it defines; their names.

    Raises EffectError where the file cannot be read or run, or has no such effect. Where the methods of these effects
    fail later on, they raise PluginError.
    """
    file = Path(path)
    if not file.is_file():
        raise EffectError(f"plugin {file}: there is no such file")
    name = f"geomdrap_plugin_{hashlib.sha256(str(file.resolve()).encode()).hexdigest()[:12]}"
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise EffectError(f"plugin {file} is no Python file; its name must end in .py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # so that its effects can be pickled within this process
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # the user's code may raise anything
        del sys.modules[name]
        raise EffectError(f"plugin {file} does not run: {type(error).__name__}: {error}") from error
    own = [v for v in vars(module).values() if isinstance(v, type) and issubclass(v, Effect) and v.__module__ == name]
    named = [effect for effect in own if effect.name]
    if not named:
        raise EffectError(f"plugin {file} has no effect: it needs a subclass of geomdrap.Effect with a name")
    for effect in own:
        guard(effect, f"plugin {file.name}")
    return tuple(register(effect).name for effect in named)
