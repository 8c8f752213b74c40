#!/usr/bin/env python3
"""`lightgrid render` as another renderer: a check of docs/put_your_renderer_on_the_plane.md that knows its answer.

lightgrid_render.py PROGRAM TECHNIQUE answers one request and ends; it is started again for the next. Its error must be
that of the sweep's own point, its time about as long: the median of nine frames of a process that was just started.
"""
import json
import os
import subprocess
import sys
import tempfile


def camera_of(request):
    if request["camera"]:
        return request["camera"]
    eye, direction = request["eye"], request["direction"]
    target = [e + f for e, f in zip(eye, direction)]
    text = [",".join(repr(v) for v in place) for place in (eye, target)]
    return f"eye:{text[0]},target:{text[1]},fov:{request['fov_y_rad'] * 57.29577951308232!r},near:{request['near']!r}"


def main():
    program, technique = sys.argv[1:]
    request = json.loads(sys.stdin.readline())
    with tempfile.TemporaryDirectory() as folder:
        picture = request["picture"] or os.path.join(folder, "picture.exr")
        run = subprocess.run([program, "render", request["scene"], "--camera", camera_of(request), "--size",
                              "{}x{}".format(*request["size"]), "-t", technique, "--warmup", "3", "--frames", "9", "-o",
                              picture, "--json", "-", "--quiet"], capture_output=True, text=True)
    answer = {"frame_ms": json.loads(run.stdout)["frame_ms"]["median"]} if run.returncode == 0 else {"error": run.stderr}
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
