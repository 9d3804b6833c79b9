#!/bin/bash
# The rooms are the architecture: no ROS in the core, and no room links another that it may not know.
set -euo pipefail
source=$1
libraries=$2
found=0

report() {
  echo "$*"
  found=1
}

core=(trajectory formats recording robot channels simulation pipelines)
ros_header='#include *[<"](ros|rosbag|rosgraph_msgs|std_msgs|std_srvs|geometry_msgs|sensor_msgs|trajectory_msgs|diagnostic_[a-z]+|tf2[a-z_]*|topic_tools|message_filters|xmlrpcpp|demo_logger/[A-Z][A-Za-z]*\.h)'
for place in include "${core[@]/#/src/}"; do
  [ -d "$source/$place" ] || continue
  if grep -rnE "$ros_header" "$source/$place"; then
    report "$place includes a ROS header (above); ROS belongs into src/ros, src/nodes and src/tool"
  fi
done

# What each room may link, directly or through the rooms it knows.
declare -A may_know=(
  [trajectory]=""
  [formats]="trajectory"
  [recording]="trajectory formats"
  [robot]="trajectory"
  [channels]="trajectory"
  [simulation]="trajectory robot channels"
  [pipelines]="trajectory formats recording robot channels"
)
ros_library='^lib(ros|tf2|topic_tools|message_filters|diagnostic_updater|class_loader|xmlrpcpp|cpp_common|actionlib|urdf\.|kdl_parser)'
for room in "${core[@]}"; do
  library=$libraries/libdemo_logger_$room.so
  if [ ! -f "$library" ]; then
    report "$library does not exist; is the room built elsewhere?"
    continue
  fi
  for needed in $(readelf --dynamic --wide "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'); do
    [[ ! $needed =~ $ros_library ]] || report "room $room links $needed, which belongs to ROS"
    case $needed in
      libdemo_logger_*)
        other=${needed#libdemo_logger_}
        other=${other%.so}
        [[ " ${may_know[$room]} " == *" $other "* ]] ||
          report "room $room links room $other; it may know: ${may_know[$room]:-no other room}" ;;
      libBullet* | libLinearMath*)
        [ "$room" = simulation ] || report "room $room links $needed; Bullet belongs into simulation" ;;
      liborocos-kdl* | liburdfdom*)
        case $room in robot | simulation | pipelines) ;; *) report "room $room links $needed; KDL belongs into robot" ;; esac ;;
    esac
  done
done
exit $found
