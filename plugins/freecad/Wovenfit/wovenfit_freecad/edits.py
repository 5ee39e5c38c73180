"""What a designer does to a brace, for scripts and for the commands of the window alike."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

import FreeCAD

from . import computation, looks, places, properties, watching
from .brace import Brace, children, is_brace
from .pattern import Pattern
from .quantities import PRESSURE, quantity
from .source import is_source
from .worn import Worn


def new_brace(document: Any, source: Any, faces: Iterable[str] = (), label: str = "Brace") -> Any:
    """Makes a brace with a pattern and a worn surface; `document.recompute()` flattens it.

    Args:
        document: in which they are made.
        source: an object with a mesh, or with a shape.
        faces: names of faces of the shape, such as "Face3"; none for all.
        label: what the tree shows.

    Raises:
        ValueError: if the source has no surface.
    """
    if not is_source(source):
        raise ValueError(f"{source.Label} has no surface: choose a mesh, or a shape with faces")
    watching.begin()
    brace = document.addObject("App::FeaturePython", "Brace")
    Brace(brace)
    brace.Label = label
    brace.Source = (source, list(faces))
    looks.dress(brace)
    add_shown(brace)
    _beside(source, brace)
    return brace


def add_shown(brace: Any) -> None:
    """Makes what shows the brace's result, where it is missing."""
    there = [type(child.Proxy) for child in children(brace)]
    if Pattern not in there:
        pattern = brace.Document.addObject("Part::FeaturePython", "Pattern")
        Pattern(pattern, brace)
        looks.dress(pattern)
    if Worn not in there:
        worn = brace.Document.addObject("Mesh::FeaturePython", "Worn")
        Worn(worn, brace)
        looks.dress(worn)


def _beside(source: Any, brace: Any) -> None:
    """Lays a new pattern beside the limb, where it can be seen; it is moved as any object."""
    box = source.Mesh.BoundBox if source.isDerivedFrom("Mesh::Feature") else source.Shape.BoundBox
    for child in children(brace):
        if isinstance(child.Proxy, Pattern):
            child.Placement.Base = FreeCAD.Vector(box.XMax + 40.0, box.YMin, 0.0)


def add_pressure(brace: Any, place: Any, pressure: Any) -> str:
    """Adds a wanted pressure and gives the name of its property, such as "Pressure1".

    Args:
        brace: the object.
        place: x, y, z in mm, on the surface or within 10 mm of it.
        pressure: a quantity or its text, such as "2 kPa" or "15 Torr" (1 Torr is 1 mmHg).
    """
    return places.add_pressure(_brace(brace), FreeCAD.Vector(*place), pressure)


def remove_pressure(brace: Any, name: str) -> None:
    """Takes a wanted pressure out, by the name of its property."""
    number = name.removeprefix("Pressure")
    if not number.isdigit() or name not in _brace(brace).PropertiesList:
        raise ValueError(f"{brace.Label} has no {name}")
    places.remove_pressure(brace, int(number))


def set_orientation(brace: Any, first: Any, second: Any) -> None:
    """Sets the two markers that stand above each other in the pattern, the first near the body."""
    _brace(brace).Orientation = [FreeCAD.Vector(*first), FreeCAD.Vector(*second)]


def clear_orientation(brace: Any) -> None:
    """Leaves the weft direction to the limb."""
    _brace(brace).Orientation = []


def add_seam(brace: Any, points: Iterable[Any]) -> str:
    """Adds a seam through two or more places, and gives the name of its property."""
    course = [FreeCAD.Vector(*point) for point in points]
    if len(course) < 2:
        raise ValueError(f"a seam needs two places or more, not {len(course)}")
    return places.add_seam(_brace(brace), course)


def clear_seams(brace: Any) -> None:
    """Leaves the seam to the library: a short smooth line between the ends of the tube."""
    for n in places.seams(_brace(brace)):
        places.remove_seam(brace, n)


def add_region_plane(brace: Any, plane: Any) -> None:
    """Bounds the brace by an object's XY plane; it covers the side to which its z axis points."""
    _brace(brace).RegionPlanes = [*brace.RegionPlanes, plane]


def add_region_between(brace: Any, first: Any, second: Any) -> None:
    """Bounds the brace by two new planes that face each other, at two places in mm."""
    along = FreeCAD.Vector(*second) - FreeCAD.Vector(*first)
    if along.Length == 0:
        raise ValueError("the two places are the same: the planes have no direction")
    for place, normal in ((first, along), (second, -along)):
        plane = {"point": list(place), "normal": list(normal)}
        add_region_plane(brace, _plane(_brace(brace).Document, plane))


def clear_region(brace: Any) -> None:
    """Lets the brace cover the whole limb; its planes go from the document."""
    planes = _brace(brace).RegionPlanes
    brace.RegionPlanes = []
    brace.RegionFacets = []
    for plane in planes:
        # One that something else hangs on stays.
        if not plane.InList:
            brace.Document.removeObject(plane.Name)


def design_of(brace: Any) -> str:
    """The wishes as the JSON of a design file, in mm and kPa."""
    return json.dumps(computation.design_of(_brace(brace)), indent=2)


def apply_design(brace: Any, design: str | Mapping[str, Any]) -> None:
    """Takes over the wishes of a design file; those that the brace has go.

    A region's planes become objects in the document.

    Raises:
        wovenfit.WovenfitError: if it is no design; the brace is then as before.
    """
    import wovenfit

    # The library checks it, and turns every unit to mm and kPa.
    with wovenfit.Design.from_json(design, "mm") as checked:
        wished = json.loads(checked.to_json())
    _brace(brace)
    for n in places.pressures(brace):
        places.remove_pressure(brace, n)
    clear_seams(brace)
    for row in properties.wishes():
        value: Any = wished
        for name in row.key.split("."):
            value = value.get(name) if isinstance(value, Mapping) else None
        row.write(brace, value)
    for wish in wished.get("pressures", ()):
        add_pressure(brace, wish["at"], quantity(wish["kpa"], PRESSURE))
    brace.Orientation = [FreeCAD.Vector(*p) for p in wished.get("orientation", ())]
    for seam in wished.get("seams", ()):
        add_seam(brace, seam)
    brace.RegionPlanes = [_plane(brace.Document, plane) for plane in wished.get("region", ())]
    brace.RegionFacets = wished.get("region_faces", [])
    bony = wished.get("limits", {}).get("bony", ())
    brace.BonyPlaces = [FreeCAD.Vector(*p) for p in bony]


def _plane(document: Any, plane: Mapping[str, Any]) -> Any:
    """A square in the document for a plane of a region."""
    size = 120.0
    made = document.addObject("Part::Plane", "RegionPlane")
    made.Length = made.Width = size
    turn = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), FreeCAD.Vector(*plane["normal"]))
    # Its corner is the object's own origin; the plane is the same wherever the square lies in it.
    corner = turn.multVec(FreeCAD.Vector(-size / 2, -size / 2, 0))
    made.Placement = FreeCAD.Placement(FreeCAD.Vector(*plane["point"]) + corner, turn)
    return made


def _brace(obj: Any) -> Any:
    if not is_brace(obj):
        raise ValueError(f"{getattr(obj, 'Label', obj)} is no brace")
    return obj
