"""What a pattern of a test must measure: from `worn.obj`, read here, and the design's allowances.

The test's limb is a cylinder cut along a straight generator, so its pattern is a rectangle but for
the fit's residue: the cut line's extent is the pattern's plus the allowances on its four sides.
"""

from __future__ import annotations

import json
import pathlib


class Truth:
    """Sizes in mm."""

    def __init__(self, folder: pathlib.Path, design: pathlib.Path) -> None:
        lines = (folder / "worn.obj").read_text().splitlines()
        plane = [tuple(map(float, line.split()[1:3])) for line in lines if line.startswith("vt ")]
        xs, ys = zip(*plane)
        self.sewn = (max(xs) - min(xs), max(ys) - min(ys))
        piece = json.loads(design.read_text()).get("piece", {})
        side, top, bottom = (
            piece.get(f"{name}_allowance_mm", 0.0) for name in ("seam", "top", "bottom")
        )
        self.piece = piece
        self.allowances = {"seam": side, "top": top, "bottom": bottom}
        self.cut = (self.sewn[0] + 2 * side, self.sewn[1] + top + bottom)

    @staticmethod
    def compare(what: str, got: float, wanted: float, tolerance: float = 0.1) -> None:
        """Ends the program unless two lengths in mm agree."""
        print(f"  {what}: {got:.3f} mm read, {wanted:.3f} mm wanted")
        if not abs(got - wanted) < tolerance:
            raise SystemExit(f"{what} is {got:.3f} mm, not {wanted:.3f} mm")


def bounds(points: list[tuple[float, float]]) -> tuple[float, float]:
    """Width and height of points."""
    xs, ys = zip(*points)
    return max(xs) - min(xs), max(ys) - min(ys)
