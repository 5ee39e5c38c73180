"""What the project asks of its speed, against one run's figures."""

from __future__ import annotations

from typing import Any

from measure import growth

# Times SLIM's time at this many triangles that the fit may take.
SHARE_OF_SLIM = {20_000: 1.0 / 8.0, 200_000: 1.0 / 25.0}
DIFFUSION_RATIO = 100.0
GROWTH = 1.3
# Seconds of a whole flatten and MiB, on a machine where SLIM's 18 steps at 20,000 take 1.4 s.
WHOLE_SECONDS = {20_000: 0.4, 100_000: 2.5, 250_000: 7.0}
WHOLE_MIB = {250_000: 2048.0}
SLIM_SECONDS = 1.4


def judge(limbs: list[dict[str, Any]], whole: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """One entry a criterion that could be measured: what, measured, holds.

    `holds` is None where the program did not say the fit's time alone, or its time does not count.
    """
    found: list[dict[str, Any]] = []

    def say(what: str, measured: str, holds: bool | None) -> None:
        found.append({"what": what, "measured": measured, "holds": holds})

    slim_at_20k: dict[str, float] = {}
    for limb in limbs:
        seconds = {
            row["key"]: row["seconds"]["median"] for row in limb["methods"] if "seconds" in row
        }
        at = f"{limb['limb']} {limb['asked_triangles']:,}"
        sure = limb["fit_alone"] and all(check["counts"] for check in limb["checks"])
        ours = seconds["ours"]
        share = SHARE_OF_SLIM.get(limb["asked_triangles"])
        if "slim" in seconds and limb["asked_triangles"] == 20_000:
            slim_at_20k[limb["limb"]] = seconds["slim"]
        if "slim" in seconds and share:
            ratio = seconds["slim"] / ours
            holds = ratio * share >= 1.0
            say(
                f"{at}: the fit at most 1/{1.0 / share:.0f} of SLIM's time",
                f"1/{ratio:.1f}",
                holds if sure else None,
            )
        if "arap" in seconds and share:
            ratio = seconds["arap"] / ours
            say(
                f"{at}: the fit faster than ARAP",
                f"ARAP takes {ratio:.2f} of ours",
                ratio > 1.0 if sure else None,
            )
        for slow in limb["diffusion"]:
            ratio = slow.get("ratio")
            if ratio is None or not slow["as_fine"]:
                continue
            say(
                f"{at}: {DIFFUSION_RATIO:.0f} times faster than our diffusion, to the same J_E, "
                "its threads as far apart as the mesh's vertices",
                f"{ratio:.0f} times",
                ratio >= DIFFUSION_RATIO if sure else None,
            )
    for name in {limb["limb"]: None for limb in limbs}:
        by_size = {limb["asked_triangles"]: limb for limb in limbs if limb["limb"] == name}
        if 20_000 in by_size and 200_000 in by_size:
            pair = by_size[20_000], by_size[200_000]
            seconds_pair = tuple(limb["methods"][0]["seconds"]["median"] for limb in pair)
            power = growth(
                (pair[0]["triangles"], pair[1]["triangles"]), (seconds_pair[0], seconds_pair[1])
            )
            say(
                f"{name}: time grows from 20,000 to 200,000 no faster than n^{GROWTH}",
                f"n^{power:.2f}",
                power <= GROWTH if all(limb["fit_alone"] for limb in pair) else None,
            )
    pace = slim_at_20k[next(iter(slim_at_20k))] / SLIM_SECONDS if slim_at_20k else None
    for row in whole:
        at = f"{row['limb']} {row['asked_triangles']:,}"
        limit = WHOLE_SECONDS.get(row["asked_triangles"])
        if limit:
            seconds_whole = row["seconds"]["median"]
            at_pace = f", {seconds_whole / pace:.2f} s at the pace of that machine" if pace else ""
            say(
                f"{at}: whole flatten in {limit:g} s where SLIM's 18 steps at 20,000 take "
                f"{SLIM_SECONDS:g} s",
                f"{seconds_whole:.2f} s{at_pace}",
                seconds_whole / pace <= limit if pace else None,
            )
        most = WHOLE_MIB.get(row["asked_triangles"])
        if most:
            say(f"{at}: under {most:.0f} MiB", f"{row['peak_mib']:.0f} MiB", row["peak_mib"] < most)
    return found
