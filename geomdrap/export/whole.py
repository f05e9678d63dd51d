"""Files that are either whole or untouched: written under a temporary name, then renamed."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from geomdrap.errors import GeomdrapError


def write_whole(path: Path, data: bytes | str) -> None:
    """Write ``data`` to ``path`` in one piece: readers see the old file or the new one, never a half.

    Text is written as UTF-8 with its line ends as they are. Raises `GeomdrapError` if the folder is
    missing, full or not writable; the old file then stays as it was.
    """
    raw = data.encode("utf-8") if isinstance(data, str) else data
    with whole_file(path) as temporary:
        temporary.write_bytes(raw)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Give a temporary path next to ``path`` (same suffix), renamed to it if the block ends well.

    For libraries that insist on opening the file themselves. If the block raises, the temporary file is
    removed and the old file stays; an `OSError` becomes a `GeomdrapError`.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        raise _cannot_write(path, error) from error
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def whole_folder(folder: Path) -> Iterator[Path]:
    """Give an empty scratch folder whose files all move into ``folder`` together if the block ends well.

    Nothing in ``folder`` changes before the last of the files is complete. ``folder`` is made if it is
    missing. Raises `GeomdrapError` if it cannot be written.
    """
    check_writable(folder)
    scratch = folder / f".geomdrap-{secrets.token_hex(4)}"
    try:
        scratch.mkdir(parents=True)
        yield scratch
        finished = sorted(scratch.iterdir())
        for file in finished:
            _refuse_folder(folder / file.name)
        for file in finished:
            os.replace(file, folder / file.name)
    except OSError as error:
        raise _cannot_write(folder, error) from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def check_writable(folder: Path) -> None:
    """Raise `GeomdrapError` if files could not be written to ``folder``, which need not exist yet.

    Made for the start of a long run: what can be known to fail at its end is said before it begins.
    """
    existing = Path(folder)
    try:
        while not existing.exists() and existing != existing.parent:
            existing = existing.parent
        is_folder = existing.is_dir()
    except OSError as error:  # a name too long, a parent that may not be entered
        raise _cannot_write(folder, error) from error
    if not is_folder:
        raise GeomdrapError(f"cannot write results to {folder}: {existing} is a file, not a folder")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise GeomdrapError(f"cannot write results to {folder}: no permission to write in {existing}")


def _refuse_folder(target: Path) -> None:
    if target.is_dir():
        raise GeomdrapError(f"cannot write {target}: a folder of that name is in the way")


def _cannot_write(path: Path, error: OSError) -> GeomdrapError:
    return GeomdrapError(f"cannot write {path}: {error.strerror or error}")
