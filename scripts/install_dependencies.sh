#!/bin/bash
# Installs the Debian packages that demo_logger needs and that are missing. This file is their only list.
# shellcheck disable=SC2034  # the lists are used by name
set -euo pipefail

usage() {
  cat <<'END'
usage: scripts/install_dependencies.sh [--list | --missing] [GROUP…]

Installs what is missing of the distribution's packages, and nothing else.

  GROUP       build, run, test, lint, picture   (default: build run test)
  --list      print the packages of the groups, one a line, install nothing
  --missing   print only those that are not installed, install nothing

example: sudo scripts/install_dependencies.sh build run
END
}

# To compile. The ros-*-msgs packages hold the .msg texts from which our own messages are generated.
build_packages=(
  catkin cmake g++ make pkg-config
  libbullet-dev libcli11-dev libeigen3-dev liborocos-kdl-dev liburdfdom-dev libyaml-cpp-dev nlohmann-json3-dev
  libdiagnostic-updater-dev libgeometry-msgs-dev librosbag-storage-dev libroscpp-dev libsensor-msgs-dev
  libstd-msgs-dev libstd-srvs-dev libtf2-ros-dev libtopic-tools-dev libtrajectory-msgs-dev
  ros-geometry-msgs ros-message-generation ros-message-runtime ros-sensor-msgs ros-std-msgs ros-std-srvs
)

# To launch the nodes, to call their services and look at their topics, and to draw what they recorded.
run_packages=(
  python3-geometry-msgs python3-matplotlib python3-numpy python3-roslaunch python3-rosservice python3-rostopic
  python3-sensor-msgs python3-std-srvs python3-trajectory-msgs ros-robot-state-publisher rosbash
)

# To run the tests: independent peers (kdl_parser, the JSON Schema), rosbag play, a locale with a decimal comma, and
# the two checks of the source that are part of every test run.
test_packages=(
  catkin-lint clang-format libgtest-dev libkdl-parser-dev librapidcheck-dev librostest-dev locales-all
  python3-jsonschema python3-rosbag python3-rostest
)

# Only for scripts/picture.sh: RViz on a virtual screen, and what takes the picture.
picture_packages=(libgl1-mesa-dri python3-pil rviz xvfb)

# Only for scripts/lint.sh.
lint_packages=(clang-tidy shellcheck)

installed() {
  dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    sed -n 's/^installed //p' || true
}

action=install
groups=()
for argument in "$@"; do
  case $argument in
    -h | --help) usage; exit 0 ;;
    --list | --missing) action=${argument#--} ;;
    build | run | test | lint | picture) groups+=("$argument") ;;
    *) echo "install_dependencies.sh: unknown argument \"$argument\"; --help shows what there is" >&2; exit 2 ;;
  esac
done
[ ${#groups[@]} -gt 0 ] || groups=(build run test)

wanted=()
for group in "${groups[@]}"; do
  declare -n packages=${group}_packages
  wanted+=("${packages[@]}")
done
if [ "$action" = list ]; then printf '%s\n' "${wanted[@]}"; exit 0; fi

if ! command -v dpkg-query >/dev/null; then
  echo "install_dependencies.sh: this is not Debian or Ubuntu; install the packages of --list by your own means" >&2
  exit 1
fi
mapfile -t missing < <(comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) <(installed "${wanted[@]}" | sort -u))
if [ "$action" = missing ]; then printf '%s\n' "${missing[@]}" | sed '/^$/d'; exit 0; fi
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  as_root=(sudo)
  [ -t 0 ] || as_root=(sudo -n)
  if ! command -v sudo >/dev/null || ! "${as_root[@]}" true 2>/dev/null; then
    echo "install_dependencies.sh: neither root nor sudo is at hand; let an administrator run" \
      "\"apt-get install --no-install-recommends ${missing[*]}\", then try again" >&2
    exit 1
  fi
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
aptGet() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 "$@" </dev/null >"$log" 2>&1
}
echo "Installing ${#missing[@]} packages and what they need: ${missing[*]}"
# The lists of packages may be missing or stale; fetching them is slow, so only when the first attempt fails.
if ! aptGet install -y --no-install-recommends "${missing[@]}"; then
  if ! aptGet update || ! aptGet install -y --no-install-recommends "${missing[@]}"; then
    tail -n 40 "$log" >&2
    echo "install_dependencies.sh: apt-get could not install the packages above (its last words are shown)" >&2
    exit 1
  fi
fi
