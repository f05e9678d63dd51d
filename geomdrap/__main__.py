"""``geomdrap`` and ``python -m geomdrap``."""

from __future__ import annotations


def main() -> None:
    """Run the command line."""
    from geomdrap.cli import cli

    cli(prog_name="geomdrap")


if __name__ == "__main__":
    main()
