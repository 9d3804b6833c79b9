#!/bin/bash
# catkin_lint knows what a ROS build farm would stumble upon.
set -euo pipefail
command -v catkin_lint >/dev/null || { echo "catkin_lint is not installed; skipped"; exit 77; }
catkin_lint --offline --strict -W2 --pkg demo_logger --package-path "$1" 2>&1 || exit 1
