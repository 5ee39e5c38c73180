"""Every signature of the C ABI, as include/wovenfit.h states it, and nothing else.

Objects are ``c_void_p``. A library is a fresh object for every load, so nothing here is set on a
library that others use.
"""

from __future__ import annotations

import ctypes
from ctypes import (
    POINTER,
    c_char,
    c_char_p,
    c_double,
    c_float,
    c_int32,
    c_size_t,
    c_uint8,
    c_uint32,
    c_void_p,
)


class JobProgress(ctypes.Structure):
    """struct wovenfit_job_progress."""

    _fields_ = (
        ("state", c_int32),
        ("stage", c_int32),
        ("fraction", c_double),
        ("energy", c_double),
    )


class ParameterBounds(ctypes.Structure):
    """struct wovenfit_parameter_bounds."""

    _fields_ = (
        ("kind", c_int32),
        ("choices", c_uint32),
        ("least", c_double),
        ("most", c_double),
    )


class ResultSummary(ctypes.Structure):
    """struct wovenfit_result_summary."""

    _fields_ = (
        ("width_mm", c_double),
        ("height_mm", c_double),
        ("area_mm2", c_double),
        ("energy", c_double),
        ("curvature_radius_mm", c_double),
        ("steps", ctypes.c_uint64),
        ("converged", c_uint32),
        ("flipped", c_uint32),
        ("overlaps", c_uint32),
        ("pressures", c_uint32),
        ("warnings", c_uint32),
        ("reserved", c_uint32),
    )


class ResultPressure(ctypes.Structure):
    """struct wovenfit_pressure."""

    _fields_ = (
        ("at", c_double * 3),
        ("asked_kpa", c_double),
        ("got_kpa", c_double),
        ("got_local_kpa", c_double),
        ("mean_curvature_per_m", c_double),
        ("warp_curvature_per_m", c_double),
        ("weft_curvature_per_m", c_double),
        ("warp_strain", c_double),
        ("weft_strain", c_double),
        ("reachable_least_kpa", c_double),
        ("reachable_most_kpa", c_double),
        ("met", c_uint32),
        ("reserved", c_uint32),
    )


_object = c_void_p
_status = c_int32
_new = POINTER(c_void_p)
_error = POINTER(c_void_p)
_doubles = POINTER(c_double)
_floats = POINTER(c_float)
_indices = POINTER(c_uint32)
_bytes = POINTER(c_uint8)
_count = POINTER(c_size_t)
# buffer, capacity, needed: a text to the caller.
_text_out = (POINTER(c_char), c_size_t, _count)

SIGNATURES: dict[str, tuple[object, tuple[object, ...]]] = {
    # Version.
    "wovenfit_abi_version": (c_uint32, ()),
    "wovenfit_version": (c_char_p, ()),
    "wovenfit_check_abi": (_status, (c_uint32, _error)),
    "wovenfit_status_name": (c_char_p, (c_int32,)),
    "wovenfit_stage_name": (c_char_p, (c_int32,)),
    # Errors.
    "wovenfit_error_status": (_status, (_object,)),
    "wovenfit_error_text": (_status, (_object, *_text_out)),
    "wovenfit_error_free": (None, (_object,)),
    # Meshes.
    "wovenfit_mesh_new_f64": (
        _status,
        (_doubles, c_size_t, c_size_t, _indices, c_size_t, c_double, _new, _error),
    ),
    "wovenfit_mesh_new_f32": (
        _status,
        (_floats, c_size_t, c_size_t, _indices, c_size_t, c_double, _new, _error),
    ),
    "wovenfit_unit_millimetres": (_status, (c_char_p, _doubles, _error)),
    "wovenfit_mesh_size": (_status, (_object, _count, _count, _error)),
    "wovenfit_mesh_free": (None, (_object,)),
    # Checks.
    "wovenfit_check_run": (_status, (_object, _object, _object, _new, _error)),
    "wovenfit_check_json": (_status, (_object, *_text_out, _error)),
    "wovenfit_check_count": (_status, (_object, _count, _count, _error)),
    "wovenfit_check_defect_text": (_status, (_object, c_size_t, c_int32, *_text_out, _error)),
    "wovenfit_check_defect_place": (_status, (_object, c_size_t, _doubles, _error)),
    "wovenfit_check_defect_vertices": (
        _status,
        (_object, c_size_t, _indices, c_size_t, _count, _error),
    ),
    "wovenfit_check_defect_triangles": (
        _status,
        (_object, c_size_t, _indices, c_size_t, _count, _error),
    ),
    "wovenfit_check_warning_text": (_status, (_object, c_size_t, c_int32, *_text_out, _error)),
    "wovenfit_check_warning_place": (_status, (_object, c_size_t, _doubles, _error)),
    "wovenfit_check_free": (None, (_object,)),
    # Designs.
    "wovenfit_design_new": (_status, (c_double, _new, _error)),
    "wovenfit_design_from_json": (_status, (c_char_p, c_double, _new, _error)),
    "wovenfit_design_copy": (_status, (_object, _new, _error)),
    "wovenfit_design_json": (_status, (_object, *_text_out, _error)),
    "wovenfit_design_schema": (_status, (*_text_out, _error)),
    "wovenfit_design_set_number": (_status, (_object, c_char_p, c_double, _error)),
    "wovenfit_design_set_text": (_status, (_object, c_char_p, c_char_p, _error)),
    "wovenfit_design_clear": (_status, (_object, c_char_p, _error)),
    "wovenfit_design_pressure_count": (_status, (_object, _count, _error)),
    "wovenfit_design_add_pressures": (_status, (_object, _doubles, _doubles, c_size_t, _error)),
    "wovenfit_design_add_pressures_at_vertices": (
        _status,
        (_object, _object, _indices, _doubles, c_size_t, _error),
    ),
    "wovenfit_design_paint_pressures": (_status, (_object, _object, _doubles, c_size_t, _error)),
    "wovenfit_design_set_orientation": (_status, (_object, _doubles, _error)),
    "wovenfit_design_set_orientation_at_vertices": (
        _status,
        (_object, _object, c_uint32, c_uint32, _error),
    ),
    "wovenfit_design_add_seam": (_status, (_object, _doubles, c_size_t, _error)),
    "wovenfit_design_add_seams_along_edges": (
        _status,
        (_object, _object, _indices, c_size_t, _error),
    ),
    "wovenfit_design_add_region_plane": (_status, (_object, _doubles, _doubles, _error)),
    "wovenfit_design_set_region_triangles": (
        _status,
        (_object, _object, _indices, c_size_t, _error),
    ),
    "wovenfit_design_add_bony": (_status, (_object, _doubles, c_size_t, _error)),
    "wovenfit_design_free": (None, (_object,)),
    # Parameters.
    "wovenfit_parameter_count": (c_size_t, ()),
    "wovenfit_parameter_describe": (_status, (c_size_t, c_int32, *_text_out, _error)),
    "wovenfit_parameter_range": (_status, (c_size_t, POINTER(ParameterBounds), _error)),
    "wovenfit_parameter_choice": (_status, (c_size_t, c_size_t, *_text_out, _error)),
    "wovenfit_parameters_new": (_status, (_new, _error)),
    "wovenfit_parameters_copy": (_status, (_object, _new, _error)),
    "wovenfit_parameters_set": (_status, (_object, c_char_p, c_char_p, _error)),
    "wovenfit_parameters_get": (_status, (_object, c_char_p, *_text_out, _error)),
    "wovenfit_parameters_free": (None, (_object,)),
    # Jobs.
    "wovenfit_job_start": (_status, (_object, _object, _object, _new, _error)),
    "wovenfit_job_start_prepared": (
        _status,
        (_object, _object, _object, _object, _new, _error),
    ),
    "wovenfit_job_poll": (_status, (_object, POINTER(JobProgress), _error)),
    "wovenfit_job_cancel": (_status, (_object, _error)),
    "wovenfit_job_wait": (_status, (_object, c_double, _error)),
    "wovenfit_job_result": (_status, (_object, _new, _error)),
    "wovenfit_job_prepared": (_status, (_object, _new, _error)),
    "wovenfit_job_free": (None, (_object,)),
    "wovenfit_prepared_free": (None, (_object,)),
    # Results.
    "wovenfit_result_figures": (_status, (_object, POINTER(ResultSummary), _error)),
    "wovenfit_result_pressure": (_status, (_object, c_size_t, POINTER(ResultPressure), _error)),
    "wovenfit_result_pressure_reason": (
        _status,
        (_object, c_size_t, c_int32, *_text_out, _error),
    ),
    "wovenfit_result_warning_text": (_status, (_object, c_size_t, c_int32, *_text_out, _error)),
    "wovenfit_result_warning_place": (_status, (_object, c_size_t, _doubles, _error)),
    "wovenfit_result_prepared": (_status, (_object, _new, _error)),
    "wovenfit_result_doubles": (_status, (_object, c_int32, _doubles, c_size_t, _count, _error)),
    "wovenfit_result_indices": (_status, (_object, c_int32, _indices, c_size_t, _count, _error)),
    "wovenfit_result_text": (_status, (_object, c_int32, *_text_out, _error)),
    "wovenfit_result_free": (None, (_object,)),
    # Formats of the pattern.
    "wovenfit_format_count": (c_size_t, ()),
    "wovenfit_format_describe": (_status, (c_size_t, c_int32, *_text_out, _error)),
    "wovenfit_result_pattern": (
        _status,
        (_object, c_char_p, c_char_p, _bytes, c_size_t, _count, _error),
    ),
    "wovenfit_result_pattern_notes": (
        _status,
        (_object, c_char_p, c_char_p, *_text_out, _error),
    ),
}
"""What each function returns (``None`` for void) and takes."""


def declare(library: ctypes.CDLL) -> None:
    """Tells ctypes every signature.

    Raises:
        AttributeError: if the library lacks a function.
    """
    for name, (result, arguments) in SIGNATURES.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
