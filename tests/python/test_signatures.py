"""Every ctypes signature, struct and number against include/wovenfit.h."""

from __future__ import annotations

import ctypes
import enum
import re
from ctypes import POINTER
from pathlib import Path

import pytest
from wovenfit import abi, signatures

KINDS: dict[str, object] = {
    "wovenfit_status": ctypes.c_int32,
    "int32_t": ctypes.c_int32,
    "uint32_t": ctypes.c_uint32,
    "uint64_t": ctypes.c_uint64,
    "size_t": ctypes.c_size_t,
    "double": ctypes.c_double,
    "void": None,
    "const char *": ctypes.c_char_p,
    "char *": POINTER(ctypes.c_char),
    "const double *": POINTER(ctypes.c_double),
    "double *": POINTER(ctypes.c_double),
    "const float *": POINTER(ctypes.c_float),
    "const uint32_t *": POINTER(ctypes.c_uint32),
    "uint32_t *": POINTER(ctypes.c_uint32),
    "size_t *": POINTER(ctypes.c_size_t),
    "uint8_t *": POINTER(ctypes.c_uint8),
}

STRUCTS = {
    "wovenfit_job_progress": signatures.JobProgress,
    "wovenfit_parameter_bounds": signatures.ParameterBounds,
    "wovenfit_result_summary": signatures.ResultSummary,
    "wovenfit_pressure": signatures.ResultPressure,
}

ENUMS = {
    "wovenfit_status": abi.Status,
    "wovenfit_job_stage": abi.JobStage,
    "wovenfit_job_state": abi.JobState,
    "wovenfit_note_text": abi.NoteText,
    "wovenfit_format_text": abi.FormatText,
    "wovenfit_parameter_kind": abi.ParameterKind,
    "wovenfit_parameter_text": abi.ParameterText,
    "wovenfit_result_array": abi.ResultArray,
    "wovenfit_result_index_array": abi.ResultIndexArray,
    "wovenfit_result_file": abi.ResultFile,
}


@pytest.fixture(scope="module")
def header(repository: Path) -> str:
    """The header without comments, preprocessor lines and the enums' widths."""
    text = (repository / "include" / "wovenfit.h").read_text(encoding="utf-8")
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    text = re.sub(r"//.*", "", text)
    text = re.sub(r"^#define wovenfit_status_ALL.*$", "", text, flags=re.MULTILINE)
    return re.sub(r"^#(?!define WOVENFIT_).*$", "", text, flags=re.MULTILINE)


def functions(header: str) -> dict[str, tuple[str, list[str]]]:
    """Each function's result and the kinds of its arguments, as written."""
    found = {}
    pattern = r"^((?:const )?\w+(?: \*)?)\s*(wovenfit_\w+)\(([^)]*)\);"
    for result, name, arguments in re.findall(pattern, header, re.MULTILINE):
        kinds = [" ".join(argument.split()) for argument in arguments.split(",")]
        kinds = [] if kinds == ["void"] else [re.sub(r"\w+$", "", kind) for kind in kinds]
        found[name] = (result.strip(), [kind.strip() for kind in kinds])
    return found


def expected(kind: str) -> object:
    """What ctypes must have for a kind of the header."""
    if kind in KINDS:
        return KINDS[kind]
    struct = re.fullmatch(r"(?:const )?struct (\w+) (\*+)", kind)
    assert struct, f"a kind that is not known: {kind}"
    if struct[2] == "**":
        return POINTER(ctypes.c_void_p)
    if struct[1] in STRUCTS:
        return POINTER(STRUCTS[struct[1]])
    return ctypes.c_void_p


def test_every_function_of_the_header_is_declared_and_no_other(header: str) -> None:
    # Counted once more in another way, so that a declaration that is not read is missed.
    names = set(re.findall(r"\b(wovenfit_\w+)\(", header))
    assert set(functions(header)) == names
    assert len(names) > 60
    assert set(signatures.SIGNATURES) == names


def test_results_and_arguments_are_of_the_same_number_and_kind(header: str) -> None:
    for name, (result, arguments) in functions(header).items():
        declared = signatures.SIGNATURES[name]
        wanted = (expected(result), tuple(map(expected, arguments)))
        assert declared == wanted, name


def test_structs_have_the_same_fields(header: str) -> None:
    bodies = dict(re.findall(r"typedef struct (\w+) \{(.*?)\}", header, re.DOTALL))
    assert set(bodies) == set(STRUCTS)
    for name, body in bodies.items():
        fields = []
        for kind, field, length in re.findall(r"(\w+) (\w+)(?:\[(\d+)\])?;", body):
            of = KINDS[kind]
            fields.append((field, of * int(length) if length else of))
        assert tuple(fields) == STRUCTS[name]._fields_, name


def test_enums_have_the_same_names_and_numbers(header: str) -> None:
    bodies = dict(re.findall(r"^enum (\w+)\s*(?::\s*int32_t)?\s*\{(.*?)\}", header, re.M | re.S))
    assert set(bodies) == set(ENUMS)
    for name, body in bodies.items():
        of = re.findall(rf"{name.upper()}_(\w+) = (\d+)", body)
        kind: type[enum.IntEnum] = ENUMS[name]
        assert {key: int(value) for key, value in of} == {m.name: m.value for m in kind}, name


def test_the_abi_number_and_no_element_are_the_headers(header: str) -> None:
    defined = dict(re.findall(r"#define (WOVENFIT_\w+) (\w+)", header))
    assert int(defined["WOVENFIT_ABI_VERSION"]) == abi.ABI_VERSION
    assert defined["WOVENFIT_NONE"] == "UINT32_MAX"
    assert abi.NONE == 2**32 - 1
