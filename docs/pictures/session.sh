#!/bin/bash
# Makes docs/images/start/session.jpg and drop.png of what the tests of one session and of dragging the extension see in a window of
# Debian sid's Blender.
set -euo pipefail
ROOT=$(cd "$(dirname "$0")/../.." && pwd)

VIEW=1320x870+0+29  # of the window: without its menus, outliner and timeline
DIALOG=780x330+130+330
FOLDER=$(mktemp -d)
trap 'rm -r "$FOLDER"' EXIT

"$ROOT/scripts/test_newer_window" --pictures "$FOLDER" sid run_as_person_in_window.py run_drop_in_window.py
convert "$FOLDER/drop_1_dialog.png" -crop $DIALOG +repage -colors 200 "$ROOT/docs/images/start/drop.png"
mogrify -crop $VIEW +repage "$FOLDER"/person_*.png
montage "$FOLDER"/person_*.png -tile 2x -geometry 860x+4+4 -background '#202020' -quality 82 "$ROOT/docs/images/start/session.jpg"
