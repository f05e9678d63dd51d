"""Logarithm and exponential from products and sums alone, so that loops over many elements vectorise.

Calls into a mathematical library stop the compiler from doing eight elements at once.
"""

from __future__ import annotations

from geomdrap.geodesic.compiled import inlined

LN2 = 0.6931471805599453


@inlined
def ln(x: float) -> float:
    """Natural logarithm, to the last digits for x between 2⁻¹⁵ and 2¹⁵; x must be positive.

    Powers of two are split off until x lies within √2 of one; there ln x = 2 artanh((x − 1)/(x + 1)).
    """
    e = 0.0
    e = e - 8.0 if x < 0.005524271728019903 else e
    x = x * 256.0 if x < 0.005524271728019903 else x
    e = e - 4.0 if x < 0.08838834764831845 else e
    x = x * 16.0 if x < 0.08838834764831845 else x
    e = e - 2.0 if x < 0.3535533905932738 else e
    x = x * 4.0 if x < 0.3535533905932738 else x
    e = e - 1.0 if x < 0.7071067811865476 else e
    x = x * 2.0 if x < 0.7071067811865476 else x
    e = e + 8.0 if x > 181.01933598375618 else e
    x = x * 0.00390625 if x > 181.01933598375618 else x
    e = e + 4.0 if x > 11.313708498984761 else e
    x = x * 0.0625 if x > 11.313708498984761 else x
    e = e + 2.0 if x > 2.8284271247461903 else e
    x = x * 0.25 if x > 2.8284271247461903 else x
    e = e + 1.0 if x > 1.4142135623730951 else e
    x = x * 0.5 if x > 1.4142135623730951 else x
    s = (x - 1.0) / (x + 1.0)
    z = s * s
    p = 1.0 / 21.0
    p = p * z + 1.0 / 19.0
    p = p * z + 1.0 / 17.0
    p = p * z + 1.0 / 15.0
    p = p * z + 1.0 / 13.0
    p = p * z + 1.0 / 11.0
    p = p * z + 1.0 / 9.0
    p = p * z + 1.0 / 7.0
    p = p * z + 1.0 / 5.0
    p = p * z + 1.0 / 3.0
    return 2.0 * s * (1.0 + z * p) + e * LN2


@inlined
def exp_of_negative(x: float) -> float:
    """Exponential, to 14 digits, for x ≤ 0; below −40 it is that of −40, which no sum of ours can tell from 0.

    The series for x/64, squared six times.
    """
    y = (x if x > -40.0 else -40.0) * 0.015625
    p = 1.0 / 6227020800.0
    p = p * y + 1.0 / 479001600.0
    p = p * y + 1.0 / 39916800.0
    p = p * y + 1.0 / 3628800.0
    p = p * y + 1.0 / 362880.0
    p = p * y + 1.0 / 40320.0
    p = p * y + 1.0 / 5040.0
    p = p * y + 1.0 / 720.0
    p = p * y + 1.0 / 120.0
    p = p * y + 1.0 / 24.0
    p = p * y + 1.0 / 6.0
    p = p * y + 0.5
    p = p * y + 1.0
    p = p * y + 1.0
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    return p * p
