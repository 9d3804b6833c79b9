#!/bin/bash
# Every C++ file is as clang-format leaves it.
set -euo pipefail
cd "$1"
command -v clang-format >/dev/null || { echo "clang-format is not installed; skipped"; exit 77; }
find include src test -name '*.h' -print0 -o -name '*.cpp' -print0 | xargs -0 clang-format --dry-run --Werror ||
  { echo "scripts/lint.sh --fix formats the files above"; exit 1; }
