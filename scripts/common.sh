# Sourced by the scripts beside it: the project's root, an environment of its own, one way to build.
# shellcheck shell=bash

project=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Debian's ROS needs no setup file. Whatever workspace, master or Python environment the caller has active stays out.
unset ROS_MASTER_URI ROS_PACKAGE_PATH ROS_IP ROS_NAMESPACE CMAKE_PREFIX_PATH PKG_CONFIG_PATH LD_LIBRARY_PATH \
  PYTHONPATH PYTHONHOME
export PATH="/usr/bin:/bin:$PATH"
export ROS_HOSTNAME=localhost

fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# A folder of this run alone, for logs and ROS's own files; it also marks every process that the run starts.
openRunFolder() {
  run_folder=$(mktemp -d "${TMPDIR:-/tmp}/demo_logger.XXXXXX")
  export ROS_HOME="$run_folder/ros" ROS_LOG_DIR="$run_folder/log" DEMO_LOGGER_RUN_FOLDER="$run_folder"
  mkdir "$ROS_HOME" "$ROS_LOG_DIR"
}

# Processes of this run other than this shell, by what they inherited in their environment.
processesOfThisRun() {
  local environment pid
  while read -r environment; do
    pid=${environment#/proc/}
    pid=${pid%/environ}
    [ "$pid" = $$ ] || [ "$pid" = "$BASHPID" ] || ! kill -0 "$pid" 2>/dev/null || echo "$pid"
  done < <(grep -lsz "^DEMO_LOGGER_RUN_FOLDER=$run_folder\$" /proc/[0-9]*/environ)
}

# Ends whatever the run left behind, politely first; says nothing.
endProcessesOfThisRun() {
  local signal pids attempt
  for signal in INT TERM KILL; do
    for attempt in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do
      pids=$(processesOfThisRun)
      [ -n "$pids" ] || return 0
      # shellcheck disable=SC2086
      [ "$attempt" -gt 1 ] || kill -"$signal" $pids 2>/dev/null || true
      sleep 0.2
    done
  done
}

closeRunFolder() {
  endProcessesOfThisRun
  rm -rf "$run_folder"
}

# One compiler per core, but each may take 1.5 GB.
defaultJobs() {
  local by_memory
  by_memory=$(awk '/^MemAvailable/ { print int($2 / 1572864) }' /proc/meminfo)
  jobs=$(nproc)
  [ "$by_memory" -ge "$jobs" ] || jobs=$by_memory
  [ "$jobs" -ge 1 ] || jobs=1
}

# buildTree FOLDER TARGET [CMAKE_ARGUMENT…]: configures and builds; on failure shows the errors and the end of the log
# and stops the script.
buildTree() {
  local tree=$1 target=$2
  shift 2
  local log=$tree/build.log
  mkdir -p "$tree"
  echo "Building in ${tree#"$project/"} with $jobs jobs (some minutes the first time; the log is ${log#"$project/"})"
  if ! { cmake -S "$project" -B "$tree" "$@" && cmake --build "$tree" --target "$target" --parallel "$jobs"; } \
    >"$log" 2>&1 </dev/null; then
    grep -nE '(error|Error [0-9]+|CMake Error|\*\*\*)' "$log" | head -n 20 >&2 || true
    tail -n 40 "$log" >&2
    fail "the build failed; the whole log is $log"
  fi
}

# The setup file reads variables that need not be set.
useDevelSpace() {
  set +u
  # shellcheck disable=SC1091
  source "$project/devel/setup.bash"
  set -u
}

freePort() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])'
}
