"""An object of the library: freed once, and never while a call uses it."""

from __future__ import annotations

import contextlib
import threading
import weakref
from typing import TYPE_CHECKING, ClassVar, Optional

from .calls import free

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import TracebackType

    from typing_extensions import Self


class _Owned:
    """Frees an object when the last reference to it goes, or when the interpreter ends.

    A handle has one reference, and every call that is under way another: Python counts them.
    """

    def __init__(self, address: int, function: str) -> None:
        self.address = address
        self.finalizer = weakref.finalize(self, free(function), address)


class Handle:
    """Owns an object of the library.

    It is freed by `close`, at the end of a ``with`` block, when nothing refers to it any more, or
    when the interpreter ends, whichever comes first. Any thread may close it at any time: calls
    that are under way in other threads end first.
    """

    _free: ClassVar[str]
    """The function that frees it."""

    def __init__(self, address: int) -> None:
        self._owned: Optional[_Owned] = _Owned(address, self._free)

    @contextlib.contextmanager
    def _lent(self) -> Iterator[int]:
        """The address, kept alive for the time of a call."""
        owned = self._owned
        if owned is None:
            raise ValueError(f"this {type(self).__name__} is closed")
        yield owned.address

    def _again(self) -> Self:
        """Another handle of the same object, which lives until both are closed."""
        twin = type(self).__new__(type(self))
        vars(twin).update(vars(self))
        return twin

    def close(self) -> None:
        """Frees the object; it can be used no more. Closing it again does nothing."""
        self._owned = None

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._owned is None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()


class Changeable(Handle):
    """An object that one thread at a time may change: its calls wait for each other."""

    def __init__(self, address: int) -> None:
        super().__init__(address)
        self._turn = threading.RLock()

    @contextlib.contextmanager
    def _lent(self) -> Iterator[int]:
        with self._turn, super()._lent() as address:
            yield address


@contextlib.contextmanager
def lent(handle: Handle | None) -> Iterator[int | None]:
    """The address of an object that may be left out."""
    if handle is None:
        yield None
    else:
        with handle._lent() as address:
            yield address
