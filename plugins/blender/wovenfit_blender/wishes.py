"""From an object's properties to the library's design and parameters."""

import numpy as np

from . import limb as limbs
from .marks import find, points_of, renew
from .plain.fields import Kind, design_fields, exact, parameter_fields
from .properties import AUTOMATIC, PAINTED, SCENE
from .wovenfit import Design, DesignError, Parameters


def design_of(limb, surface, mesh, context):
    """The design, and remarks for the designer.

    Raises:
        WovenfitError: if a wish cannot be; its text says which.
    """
    kept = limb.wovenfit
    design = fields_of(limb, surface)
    remarks = []
    points = points_of(limb.data)
    if kept.source == PAINTED:
        design.paint_pressures(mesh, _painted(limb, context))
    else:
        for number, wanted in enumerate(kept.pressures, 1):
            found = find(wanted.mark, points)
            renew(wanted.mark, found, points)
            kpa = exact(wanted.kpa)
            if found.vertex >= 0 and surface.own:
                design.add_pressures_at_vertices(mesh, [found.vertex], kpa)
            else:
                design.add_pressures(limbs.in_world(limb, found.place[None]), kpa)
            if found.vertex < 0:
                remarks.append(
                    f"the vertex of pressure {number} is gone since the mesh was edited: it is "
                    "asked for where the vertex was; select another vertex and Move, or remove it"
                )
    if kept.oriented:
        ends = []
        for name, one in (("first", kept.first), ("second", kept.second)):
            found = find(one, points)
            renew(one, found, points)
            ends.append(found)
            if found.vertex < 0:
                remarks.append(
                    f"the {name} vertex of the orientation is gone since the mesh was edited: the "
                    "place where it was is taken; set the orientation again"
                )
        if surface.own and all(one.vertex >= 0 for one in ends):
            design.set_orientation_at_vertices(mesh, *(one.vertex for one in ends))
        else:
            design.set_orientation(*limbs.in_world(limb, [one.place for one in ends]))
    if len(surface.seams):
        design.add_seams_along_edges(mesh, surface.seams)
    if kept.only_selected:
        if not surface.selected.any():
            raise DesignError(
                "no face is selected: select the faces that the brace covers in edit mode, or "
                "switch off Selected faces only in the panel Seams and Orientation"
            )
        if not surface.selected.all():
            design.set_region_triangles(mesh, surface.selected)
    return design, remarks


def fields_of(limb, surface):
    """A design of those wishes alone that are no places."""
    design = Design(unit=surface.unit)
    _set_fields(design, limb.wovenfit.design)
    return design


def parameters_of(limb):
    """The settings of a limb.

    A unit that was chosen is the designer's word: an unusual size is then a warning, no refusal.
    """
    values = Parameters()
    if limb.wovenfit.units != SCENE:
        values["units"] = limb.wovenfit.units
    for field in parameter_fields():
        value = getattr(limb.wovenfit.settings, field.identifier)
        if field.kind is Kind.NUMBER:
            value = exact(value)
        if value != field.default:
            values[field.name] = value
    return values


def _set_fields(design, group):
    for field in design_fields():
        value = getattr(group, field.identifier)
        if field.optional and field.kind is Kind.NUMBER:
            if not getattr(group, f"use_{field.identifier}"):
                continue
        elif field.kind is Kind.CHOICE and value == AUTOMATIC:
            continue
        if field.kind is Kind.NUMBER:
            value = exact(value)
        if value != field.default:
            design.set(field.name, value)


def _painted(limb, context):
    kept = limb.wovenfit
    if kept.group not in limb.vertex_groups:
        named = f"the vertex group {kept.group!r} is not there" if kept.group else "no vertex group"
        raise DesignError(
            f"pressures are to be painted, and {named}: choose one in the panel Pressures, or "
            "press Paint there"
        )
    asked = limbs.weights(limb, context, kept.group) * exact(kept.most_kpa)
    if not np.any(asked > 0.0):
        raise DesignError(
            f"nothing is painted: all weights of the vertex group {kept.group!r} are 0; paint "
            "where the brace is to press"
        )
    return asked
