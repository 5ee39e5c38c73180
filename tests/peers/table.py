"""What the measurement found, as text: one line a method, checks and criteria below."""

from __future__ import annotations

from typing import Any

HEADINGS = (
    "method",
    "median",
    "min",
    "max",
    "runs",
    "ratio",
    "stretch",
    "flips",
    "seam edge",
    "whole",
    "strain err",
    "",
)
WIDTHS = (36, 9, 9, 9, 4, 7, 7, 5, 9, 8, 10, 0)

LEGEND = """\
median, min, max  wall-clock seconds of the fit alone: the start is not in it, nor files
ratio             median over ours (the first line): above 1 ours is faster
stretch           RMS of both principal stretches about 1, surface to pattern, by the
                  surface's area; ours and the trick are meant to be stretched
flips             triangles that lie the wrong way round
seam edge, whole  largest difference of a seam edge's two sides, of a whole seam's, over their mean
strain err        RMS of warp strain minus wanted strain, by area in the pattern"""


def _seconds(value: float) -> str:
    return f"{value:.4f} s" if value < 1.0 else f"{value:.2f} s"


def _line(cells: tuple[str, ...]) -> str:
    first, *others = zip(cells, WIDTHS, strict=True)
    padded = [first[0].ljust(first[1]), *(cell.rjust(width) for cell, width in others)]
    return "  ".join(padded).rstrip()


def limb_table(limb: dict[str, Any]) -> str:
    """One limb at one size: the methods, then what was compared."""
    size = f"{limb['triangles']:,} triangles, {limb['cut_triangles']:,} in the cut mesh"
    lines = [
        "",
        f"{limb['limb']}, {size}",
        _line(HEADINGS),
    ]
    for row in limb["methods"]:
        if "failed" in row:
            lines.append(f"{row['method']:{WIDTHS[0]}}  {row['failed']}")
            continue
        runs = row["seconds"]["runs"]
        error = row.get("strain_error")
        lines.append(
            _line(
                (
                    row["method"],
                    *(
                        _seconds(value)
                        for value in (row["seconds"]["median"], min(runs), max(runs))
                    ),
                    str(len(runs)),
                    f"{row['ratio']:.2f}" if row.get("ratio") else "",
                    f"{row['stretch_rms']:.3f}",
                    str(row["flips"]),
                    f"{100.0 * row['seam_edge']:.3f} %",
                    f"{100.0 * row['seam_whole']:.3f} %",
                    f"{error:.4f}" if error is not None else "",
                    row.get("remark", ""),
                )
            )
        )
    for check in limb["checks"]:
        verdict = "the time counts" if check["counts"] else "THE TIME DOES NOT COUNT"
        lines.append(
            f"{check['method']} against a tolerance of {check['tighter_mm']:g} mm: outline "
            f"{check['outline_mm']:.4f} mm, all vertices {check['vertices_mm']:.4f} mm, pressures "
            f"{100.0 * check['pressure']:.3f} %, converged: "
            f"{'yes' if check['converged'] else 'NO'}; {verdict}"
        )
    for diffusion in limb["diffusion"]:
        lines.append(
            f"J_E over the fabric's area: ours, free, {diffusion['ours_density']:.4e}, diffusion of "
            f"{diffusion['spacing_mm']:.3g} mm {diffusion['diffusion_density']:.4e} N/mm ({diffusion['above'] * 100.0:+.1f} %)"
            + (
                f"; ours is down there after step {diffusion['step']} of {diffusion['steps']}, "
                f"{_seconds(diffusion['ours_seconds'])}: the diffusion takes "
                f"{diffusion['ratio']:.0f} times as long to the same J_E"
                if "ratio" in diffusion
                else "; ours does not come down there: no time to the same J_E"
            )
        )
    return "\n".join(lines)


def whole_table(rows: list[dict[str, Any]]) -> str:
    """The whole of `flatten`, by size."""
    lines = [
        "",
        "whole flatten with the design's pressures, reading to written report",
        f"{'limb':8} {'triangles':>10} {'median':>10} {'min':>10} {'CPU':>10} {'peak':>11}"
        "  stages (seconds, last run)",
    ]
    for row in rows:
        stages = "  ".join(f"{name} {value:.3f}" for name, value in row["stages"].items())
        lines.append(
            f"{row['limb']:8} {row['triangles']:>10,} {_seconds(row['seconds']['median']):>10} "
            f"{_seconds(min(row['seconds']['runs'])):>10} {_seconds(row['cpu']['median']):>10} "
            f"{row['peak_mib']:>7.0f} MiB  {stages}"
        )
    return "\n".join(lines)


def criteria_table(criteria: list[dict[str, Any]]) -> str:
    """What is wanted against what was measured."""
    lines = ["", "wanted and measured"]
    for entry in criteria:
        mark = {True: "holds", False: "MISSED", None: "unsure"}[entry["holds"]]
        lines.append(f"{mark:8}{entry['what']}: {entry['measured']}")
    return "\n".join(lines)
