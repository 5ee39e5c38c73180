"""Finding and loading the library, and what the package is made of."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import wovenfit
from wovenfit import calls, errors, library


@pytest.fixture
def unset(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    monkeypatch.delenv(library.VARIABLE, raising=False)
    return monkeypatch


def fake(folder: Path, source: str) -> Path:
    """A shared library made from C."""
    compiler = shutil.which("cc")
    assert compiler, "a C compiler is needed, as by cargo"
    code, made = folder / "fake.c", folder / library.FILE_NAME
    code.write_text(source)
    subprocess.run([compiler, "-shared", "-fPIC", "-o", str(made), str(code)], check=True)
    return made


def test_the_version_is_the_workspaces(repository: Path) -> None:
    manifest = (repository / "Cargo.toml").read_text(encoding="utf-8")
    assert f'\nversion = "{wovenfit.version()}"\n' in manifest


def test_the_installed_package_carries_its_library(unset: pytest.MonkeyPatch) -> None:
    found = library.candidates()[0]
    assert found.is_file()
    assert found.parent == Path(wovenfit.__file__).resolve().parent / "lib"


def test_a_wrong_path_is_named_and_nothing_else_is_taken(
    unset: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    missing = tmp_path / "nowhere.so"
    unset.setenv(library.VARIABLE, str(missing))
    with pytest.raises(wovenfit.LibraryError, match=library.VARIABLE) as raised:
        library.find_library()
    assert str(missing) in str(raised.value)
    assert isinstance(raised.value, ImportError)


def test_without_a_library_every_place_is_named(unset: pytest.MonkeyPatch, tmp_path: Path) -> None:
    # As in a checkout in which nothing was built.
    package = tmp_path / "plugins" / "python" / "wovenfit"
    (tmp_path / "ffi").mkdir()
    (tmp_path / "ffi" / "Cargo.toml").touch()
    unset.setattr(library, "__file__", str(package / "library.py"))
    with pytest.raises(wovenfit.LibraryError) as raised:
        library.find_library()
    for place in (package / "lib", tmp_path / "target" / "release"):
        assert str(place / library.FILE_NAME) in str(raised.value)


def test_the_order_is_variable_then_package_then_checkout(
    unset: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    package = tmp_path / "plugins" / "python" / "wovenfit"
    unset.setattr(library, "__file__", str(package / "library.py"))
    own = package / "lib" / library.FILE_NAME
    assert library.candidates() == [own]
    (tmp_path / "ffi").mkdir()
    (tmp_path / "ffi" / "Cargo.toml").touch()
    assert library.candidates() == [own, tmp_path / "target" / "release" / library.FILE_NAME]
    unset.setenv(library.VARIABLE, "here.so")
    assert library.candidates() == [Path.cwd() / "here.so"]


def test_what_is_no_library_is_refused(tmp_path: Path) -> None:
    text = tmp_path / library.FILE_NAME
    text.write_text("not a library")
    with pytest.raises(wovenfit.LibraryError, match="cannot be loaded"):
        library.open_library(text)


def test_a_library_of_something_else_is_refused(tmp_path: Path) -> None:
    made = fake(tmp_path, "int something(void) { return 1; }")
    with pytest.raises(wovenfit.LibraryError, match=r"is not a library of wovenfit"):
        library.open_library(made)


def test_another_abi_is_refused_with_both_numbers(tmp_path: Path) -> None:
    made = fake(tmp_path, "unsigned wovenfit_abi_version(void) { return 77; }")
    with pytest.raises(wovenfit.LibraryError) as raised:
        library.open_library(made)
    assert f"has ABI 77, and this package was made for ABI {wovenfit.ABI_VERSION}" in str(
        raised.value
    )


def test_a_missing_function_is_named(tmp_path: Path) -> None:
    source = f"unsigned wovenfit_abi_version(void) {{ return {wovenfit.ABI_VERSION}; }}"
    with pytest.raises(wovenfit.LibraryError, match=r"lacks a function.*wovenfit_version"):
        library.open_library(fake(tmp_path, source))


def test_the_library_itself_refuses_another_abi() -> None:
    with pytest.raises(wovenfit.AbiMismatch, match=r"ABI 99 .* ABI 1"):
        calls.call("wovenfit_check_abi", 99)


def test_every_status_has_its_own_exception() -> None:
    failures = {int(status) for status in wovenfit.Status if status != wovenfit.Status.OK}
    assert set(errors.BY_STATUS) == failures
    kinds = {errors.error_of(status, "why") for status in failures}
    assert len({type(error) for error in kinds}) == len(failures)
    assert all(str(error) == "why" for error in kinds)
    unknown = errors.error_of(12345, "why")
    assert isinstance(unknown, wovenfit.UnknownStatus)
    assert unknown.number == 12345


def test_the_package_imports_no_host() -> None:
    allowed = {
        *("__future__", "collections", "contextlib", "ctypes", "dataclasses", "enum", "errno"),
        *("functools", "json", "math", "os", "pathlib", "sys", "tempfile", "threading", "time"),
        *("types", "typing", "typing_extensions", "weakref", "numpy"),
    }
    files = sorted(Path(wovenfit.__file__).parent.glob("**/*.py"))
    assert len(files) > 10
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                modules = [node.module or ""]
            else:
                continue
            assert {module.split(".")[0] for module in modules} <= allowed, (file, modules)


def test_importing_loads_no_library(tmp_path: Path) -> None:
    # A host that lists its add-ons imports them: that must work where the library does not.
    there = {**os.environ, library.VARIABLE: str(tmp_path / "nowhere.so")}
    done = subprocess.run([sys.executable, "-c", "import wovenfit"], env=there, check=False)
    assert done.returncode == 0
