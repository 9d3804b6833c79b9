#!/bin/bash
# Builds the measurements and runs them: writes the tables of doc/benchmarks/ with the machine and the date.
set -euo pipefail
if [ "${1:-}" = --help ]; then
  echo "usage: bench/run.sh [MEASUREMENT [options of recording_cost.py]]"
  echo "Measurements: human_torque inverse_kinematics recording_cost robot_model simulated_arm synchronisation_error."
  echo "Needs what scripts/test.sh installs. About 30 minutes for all; without a name it runs all."
  echo "inverse_kinematics and robot_model also measure the arms in the folder that DEMO_LOGGER_URDF names,"
  echo "human_torque a real arm's run in the folder that DEMO_LOGGER_DATA names."
  exit 0
fi
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
which=${1:-all}
[ $# -eq 0 ] || shift
case $which in
  all | human_torque | inverse_kinematics | recording_cost | robot_model | simulated_arm | synchronisation_error) ;;
  *) echo "run.sh: unknown measurement \"$which\"; --help shows what there is" >&2; exit 2 ;;
esac
cmake -S "$project" -B "$project/build" -DDEMO_LOGGER_BENCH=ON >/dev/null
cmake --build "$project/build" -j "$(nproc)" >/dev/null
set +u
. "$project/devel/setup.bash"
set -u
programs=$project/devel/lib/demo_logger
[ -x "$programs/paced_publisher" ] || programs=$project/build/bench

machine() {
  echo "Measured $(date +%Y-%m-%d) on $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) cores," \
    "$(awk '/MemTotal/{printf "%.0f GiB", $2 / 1048576}' /proc/meminfo), Linux $(uname -r), $(. /etc/os-release && echo "$PRETTY_NAME")," \
    "load average $(cut -d' ' -f1-3 /proc/loadavg) at the start. Shared machine: trust ratios and medians."
  echo
}

measure() {  # title, output, command …
  local title=$1 output=$2
  shift 2
  { echo "# $title"; echo; machine; "$@"; } >"$output.new"
  mv "$output.new" "$output"
  echo "$output"
}

mkdir -p "$project/doc/benchmarks"
wanted() { [ "$which" = all ] || [ "$which" = "$1" ]; }

# withPeers FOLDER MODULE…: an environment of their own for peers that the distribution lacks; where it cannot be had,
# their rows are missing, and a sentence says so. Prints the Python to take.
withPeers() {
  local folder=$1
  shift
  if { python3 -m venv "$folder" && "$folder/bin/pip" install --quiet "$@"; } >/dev/null 2>&1; then
    echo "$folder/bin/python"
  else
    echo python3
  fi
}

robotModel() {
  local peers
  peers=$(mktemp -d)
  /usr/bin/python3 "$project/bench/robot_model.py" "$programs" --pinocchio "$(withPeers "$peers" pin)"
  rm -rf "$peers"
}

simulatedArm() {
  "$programs/simulated_arm_cost"
  local peers python
  peers=$(mktemp -d)
  python=$(withPeers "$peers" pybullet mujoco)
  "$python" "$project/bench/simulated_arm_peers.py" "$project/urdf/demo_arm.urdf" 2>/dev/null | grep -E '^\||^Not compared' || true
  rm -rf "$peers"
  "$programs/simulated_arm_cost" drift
}

if wanted robot_model; then
  measure "Inverse dynamics: cost and agreement" "$project/doc/benchmarks/robot_model.md" robotModel
fi
if wanted inverse_kinematics; then
  measure "Inverse kinematics" "$project/doc/benchmarks/inverse_kinematics.md" "$programs/inverse_kinematics"
fi
if wanted human_torque; then
  measure "The torque of the hand, against the truth" "$project/doc/benchmarks/human_torque.md" "$programs/human_torque"
fi
if wanted simulated_arm; then
  measure "What a simulated millisecond costs" "$project/doc/benchmarks/simulated_arm.md" simulatedArm
fi
if wanted synchronisation_error; then
  measure "Synchronisation error against truth" "$project/doc/benchmarks/synchronisation_error.md" "$programs/synchronisation_error"
fi
if wanted recording_cost; then
  measure "What recording costs and loses" "$project/doc/benchmarks/recording_cost.md" \
    /usr/bin/python3 "$project/bench/recording_cost.py" "$programs" "$@"
fi
