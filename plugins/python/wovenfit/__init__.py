"""From a scanned limb, a fabric's stiffness and wanted normal pressures to the flat pattern.

Begin with `flatten`, for scripts, or with `Mesh`, `Design` and `Job`, for programs that do
something else meanwhile. The library is loaded when it is first needed.

What the model is, and is not, stands in the README of the repository: the figures are computed
residuals of a model, not measured pressures.
"""

from .abi import ABI_VERSION, NONE, JobStage, JobState, ParameterKind, Status
from .api import flatten
from .check import Check
from .design import Design, design_schema
from .errors import (
    AbiMismatch,
    BufferTooSmall,
    Cancelled,
    DesignError,
    FitError,
    InternalError,
    InvalidArgument,
    LibraryError,
    MappingError,
    NotReady,
    NotUtf8,
    NullArgument,
    OutOfRange,
    ParameterError,
    ParameterizationError,
    PreparedForAnother,
    PressureError,
    SeamError,
    SurfaceError,
    TimedOut,
    TooLarge,
    UnitError,
    UnknownStatus,
    WovenfitError,
)
from .fabrics import FABRICS
from .formats import Format, pattern_formats
from .given import polygon_corners, torn_edges
from .job import Job, Prepared, Progress
from .library import version
from .mesh import KPA_PER_MMHG, Mesh
from .notes import Defect, Note
from .parameters import Parameter, Parameters, parameter_table
from .pattern import FILES, Figures, Pattern, Pressure, Seam

__all__ = [
    "ABI_VERSION",
    "FABRICS",
    "FILES",
    "KPA_PER_MMHG",
    "NONE",
    "AbiMismatch",
    "BufferTooSmall",
    "Cancelled",
    "Check",
    "Defect",
    "Design",
    "DesignError",
    "Figures",
    "FitError",
    "Format",
    "InternalError",
    "InvalidArgument",
    "Job",
    "JobStage",
    "JobState",
    "LibraryError",
    "MappingError",
    "Mesh",
    "NotReady",
    "NotUtf8",
    "Note",
    "NullArgument",
    "OutOfRange",
    "Parameter",
    "ParameterError",
    "ParameterKind",
    "ParameterizationError",
    "Parameters",
    "Pattern",
    "Prepared",
    "PreparedForAnother",
    "Pressure",
    "PressureError",
    "Progress",
    "Seam",
    "SeamError",
    "Status",
    "SurfaceError",
    "TimedOut",
    "TooLarge",
    "UnitError",
    "UnknownStatus",
    "WovenfitError",
    "design_schema",
    "flatten",
    "parameter_table",
    "pattern_formats",
    "polygon_corners",
    "torn_edges",
    "version",
]
