"""Fabrics to begin with, for the presets of hosts.

They are the two test fabrics of Wang & Tang (REFERENCES.md), not fabrics that one can buy: measure
yours at working strain and keep it as a preset of the host.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Union

FABRICS: Mapping[str, Mapping[str, Union[float, str]]] = MappingProxyType(
    {
        "isotropic": MappingProxyType(
            {"name": "weave 0.5 / 0.5 / 0.05 N/mm", "warp": 0.5, "weft": 0.5, "diagonal": 0.05}
        ),
        "anisotropic": MappingProxyType(
            {"name": "weave 0.5 / 5 / 0.05 N/mm", "warp": 0.5, "weft": 5.0, "diagonal": 0.05}
        ),
    }
)
"""What `Design.set_fabric` takes, by the fabrics' short names; stiffness in N/mm."""
