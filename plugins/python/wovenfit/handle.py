"""An object of the library: freed once, and never while a call uses it."""

from __future__ import annotations

import contextlib
import threading
import weakref
from typing import TYPE_CHECKING, ClassVar

from .calls import free

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import TracebackType

    from typing_extensions import Self


class Handle:
    """Owns an object of the library.

    It is freed by `close`, at the end of a ``with`` block, when nothing refers to it any more, or
    when the interpreter ends, whichever comes first. Any thread may close it at any time: calls
    that are under way in other threads end first.
    """

    _free: ClassVar[str]
    """The function that frees it."""

    def __init__(self, address: int) -> None:
        self._address = address
        self._finalizer = weakref.finalize(self, free(self._free), address)
        self._guard = threading.Lock()
        self._users = 0
        self._closing = False

    @contextlib.contextmanager
    def _lent(self) -> Iterator[int]:
        """The address, kept alive for the time of a call."""
        with self._guard:
            if self._closing:
                raise ValueError(f"this {type(self).__name__} is closed")
            self._users += 1
        try:
            yield self._address
        finally:
            with self._guard:
                self._users -= 1
                last = self._closing and self._users == 0
            if last:
                self._finalizer()

    def close(self) -> None:
        """Frees the object; it can be used no more. Closing it again does nothing."""
        with self._guard:
            self._closing = True
            unused = self._users == 0
        if unused:
            self._finalizer()

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._closing

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
