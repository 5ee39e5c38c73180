"""What is wanted of one brace: fabric, pressures, orientation, seams, region."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import arrays, calls
from .errors import InvalidArgument
from .handle import Changeable, lent
from .mesh import Mesh, Unit, millimetres

if TYPE_CHECKING:
    import numpy.typing as npt


def design_schema() -> dict[str, Any]:
    """The JSON schema (draft 2020-12) of the design file, with descriptions."""
    schema: dict[str, Any] = json.loads(calls.text("wovenfit_design_schema"))
    return schema


class Design(Changeable):
    """The wishes for one brace. Everything is checked when it is set.

    Made empty it has the default fabric, no pressures, and covers the whole surface.

    Args:
        unit: of all coordinates that are given to it: "mm", "cm", "m", "in", or millimetres.

    Any thread may use it; a job takes the wishes that it has when the job starts.

    Raises:
        DesignError: from every method that sets something, for what the design file's rules refuse.
        InvalidArgument: for arrays of a wrong shape, type, or with numbers that are not finite.
        TooLarge: beyond 1000 pressures, 5000 seam points, 1000 planes or bony places.
    """

    _free = "wovenfit_design_free"

    def __init__(self, unit: Unit = "mm") -> None:
        super().__init__(calls.new("wovenfit_design_new", millimetres(unit)))

    @classmethod
    def _of(cls, address: int) -> Design:
        design = cls.__new__(cls)
        Changeable.__init__(design, address)
        return design

    @classmethod
    def from_json(cls, text: Union[str, Mapping[str, Any]], unit: Unit = "mm") -> Design:
        """A design from the JSON text of a design file, or from a mapping of the same keys.

        Its coordinates are in its "units"; where it says none they are in `unit`. Coordinates given
        later are in `unit`.
        """
        if isinstance(text, Mapping):
            try:
                text = json.dumps(text, allow_nan=False, default=_plain)
            except (TypeError, ValueError) as error:
                raise InvalidArgument(f"`text` cannot be written as JSON: {error}") from error
        given = calls.c_text(text, "text")
        return cls._of(calls.new("wovenfit_design_from_json", given, millimetres(unit)))

    def to_json(self) -> str:
        """The JSON text of a design file in mm and kPa; read again it gives the same design.

        Triangles that the region was set to are not in it, as no design file has them.
        """
        with self._lent() as address:
            return calls.text("wovenfit_design_json", address).decode()

    def copy(self) -> Design:
        """A design of its own with the same wishes."""
        with self._lent() as address:
            return self._of(calls.new("wovenfit_design_copy", address))

    def set(self, name: str, value: Union[float, str]) -> None:
        """Sets a number or a text by its name in the design file.

        Numbers: "fabric.warp", "fabric.weft", "fabric.diagonal" (N/mm), "fabric.s",
        "fabric.max_strain", "fabric.weft_strain" (strains, no unit), "limits.max_kpa" (kPa). Texts:
        "fabric.name", "pressure_model" ("laplace" or "paper"), "facing" ("outward" or "inward"),
        "piece.name", "piece.reference", "piece.date".
        """
        known = calls.c_text(name, "name")
        if isinstance(value, str):
            self._call("wovenfit_design_set_text", known, calls.c_text(value, "value"))
            return
        try:
            number = float(value)
        except (TypeError, ValueError) as error:
            raise InvalidArgument(f"`{name}` is {value!r}: give a number or a str") from error
        self._call("wovenfit_design_set_number", known, number)

    def set_fabric(self, **values: Union[float, str]) -> None:
        """Sets numbers and the name of the fabric.

        Args:
            **values: `warp`, `weft`, `diagonal` (stiffness in N/mm: force per rest width at strain
                1), `max_strain`, `weft_strain` (no unit), `s` (the paper's coefficient), `name`.
        """
        for name, value in values.items():
            self.set(f"fabric.{name}", value)

    def clear(self, name: str) -> None:
        """Takes a wish out so that its default holds.

        Any name of `set`, or "pressures", "orientation", "seams", "region" (its planes),
        "region_faces" (its triangles), "limits.bony", "fabric", "limits", "piece".
        """
        self._call("wovenfit_design_clear", calls.c_text(name, "name"))

    @property
    def pressure_count(self) -> int:
        """Number of wanted pressures."""
        with self._lent() as address:
            return calls.count("wovenfit_design_pressure_count", address)

    def add_pressures(self, positions: npt.ArrayLike, kpa: npt.ArrayLike) -> None:
        """Adds wanted pressures at points.

        Args:
            positions: (n, 3) numbers in the design's unit, on the surface or within 10 mm of it.
            kpa: (n,) numbers, or one for all, in kPa (1 mmHg is 0.133322 kPa): 0 to 13.3 unless
                "limits.max_kpa" allows more.
        """
        points = arrays.numbers(positions, ("n", 3), "positions")
        wanted = _for_each(kpa, len(points))
        self._call(
            "wovenfit_design_add_pressures",
            arrays.doubles_at(points),
            arrays.doubles_at(wanted),
            len(points),
        )

    def add_pressures_at_vertices(
        self, mesh: Mesh, vertices: npt.ArrayLike, kpa: npt.ArrayLike
    ) -> None:
        """Adds wanted pressures at vertices of a mesh.

        Args:
            mesh: of the vertices.
            vertices: (n,) whole numbers, counted from 0.
            kpa: as in `add_pressures`.

        Raises:
            OutOfRange: if the mesh has no such vertex.
        """
        chosen = arrays.indices(vertices, ("n",), "vertices")
        wanted = _for_each(kpa, len(chosen))
        self._on(
            mesh,
            "wovenfit_design_add_pressures_at_vertices",
            arrays.indices_at(chosen),
            arrays.doubles_at(wanted),
            len(chosen),
        )

    def paint_pressures(self, mesh: Mesh, kpa: npt.ArrayLike) -> None:
        """Adds the pressures painted onto a mesh.

        Painted vertices are condensed to at most 200 points at least 10 mm apart, each wanting the
        mean of the values round it; a warning of the pattern says how many became how many. Paint
        that was there before stays: clear "pressures" first.

        Args:
            mesh: that was painted.
            kpa: a number for each of its vertices in kPa, 0 where nothing is asked.
        """
        painted = arrays.numbers(kpa, ("n",), "kpa")
        self._on(mesh, "wovenfit_design_paint_pressures", arrays.doubles_at(painted), len(painted))

    def set_orientation(self, first: npt.ArrayLike, second: npt.ArrayLike) -> None:
        """Sets the two orientation markers, which stand above each other in the pattern.

        Args:
            first: (3,) numbers in the design's unit, near the body.
            second: (3,) numbers, away from it.
        """
        both = np.stack(
            [arrays.numbers(first, (3,), "first"), arrays.numbers(second, (3,), "second")]
        )
        self._call("wovenfit_design_set_orientation", arrays.doubles_at(both))

    def set_orientation_at_vertices(self, mesh: Mesh, first: int, second: int) -> None:
        """Sets the two orientation markers at vertices of a mesh, `first` near the body."""
        chosen = arrays.indices([first, second], (2,), "vertices")
        self._on(mesh, "wovenfit_design_set_orientation_at_vertices", *map(int, chosen))

    def add_seam(self, positions: npt.ArrayLike) -> None:
        """Adds a seam along which the surface is cut.

        Args:
            positions: (n, 3) numbers in the design's unit, n >= 2, within 10 mm of the surface. It
                begins at an edge of the brace or at an earlier seam.
        """
        points = arrays.numbers(positions, ("n", 3), "positions")
        self._call("wovenfit_design_add_seam", arrays.doubles_at(points), len(points))

    def add_seams_along_edges(self, mesh: Mesh, edges: npt.ArrayLike) -> None:
        """Adds seams along edges of a mesh.

        Edges are chained from branch to branch or free end, and their zigzag is drawn straight to
        within an edge's mean length: a seam of zigzags cannot be sewn.

        Args:
            mesh: of the edges.
            edges: (n, 2) whole numbers, the vertices of each edge, in any order.
        """
        ends = arrays.indices(edges, ("n", 2), "edges")
        self._on(mesh, "wovenfit_design_add_seams_along_edges", arrays.indices_at(ends), len(ends))

    def add_region_plane(self, point: npt.ArrayLike, normal: npt.ArrayLike) -> None:
        """Adds a plane that bounds the brace: it covers the side to which all normals point.

        Args:
            point: (3,) numbers in the design's unit, a point of the plane.
            normal: (3,) numbers, of any length but zero.
        """
        at = arrays.numbers(point, (3,), "point")
        along = arrays.numbers(normal, (3,), "normal")
        self._call(
            "wovenfit_design_add_region_plane", arrays.doubles_at(at), arrays.doubles_at(along)
        )

    def set_region_triangles(self, mesh: Mesh, triangles: npt.ArrayLike) -> None:
        """Sets the triangles of a mesh that the brace covers; planes bound it further.

        Pressure is still read off the whole scan. The design then fits jobs on a mesh of as many
        triangles only.

        Args:
            mesh: of the triangles.
            triangles: (n,) whole numbers, counted from 0, or a bool for each triangle of the mesh.
        """
        chosen = np.asarray(triangles)
        if chosen.dtype == np.bool_:
            if chosen.shape != (mesh.triangle_count,):
                raise InvalidArgument(
                    f"`triangles` has shape {chosen.shape}: give a bool for each of the mesh's "
                    f"{mesh.triangle_count} triangles"
                )
            chosen = np.flatnonzero(chosen)
        chosen = arrays.indices(chosen, ("n",), "triangles")
        self._on(
            mesh, "wovenfit_design_set_region_triangles", arrays.indices_at(chosen), len(chosen)
        )

    def add_bony(self, positions: npt.ArrayLike) -> None:
        """Adds places where bone lies under the skin, at which the report warns of pressure.

        Args:
            positions: (n, 3) numbers in the design's unit.
        """
        points = arrays.numbers(positions, ("n", 3), "positions")
        self._call("wovenfit_design_add_bony", arrays.doubles_at(points), len(points))

    def _call(self, name: str, *arguments: object) -> None:
        with self._lent() as address:
            calls.call(name, address, *arguments)

    def _on(self, mesh: Mesh, name: str, *arguments: object) -> None:
        with lent(mesh) as address:
            self._call(name, address, *arguments)


def _for_each(kpa: npt.ArrayLike, count: int) -> npt.NDArray[np.float64]:
    """One pressure for each of so many places."""
    if np.ndim(kpa) == 0:
        kpa = np.full(count, kpa)
    return arrays.numbers(kpa, (count,), "kpa")


def _plain(value: object) -> object:
    """Arrays and numbers of numpy as JSON has them."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"{value!r} has no JSON")
