#!/bin/bash
# A demonstration without a robot: a simulated human teleoperates a simulated arm, or guides it by hand, and demo_logger
# records it.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'END'
usage: scripts/demo.sh [--rviz] [ROSLAUNCH_ARGUMENT:=VALUE…]

Installs what is missing of the distribution's packages, builds, starts a ROS master of its own on a free port, and
records an episode of about 20 s: a simulated human teleoperates the simulated arm. Says what was recorded, checks it,
draws it. Everything lies in demos/ afterwards; running it again adds the next number.
With channel:=kinesthetic a simulated hand guides the compliant arm instead, for about 7 s, and what the hand did is
recovered, and drawn beside the truth.

  --rviz            show the arm while it moves (needs rviz and a screen)
  NAME:=VALUE       given to demo.launch, for example seed:=7; "roslaunch --ros-args demo_logger demo.launch"
                    lists the names

Exit code 0 only if the recording passes its own checks, and by hand, if the torque was recovered without findings.
END
}

launch_arguments=()
channel=teleoperation
for argument in "$@"; do
  case $argument in
    -h | --help) usage; exit 0 ;;
    --rviz) launch_arguments+=(rviz:=true) ;;
    *:=*)
      launch_arguments+=("$argument")
      case $argument in channel:=*) channel=${argument#*:=} ;; esac
      ;;
    *) fail "unknown argument \"$argument\"; --help shows what there is" ;;
  esac
done

"$project/scripts/install_dependencies.sh" build run
defaultJobs
buildTree "$project/build" demo_logger_programs -DCMAKE_BUILD_TYPE=Release
useDevelSpace
openRunFolder
trap closeRunFolder EXIT
trap 'exit 130' INT TERM
demos=$project/demos
mkdir -p "$demos"
before=$(find "$demos" -maxdepth 1 -name 'demo_??????.csv' | sort)

port=$(freePort)
export ROS_MASTER_URI=http://localhost:$port
echo "Recording a demonstration by $channel, which takes some 10 to 20 s (ROS master on port $port)"
# The human is a required node: roslaunch ends when the task is done, and the recorder closes its file.
timeout --foreground --signal=INT --kill-after=30 180 roslaunch --port "$port" demo_logger demo.launch output_dir:="$demos" \
  "${launch_arguments[@]}" >"$run_folder/demo.log" 2>&1 </dev/null ||
  { tail -n 60 "$run_folder/demo.log" >&2; fail "the demonstration did not come to its end (its log is above)"; }

recorded=$(comm -13 <(echo "$before") <(find "$demos" -maxdepth 1 -name 'demo_??????.csv' | sort) | tail -n 1)
[ -n "$recorded" ] || { tail -n 60 "$run_folder/demo.log" >&2; fail "no episode was written to $demos"; }
demo_tool info "$recorded"
status=0
demo_tool check "$recorded" || status=$?
picture=$("$project/scripts/draw_demonstration.py" "$recorded" --force)
files="$recorded, ${recorded%.csv}.json, $picture"
if [ "$channel" = kinesthetic ]; then
  taught=${recorded%.csv}_taught.csv
  found=0
  demo_tool torque "$recorded" -o "$taught" --force --urdf "$project/urdf/demo_arm.urdf" --base base_link \
    --tip tool_tip || found=$?
  [ "$found" -le 1 ] || exit "$found"  # 1: done, with findings
  [ "$status" -ne 0 ] || status=$found
  files+=", $taught, $("$project/scripts/draw_human_torque.py" "$taught" --live "$recorded" --force)"
fi
echo "Files: $files"
exit $status
