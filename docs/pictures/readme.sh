#!/usr/bin/env bash
# Makes the animation and the sample report that README shows, from the run that ./quickstart makes.
# Usage: docs/pictures/readme.sh [LGABENCH]
set -euo pipefail
docs=$(realpath "$(dirname "$0")/..")
lgabench=$(realpath "${1:-$docs/../build/release/bin/lgabench}")
kept=$(mktemp -d)
trap 'rm -rf "$kept"' EXIT
cd "$kept"  # the page says which command made it, without a place of this machine
PATH=$(dirname "$lgabench"):$PATH
lgabench run clutter --preset smoke --quiet --out run > /dev/null
key_of() { grep -l "\"id\":\"heart\"" $(grep -l "\"name\":\"$1\"" run/cells/*/cell.json) | cut -d / -f 3; }
lgabench replay run "$(key_of lga)/near_6/1" "$(key_of gcbc_seg)/near_6/1" --out "$docs/pictures/heart.gif"
cp run/report.html "$docs/sample-report.html"
