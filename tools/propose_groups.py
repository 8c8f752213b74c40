#!/usr/bin/env python3
"""Proposes light groups in place of shadows: nodes that lights should exclude because all of their light there comes through walls. See
docs/light_groups.md#proposed.

    lightgrid plan SCENE --lights-file LIGHTS --leaks --json plan.json
    tools/propose_groups.py plan.json LIGHTS >GROUPED

GROUPED is LIGHTS with the groups. Lights share a group unless one of them lights a node that another excludes. Lights with groups of their own keep them.
"""
import json
import sys

MAX_GROUPS = 31  # one of 32 remains for what is in no list


def lit_by_each(received, lights):
    """(lights, seen nodes, nodes to exclude, leaked pairs) per light that leaks."""
    nodes = {}
    for r in received:
        if any(key in lights[r["light"]] for key in ("groups", "include", "exclude")):
            continue
        pairs = nodes.setdefault(r["light"], {}).setdefault(r["node_name"], [0, 0])
        pairs[0] += r["seen"]
        pairs[1] += r["leaked"]
    found = []
    for light, of in nodes.items():
        seen = {name for name, (pairs_seen, _) in of.items() if pairs_seen > 0 or not name}
        hidden = set(of) - seen
        if hidden:
            found.append(([light], seen, hidden, sum(of[name][1] for name in hidden)))
    return sorted(found, key=lambda lit: -lit[3])


def joined(lit_lights, room):
    groups = []
    for lit in lit_lights:
        fitting = [g for g in groups if not g[1] & lit[2] and not g[2] & lit[1]]
        if fitting:
            best = max(fitting, key=lambda g: len(g[1] & lit[1]))
            groups[groups.index(best)] = (best[0] + lit[0], best[1] | lit[1], best[2] | lit[2], best[3] + lit[3])
        elif len(groups) < room:
            groups.append(lit)
    return sorted(groups, key=lambda g: -g[3])


def main(plan_file, lights_file):
    with open(plan_file) as file:
        leaks = json.load(file)["leaks"]
    with open(lights_file) as file:
        scene = json.load(file)
    named = {group for item in [*scene["lights"], *scene.get("instances", [])] for group in item.get("groups", [])}
    groups = joined(lit_by_each(leaks["received"], scene["lights"]), MAX_GROUPS - len(named))
    for lights, _, hidden, _ in groups:
        for light in lights:
            scene["lights"][light]["exclude"] = sorted(hidden)
    removed = sum(leaked for *_, leaked in groups)
    print(f"{len(groups)} groups remove {removed} of {leaks['leaked']} leaked pairs", file=sys.stderr)
    json.dump(scene, sys.stdout, indent=1)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
