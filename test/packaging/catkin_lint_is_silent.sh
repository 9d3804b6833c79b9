#!/bin/bash
# catkin_lint knows what a ROS build farm would stumble upon.
set -euo pipefail
source=$1
command -v catkin_lint >/dev/null || { echo "catkin_lint is not installed; skipped"; exit 77; }
export PATH=/usr/bin:/bin

# It would judge build trees too, so it sees a copy of the sources, in a folder of the package's name.
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
mkdir "$copy/demo_logger"
tar --create --directory "$source" --exclude=./build --exclude=./devel --exclude=./demos \
  --exclude=./.git . | tar --extract --directory "$copy/demo_logger"

# Left out: writing ${PROJECT_NAME} for our own name, CMake's own variables, include_directories() for all (targets name
# theirs), scripts and measurements for those who work on the sources (that every node is installed is seen by
# install_space_works.sh).
catkin_lint --offline --strict -W2 --ignore literal_project_name --ignore global_var_collision \
  --ignore unused_catkin_include_dirs --ignore uninstalled_script --ignore uninstalled_target "$copy/demo_logger" 2>&1
