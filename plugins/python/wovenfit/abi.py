"""The numbers of the C ABI (include/wovenfit.h), by the names that they have there."""

from __future__ import annotations

import enum

ABI_VERSION = 1

NONE = 0xFFFF_FFFF
"""No element: where an index could stand. Using it as an index raises `IndexError`."""


class Status(enum.IntEnum):
    """What a function returns."""

    OK = 0
    NULL_ARGUMENT = 1
    INVALID_ARGUMENT = 2
    BUFFER_TOO_SMALL = 3
    TOO_LARGE = 4
    NOT_UTF8 = 5
    ABI_MISMATCH = 6
    NOT_READY = 7
    TIMEOUT = 8
    CANCELLED = 9
    OUT_OF_RANGE = 10
    DESIGN = 20
    PARAMETER = 21
    SURFACE = 22
    UNIT = 23
    SEAM = 24
    PRESSURE = 25
    PARAMETERIZATION = 26
    FIT = 27
    MAPPING = 28
    PREPARED_FOR_ANOTHER = 29
    INTERNAL = 100


class JobStage(enum.IntEnum):
    """A stage of a job, in the order in which they come. Those that are not needed are left out."""

    WAITING = 0
    SURFACE = 1
    REGION = 2
    CUT = 3
    PARAMETERIZATION = 4
    CURVATURE = 5
    FIT = 6
    MAPPING = 7
    REPORT = 8


class JobState(enum.IntEnum):
    """Where a job is."""

    RUNNING = 0
    DONE = 1
    FAILED = 2
    CANCELLED = 3


class NoteText(enum.IntEnum):
    """A text about a defect or a warning."""

    CODE = 1
    MESSAGE = 2


class FormatText(enum.IntEnum):
    """A text about a format of the pattern."""

    NAME = 1
    FILE_NAME = 2
    SUMMARY = 3


class ParameterKind(enum.IntEnum):
    """What a parameter may be."""

    NUMBER = 1
    """A `float` in a closed range."""
    INTEGER = 2
    """An `int` in a closed range."""
    SWITCH = 3
    """A `bool`."""
    CHOICE = 4
    """One of some names."""


class ParameterText(enum.IntEnum):
    """A text about a parameter."""

    NAME = 1
    UNIT = 2
    DEFAULT = 3
    SUMMARY = 4
    PARAGRAPH = 5


class ResultArray(enum.IntEnum):
    """An array of numbers of a result."""

    PATTERN = 1
    PATTERN_PER_CORNER = 2
    POSITIONS = 3
    VERTEX_WEIGHTS = 4
    WARP_STRAIN = 5
    WEFT_STRAIN = 6
    AREA_STRETCH = 7
    PRESSURE_KPA = 8
    FRICTION = 9
    OUTLINE = 10
    SEAM_LENGTHS = 11
    GIRTHS = 12
    PRESSURE_POINTS = 13
    ORIENTATION_MARKERS = 14
    GIVEN_PATTERN_PER_CORNER = 20
    GIVEN_WARP_STRAIN = 21
    GIVEN_WEFT_STRAIN = 22
    GIVEN_PRESSURE_KPA = 23


class ResultIndexArray(enum.IntEnum):
    """An array of indices of a result."""

    TRIANGLES = 1
    VERTEX_TO_GIVEN_VERTEX = 2
    VERTEX_TO_GIVEN_TRIANGLE = 3
    TRIANGLE_TO_GIVEN_TRIANGLE = 4
    OUTLINE = 5
    OUTLINE_STARTS = 6
    SEAM_LEFT = 7
    SEAM_RIGHT = 8
    SEAM_STARTS = 9


class ResultFile(enum.IntEnum):
    """A text of a result."""

    REPORT_JSON = 1
    REPORT_HTML = 2
    PATTERN_SVG = 3
    WORN_OBJ = 4
    FLAT_OBJ = 5
    TABLE = 6
