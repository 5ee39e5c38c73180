"""Values as colours: one ramp from dark violet over green to yellow, grey where there is none.

The ramp rises evenly in lightness, so that it reads in print and with any colour vision.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Doubles = npt.NDArray[np.float64]

RAMP = np.array(
    [
        [0.27, 0.00, 0.33],
        [0.23, 0.32, 0.55],
        [0.13, 0.57, 0.55],
        [0.37, 0.79, 0.38],
        [0.99, 0.91, 0.14],
    ]
)
"""sRGB at equal steps."""

NOTHING = (0.45, 0.45, 0.45)
"""sRGB where there is no value."""

OUTLIERS = 1.0
"""Per cent of the values that lie beyond either end of the ramp: a rim's few would flatten it."""


def range_of(values: Doubles) -> tuple[float, float]:
    """The values at the two ends of the ramp, for values of which some may be NaN."""
    known = values[np.isfinite(values)]
    if known.size == 0:
        return 0.0, 1.0
    least, most = np.percentile(known, [OUTLIERS, 100.0 - OUTLIERS])
    return (float(least), float(most)) if most > least else (float(least), float(least) + 1e-6)


def ramp(share: Doubles) -> Doubles:
    """(n, 3) sRGB for shares of the way along the ramp, from 0 to 1."""
    steps = np.linspace(0.0, 1.0, len(RAMP))
    return np.stack([np.interp(share, steps, RAMP[:, channel]) for channel in range(3)], axis=1)


def linear(srgb: Doubles) -> Doubles:
    """Scene-linear from sRGB, as a host's colour attributes hold it."""
    low = srgb / 12.92
    high = ((srgb + 0.055) / 1.055) ** 2.4
    return np.where(srgb <= 0.04045, low, high)


def coloured(values: Doubles, between: tuple[float, float]) -> npt.NDArray[np.float32]:
    """(n, 4) scene-linear colours of values on a ramp between two of them."""
    least, most = between
    known = np.isfinite(values)
    share = np.clip((np.where(known, values, least) - least) / (most - least), 0.0, 1.0)
    srgb = np.where(known[:, None], ramp(share), np.array(NOTHING))
    return np.concatenate([linear(srgb), np.ones((len(values), 1))], axis=1).astype(np.float32)
