"""The brace's wishes at places: pressures, orientation, seams, region, bony places.

A pressure is a pair of properties, `Pressure1` and `PressurePlace1`, so that each is a quantity
that an expression can drive; beside them stands what was computed. A seam is a list of points.
"""

from __future__ import annotations

import re
from typing import Any

import FreeCAD

from .quantities import PRESSURE, number
from .scripted import OUTPUT, READ_ONLY, ensure

_PRESSURE = re.compile(r"Pressure(\d+)")
_PLACE = re.compile(r"PressurePlace(\d+)")
_SEAM = re.compile(r"Seam(\d+)")


def add_all(obj: Any) -> None:
    """Adds the properties that every brace has, unless they are there."""
    ensure(
        obj,
        "App::PropertyVectorList",
        "Orientation",
        "Orientation",
        "Two places on the limb in mm, the first near the body: in the pattern they stand above "
        "each other, the weft direction. Empty: the limb's own direction.",
    )
    ensure(
        obj,
        "App::PropertyLinkListGlobal",
        "RegionPlanes",
        "Region",
        "Planes that bound the brace; it covers the side to which their own z axes point.",
    )
    ensure(
        obj,
        "App::PropertyIntegerList",
        "RegionFacets",
        "Region",
        "Facets of the source mesh that the brace covers, counted from 0. Empty: all of them.",
    )
    ensure(
        obj,
        "App::PropertyVectorList",
        "BonyPlaces",
        "Limits",
        "Places in mm where bone lies under the skin: the report warns of pressure there.",
    )


def pressures(obj: Any) -> list[int]:
    """The numbers of the wanted pressures, in order.

    Raises:
        ValueError: if a pressure lacks its place, or a place its pressure.
    """
    names = obj.PropertiesList
    wanted = {int(m[1]) for m in map(_PRESSURE.fullmatch, names) if m}
    placed = {int(m[1]) for m in map(_PLACE.fullmatch, names) if m}
    for n in sorted(wanted ^ placed):
        missing, there = (
            ("PressurePlace", "Pressure") if n in wanted else ("Pressure", "PressurePlace")
        )
        raise ValueError(
            f"{there}{n} has no {missing}{n}: remove {there}{n}, or add the pressure anew"
        )
    return sorted(wanted)


def seams(obj: Any) -> list[int]:
    """The numbers of the seams, in the order in which they are cut."""
    return sorted(int(m[1]) for m in map(_SEAM.fullmatch, obj.PropertiesList) if m)


def add_pressure(obj: Any, place: Any, pressure: Any) -> str:
    """Adds a wanted pressure; the name of its property."""
    n = max(pressures(obj), default=0) + 1
    group = "Pressures"
    ensure(
        obj,
        "App::PropertyPressure",
        f"Pressure{n}",
        group,
        "The wanted pressure. 1 mmHg is written 1 Torr.",
    )
    ensure(
        obj,
        "App::PropertyPosition",
        f"PressurePlace{n}",
        group,
        "Where it is wanted, on the surface or within 10 mm of it.",
    )
    ensure(
        obj,
        "App::PropertyPressure",
        f"PressureComputed{n}",
        group,
        "What the model computes there.",
        READ_ONLY | OUTPUT,
    )
    setattr(obj, f"Pressure{n}", pressure)
    setattr(obj, f"PressurePlace{n}", place)
    return f"Pressure{n}"


def remove_pressure(obj: Any, n: int) -> None:
    """Takes a wanted pressure out; the others keep their numbers, on which expressions rely."""
    for name in (f"Pressure{n}", f"PressurePlace{n}", f"PressureComputed{n}"):
        if name in obj.PropertiesList:
            obj.setExpression(name, None)
            obj.removeProperty(name)


def add_seam(obj: Any, points: list[Any]) -> str:
    """Adds a seam; the name of its property."""
    n = max(seams(obj), default=0) + 1
    ensure(
        obj,
        "App::PropertyVectorList",
        f"Seam{n}",
        "Seams",
        "Places in mm along which the surface is cut, two or more, within 10 mm of it. It begins "
        "at an edge of the brace or at an earlier seam.",
    )
    setattr(obj, f"Seam{n}", points)
    return f"Seam{n}"


def remove_seam(obj: Any, n: int) -> None:
    """Takes a seam out."""
    obj.removeProperty(f"Seam{n}")


def read(obj: Any) -> dict[str, Any]:
    """The wishes at places by the keys of a design file, in mm and kPa.

    Raises:
        ValueError: as `pressures`, or if a region's plane has no placement.
    """
    design: dict[str, Any] = {
        "pressures": [
            {
                "at": list(getattr(obj, f"PressurePlace{n}")),
                "kpa": number(getattr(obj, f"Pressure{n}"), PRESSURE),
            }
            for n in pressures(obj)
        ]
    }
    if obj.Orientation:
        design["orientation"] = [list(place) for place in obj.Orientation]
    if seams(obj):
        design["seams"] = [[list(p) for p in getattr(obj, f"Seam{n}")] for n in seams(obj)]
    if obj.RegionPlanes:
        design["region"] = [_plane(plane) for plane in obj.RegionPlanes]
    if obj.RegionFacets:
        design["region_faces"] = list(obj.RegionFacets)
    return design


def bony(obj: Any) -> list[list[float]]:
    """The bony places, in mm."""
    return [list(place) for place in obj.BonyPlaces]


def _plane(plane: Any) -> dict[str, Any]:
    if not hasattr(plane, "getGlobalPlacement"):
        raise ValueError(f"RegionPlanes: {plane.Label} has no placement: give a plane")
    placement = plane.getGlobalPlacement()
    normal = placement.Rotation.multVec(FreeCAD.Vector(0, 0, 1))
    return {"point": list(placement.Base), "normal": list(normal)}
