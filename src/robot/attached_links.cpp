#include "demo_logger/robot/attached_links.h"

#include <map>
#include <utility>

#include "locked_joints.h"
#include "urdf_reader.h"
#include "urdf_tree.h"

namespace demo_logger {
namespace {

void readShapes(const urdf::Link& link, AttachedLink& attached) {
  for (const auto& collision : link.collision_array) {
    CollisionShape shape;
    shape.pose = toEigen(collision->origin);
    if (const auto box = std::dynamic_pointer_cast<urdf::Box>(collision->geometry)) {
      shape.kind = CollisionShape::Kind::box;
      shape.size = {box->dim.x, box->dim.y, box->dim.z};
    } else if (const auto sphere = std::dynamic_pointer_cast<urdf::Sphere>(collision->geometry)) {
      shape.kind = CollisionShape::Kind::sphere;
      shape.size = {sphere->radius, 0.0, 0.0};
    } else if (const auto cylinder = std::dynamic_pointer_cast<urdf::Cylinder>(collision->geometry)) {
      shape.kind = CollisionShape::Kind::cylinder;
      shape.size = {cylinder->radius, cylinder->length, 0.0};
    } else {
      attached.has_mesh = true;
      continue;
    }
    attached.shapes.push_back(shape);
  }
}

}  // namespace

std::vector<AttachedLink> attachedLinks(const std::string& urdf_xml, const DescriptionOptions& options) {
  const RobotDescription description = describeRobot(urdf_xml, options);  // judges everything
  const ParsedUrdf parsed = parseUrdf(urdf_xml);
  const urdf::ModelInterface& model = *parsed.model;
  const auto chain = jointsBetween(model, findLink(model, description.base), findLink(model, description.tip));
  const LockedJoints locked(model, chain, options.locked);
  std::map<std::string, int> arm_joints;
  for (std::size_t i = 0; i < description.joints.size(); ++i) {
    arm_joints[description.joints[i].name] = static_cast<int>(i);
  }

  Eigen::Isometry3d X_root_base = Eigen::Isometry3d::Identity();
  for (const auto& joint : jointsBetween(model, model.getRoot(), findLink(model, description.base))) {
    X_root_base = X_root_base * childInParent(*joint, locked.position(*joint));
  }
  std::vector<AttachedLink> links{{model.getRoot()->name, -1, X_root_base.inverse(), {}, false}};
  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto link = model.getLink(links[i].name);
    readShapes(*link, links[i]);
    for (const auto& joint : link->child_joints) {
      AttachedLink child{joint->child_link_name, links[i].joint, Eigen::Isometry3d::Identity(), {}, false};
      const auto moving = arm_joints.find(joint->name);
      if (moving != arm_joints.end()) {
        child.joint = moving->second;
      } else {
        child.X_body_link = links[i].X_body_link * childInParent(*joint, locked.position(*joint));
      }
      links.push_back(std::move(child));
    }
  }
  return links;
}

}  // namespace demo_logger
