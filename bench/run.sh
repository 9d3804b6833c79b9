#!/bin/bash
# Builds the measurements and runs them: writes doc/benchmarks/{recording_cost,synchronisation_error,robot_model}.md with
# the machine and the date.
set -euo pipefail
if [ "${1:-}" = --help ]; then
  echo "usage: bench/run.sh [recording_cost|synchronisation_error|robot_model] [options of recording_cost.py or robot_model.py]"
  echo "Needs what scripts/test.sh installs. About 15 minutes for all; without a name it runs all."
  echo "robot_model takes --pinocchio PYTHON (one with the module pinocchio) and arms from the folder DEMO_LOGGER_URDF."
  exit 0
fi
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
which=${1:-all}
[ $# -eq 0 ] || shift
[ "$which" != all ] || set --
targets=()
case $which in
  all | recording_cost) ;;
  synchronisation_error | robot_model) targets=(--target "$which") ;;
  *) echo "run.sh: unknown measurement \"$which\"; --help shows what there is" >&2; exit 2 ;;
esac
cmake -S "$project" -B "$project/build" -DDEMO_LOGGER_BENCH=ON >/dev/null
cmake --build "$project/build" -j "$(nproc)" ${targets[@]+"${targets[@]}"} >/dev/null
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
if [ "$which" = all ] || [ "$which" = synchronisation_error ]; then
  measure "Synchronisation error against truth" "$project/doc/benchmarks/synchronisation_error.md" "$programs/synchronisation_error"
fi
if [ "$which" = all ] || [ "$which" = robot_model ]; then
  measure "Inverse dynamics: cost and agreement" "$project/doc/benchmarks/robot_model.md" \
    /usr/bin/python3 "$project/bench/robot_model.py" "$programs" "$@"
fi
if [ "$which" = all ] || [ "$which" = recording_cost ]; then
  measure "What recording costs and loses" "$project/doc/benchmarks/recording_cost.md" \
    /usr/bin/python3 "$project/bench/recording_cost.py" "$programs" "$@"
fi
