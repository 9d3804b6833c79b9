#include "demo_logger/robot/identified_arm.h"

#include <algorithm>

#include "body_inertia.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "joint_named.h"

namespace demo_logger {
namespace {

constexpr double kFarthest = 10.0;  // [m] beyond that nothing hangs on an arm

}  // namespace

RobotDescription withPayload(const RobotDescription& description, const BodyInertia& payload) {
  if (description.joints.empty()) throw ModelError("the payload needs an arm with at least one joint");
  const std::string where = "the payload at tip '" + description.tip + "'";
  RobotDescription loaded = description;
  BodyInertia& last = loaded.joints.back().body;
  if (payload.mass >= 0.0) {
    if (const std::string impossible = impossibility(payload); !impossible.empty()) {
      throw ModelError(where + " has " + impossible);
    }
    last = lumped(last, movedTo(loaded.X_lastlink_tip, payload));
  } else {
    const BodyInertia lost = movedTo(loaded.X_lastlink_tip, payload);
    const double mass = last.mass + lost.mass;
    if (!(mass > 0.0)) {
      throw ModelError(where + " takes " + print(-payload.mass) + " kg from a last body of " + print(last.mass) +
                       " kg, expected to leave some of it");
    }
    last.center = (last.mass * last.center + lost.mass * lost.center) / mass;
    last.inertia *= mass / last.mass;
    last.mass = mass;
  }
  if (!(last.center.norm() <= kFarthest)) {
    throw ModelError(where + " puts the last body's centre of mass " + print(last.center.norm()) +
                     " m away from its joint, expected at most " + print(kFarthest) + " m");
  }
  return loaded;
}

RobotDescription withBodies(const RobotDescription& description, const std::map<std::string, BodyInertia>& bodies) {
  RobotDescription other = description;
  for (const auto& [name, body] : bodies) {
    ArmJoint& joint = jointNamed(other, name, "to move a body");
    const std::string impossible = body.mass == 0.0 ? "no mass" : impossibility(body);
    if (!impossible.empty())
      throw ModelError(std::string("the body that joint '").append(name) + "' moves has " + impossible);
    joint.body = body;
  }
  return other;
}

}  // namespace demo_logger
