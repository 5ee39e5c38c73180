"""What is in the two packages: names, versions, licences, a library for old systems.

    packages.py FOLDER BLENDER_EXT.PY

Validating is Blender's; that it can refuse is tried on a package without its manifest's id.
"""

import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[3]
folder, tool = Path(sys.argv[1]), sys.argv[2]

found = sorted(folder.glob("*.zip"))
assert len(found) == 2, found
version = re.search(r'^version = "(.+)"$', (REPOSITORY / "Cargo.toml").read_text(), re.MULTILINE)[1]
for path in found:
    assert f"-{version}-" in path.name, path
    with zipfile.ZipFile(path) as package:
        names = package.namelist()
        inside = "wovenfit_blender/" if path.stem.endswith("-legacy") else ""
        assert all(name.startswith(inside) for name in names)
        assert not any("__pycache__" in name for name in names)
        for name in ("__init__.py", "LICENSE-MIT", "LICENSE-APACHE", "wovenfit/signatures.py"):
            assert inside + name in names, name
        stated = f'"version": ({version.replace(".", ", ")})'.encode()
        assert stated in package.read(f"{inside}__init__.py")
        assert (f"{inside}blender_manifest.toml" in names) == (not inside)
        # The one source: the Python package of this checkout.
        for source in sorted((REPOSITORY / "plugins/python/wovenfit").glob("*.py")):
            assert package.read(f"{inside}wovenfit/{source.name}") == source.read_bytes(), source
        # Blender's own code stands apart from the rest.
        for name in names:
            if name.startswith(f"{inside}plain/") or name.startswith(f"{inside}wovenfit/"):
                assert b"import bpy" not in package.read(name), name
        library = next(name for name in names if "/lib/" in name)
        data = package.read(library)
    if sys.platform.startswith("linux"):
        needed = {
            tuple(map(int, one.split(b"."))) for one in re.findall(rb"GLIBC_(\d+\.\d+)", data)
        }
        assert needed and max(needed) <= (2, 17), max(needed)
    print(f"{path.name}: {len(names)} files, {path.stat().st_size / 1e6:.1f} MB")

extension = next(path for path in found if not path.stem.endswith("-legacy"))
with tempfile.TemporaryDirectory() as scratch:
    broken = Path(scratch) / "broken.zip"
    with zipfile.ZipFile(extension) as package, zipfile.ZipFile(broken, "w") as other:
        for name in package.namelist():
            data = package.read(name)
            if name == "blender_manifest.toml":
                data = re.sub(rb"(?m)^id = .*$", b"", data)
            other.writestr(name, data)
    done = subprocess.run(
        [sys.executable, tool, "validate", str(broken)], capture_output=True, check=False
    )
    assert done.returncode != 0, "Blender's tool takes a manifest without an id"
