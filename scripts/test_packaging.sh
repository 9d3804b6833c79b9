#!/bin/bash
# Builds the package as other people's workspaces do: with catkin_make, from a copy, beside nothing else.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'END'
usage: scripts/test_packaging.sh

Copies the sources into a scratch catkin workspace, builds them there with catkin_make, then installs them with
catkin_make install and runs demo_tool and one demonstration from both spaces. Takes as long as a full build.
END
}
case ${1:-} in
  "") ;;
  -h | --help) usage; exit 0 ;;
  *) fail "unknown argument \"$1\"; --help shows what there is" ;;
esac

"$project/scripts/install_dependencies.sh" build run
defaultJobs
openRunFolder
trap closeRunFolder EXIT
trap 'exit 130' INT TERM
workspace=$run_folder/workspace
mkdir -p "$workspace/src/demo_logger"
(cd "$project" && tar --create --exclude=./build --exclude=./devel --exclude=./demos \
  --exclude=./.git .) | tar --extract --directory "$workspace/src/demo_logger"

cd "$workspace"
# The workspace's own top level looks for catkin before it reads the package, so it must be told the interpreter.
catkin_make -j"$jobs" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCATKIN_ENABLE_TESTING=OFF install >build.log 2>&1 ||
  { tail -n 60 build.log >&2; fail "catkin_make failed"; }

for space in devel install; do
  (
    set +u
    # shellcheck disable=SC1090
    source "$workspace/$space/setup.bash"
    set -u
    case $(command -v demo_tool) in
      "$workspace/$space"/*) ;;
      *) fail "demo_tool on PATH is \"$(command -v demo_tool)\", expected one below $workspace/$space" ;;
    esac
    rosrun demo_logger demo_tool --help >/dev/null
    port=$(freePort)
    export ROS_MASTER_URI=http://localhost:$port
    timeout --foreground --signal=INT 120 roslaunch --port "$port" demo_logger demo.launch output_dir:="$run_folder/$space" \
      >"$run_folder/$space.log" 2>&1 </dev/null || { cat "$run_folder/$space.log" >&2; fail "demo.launch"; }
    demo_tool check "$run_folder/$space/demo_000001.csv" || [ $? -eq 1 ]  # findings, on a busy machine
  )
  echo "test_packaging.sh: the $space space works"
done
