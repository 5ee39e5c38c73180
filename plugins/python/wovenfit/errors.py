"""What is raised: a class for each status of the library, with the library's own text.

All are `WovenfitError`. Those that mean what a class of Python's own means are of that class, too:
`InvalidArgument` is a `ValueError`, `OutOfRange` an `IndexError`, `TimedOut` a `TimeoutError`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Callable, ClassVar, Optional

from .abi import Status

if TYPE_CHECKING:
    from .notes import Defect


class WovenfitError(Exception):
    """Anything that goes wrong here; its text says what, where and what to do.

    Attributes:
        status: the library's status; None where the library was not asked.
        elements: indices, counted from 0, of the faulty elements of the array that the text names,
            where they are known before the library is asked: rows that are not finite, or indices
            that no 32-bit number holds. At most ten.
    """

    status: ClassVar[Optional[Status]] = None

    def __init__(self, text: str, elements: tuple[int, ...] = ()) -> None:
        super().__init__(text)
        self.elements = elements


class LibraryError(WovenfitError, ImportError):
    """The shared library is not there, or cannot be used."""


class NullArgument(WovenfitError, TypeError):
    """Something that must be given is missing."""

    status = Status.NULL_ARGUMENT


class InvalidArgument(WovenfitError, ValueError):
    """An argument that cannot be: no number, out of its range, of the wrong shape or type."""

    status = Status.INVALID_ARGUMENT


class BufferTooSmall(WovenfitError):
    """A buffer was too small: a fault of this package."""

    status = Status.BUFFER_TOO_SMALL


class TooLarge(WovenfitError, ValueError):
    """More than the library takes; the text states the limit."""

    status = Status.TOO_LARGE


class NotUtf8(WovenfitError, ValueError):
    """A text is not UTF-8."""

    status = Status.NOT_UTF8


class AbiMismatch(LibraryError):
    """The library has another ABI number than this package was made for."""

    status = Status.ABI_MISMATCH


class NotReady(WovenfitError):
    """The job has not got that far."""

    status = Status.NOT_READY


class TimedOut(WovenfitError, TimeoutError):
    """The time to wait is over and the job runs."""

    status = Status.TIMEOUT


class Cancelled(WovenfitError):
    """The job was cancelled."""

    status = Status.CANCELLED


class OutOfRange(WovenfitError, IndexError):
    """No element has this index."""

    status = Status.OUT_OF_RANGE


class DesignError(WovenfitError, ValueError):
    """The design breaks a rule of the design file."""

    status = Status.DESIGN


class ParameterError(WovenfitError, ValueError):
    """No parameter has this name, or it cannot take the value."""

    status = Status.PARAMETER


class SurfaceError(WovenfitError):
    """The surface is broken; `defects` lists what is wrong with it, and where."""

    status = Status.SURFACE

    _find_defects: Optional[Callable[[], tuple[Defect, ...]]] = None

    @property
    def defects(self) -> tuple[Defect, ...]:
        """Every defect with its place, vertices and triangles.

        Asking checks the mesh again, in about a second for 250,000 triangles.
        """
        return () if self._find_defects is None else self._find_defects()


class UnitError(WovenfitError):
    """The surface is not of a limb's size in its unit."""

    status = Status.UNIT


class SeamError(WovenfitError):
    """Region, seams or orientation are impossible."""

    status = Status.SEAM


class PressureError(WovenfitError):
    """A wanted pressure lies off the surface or outside the region."""

    status = Status.PRESSURE


class ParameterizationError(WovenfitError):
    """The cut surface has no parameterization."""

    status = Status.PARAMETERIZATION


class FitError(WovenfitError):
    """The fit is impossible."""

    status = Status.FIT


class MappingError(WovenfitError):
    """The fabric does not cover the surface."""

    status = Status.MAPPING


class PreparedForAnother(WovenfitError):
    """The prepared limb is for another region, seams, facing, unit or parameter.

    Start a job on the mesh instead.
    """

    status = Status.PREPARED_FOR_ANOTHER


class InternalError(WovenfitError):
    """A fault of the library, to be reported with its text."""

    status = Status.INTERNAL


def _all(base: type[WovenfitError]) -> list[type[WovenfitError]]:
    return [base, *(deeper for one in base.__subclasses__() for deeper in _all(one))]


BY_STATUS: dict[int, type[WovenfitError]] = {
    int(kind.status): kind for kind in _all(WovenfitError) if kind.status is not None
}


class UnknownStatus(WovenfitError):
    """The library returned a status that this package does not know; `number` is it."""

    def __init__(self, text: str, number: int) -> None:
        super().__init__(f"status {number}: {text}")
        self.number = number


def error_of(status: int, text: str) -> WovenfitError:
    """The exception for a status that is a failure."""
    kind = BY_STATUS.get(status)
    return UnknownStatus(text, status) if kind is None else kind(text)
