#!/bin/bash
# A picture of the simulated arm at work, taken from RViz on a screen that nobody needs to have.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'END'
usage: scripts/picture.sh [FILE.png]

Runs the demonstration of scripts/demo.sh with RViz in it, on a virtual screen (Xvfb, software OpenGL), and keeps the
last picture of the window before the task is done: the arm, and the way of its tool. The default is doc/rviz.png, the
picture in the README. The recording itself is thrown away.

Needs a build (scripts/demo.sh makes one) and the packages of scripts/install_dependencies.sh run picture.
END
}

case ${1:-} in
  -h | --help) usage; exit 0 ;;
  -*) fail "unknown argument \"$1\"; --help shows what there is" ;;
esac
[ $# -le 1 ] || fail "one file is enough; --help shows what there is"
picture=${1:-$project/doc/rviz.png}

missing=$("$project/scripts/install_dependencies.sh" --missing run picture | paste -sd' ')
[ -z "$missing" ] || fail "not installed: $missing; run \"sudo scripts/install_dependencies.sh run picture\""
[ -f "$project/devel/setup.bash" ] || fail "nothing is built yet; run scripts/demo.sh or build as in CONTRIBUTING.md"
useDevelSpace
openRunFolder
trap closeRunFolder EXIT
trap 'exit 130' INT TERM
export HOME=$run_folder XDG_RUNTIME_DIR=$run_folder/xdg LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1
mkdir -m 700 "$XDG_RUNTIME_DIR"

# The server chooses a free number and says it; between two clients it would begin anew, under RViz's feet.
Xvfb -displayfd 3 -screen 0 1200x800x24 +extension GLX -noreset 3>"$run_folder/display" >"$run_folder/xvfb.log" 2>&1 &
for _ in {1..100}; do
  [ ! -s "$run_folder/display" ] || break
  sleep 0.1
done
[ -s "$run_folder/display" ] || { cat "$run_folder/xvfb.log" >&2; fail "the virtual screen did not start"; }
DISPLAY=:$(cat "$run_folder/display")
export DISPLAY

port=$(freePort)
export ROS_MASTER_URI=http://localhost:$port
log=$run_folder/demo.log
timeout --signal=INT --kill-after=30 180 roslaunch --port "$port" demo_logger demo.launch rviz:=true \
  output_dir:="$run_folder/demos" >"$log" 2>&1 </dev/null &
launched=$!
while kill -0 $launched 2>/dev/null && ! grep -q 'the task is done' "$log"; do
  python3 - "$DISPLAY" "$run_folder/next.png" <<'END'
import sys
from PIL import ImageGrab
ImageGrab.grab(xdisplay=sys.argv[1]).save(sys.argv[2], optimize=True)
END
  # A picture is good if RViz was still there when it was taken.
  if kill -0 $launched 2>/dev/null && ! grep -q 'the task is done' "$log"; then
    mv "$run_folder/next.png" "$run_folder/last.png"
  fi
  sleep 0.3
done
wait $launched || { tail -n 60 "$log" >&2; fail "the demonstration did not come to its end (its log is above)"; }

# The arm and the way of its tool are orange in parts; nothing else of the window is.
if ! python3 - "$run_folder/last.png" <<'END'
import sys
from PIL import Image
pixels = Image.open(sys.argv[1]).convert("RGB").getdata()
orange = sum(red > 150 and 60 < green < 190 and blue < 80 for red, green, blue in pixels)
sys.exit(0 if orange > 500 else 1)
END
then
  tail -n 60 "$log" >&2
  fail "RViz showed no arm (its log is above)"
fi
mv "$run_folder/last.png" "$picture"
echo "$picture"
