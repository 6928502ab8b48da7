#!/usr/bin/env bash
# The first minute on the real window: starts the program on a display of its own, drives it with mouse and keys as a
# newcomer would, and leaves a picture of every step to be looked at.
#
#   bash tests/window/first-minute.sh [FOLDER] [PROGRAM]
#
# FOLDER (default: target/first-minute) receives WIDTHxHEIGHT-STYLE-STEP.png for 1280x720 and 1920x1080, light, dark and
# projector. PROGRAM is the release binary where none is named. It fails where the program does not start, dies on the
# way, stands still where it should move, or does not close; what the pictures show is judged by eye. Needs Xvfb,
# xdotool and ImageMagick, and says so where they are missing.
set -euo pipefail
cd "$(dirname "$0")/../.."

folder=${1:-target/first-minute}
program=${2:-target/release/interwell}
for tool in Xvfb xdotool import compare; do
    if ! command -v "$tool" >/dev/null; then
        echo "skipped: $tool is missing (packages xvfb, xdotool, imagemagick)"
        exit 0
    fi
done
[ -x "$program" ] || { echo "$program is missing: cargo build --release makes it" >&2; exit 2; }
mkdir -p "$folder"

server= app=
leave() { [ -z "$app" ] || kill "$app" 2>/dev/null || true; [ -z "$server" ] || kill "$server" 2>/dev/null || true; }
trap leave EXIT

fail() { echo "$1" >&2; exit 1; }

shot() { import -window root "$folder/$name-$1.png"; kill -0 "$app" 2>/dev/null || fail "the program ended at $name-$1"; }

# Pixels in which two pictures differ by more than a shade.
differ() { compare -metric AE -fuzz 5% "$folder/$name-$1.png" "$folder/$name-$2.png" null: 2>&1 || true; }

key() { for one in "$@"; do xdotool key "$one"; sleep 0.15; done; }

# A number typed into a field: click, all of it, the new one.
type_into() { xdotool mousemove "$1" "$2" click 1; sleep 0.3; key ctrl+a; xdotool type "$3"; key Return; sleep 0.2; }

minute() {
    local width=$1 height=$2 style=$3
    name=${width}x$height-$style
    # where the number of the shaking, the switch of the stops and the number of the limit stand
    local shaking="200 133" stops="19 232" limit="200 285"
    case $name in
        1920*-light | 1920*-dark) shaking="249 133" limit="249 285" ;;
        1280*-projector) shaking="403 128" stops="500 128" limit="905 128" ;;
        1920*-projector) shaking="604 192" stops="750 192" limit="1357 192" ;;
    esac
    local kept display
    kept=$(mktemp -d)
    exec 9>"$kept/display"
    Xvfb -displayfd 9 -screen 0 "${width}x${height}x24" -nolisten tcp 2>/dev/null &
    server=$!
    exec 9>&-
    for _ in $(seq 100); do [ -s "$kept/display" ] && break; sleep 0.05; done
    display=$(cat "$kept/display")
    [ -n "$display" ] || fail "no display came up"
    export DISPLAY=:$display XDG_DATA_HOME=$kept

    local begun
    begun=$(date +%s%N)
    "$program" 2>"$kept/errors" &
    app=$!
    local window=
    for _ in $(seq 400); do
        window=$(xdotool search --onlyvisible --pid "$app" --name interwell 2>/dev/null | tail -1) || true
        [ -n "$window" ] && break
        kill -0 "$app" 2>/dev/null || { cat "$kept/errors" >&2; fail "the program did not start"; }
        sleep 0.02
    done
    [ -n "$window" ] || fail "no window came up"
    echo "$name: a window after $(( ($(date +%s%N) - begun) / 1000000 )) ms"
    xdotool windowsize "$window" "$width" "$height" windowmove "$window" 0 0
    xdotool windowfocus --sync "$window"
    sleep 1
    case $style in dark) key d ;; projector) key p ;; esac
    sleep 1
    key Home
    sleep 2
    shot 1-opened
    sleep 1
    shot 1-plays
    [ "$(differ 1-opened 1-plays)" != 0 ] || fail "$name: nothing moves"
    # shake harder: it begins to cross
    type_into $shaking 1.3
    sleep 6
    shot 2-shaken-harder
    # back: it falls into a well
    type_into $shaking 0.9
    sleep 3
    shot 3-back
    # stops on: it crosses every period
    xdotool mousemove $stops click 1
    xdotool mousemove $((width * 3 / 5)) 12
    sleep 6
    shot 4-stops
    # outward: faster, then over the cliff
    type_into $limit 1.8
    sleep 5
    shot 5-further-out
    type_into $limit 2.2
    sleep 5
    shot 6-too-far
    key h
    sleep 1.5
    shot 7-what-it-would-take
    key h ctrl+2
    sleep 2
    shot 8-study
    key ctrl+3
    sleep 4
    shot 9-map
    key ctrl+1 z
    sleep 1
    shot 10-one-view
    key z c
    sleep 1
    shot 11-covered
    key c space
    sleep 2
    shot 12-paused
    sleep 1
    shot 12-still
    [ "$(differ 12-paused 12-still)" = 0 ] || fail "$name: it moves though it is paused"
    rm "$folder/$name-1-plays.png" "$folder/$name-12-still.png"
    # nothing is unsaved once everything is undone
    key ctrl+z ctrl+z ctrl+z ctrl+z ctrl+z ctrl+z ctrl+q
    for _ in $(seq 100); do kill -0 "$app" 2>/dev/null || break; sleep 0.05; done
    if kill -0 "$app" 2>/dev/null; then shot 13-does-not-close; fail "$name: it does not close"; fi
    wait "$app" || fail "$name: it closed with an error: $(cat "$kept/errors")"
    app=
    kill "$server" && wait "$server" 2>/dev/null || true
    server=
    rm -r "$kept"
}

# one of them alone: ONLY="1280 720 light"
for size in "1280 720" "1920 1080"; do
    for style in light dark projector; do
        [ "${ONLY:-$size $style}" != "$size $style" ] || minute $size $style
    done
done
echo "pictures in $folder"
