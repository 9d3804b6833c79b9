# shellcheck shell=sh
# Puts demo_tool onto PATH, from the workspace whose setup file is sourced; rosrun finds the very same file.
case ":$PATH:" in
  *":$CATKIN_ENV_HOOK_WORKSPACE/lib/demo_logger:"*) ;;
  *) export PATH="$CATKIN_ENV_HOOK_WORKSPACE/lib/demo_logger:$PATH" ;;
esac
