"""How the library is called: failures become exceptions, texts and arrays are fetched whole.

ctypes lets other Python threads run during every call.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Callable

import numpy as np

from .abi import Status
from .errors import InvalidArgument, NotUtf8, NullArgument, error_of
from .library import library

if TYPE_CHECKING:
    import numpy.typing as npt


def _text_of(error: ctypes.c_void_p) -> str:
    lib = library()
    try:
        needed = ctypes.c_size_t()
        lib.wovenfit_error_text(error, None, 0, ctypes.byref(needed))
        buffer = ctypes.create_string_buffer(needed.value)
        lib.wovenfit_error_text(error, buffer, needed.value, ctypes.byref(needed))
        return buffer.value.decode()
    finally:
        lib.wovenfit_error_free(error)


def call(name: str, *arguments: object) -> None:
    """Calls a function that ends with `error`.

    Raises:
        WovenfitError: of the class of the status, with the library's text.
    """
    error = ctypes.c_void_p()
    status = getattr(library(), name)(*arguments, ctypes.byref(error))
    if status != Status.OK:
        raise error_of(status, _text_of(error))


def new(name: str, *arguments: object) -> int:
    """Calls a function that gives an object; its address."""
    made = ctypes.c_void_p()
    call(name, *arguments, ctypes.byref(made))
    if made.value is None:
        raise error_of(Status.INTERNAL, f"{name} gave no object")
    return made.value


def count(name: str, *arguments: object) -> int:
    """Calls a function whose only output is a number of elements."""
    number = ctypes.c_size_t()
    call(name, *arguments, ctypes.byref(number))
    return number.value


def text(name: str, *arguments: object) -> bytes:
    """Calls a function that gives a text; its bytes, which are UTF-8."""
    needed = count(name, *arguments, None, 0)
    buffer = ctypes.create_string_buffer(needed)
    count(name, *arguments, buffer, needed)
    return buffer.raw[:-1]


def _array(kind: Any, dtype: npt.DTypeLike, name: str, arguments: tuple[object, ...]) -> Any:
    values = np.empty(count(name, *arguments, None, 0), dtype)
    count(name, *arguments, values.ctypes.data_as(ctypes.POINTER(kind)), values.size)
    return values


def data(name: str, *arguments: object) -> bytes:
    """Calls a function that gives bytes."""
    values: npt.NDArray[np.uint8] = _array(ctypes.c_uint8, np.uint8, name, arguments)
    return values.tobytes()


def doubles(name: str, *arguments: object) -> npt.NDArray[np.float64]:
    """Calls a function that gives 64-bit numbers."""
    values: npt.NDArray[np.float64] = _array(ctypes.c_double, np.float64, name, arguments)
    return values


def indices(name: str, *arguments: object) -> npt.NDArray[np.uint32]:
    """Calls a function that gives indices."""
    values: npt.NDArray[np.uint32] = _array(ctypes.c_uint32, np.uint32, name, arguments)
    return values


def c_text(value: str, name: str) -> bytes:
    """A text for the library.

    Raises:
        NullArgument: if it is no `str`.
        NotUtf8: if it has no UTF-8, as lone surrogates have none.
        InvalidArgument: if it contains the NUL that would end it.
    """
    if not isinstance(value, str):
        raise NullArgument(f"`{name}` is a {type(value).__name__}: give a str")
    if "\0" in value:
        raise InvalidArgument(f"`{name}` contains a NUL at {value.index(chr(0))}: leave it out")
    try:
        return value.encode()
    except UnicodeEncodeError as error:
        raise NotUtf8(f"`{name}` is not UTF-8 text: {error}") from error


def place(name: str, *arguments: object) -> tuple[float, float, float] | None:
    """Calls a function that gives a place in mm; None if it is at no one place."""
    at = (ctypes.c_double * 3)()
    call(name, *arguments, at)
    x, y, z = at
    return None if x != x else (x, y, z)  # NaN


def free(name: str) -> Callable[[int], None]:
    """The function that frees an object, looked up now and called when the object goes."""
    function: Callable[[int], None] = getattr(library(), name)
    return function
