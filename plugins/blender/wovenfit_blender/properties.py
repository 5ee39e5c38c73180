"""What is kept with an object: wishes, marks on its vertices, and what was found.

All of it is stored in the file, undone and duplicated with the object. Properties of the design and
of the settings are made from the library's schema and table.
"""

import bpy

from .plain.fields import Field, Kind, design_fields, parameter_fields, unit_names
from .plain.wording import mmhg
from .wovenfit import KPA_PER_MMHG

SCENE = "scene"
"""Units that are the scene's."""
AUTOMATIC = "automatic"
"""A choice that was not made."""

WARP, WEFT, PRESSURE = "warp", "weft", "pressure"
SHOWN = (
    (WARP, "Warp strain", "Strain of the fabric round the limb"),
    (WEFT, "Weft strain", "Strain of the fabric along the limb"),
    (PRESSURE, "Pressure", "Computed normal pressure"),
)
"""What colours may show."""


def changed(self, context):
    """A wish was changed: what was found before is no longer of these wishes."""
    del context
    owner = self.id_data
    kept = getattr(owner, "wovenfit", None)
    if kept is not None and kept.result:
        kept.stale = True


def _recolour(self, context):
    from .result import recolour  # which needs these properties

    recolour(self.id_data)


def in_mmhg(name):
    """The property that shows another, which holds kPa, in mmHg."""
    return bpy.props.FloatProperty(
        name="mmHg",
        description="In mmHg. 1 mmHg is 0.133322 kPa",
        get=lambda self: mmhg(getattr(self, name)),
        set=lambda self, value: setattr(self, name, value * KPA_PER_MMHG),
        min=0.0,
        precision=1,
        step=100,
    )


def of_field(field: Field):
    """The properties that hold a field, by their names."""
    given = {"name": field.label, "description": field.tooltip, "update": changed}
    made = {}
    if field.kind is Kind.CHOICE:
        items = [(name, name.capitalize(), text) for name, text in field.choices]
        if field.optional:
            items.insert(0, (AUTOMATIC, "Automatic", "Taken from the limb's shape"))
        default = AUTOMATIC if field.optional else field.default
        made[field.identifier] = bpy.props.EnumProperty(items=items, default=default, **given)
        return made
    if field.kind is Kind.TEXT:
        return {field.identifier: bpy.props.StringProperty(default=field.default, **given)}
    if field.kind is Kind.SWITCH:
        return {field.identifier: bpy.props.BoolProperty(default=field.default, **given)}
    if field.kind is Kind.INTEGER:
        bounds = {"min": int(field.least), "max": int(field.most)}
        return {
            field.identifier: bpy.props.IntProperty(default=int(field.default), **bounds, **given)
        }
    bounds = {}
    if field.least is not None:
        bounds["min"] = field.least
    if field.most is not None:
        bounds["max"] = field.most
    precision = 6 if field.default and abs(field.default) < 1e-3 else 3
    default = 0.0 if field.optional else field.default
    if field.optional:
        made[f"use_{field.identifier}"] = bpy.props.BoolProperty(**given)
        bounds["min"] = 0.0
    made[field.identifier] = bpy.props.FloatProperty(
        default=default, precision=precision, step=1, **bounds, **given
    )
    if field.unit == "kPa":
        made[f"{field.identifier}_mmhg"] = in_mmhg(field.identifier)
    return made


def _group(name, documentation, fields):
    made = {}
    for field in fields:
        made.update(of_field(field))
    return type(
        name,
        (bpy.types.PropertyGroup,),
        {"__doc__": documentation, "__annotations__": made, "__module__": __name__},
    )


class WovenfitMark(bpy.types.PropertyGroup):
    """A vertex of the object's mesh, and what it is found again by."""

    vertex: bpy.props.IntProperty(name="Vertex", description="Its index", default=-1)
    place: bpy.props.FloatVectorProperty(
        name="Place", description="Where it was, in the object's own coordinates", size=3
    )
    vertices: bpy.props.IntProperty(
        name="Vertices", description="How many the mesh had when it was marked"
    )


class WovenfitPressure(bpy.types.PropertyGroup):
    """A wanted pressure at a vertex."""

    mark: bpy.props.PointerProperty(type=WovenfitMark)
    kpa: bpy.props.FloatProperty(
        name="kPa",
        description="Wanted normal pressure in kPa",
        default=15.0 * KPA_PER_MMHG,
        min=0.0,
        precision=3,
        step=1,
        update=changed,
    )
    mmhg: in_mmhg("kpa")


WovenfitDesign = _group(
    "WovenfitDesign", "Wishes of the design file that are no places.", design_fields()
)
WovenfitSettings = _group("WovenfitSettings", "The library's parameters.", parameter_fields())

PINNED, PAINTED = "pinned", "painted"


def _is_mesh(self, candidate):
    del self
    return candidate.type == "MESH"


class WovenfitObject(bpy.types.PropertyGroup):
    """What the add-on keeps with an object."""

    # Wishes.
    units: bpy.props.EnumProperty(
        name="Units",
        description="What one unit of the object's world coordinates is",
        items=[
            (SCENE, "Scene", "What the scene's units say: a metre times its unit scale"),
            *(
                (name, name, f"One unit is 1 {name}, whatever the scene says")
                for name in unit_names()
            ),
        ],
        update=changed,
    )
    source: bpy.props.EnumProperty(
        name="Pressures from",
        description="How pressures are asked for",
        items=[
            (PINNED, "Points", "A list of vertices with a pressure each"),
            (PAINTED, "Paint", "A vertex group: its weights times the highest pressure"),
        ],
        update=changed,
    )
    pressures: bpy.props.CollectionProperty(type=WovenfitPressure)
    active_pressure: bpy.props.IntProperty(name="Pressure", description="The one that is chosen")
    group: bpy.props.StringProperty(
        name="Vertex group",
        description="Its weights times the highest pressure are asked for; weight 0 asks nothing",
        update=changed,
    )
    most_kpa: bpy.props.FloatProperty(
        name="At weight 1 (kPa)",
        description="Pressure wanted where the weight is 1, in kPa",
        default=20.0 * KPA_PER_MMHG,
        min=0.0,
        precision=3,
        step=1,
        update=changed,
    )
    most_kpa_mmhg: in_mmhg("most_kpa")
    oriented: bpy.props.BoolProperty(
        name="By two vertices",
        description="Whether two vertices say what is up in the pattern; else the limb itself does",
        update=changed,
    )
    first: bpy.props.PointerProperty(type=WovenfitMark)
    second: bpy.props.PointerProperty(type=WovenfitMark)
    only_selected: bpy.props.BoolProperty(
        name="Selected faces only",
        description="The brace covers the faces that are selected in edit mode alone. "
        "Pressure is still read off all of it",
        update=changed,
    )
    design: bpy.props.PointerProperty(type=WovenfitDesign)
    settings: bpy.props.PointerProperty(type=WovenfitSettings)

    # What was found, as text that the panels read.
    check: bpy.props.StringProperty()
    result: bpy.props.StringProperty()
    solved: bpy.props.StringProperty()
    error: bpy.props.StringProperty()
    faults: bpy.props.StringProperty()
    stale: bpy.props.BoolProperty()
    full_notes: bpy.props.BoolProperty(
        name="In full", description="Show of every warning also where it is and what to do"
    )
    shown: bpy.props.EnumProperty(
        name="Colours",
        description="What the colour attribute shows, on limb and pattern",
        items=SHOWN,
        update=_recolour,
    )
    scale_least: bpy.props.FloatProperty()
    scale_most: bpy.props.FloatProperty()

    # Who belongs to whom.
    flat: bpy.props.PointerProperty(type=bpy.types.Object, poll=_is_mesh)
    worn: bpy.props.PointerProperty(type=bpy.types.Object, poll=_is_mesh)
    limb: bpy.props.PointerProperty(type=bpy.types.Object, poll=_is_mesh)


def limb_of(context):
    """The limb that panels and operators are about: the active mesh, or what it is a pattern of."""
    active = context.object
    if active is None or active.type != "MESH":
        return None
    return active.wovenfit.limb or active


CLASSES = (
    WovenfitMark,
    WovenfitPressure,
    WovenfitDesign,
    WovenfitSettings,
    WovenfitObject,
)


def register():
    bpy.types.Object.wovenfit = bpy.props.PointerProperty(type=WovenfitObject)


def unregister():
    del bpy.types.Object.wovenfit
