#!/bin/bash
# Everything that judges the source without running it.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'END'
usage: scripts/lint.sh [--fix] [FILE.cpp…]

Formats (with --fix) or checks the format, then runs catkin_lint, shellcheck on the scripts, and clang-tidy on the
given files (default: all of src/ and test/, which takes some minutes).

example: scripts/lint.sh --fix src/recording/synchroniser.cpp
END
}

fix=
files=()
for argument in "$@"; do
  case $argument in
    -h | --help) usage; exit 0 ;;
    --fix) fix=yes ;;
    *.cpp) files+=("$(realpath "$argument")") ;;
    *) fail "unknown argument \"$argument\"; --help shows what there is" ;;
  esac
done
"$project/scripts/install_dependencies.sh" build test lint
defaultJobs
cd "$project"

[ -z "$fix" ] || find include src test bench \( -name '*.h' -o -name '*.cpp' \) -print0 | xargs -0 clang-format -i
test/packaging/source_is_formatted.sh .
test/packaging/catkin_lint_is_silent.sh .
find . -path ./build -prune -o -path ./devel -prune -o -name '*.sh' -print0 | xargs -0 shellcheck --external-sources \
  --source-path=SCRIPTDIR

buildTree "$project/build" all
if [ ${#files[@]} -eq 0 ]; then
  mapfile -t files < <(sed -n 's/^ *"file": "\(.*\.cpp\)",*$/\1/p' build/compile_commands.json |
    grep -E "^$project/(src|test)/" | sort -u)
fi
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy --quiet -p build 2>/dev/null ||
  fail "clang-tidy found the above"
