"""Works in Blender's window as a designer does: clicks and keys, and pictures of what is seen.

    xvfb-run -a -s "-screen 0 1280x900x24" blender --factory-startup --enable-event-simulate \
        --python-exit-code 1 -p 0 0 1280 900 --python window.py

The environment is that of run.py; WOVENFIT_PICTURES is the folder for the pictures. Positions of
buttons are those of Debian's Blender 3.4.1 at the size above; where one is not hit a check fails,
and the last picture shows what is there. The last line says `N passed, M failed`.
"""

import os
import sys
import time
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bpy
import numpy as np
import scene
from install import install

PICTURES = Path(os.environ["WOVENFIT_PICTURES"])
SEEN = {"passed": 0, "failed": 0, "drawn": 0}

# No splash over the buttons.
bpy.context.preferences.view.show_splash = False


def check(good, what):
    """Counts one check."""
    SEEN["passed" if good else "failed"] += 1
    if not good:
        print(f"FAILED: {what}")


def window():
    """The only window."""
    return bpy.context.window_manager.windows[0]


def view():
    """The 3D view's area and its regions by their types."""
    area = next(one for one in window().screen.areas if one.type == "VIEW_3D")
    return area, {region.type: region for region in area.regions}


def picture(name):
    """Keeps what the window shows."""
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    with bpy.context.temp_override(window=window()):
        bpy.ops.screen.screenshot(filepath=str(PICTURES / f"{name}.png"))


def move(x, y):
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=int(x), y=int(y))


def click(x, y):
    """A click at a place of the window, in pixels from its lower left corner."""
    move(x, y)
    yield 0.1
    window().event_simulate(type="LEFTMOUSE", value="PRESS", x=int(x), y=int(y))
    yield 0.05
    window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=int(x), y=int(y))
    yield 0.3


def key(kind, **also):
    """A key, with the mouse over the 3D view."""
    _, regions = view()
    main = regions["WINDOW"]
    move(main.x + main.width // 3, main.y + main.height // 2)
    yield 0.1
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(
            type=kind, value=value, x=main.x + main.width // 3, y=main.y + main.height // 2, **also
        )
        yield 0.1


def sidebar(from_left, from_top):
    """A place of the sidebar, in pixels of the picture from its left and upper edge."""
    _, regions = view()
    region = regions["UI"]
    return region.x + from_left, region.y + region.height - from_top


def scroll_to_top():
    """The sidebar from its beginning."""
    x, y = sidebar(100, 200)
    move(x, y)
    yield 0.05
    for _ in range(30):
        window().event_simulate(type="WHEELUPMOUSE", value="PRESS", x=int(x), y=int(y))
    yield 0.3


def watch_panel():
    """Counts how often our first panel is drawn: 3.4 does not say which tab is in front."""
    panel = bpy.types.WOVENFIT_PT_surface
    draw = panel.draw

    def counted(self, context):
        SEEN["drawn"] += 1
        draw(self, context)

    panel.draw = counted


def look_at(limb, sideways=0.0):
    """Frames limb and pattern from the front."""
    area, regions = view()
    space = area.spaces.active
    region = space.region_3d
    region.view_perspective = "ORTHO"
    region.view_rotation = (0.7071, 0.7071, 0.0, 0.0)
    points = scene.world(limb)
    low, high = points.min(axis=0), points.max(axis=0)
    region.view_location = ((low + high) / 2 + [sideways, 0.0, 0.0]).tolist()
    region.view_distance = 0.75
    del regions


def steps():
    """What is done, one step after the other; each yields the seconds to wait."""
    scene.module_name = install()
    watch_panel()
    scene.clear()
    limb = scene.pinned_arm()
    for _ in range(3):
        bpy.ops.wovenfit.remove_pressure()
    limb.wovenfit.pressures[0].mmhg = 12.0
    area, _ = view()
    area.spaces.active.show_region_ui = True
    look_at(limb, 0.12)
    yield 0.5

    # The tabs stand at the sidebar's right edge: click down until ours is in front.
    _, regions = view()
    before = SEEN["drawn"]
    for from_top in range(60, 500, 25):
        yield from click(*sidebar(regions["UI"].width - 8, from_top))
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
        if SEEN["drawn"] > before:
            break
    check(SEEN["drawn"] > before, "the tab WovenFit is not found in the sidebar")
    picture("1-panels")

    # Fabric and seams away, so that all that is pressed below is in sight.
    for from_top in (379, 408):
        yield from click(*sidebar(60, from_top))
    picture("2-closed")

    # A vertex is selected in edit mode; + is pressed; a value is typed into the list.
    bpy.ops.object.mode_set(mode="EDIT")
    front = nearest(limb, [0.02, -0.04, 0.0])
    select_vertex(limb, front)
    yield 0.3
    yield from click(*sidebar(173, 235))
    kept = limb.wovenfit
    check(len(kept.pressures) == 2, "Add pressure was not pressed")
    check(len(kept.pressures) == 2 and kept.pressures[1].mark.vertex == front, "another vertex")
    picture("3-added")
    # With the mouse over a field Enter opens it for typing.
    x, y = sidebar(100, 265)
    move(x, y)
    yield 0.2
    for name, letter in (("RET", ""), ("ONE", "1"), ("FIVE", "5"), ("RET", "")):
        also = {"unicode": letter} if letter else {}
        window().event_simulate(type=name, value="PRESS", x=int(x), y=int(y), **also)
        yield 0.1
        window().event_simulate(type=name, value="RELEASE", x=int(x), y=int(y))
        yield 0.1
    yield 0.3
    check(abs(kept.pressures[-1].mmhg - 15.0) < 1e-3, f"typed: {kept.pressures[-1].mmhg} mmHg")
    bpy.ops.object.mode_set(mode="OBJECT")
    yield 0.3
    picture("4-typed")

    # Flatten.
    before = set(bpy.data.objects)
    bpy.ops.ed.undo_push(message="before Flatten")
    yield from click(*sidebar(60, 471))
    yield from until(lambda: kept.flat is not None, 30)
    check(kept.flat is not None and not kept.error, f"Flatten: {kept.error}")
    check(len(set(bpy.data.objects) - before) == 1, "Flatten made no object, or several")
    area.spaces.active.shading.color_type = "VERTEX"
    yield 0.5
    picture("5-flattened")
    for _ in range(2):
        x, y = sidebar(60, 520)
        for _ in range(4):
            window().event_simulate(type="WHEELDOWNMOUSE", value="PRESS", x=int(x), y=int(y))
            yield 0.05
    yield 0.3
    picture("6-result")
    yield from scroll_to_top()

    # A file through the file dialog, which takes the place of the 3D view for once.
    yield from export()

    # One step back.
    name = limb.name
    yield from key("Z", ctrl=True)
    yield 0.5
    limb = bpy.data.objects[name]
    check(limb.wovenfit.flat is None, "Ctrl Z did not take the pattern away")
    check(len(limb.wovenfit.pressures) == 2, "Ctrl Z took more than one step")
    picture("7-undone")
    yield from cancel_a_long_one()


def export():
    """Export One File: the dialog, and Enter."""
    into = Path(os.environ["WOVENFIT_SCRATCH"]) / "window"
    into.mkdir(exist_ok=True)
    pattern = scene.solved().pattern
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    with bpy.context.temp_override(window=window(), area=view()[0]):
        bpy.ops.wovenfit.export_file("INVOKE_DEFAULT", filepath=f"{into}/", file="pattern.svg")
    yield 1.0
    area = next((one for one in window().screen.areas if one.type == "FILE_BROWSER"), None)
    check(area is not None, "no file dialog opened")
    picture("6-export")
    if area is None:
        return
    x, y = area.x + area.width // 2, area.y + area.height // 2
    move(x, y)
    yield 0.3
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type="RET", value=value, x=x, y=y)
        yield 0.2
    written = into / "pattern.svg"
    yield from until(written.exists, 5)
    check(written.exists(), "the file dialog wrote nothing")
    check(written.exists() and written.read_bytes() == pattern.file("pattern.svg"), "other bytes")
    yield 0.5


def cancel_a_long_one():
    """Flatten with settings that take minutes, and Esc."""
    scene.clear()
    limb = scene.pinned_arm()
    limb.wovenfit.settings.method = "diffusion"
    limb.wovenfit.settings.spacing = 1.0
    look_at(limb, 0.12)
    yield 0.5
    area, regions = view()
    job = scene.addon("job")
    yield from click(*sidebar(60, 471))
    yield from until(lambda: job.running is not None, 5)
    check(job.running is not None, "Flatten does not run")
    # The window is alive: the view zooms while the solver works.
    distance = area.spaces.active.region_3d.view_distance
    main = regions["WINDOW"]
    x, y = main.x + main.width // 3, main.y + main.height // 2
    move(x, y)
    window().event_simulate(type="WHEELUPMOUSE", value="PRESS", x=x, y=y)
    yield 0.2
    running = job.running is not None
    picture("8-running")
    check(running and area.spaces.active.region_3d.view_distance < distance, "the window stands")
    check(job.running is not None and job.running.share > 0.0, "no progress is shown")
    yield from key("ESC")
    begun = time.monotonic()
    yield from until(lambda: job.running is None, 20)
    print(f"cancelled after {time.monotonic() - begun:.2f} s")
    yield 0.3
    check(job.running is None, "Esc did not end it")
    check(limb.wovenfit.flat is None and limb.wovenfit.result == "", "Esc left a pattern")
    check(len(bpy.data.objects) == 1, "Esc left an object")
    picture("9-cancelled")


def until(true, seconds):
    """Waits until something is true, or so many seconds."""
    end = time.monotonic() + seconds
    while not true() and time.monotonic() < end:
        yield 0.1


def nearest(limb, place):
    """The vertex nearest to a place in the world."""
    return int(np.argmin(np.linalg.norm(scene.world(limb) - place, axis=1)))


def select_vertex(limb, vertex):
    """Selects a vertex in edit mode, as a click on it does."""
    import bmesh

    bpy.ops.mesh.select_all(action="DESELECT")
    edited = bmesh.from_edit_mesh(limb.data)
    edited.verts.ensure_lookup_table()
    edited.verts[vertex].select_set(True)
    edited.select_history.add(edited.verts[vertex])
    bmesh.update_edit_mesh(limb.data)


def run():
    """Drives the steps from Blender's timer."""
    going = steps()
    begun = time.monotonic()

    def tick():
        try:
            if time.monotonic() - begun > 330:
                raise TimeoutError("the window took too long")
            return next(going)
        except StopIteration:
            pass
        except BaseException:
            traceback.print_exc()
            SEEN["failed"] += 1
            picture("broken")
        print(f"window: {SEEN['passed']} passed, {SEEN['failed']} failed")
        sys.stdout.flush()
        os._exit(1 if SEEN["failed"] or not SEEN["passed"] else 0)

    bpy.app.timers.register(tick, first_interval=1.0)


if __name__ == "__main__":
    run()
