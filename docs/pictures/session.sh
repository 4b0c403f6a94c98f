#!/bin/bash
# Makes docs/images/start/session.jpg of what the test of one session sees in a window of Debian sid's Blender.
set -euo pipefail
ROOT=$(cd "$(dirname "$0")/../.." && pwd)

VIEW=1320x870+0+29  # of the window: without its menus, outliner and timeline
FOLDER=$(mktemp -d)
trap 'rm -r "$FOLDER"' EXIT

"$ROOT/scripts/test_newer_window" --pictures "$FOLDER" sid run_as_person_in_window.py
mogrify -crop $VIEW +repage "$FOLDER"/*.png
montage "$FOLDER"/person_*.png -tile 2x -geometry 860x+4+4 -background '#202020' -quality 82 "$ROOT/docs/images/start/session.jpg"
