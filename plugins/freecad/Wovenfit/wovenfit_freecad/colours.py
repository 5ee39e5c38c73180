"""Numbers as colours: a scale that also shows in grey print and to the colour-blind (dark blue is
low, yellow is high)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

STOPS = np.array(
    [
        [0.19, 0.07, 0.36],
        [0.20, 0.28, 0.58],
        [0.13, 0.50, 0.60],
        [0.28, 0.68, 0.47],
        [0.67, 0.82, 0.28],
        [0.99, 0.91, 0.30],
    ]
)
"""RGB at equal steps from low to high; lightness grows evenly."""

NONE = (0.6, 0.6, 0.6)
"""Where there is no value."""


def scale(values: npt.NDArray[np.float64], least: float) -> tuple[float, float]:
    """The ends of the scale: without the outermost hundredth on each side, which would take the
    colours from all else. It spans at least `least`: colours that show less would show rounding."""
    there = values[np.isfinite(values)]
    if there.size == 0:
        return 0.0, least
    low, high = map(float, np.percentile(there, [1, 99]))
    missing = max(0.0, least - (high - low)) / 2
    return low - missing, high + missing


def colours(values: npt.NDArray[np.float64], low: float, high: float) -> npt.NDArray[np.float64]:
    """(n, 3) RGB for (n,) values; beyond the ends the end's colour."""
    at = np.clip((np.nan_to_num(values) - low) / (high - low), 0, 1)
    stops = np.linspace(0, 1, len(STOPS))
    rgb = np.stack([np.interp(at, stops, STOPS[:, c]) for c in range(3)], axis=-1)
    rgb[~np.isfinite(values)] = NONE
    return rgb
