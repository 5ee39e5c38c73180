"""MeshLab's sources, whose headers a plugin needs and no package brings, from Debian's archive.

They go to ``target/meshlab`` and are never part of this repository: MeshLab is under the GPL. apt
is asked with lists of its own, so that the machine's sources stay as they are.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tarfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
FOLDER = REPOSITORY / "target" / "meshlab"


class NoHeadersError(Exception):
    """The sources of this version cannot be had; the text says why."""


def sources(version: str) -> Path:
    """The folder with the unpacked sources of a version such as ``2020.09``.

    Raises:
        NoHeadersError: if Debian no longer has them, or this is no Debian.
    """
    unpacked = FOLDER / f"sources-{version}"
    if (unpacked / "src" / "common").is_dir():
        return unpacked
    archive = _downloaded(version)
    fresh = FOLDER / f"unpacking-{version}"
    shutil.rmtree(fresh, ignore_errors=True)
    with tarfile.open(archive) as tar:
        tar.extractall(fresh)
    inside = next((p.parents[1] for p in fresh.rglob("src/common") if p.is_dir()), None)
    if inside is None:
        raise NoHeadersError(f"{archive.name} does not hold MeshLab's sources")
    shutil.rmtree(unpacked, ignore_errors=True)
    inside.rename(unpacked)
    shutil.rmtree(fresh, ignore_errors=True)
    return unpacked


def _downloaded(version: str) -> Path:
    """The archive of the upstream sources."""
    downloads = FOLDER / "downloads"
    downloads.mkdir(parents=True, exist_ok=True)

    def known() -> Path | None:
        return next(iter(sorted(downloads.glob(f"meshlab_{version}*.orig.tar.*"))), None)

    if known() is None:
        apt = _apt()
        full = _full_version(apt, version)
        # What Debian adds to the sources may be gone already; the sources are what counts.
        _run([*apt, "source", "--download-only", f"meshlab={full}"], downloads)
    found = known()
    if found is None:
        raise NoHeadersError(f"Debian's archive no longer has the sources of MeshLab {version}")
    return found


def _apt() -> list[str]:
    """apt-get with lists of its own, of this Debian's and the newest sources."""
    if shutil.which("apt-get") is None:
        raise NoHeadersError(
            "MeshLab's sources come by apt-get, which is not here: unpack them yourself and "
            "name their folder with --sources"
        )
    asked = [
        "apt-get",
        "indextargets",
        "--format",
        "$(REPO_URI) $(CODENAME) $(ORIGIN)",
        "Created-By: Packages",
    ]
    lines = subprocess.run(asked, capture_output=True, text=True, check=False).stdout.splitlines()
    debian = [
        line.split()[:2] for line in lines if line.endswith(" Debian") and "security" not in line
    ]
    if not debian:
        raise NoHeadersError("apt knows no archive of Debian: run apt-get update first")
    address, suite = debian[0]
    suite = re.sub("-.*", "", suite)
    key = "/usr/share/keyrings/debian-archive-keyring.gpg"
    own = FOLDER / "apt"
    for folder in ("lists/partial", "cache/archives/partial"):
        (own / folder).mkdir(parents=True, exist_ok=True)
    entry = f"deb-src [signed-by={key}] {address}"
    (own / "sources.list").write_text(f"{entry} {suite} main\n{entry} sid main\n")
    apt = [
        "apt-get",
        *(
            "-o",
            f"Dir::Etc::sourcelist={own / 'sources.list'}",
            "-o",
            "Dir::Etc::sourceparts=/dev/null",
        ),
        *("-o", f"Dir::State::Lists={own / 'lists'}", "-o", f"Dir::Cache={own / 'cache'}"),
        *("-o", "APT::Sandbox::User=root", "-qq"),
    ]
    _run([*apt, "update"], own)
    return apt


def _full_version(apt: list[str], version: str) -> str:
    shown = subprocess.run(
        ["apt-cache", *apt[1:-1], "showsrc", "meshlab"], capture_output=True, text=True, check=False
    ).stdout
    versions = re.findall(r"^Version: (\S+)$", shown, re.MULTILINE)
    fitting = [full for full in versions if full.startswith(version)]
    if not fitting:
        there = ", ".join(versions) or "none"
        raise NoHeadersError(
            f"Debian's archive has no sources of MeshLab {version} (there are: {there})"
        )
    return fitting[0]


def _run(command: list[str], folder: Path) -> None:
    try:
        subprocess.run(
            command,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=300,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise NoHeadersError(
            f"{' '.join(command[:1])} did not answer within five minutes"
        ) from error
