"""Words for a narrow panel: numbers with units, wrapped lines, the host's names for the library's."""

from __future__ import annotations

import re
import textwrap

from ..wovenfit import KPA_PER_MMHG, JobStage

MMHG, KPA = "mmHg", "kPa"

STAGES = {
    JobStage.WAITING: "Waiting",
    JobStage.SURFACE: "Checking the surface",
    JobStage.REGION: "Keeping the region",
    JobStage.CUT: "Cutting it open",
    JobStage.PARAMETERIZATION: "Laying it flat",
    JobStage.CURVATURE: "Reading curvature",
    JobStage.FIT: "Fitting the fabric",
    JobStage.MAPPING: "Mapping the fabric",
    JobStage.REPORT: "Judging the pattern",
}
"""What a stage does, for the progress bar."""


def mmhg(kpa: float) -> float:
    """Pressure in mmHg."""
    return kpa / KPA_PER_MMHG


def pressure(kpa: float | None, unit: str) -> str:
    """A pressure with its unit; a dash for one that is not known."""
    if kpa is None:
        return "–"
    return f"{mmhg(kpa):.1f} mmHg" if unit == MMHG else f"{kpa:.2f} kPa"


def percent(strain: float | None) -> str:
    """A strain in per cent."""
    return "–" if strain is None else f"{100 * strain:.1f} %"


def millimetres(length: float) -> str:
    """A length with its unit."""
    return f"{length:.1f} mm"


def wrapped(text: str, width: int) -> list[str]:
    """Lines of at most so many characters; line breaks of the text stay."""
    lines = []
    for line in text.splitlines():
        lines += textwrap.wrap(line, max(width, 20)) or [""]
    return lines


def in_host_words(text: str) -> str:
    """The library's text where it names the command line's options, with the panels' names."""
    text = re.sub(r"its unit with `--units`", "its unit under Units in the panel Surface", text)
    text = re.sub(r"say `--units ([a-z]+)`", r"set Units to \1 in the panel Surface", text)
    text = re.sub(r"`--units ([a-z]+)`", r"Units \1 in the panel Surface", text)
    return re.sub(
        r"`--([a-z-]+)`",
        lambda match: f"{match[1].replace('-', ' ').capitalize()} under Settings",
        text,
    )
