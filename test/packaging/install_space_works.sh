#!/bin/bash
# Installs into a scratch folder and works from there with nothing but its setup file: rosrun, roslaunch, PATH.
# usage: install_space_works.sh BUILD_FOLDER DEVEL_PREFIX INSTALL_PREFIX
set -euo pipefail
build=$1
devel=$2

# Not below the package: roslaunch would find its launch files twice.
home=$(mktemp -d)
launched=
trap 'kill -INT $launched 2>/dev/null && wait $launched; rm -rf "$home"' EXIT
# The setup files go to the prefix chosen when configuring, so the whole is moved below the scratch folder instead.
installed=$home$3
DESTDIR=$home cmake --install "$build" >"$home/install.log" 2>&1 || { cat "$home/install.log"; exit 1; }

export HOME=$home ROS_HOME=$home ROS_LOG_DIR=$home/log ROS_HOSTNAME=localhost
unset ROS_MASTER_URI ROS_PACKAGE_PATH CMAKE_PREFIX_PATH LD_LIBRARY_PATH PYTHONPATH PKG_CONFIG_PATH
PATH=/usr/sbin:/usr/bin:/sbin:/bin
cd "$home"
set +u
# shellcheck disable=SC1091
source "$installed/setup.bash"
set -u

expect() {
  local found=$1 wanted=$2 what=$3
  [ "$found" = "$wanted" ] || { echo "$what is \"$found\", expected \"$wanted\""; exit 1; }
}
expect "$(rospack find demo_logger)" "$installed/share/demo_logger" "the package's folder"
expect "$(command -v demo_tool)" "$installed/lib/demo_logger/demo_tool" "demo_tool on PATH"
rosrun demo_logger demo_tool --help >/dev/null
programs() { (cd "$1/lib/demo_logger" && printf '%s\n' *_node demo_tool | sort); }
expect "$(programs "$installed")" "$(programs "$devel")" "what is installed in lib/demo_logger"
rosrun demo_logger draw_demonstration.py --help >/dev/null
rosrun demo_logger draw_human_torque.py --help >/dev/null

port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://localhost:$port
# One demonstration, from the simulated arm to the file.
timeout --signal=INT 100 roslaunch --port "$port" demo_logger demo.launch output_dir:="$home/demos" \
  >"$home/launch.log" 2>&1 </dev/null &
launched=$!
wait $launched || { cat "$home/launch.log"; echo "demo.launch from the install space failed"; exit 1; }
episode=$home/demos/demo_000001.csv
# 1: a machine so busy that the arm stalled is a finding, and none of the package's faults.
demo_tool check "$episode" || [ $? -eq 1 ] || { cat "$home/launch.log"; exit 1; }
demo_tool info "$episode" | grep -q 'outcome success, complete$' || { demo_tool info "$episode"; exit 1; }
