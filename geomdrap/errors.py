"""Errors that a user can act on: one sentence that names the thing and says what to do."""

from __future__ import annotations


class GeomdrapError(Exception):
    """Bad input or usage. The command line prints it in one line and exits with code 2."""


class SurfaceError(GeomdrapError):
    """The part cannot be read or is not a surface that can be draped."""


class DrapeError(GeomdrapError):
    """The drape cannot start or cannot be carried out as asked (seed, heading, pitch, blank)."""


class MeasurementError(GeomdrapError):
    """A measured table or its set-up cannot be read, or does not fit the part."""


class EffectError(GeomdrapError):
    """An effect is unknown, its parameters are not what it takes, or it cannot act on this part."""


class PluginError(GeomdrapError):
    """An effect of the user's own fails or returns what it must not.

    A search passes over models that cannot be draped, but not over mistakes in a program.
    """


class SweepError(GeomdrapError):
    """The cases of a sweep cannot be read, or cannot be run where they should."""


class FormingError(GeomdrapError):
    """A material, a mesh or a run of the mechanical model is not as it must be, or the run did not end well."""


def interrupt_within(error: BaseException) -> KeyboardInterrupt | None:
    """Give the interrupt from the keyboard that an error is, or that came while a compiled kernel ran.

    Such a kernel returns as if all were well, which Python reports as a SystemError with the interrupt as its cause.
    """
    if isinstance(error, KeyboardInterrupt):
        return error
    if not isinstance(error, SystemError):
        return None
    reason = error.__cause__ or error.__context__
    return None if reason is None else interrupt_within(reason)
