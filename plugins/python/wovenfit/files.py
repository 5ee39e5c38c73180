"""Writing results as the command line does: all files appear complete, or none does.

They are first written into a hidden folder on the same file system and then renamed, which replaces
a file in one step. If a rename fails, what was there before is put back. Only the named files are
touched; whatever else lies in the folder stays.
"""

from __future__ import annotations

import errno
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping


def write_together(folder: str | os.PathLike[str], files: Mapping[str, bytes]) -> tuple[Path, ...]:
    """Writes files by their names into a folder, which is made if there is none; where they are.

    Raises:
        OSError: if they cannot be written; nothing has changed then.
    """
    into = Path(folder)
    missing = [path for path in (into, *into.parents) if not path.exists()]
    try:
        into.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".wovenfit-", dir=into) as work:
            _place(into, files, Path(work))
    except BaseException:
        # Ours and empty, or they stay.
        for path in missing:
            try:
                path.rmdir()
            except OSError:
                break
        raise
    return tuple(into / name for name in files)


def _place(into: Path, files: Mapping[str, bytes], work: Path) -> None:
    fresh, former = work / "new", work / "old"
    fresh.mkdir()
    former.mkdir()
    for name, contents in files.items():
        if (into / name).is_dir():
            raise IsADirectoryError(
                errno.EISDIR, "this is a folder there; move it away", str(into / name)
            )
        with (fresh / name).open("xb") as file:
            file.write(contents)
            file.flush()
            os.fsync(file.fileno())
    begun = []
    try:
        for name in files:
            begun.append(name)
            target = into / name
            if target.exists() or target.is_symlink():
                target.rename(former / name)
            (fresh / name).rename(target)
    except BaseException:
        for name in reversed(begun):
            _restore(into / name, former / name, fresh / name)
        raise


def _restore(target: Path, before: Path, fresh: Path) -> None:
    """Undoes the exchange of a file as far as it came."""
    if before.exists() or before.is_symlink():
        before.replace(target)
    elif not fresh.exists():
        target.unlink()
