#!/bin/bash
# Installs what is missing, builds, runs every test. The last line is ctest's.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'END'
usage: scripts/test.sh [--sanitize address|thread] [-j N] [-- CTEST_ARGUMENT…]

Installs what is missing of the distribution's packages, builds, and runs every test.

  --sanitize address   with AddressSanitizer, LeakSanitizer and UndefinedBehaviorSanitizer, in build/address
  --sanitize thread    with ThreadSanitizer, in build/thread
  -j N                 compile and test with N jobs (default: the number of cores, fewer if memory is short)
  -- …                 given to ctest, for example: scripts/test.sh -- -R synchroniser --output-on-failure

Tests with real recordings and real robots run when the environment names their folders:
DEMO_LOGGER_DATA (bags with truth.json) and DEMO_LOGGER_URDF; the default is shared/ beside the project.
Exit code 0 only if every test passed.
END
}

sanitizer=none
defaultJobs
ctest_arguments=()
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --sanitize)
      case ${2:-} in
        address | thread) sanitizer=$2 ;;
        *) fail "--sanitize is \"${2:-}\", expected address or thread" ;;
      esac
      shift ;;
    -j)
      [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || fail "-j is \"${2:-}\", expected a number of jobs"
      jobs=$2
      shift ;;
    --) shift; ctest_arguments=("$@"); break ;;
    *) fail "unknown argument \"$1\"; --help shows what there is" ;;
  esac
  shift
done

"$project/scripts/install_dependencies.sh" build run test

for pair in DATA:data URDF:urdf; do
  variable=DEMO_LOGGER_${pair%:*}
  folder=$project/../shared/${pair#*:}
  if [ -z "${!variable:-}" ] && [ -d "$folder" ]; then
    declare -x "$variable=$(cd "$folder" && pwd)"
  fi
done

tree=$project/build
configuration=(-DCMAKE_BUILD_TYPE=Release)
runner=()
if [ "$sanitizer" != none ]; then
  tree=$project/build/$sanitizer
  configuration=(-DCMAKE_BUILD_TYPE=RelWithDebInfo -DDEMO_LOGGER_SANITIZE="$sanitizer")
  # The sanitizers' shadow memory collides with kernels that randomise addresses over more bits than they expect.
  runner=(setarch "$(uname -m)" --addr-no-randomize)
fi
buildTree "$tree" all "${configuration[@]}"
# Instrumented code makes the compiler suspect the standard library, so its warnings count without sanitizers only.
if [ "$sanitizer" = none ] && grep -E 'warning: ' "$tree/build.log" >&2; then
  fail "the compiler warned (above); the sources are meant to be free of warnings"
fi

openRunFolder
trap closeRunFolder EXIT
trap 'exit 130' INT TERM
# A finding in a node would go unseen, as rostest only looks at the test's own exit code: reports go to files.
reports=$run_folder/sanitizer
mkdir "$reports"
suppressions=$project/cmake/sanitizer
export ASAN_OPTIONS="log_path=$reports/report:detect_stack_use_after_return=1:strict_string_checks=1"
export LSAN_OPTIONS="suppressions=$suppressions/leak.txt:print_suppressions=0"
export UBSAN_OPTIONS="log_path=$reports/report:print_stacktrace=1"
# Where an unlock happens in a library without instrumentation, the detector of lock orders believes the lock held, until
# it has no room for more and gives up.
export TSAN_OPTIONS="log_path=$reports/report:suppressions=$suppressions/thread.txt:detect_deadlocks=0"

rm -rf "$tree/test_results"
status=0
(cd "$tree" && "${runner[@]}" ctest --output-on-failure --parallel "$jobs" "${ctest_arguments[@]}" </dev/null) || status=$?

# A node that has just been told to end may need a moment.
for _ in 1 2 3 4 5 6 7 8 9 10; do
  left_behind=$(processesOfThisRun)
  [ -n "$left_behind" ] || break
  sleep 0.3
done
if [ -n "$left_behind" ]; then
  for pid in $left_behind; do
    { tr '\0' ' ' <"/proc/$pid/cmdline" && echo; } >&2 || true
  done
  echo "test.sh: the processes above outlived the tests that started them" >&2
  status=1
fi
if [ -n "$(find "$reports" -type f -size +0)" ]; then
  find "$reports" -type f -size +0 -exec cat {} + >&2
  echo "test.sh: the $sanitizer sanitizer reported the above" >&2
  status=1
fi
exit $status
