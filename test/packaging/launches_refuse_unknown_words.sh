#!/bin/bash
# kinesthetic.launch stops at a word that it does not know, before anything starts. Needs no master.
set -uo pipefail
export ROS_PACKAGE_PATH=$1:/usr/share  # as below a source tree that nobody has sourced
launch=$1/launch/kinesthetic.launch
failed=0
for good in hand:=none hand:=peg control_mode:=impedance arm:=real; do
  said=$(roslaunch --nodes "$launch" "$good" 2>&1) || { echo "$good is refused: $said"; failed=1; }
done
for bad in hand:=bar control_mode:=velocity arm:=virtual; do
  said=$(roslaunch --nodes "$launch" "$bad" 2>&1) && { echo "$bad is taken"; failed=1; }
  [[ $said == *"'${bad#*:=}' is not in list"* ]] || { echo "$bad is not named in: $said"; failed=1; }
done
exit $failed
