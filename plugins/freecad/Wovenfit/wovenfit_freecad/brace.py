"""The brace: what is wanted, as properties; its recomputation is the flattening."""

from __future__ import annotations

from typing import Any

import wovenfit

from . import looks, places, properties, watching
from .computation import Inputs, Results, inputs_of
from .quantities import LENGTH, PRESSURE, quantity
from .scripted import HIDDEN, OUTPUT, READ_ONLY, Scripted, ensure, is_scripted
from .words import in_words_of_the_host


class OutOfDate(RuntimeError):
    """Inputs have changed, and the brace waits for the command to flatten."""


class Brace(Scripted):
    """The proxy of a brace.

    The object is invalid, with the reason as its status, whenever its pattern does not belong to
    its properties; what hangs on it is then empty and invalid, too.
    """

    _results: Results | None = None
    _failure = ""

    def __init__(self, obj: Any) -> None:
        obj.Proxy = self
        _add_properties(obj)

    @property
    def results(self) -> Results:
        """The patterns at hand."""
        if self._results is None:
            self._results = Results()
        return self._results

    def onDocumentRestored(self, obj: Any) -> None:
        """After opening or pasting: adds what this version has more."""
        _add_properties(obj)
        watching.begin()
        looks.opened(obj)

    def mustExecute(self, obj: Any) -> bool:
        """Whether a recomputation must not pass over it: what is there is no valid result of this
        version."""
        return not obj.ComputedFor or obj.ComputedBy != wovenfit.version()

    def execute(self, obj: Any) -> None:
        """Flattens, if what was computed last is for other inputs.

        Raises:
            ValueError, RuntimeError: what is wrong; FreeCAD makes it the object's status.
        """
        try:
            inputs = inputs_of(obj)
            if obj.ComputedFor == inputs.key and not self._failure and not self.mustExecute(obj):
                return
            if not (obj.Automatic or self.results.has(inputs)):
                raise OutOfDate(
                    "out of date: something has changed since the last flattening. Use the command "
                    "Flatten, or set Automatic"
                )
            pattern = self.results.compute(inputs)
            self._failure = ""
            _publish(obj, inputs, pattern)
        except wovenfit.WovenfitError as error:
            text = in_words_of_the_host(obj, str(error))
            self._fail(obj, text)
            raise RuntimeError(text) from None
        except Exception as error:
            self._fail(obj, str(error))
            raise

    def pattern(self, obj: Any) -> wovenfit.Pattern:
        """The pattern of a brace that is up to date; computed once more after a reopening.

        Raises:
            RuntimeError: if the brace is invalid, with its reason.
        """
        if self._failure:
            raise RuntimeError(f"{obj.Label} is invalid: {self._failure}")
        inputs = inputs_of(obj)
        if obj.ComputedFor != inputs.key:
            raise RuntimeError(f"{obj.Label} is out of date: recompute it first")
        return self.results.compute(inputs)

    def recomputed(self, obj: Any) -> wovenfit.Pattern:
        """The same for what is recomputed right after the brace, whose properties are then as they
        were: without reading its mesh once more.

        Raises:
            RuntimeError: as `pattern`.
        """
        held = None if self._failure else self.results.held(obj.ComputedFor)
        return self.pattern(obj) if held is None else held

    def _fail(self, obj: Any, text: str) -> None:
        self._failure = text
        obj.ComputedFor = ""
        _clear(obj)
        # FreeCAD passes over what depends on an invalid object and leaves it looking valid.
        for child in children(obj):
            child.recompute()
            for other in _dependents(child):
                other.recompute()


def is_brace(obj: Any) -> bool:
    """Whether an object is a brace."""
    return is_scripted(obj, Brace)


def children(brace: Any) -> list[Any]:
    """What shows a brace's result: patterns and worn surfaces."""
    return [obj for obj in brace.InList if getattr(obj, "Brace", None) == brace]


def _dependents(obj: Any) -> list[Any]:
    """What hangs on an object, such as drawings of it, each after what it hangs on itself."""
    return sorted(obj.InListRecursive, key=lambda other: len(other.OutListRecursive))


def _add_properties(obj: Any) -> None:
    ensure(
        obj,
        "App::PropertyLinkSubGlobal",
        "Source",
        "Brace",
        "The scanned limb: a mesh, or a shape of whose faces all or those named are taken.",
    )
    if ensure(
        obj,
        "App::PropertyLength",
        "EdgeLength",
        "Brace",
        "Longest edge of the triangles into which a shape is divided; a mesh is taken as it is. On "
        "a limb of radius r it departs from the shape by EdgeLength squared over 8 r.",
    ):
        obj.EdgeLength = quantity(4.0, LENGTH)
    if ensure(
        obj,
        "App::PropertyBool",
        "Automatic",
        "Brace",
        "Flatten whenever something changes. Off: the brace is marked out of date instead, until "
        "the command Flatten.",
    ):
        obj.Automatic = True
    for row in (*properties.wishes(), *properties.parameters()):
        row.add(obj)
    places.add_all(obj)
    shown = READ_ONLY | OUTPUT
    for kind, name, text in (
        ("App::PropertyLength", "Width", "Extent of the pattern along warp, round the limb."),
        ("App::PropertyLength", "Height", "Extent of the pattern along weft, along the limb."),
        ("App::PropertyArea", "Area", "Area of the pattern."),
        ("App::PropertyBool", "AllPressuresMet", "Whether every wanted pressure is computed."),
        ("App::PropertyStringList", "Warnings", "What to know before cutting."),
    ):
        ensure(obj, kind, name, "Result", text, shown)
    secret = READ_ONLY | OUTPUT | HIDDEN
    ensure(obj, "App::PropertyString", "ComputedFor", "Result", "The inputs of the result.", secret)
    ensure(obj, "App::PropertyString", "ComputedBy", "Result", "The library's version.", secret)


def _publish(obj: Any, inputs: Inputs, pattern: wovenfit.Pattern) -> None:
    figures = pattern.figures
    obj.Width, obj.Height, obj.Area = figures.width_mm, figures.height_mm, figures.area_mm2
    obj.AllPressuresMet = all(row.met for row in pattern.pressures)
    said = [note.message for note in pattern.warnings]
    for n, row in zip(places.pressures(obj), pattern.pressures):
        setattr(obj, f"PressureComputed{n}", quantity(row.got_kpa, PRESSURE))
        if row.reason is not None:
            said.append(f"Pressure{n}: {row.reason.message}")
    obj.Warnings = [in_words_of_the_host(obj, text) for text in said]
    obj.ComputedFor, obj.ComputedBy = inputs.key, wovenfit.version()


def _clear(obj: Any) -> None:
    obj.Width, obj.Height, obj.Area = 0, 0, 0
    obj.AllPressuresMet = False
    obj.Warnings = []
    for name in obj.PropertiesList:
        if name.startswith("PressureComputed"):
            setattr(obj, name, 0)
