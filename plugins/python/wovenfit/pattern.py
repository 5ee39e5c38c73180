"""The flattened brace: arrays, the table of pressures, warnings, files."""

from __future__ import annotations

import ctypes
import json
import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from . import calls
from .abi import NoteText, ResultArray, ResultFile, ResultIndexArray
from .files import write_together
from .formats import pattern_formats
from .handle import Handle
from .notes import Note, Place, read_note, read_text
from .signatures import ResultPressure, ResultSummary

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable
    from pathlib import Path

    import numpy.typing as npt

    from .job import Prepared

    Doubles = npt.NDArray[np.float64]
    Indices = npt.NDArray[np.uint32]

FILES = {
    "report.html": ResultFile.REPORT_HTML,
    "pattern.svg": ResultFile.PATTERN_SVG,
    "report.json": ResultFile.REPORT_JSON,
    "worn.obj": ResultFile.WORN_OBJ,
    "flat.obj": ResultFile.FLAT_OBJ,
}
"""What `Pattern.write` and the command line write; `pattern_formats` are more."""


@dataclass(frozen=True)
class Figures:
    """The figures of a pattern."""

    width_mm: float
    """Extent along warp."""
    height_mm: float
    """Extent along weft."""
    area_mm2: float
    energy: float
    """Of the fit, in N mm."""
    curvature_radius_mm: float
    """Radius over which curvature was read: the scale at which pressure is stated."""
    steps: int
    """Of the fit."""
    converged: bool
    """Whether the fit has converged."""
    flipped: int
    """Triangles of the pattern that lie upside down."""
    overlaps: int
    """Places where the pattern's edge crosses itself."""


@dataclass(frozen=True)
class Pressure:
    """A row of the table of pressures. NaN stands for what is not known."""

    at: Place
    """Where it is wanted, in mm."""
    asked_kpa: float
    got_kpa: float
    """Computed with the tension equal along the thread."""
    got_local_kpa: float
    """Computed from the fabric's strain near the point alone."""
    mean_curvature_per_m: float
    """Outward positive."""
    warp_curvature_per_m: float
    weft_curvature_per_m: float
    warp_strain: float
    weft_strain: float
    reachable_least_kpa: float
    """Least pressure that strains from zero to the fabric's limit give here."""
    reachable_most_kpa: float
    met: bool
    reason: Optional[Note]
    """Why it is missed; None where it is met."""


@dataclass(frozen=True)
class Seam:
    """Two sides that are sewn together, start to start; each has n vertices."""

    left: Indices
    """(n,) vertices of the cut surface, counted from 0."""
    right: Indices
    """(n,) vertices of the cut surface."""
    left_mm: float
    """Length in the pattern."""
    right_mm: float


class Pattern(Handle):
    """A flattened brace. It never changes: any thread may use it.

    In the shapes below V and T are the numbers of vertices and triangles of the cut surface, GV and
    GT those of the mesh given. Lengths are in mm, pressures in kPa, strains have no unit. Arrays
    are fetched when they are first asked for, kept, and cannot be written to: copy those to change.
    """

    _free = "wovenfit_result_free"

    @cached_property
    def figures(self) -> Figures:
        """Extent, area, energy, and whether the fit is sound."""
        got = self._summary
        return Figures(
            got.width_mm,
            got.height_mm,
            got.area_mm2,
            got.energy,
            got.curvature_radius_mm,
            got.steps,
            bool(got.converged),
            got.flipped,
            got.overlaps,
        )

    @cached_property
    def pressures(self) -> tuple[Pressure, ...]:
        """The table of pressures, in the order of the design."""
        with self._lent() as address:
            return tuple(_pressure(address, row) for row in range(self._summary.pressures))

    @cached_property
    def warnings(self) -> tuple[Note, ...]:
        """What the designer should know: read them before cutting."""
        texts, places = "wovenfit_result_warning_text", "wovenfit_result_warning_place"
        with self._lent() as address:
            return tuple(
                read_note(texts, places, address, index) for index in range(self._summary.warnings)
            )

    # The cut surface and the pattern on it.

    @cached_property
    def coordinates(self) -> Doubles:
        """(V, 2) pattern coordinates of the vertices: x along warp, y along weft.

        The pattern's lower left corner is the origin.
        """
        return self._doubles(ResultArray.PATTERN, 2)

    @cached_property
    def corner_coordinates(self) -> Doubles:
        """(T, 3, 2) the same for every corner of every triangle."""
        return self._doubles(ResultArray.PATTERN_PER_CORNER, 3, 2)

    @cached_property
    def positions(self) -> Doubles:
        """(V, 3) places of the vertices on the limb."""
        return self._doubles(ResultArray.POSITIONS, 3)

    @cached_property
    def triangles(self) -> Indices:
        """(T, 3) vertices of the triangles, counter-clockwise seen from outside."""
        return self._indices(ResultIndexArray.TRIANGLES, 3)

    @cached_property
    def warp_strain(self) -> Doubles:
        """(V,) strain along warp."""
        return self._doubles(ResultArray.WARP_STRAIN)

    @cached_property
    def weft_strain(self) -> Doubles:
        """(V,) strain along weft."""
        return self._doubles(ResultArray.WEFT_STRAIN)

    @cached_property
    def area_stretch(self) -> Doubles:
        """(V,) present area over rest area."""
        return self._doubles(ResultArray.AREA_STRETCH)

    @cached_property
    def pressure_kpa(self) -> Doubles:
        """(V,) pressure, negative where the fabric would lift off."""
        return self._doubles(ResultArray.PRESSURE_KPA)

    @cached_property
    def friction(self) -> Doubles:
        """(V,) coefficient of friction needed to hold the fabric.

        NaN near a free edge and where nearly nothing presses.
        """
        return self._doubles(ResultArray.FRICTION)

    @cached_property
    def girths(self) -> Doubles:
        """(n, 2) distance along the limb from the end near the body, and girth there."""
        return self._doubles(ResultArray.GIRTHS, 2)

    @cached_property
    def outlines(self) -> tuple[Doubles, ...]:
        """(n, 2) pattern coordinates along each outline loop, the outer one first."""
        return tuple(self._split(self._doubles(ResultArray.OUTLINE, 2), self._outline_starts))

    @cached_property
    def outline_vertices(self) -> tuple[Indices, ...]:
        """(n,) vertices along each outline loop, as in `outlines`."""
        return tuple(self._split(self._indices(ResultIndexArray.OUTLINE), self._outline_starts))

    @cached_property
    def seams(self) -> tuple[Seam, ...]:
        """The pairs of sides that are sewn together."""
        starts = self._indices(ResultIndexArray.SEAM_STARTS)
        left = self._split(self._indices(ResultIndexArray.SEAM_LEFT), starts)
        right = self._split(self._indices(ResultIndexArray.SEAM_RIGHT), starts)
        lengths = self._doubles(ResultArray.SEAM_LENGTHS, 2)
        return tuple(
            Seam(left[i], right[i], float(lengths[i, 0]), float(lengths[i, 1]))
            for i in range(len(lengths))
        )

    @cached_property
    def pressure_points(self) -> Doubles:
        """(n, 2) pattern coordinates of the wanted pressures, in the order of `pressures`."""
        return self._doubles(ResultArray.PRESSURE_POINTS, 2)

    @cached_property
    def orientation_markers(self) -> Doubles:
        """(2, 2) pattern coordinates of the orientation markers, the first near the body."""
        return self._doubles(ResultArray.ORIENTATION_MARKERS, 2)

    # The way back to the mesh that was given. The first of these that is asked for finds it, in a
    # fraction of the job's time.

    @cached_property
    def vertex_to_given_vertex(self) -> Indices:
        """(V,) the given vertex that each vertex is, `NONE` if the cut made it.

        Of given vertices that were welded it is the first.
        """
        return self._indices(ResultIndexArray.VERTEX_TO_GIVEN_VERTEX)

    @cached_property
    def vertex_to_given_triangle(self) -> Indices:
        """(V,) a given triangle in which each vertex lies, `NONE` on what closes a hole."""
        return self._indices(ResultIndexArray.VERTEX_TO_GIVEN_TRIANGLE)

    @cached_property
    def vertex_weights(self) -> Doubles:
        """(V, 3) weights of that triangle's corners, which sum to 1; zeros without a triangle."""
        return self._doubles(ResultArray.VERTEX_WEIGHTS, 3)

    @cached_property
    def triangle_to_given_triangle(self) -> Indices:
        """(T,) the given triangle in which each triangle's middle lies, `NONE` on closed holes."""
        return self._indices(ResultIndexArray.TRIANGLE_TO_GIVEN_TRIANGLE)

    @cached_property
    def given_corner_coordinates(self) -> Doubles:
        """(GT, 3, 2) pattern coordinates of the corners of the given triangles, in their order.

        NaN where the brace does not cover a triangle's middle. A triangle through which the edge or
        a seam runs belongs to the side of its middle, and goes on linearly beyond.
        """
        return self._doubles(ResultArray.GIVEN_PATTERN_PER_CORNER, 3, 2)

    @cached_property
    def given_warp_strain(self) -> Doubles:
        """(GV,) strain along warp at the given vertices, NaN where the brace does not reach."""
        return self._doubles(ResultArray.GIVEN_WARP_STRAIN)

    @cached_property
    def given_weft_strain(self) -> Doubles:
        """(GV,) strain along weft, NaN likewise."""
        return self._doubles(ResultArray.GIVEN_WEFT_STRAIN)

    @cached_property
    def given_pressure_kpa(self) -> Doubles:
        """(GV,) pressure, NaN likewise."""
        return self._doubles(ResultArray.GIVEN_PRESSURE_KPA)

    # Texts and files.

    @cached_property
    def report(self) -> dict[str, Any]:
        """Every figure: the contents of report.json."""
        report: dict[str, Any] = json.loads(self.file("report.json"))
        return report

    @property
    def html(self) -> str:
        """The page to read first. It is drawn when first asked for, in about a second."""
        return self.file("report.html").decode()

    @property
    def svg(self) -> str:
        """The pattern at true size in mm."""
        return self.file("pattern.svg").decode()

    @property
    def table(self) -> str:
        """The table of pressures for a terminal."""
        return self._text(ResultFile.TABLE).decode()

    def file(self, name: str) -> bytes:
        """A file as the command line writes it, byte for byte; `name` is one of `FILES`."""
        return self._text(FILES[name])

    def export(self, format: str, unit: str = "mm") -> bytes:
        """The pattern as a file's bytes, with allowances, notches and marks of its design.

        Args:
            format: the name of one of `pattern_formats`, for example "dxf-astm".
            unit: "mm" or "in": of the numbers in SVG and DXF, of the words in all.

        Raises:
            InvalidArgument: if there is no such format or unit.
        """
        names = calls.c_text(format, "format"), calls.c_text(unit, "unit")
        with self._lent() as address:
            return calls.data("wovenfit_result_pattern", address, *names)

    def export_notes(self, format: str, unit: str = "mm") -> list[str]:
        """What a format cannot hold, as letters of a name, and what it says instead."""
        names = calls.c_text(format, "format"), calls.c_text(unit, "unit")
        with self._lent() as address:
            text = calls.text("wovenfit_result_pattern_notes", address, *names)
        return text.decode().splitlines()

    def write(
        self,
        folder: str | os.PathLike[str],
        formats: Iterable[str] = ("svg",),
        unit: str = "mm",
    ) -> tuple[Path, ...]:
        """Writes the files of `wovenfit flatten` into a folder, all of them or none.

        The folder is made if there is none. What else lies in it stays.

        Args:
            folder: where to.
            formats: those of the pattern, names of `pattern_formats`.
            unit: of the pattern's files, "mm" or "in".

        Raises:
            InvalidArgument: if there is no such format or unit.
            OSError: if they cannot be written; what was there before is then put back.
        """
        names = {row.name: row.file_name for row in pattern_formats()}
        files = {name: self.file(name) for name in FILES if name != "pattern.svg"}
        for format in formats:
            contents = self.export(format, unit)
            files[names[format]] = contents
        return write_together(folder, files)

    def prepared(self) -> Prepared:
        """The limb that is cut open, to solve again on."""
        from .job import Prepared  # a job gives patterns, too

        with self._lent() as address:
            return Prepared(calls.new("wovenfit_result_prepared", address))

    def __repr__(self) -> str:
        if self.closed:
            return "<Pattern, closed>"
        return f"<Pattern {self.figures.width_mm:.1f} mm by {self.figures.height_mm:.1f} mm>"

    @cached_property
    def _summary(self) -> ResultSummary:
        got = ResultSummary()
        with self._lent() as address:
            calls.call("wovenfit_result_figures", address, ctypes.byref(got))
        return got

    @cached_property
    def _outline_starts(self) -> Indices:
        return self._indices(ResultIndexArray.OUTLINE_STARTS)

    def _doubles(self, what: ResultArray, *row: int) -> Doubles:
        with self._lent() as address:
            values = calls.doubles("wovenfit_result_doubles", address, what)
        values.setflags(write=False)
        return values.reshape(-1, *row)

    def _indices(self, what: ResultIndexArray, *row: int) -> Indices:
        with self._lent() as address:
            values = calls.indices("wovenfit_result_indices", address, what)
        values.setflags(write=False)
        return values.reshape(-1, *row)

    @staticmethod
    def _split(values: npt.NDArray[Any], starts: Indices) -> list[npt.NDArray[Any]]:
        """Lists that stand one after the other, apart."""
        return [values[int(a) : int(b)] for a, b in zip(starts[:-1], starts[1:])]

    def _text(self, what: ResultFile) -> bytes:
        with self._lent() as address:
            return calls.text("wovenfit_result_text", address, what)


def _pressure(address: int, index: int) -> Pressure:
    row = ResultPressure()
    calls.call("wovenfit_result_pressure", address, index, ctypes.byref(row))
    x, y, z = row.at
    reason = None
    if not row.met:
        code, message = (
            read_text("wovenfit_result_pressure_reason", address, index, what)
            for what in (NoteText.CODE, NoteText.MESSAGE)
        )
        reason = Note(code, message, None if math.isnan(x) else (x, y, z))
    return Pressure(
        (x, y, z),
        row.asked_kpa,
        row.got_kpa,
        row.got_local_kpa,
        row.mean_curvature_per_m,
        row.warp_curvature_per_m,
        row.weft_curvature_per_m,
        row.warp_strain,
        row.weft_strain,
        row.reachable_least_kpa,
        row.reachable_most_kpa,
        bool(row.met),
        reason,
    )
