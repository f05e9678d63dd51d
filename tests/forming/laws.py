"""Cloths for tests: yarns alone, resin alone."""

from __future__ import annotations

from geomdrap.forming import ELASTIC, Cloth, Fibre, Resin

NO_YARNS = Fibre(modulus=0.0)
STRAIGHT = Fibre(undulation=0.0, compression=1.0)


def resin_alone(**resin: object) -> Cloth:
    """A membrane without yarns, elastic unless told otherwise."""
    return Cloth(NO_YARNS, NO_YARNS, Resin(**{"relaxation": ELASTIC, **resin}))  # type: ignore[arg-type]


def yarns_alone(fibre: Fibre) -> Cloth:
    """Yarns without resin."""
    return Cloth(fibre, fibre, Resin(modulus=0.0, relaxation=ELASTIC))
