"""A sealed truth: not readable at a glance, and provably the same before and after.

``seal.txt`` holds the SHA-256 of the truth's text and a random salt, fit to be printed before anybody solves the
set; ``truth.sealed`` holds both, masked. The truth holds the hashes of the files that it is the truth about. This
guards against looking by accident, not against an attacker.
"""

from __future__ import annotations

import base64
import hashlib
import json
import secrets
from pathlib import Path
from typing import Any

from geomdrap.errors import GeomdrapError

SALT = 16
OPEN = ("part.stl", "measured.csv", "setup.toml")
"""Files of a set that are for everybody to see."""


def seal(folder: Path, truth: dict[str, Any]) -> str:
    """Write ``truth`` sealed into ``folder``, with the hashes of the files there; gives the hash."""
    text, salt = json.dumps({**truth, "files": hashes(folder)}, indent=1).encode(), secrets.token_bytes(SALT)
    (folder / "truth.sealed").write_bytes(base64.encodebytes(salt + _masked(text, salt)))
    found = hashlib.sha256(text + salt).hexdigest()
    (folder / "seal.txt").write_text(found + "\n", encoding="utf-8")
    return found


def read_seal(folder: Path) -> str:
    """Read the hash of the sealed truth in ``folder``; GeomdrapError if there is none."""
    try:
        return (folder / "seal.txt").read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError):
        raise GeomdrapError(f"{folder} is no blind set: it has no seal.txt; make one with blind make") from None


def unseal(folder: Path) -> dict[str, Any]:
    """Read the truth in ``folder``; GeomdrapError if it is missing or is not the one that was sealed."""
    expected = read_seal(folder)
    try:
        data = base64.b64decode((folder / "truth.sealed").read_bytes())
    except (OSError, ValueError):
        raise GeomdrapError(f"{folder}/truth.sealed is missing or cannot be read; make the set again") from None
    salt, text = data[:SALT], _masked(data[SALT:], data[:SALT])
    if hashlib.sha256(text + salt).hexdigest() != expected:
        raise GeomdrapError(f"the seal of {folder} is broken: truth.sealed is not what seal.txt was made for")
    truth: dict[str, Any] = json.loads(text)
    return truth


def hashes(folder: Path) -> dict[str, str]:
    """SHA-256 of the open files that are in ``folder``, by their names."""
    there = [name for name in OPEN if (folder / name).exists()]
    return {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in there}


def _masked(text: bytes, salt: bytes) -> bytes:
    """XOR with a stream of hashes of the salt; its own inverse."""
    stream = b"".join(hashlib.sha256(salt + n.to_bytes(4, "big")).digest() for n in range(len(text) // 32 + 1))
    return bytes(a ^ b for a, b in zip(text, stream, strict=False))
