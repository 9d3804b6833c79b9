#!/bin/bash
# A relative file or directory on roslaunch's command line is one where the user stands, not where nodes run. Needs no
# master.
set -uo pipefail
export ROS_PACKAGE_PATH=$1:/usr/share  # as below a source tree that nobody has sourced
launches=$1/launch
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
cd "$here" || exit 1
failed=0
expect() {  # a parameter, its value, a launch file, arguments
  local dumped
  dumped=$(roslaunch --dump-params "$launches/$3" "${@:4}" 2>&1) || { echo "${*:3}: $dumped"; failed=1; }
  grep -qxF "$1: $2" <<<"$dumped" || { echo "${*:3}: expected $1: $2, found $(grep "^$1" <<<"$dumped")"; failed=1; }
}
model=/demo_logger/human_torque/model
expect $model "$here/arm.yaml" kinesthetic.launch model:=arm.yaml
expect $model "$here/models/arm.yaml" kinesthetic.launch model:=models/arm.yaml arm:=real
expect $model /models/arm.yaml kinesthetic.launch model:=/models/arm.yaml
expect /demo_logger/output_dir "$here/demos" record.launch
expect /demo_logger/output_dir /recordings record.launch output_dir:=/recordings
for launch in record.launch kinesthetic.launch demo.launch; do
  expect /demo_logger/output_dir "$here/mine" $launch output_dir:=mine
done
exit $failed
