#include "contact_finder.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr double kReach = 0.005;           // [m] no link comes so far within a step of a quarter of a millisecond
constexpr double kMargin = 1e-4;           // [m] by which Bullet rounds edges
constexpr std::size_t kMostContacts = 12;  // a rigid chain is held by fewer
constexpr double kTouching = 1e-6;         // [m]
constexpr double kRodRadius = 0.04;        // [m] of a link without a shape

btVector3 toBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d toEigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform toBullet(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), toBullet(Eigen::Vector3d(X.translation())));
}

using Kind = CollisionShape::Kind;

double boundingRadius(const CollisionShape& shape) {
  switch (shape.kind) {
    case Kind::box:
      return shape.size.norm() / 2.0;
    case Kind::sphere:
      return shape.size.x();
    case Kind::cylinder:
      return std::hypot(shape.size.x(), shape.size.y() / 2.0);
  }
  return 0.0;
}

std::unique_ptr<btCollisionShape> makeBulletShape(const CollisionShape& shape) {
  std::unique_ptr<btConvexInternalShape> result;
  if (shape.kind == Kind::sphere) return std::make_unique<btSphereShape>(shape.size.x());
  if (shape.kind == Kind::box) {
    result = std::make_unique<btBoxShape>(toBullet(Eigen::Vector3d(shape.size / 2.0)));
  } else {
    result = std::make_unique<btCylinderShapeZ>(btVector3(shape.size.x(), shape.size.x(), shape.size.y() / 2.0));
  }
  result->setMargin(kMargin);
  return result;
}

void requireSize(const CollisionShape& shape) {
  const int numbers = shape.kind == Kind::box ? 3 : shape.kind == Kind::cylinder ? 2 : 1;
  for (int i = 0; i < numbers; ++i) {
    if (std::isfinite(shape.size[i]) && shape.size[i] > 0.0) continue;
    throw ModelError("an obstacle has a size of " + print(shape.size[i]) + " m, expected above 0");
  }
  if (!shape.pose.matrix().allFinite()) throw ModelError("an obstacle has a pose that is not finite");
}

/// From joint to joint, for a link whose shape nobody told.
CollisionShape rod(const Eigen::Vector3d& end) {
  CollisionShape shape;
  shape.kind = Kind::cylinder;
  shape.size = {kRodRadius, std::max(end.norm(), kRodRadius), 0.0};
  shape.pose.translation() = end / 2.0;
  shape.pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), end).toRotationMatrix();
  return shape;
}

/// Corners of a box; of a cylinder four points on the rim of either end, one of them the lowest; the lowest of a ball.
std::vector<Eigen::Vector3d> lowPoints(const CollisionShape& shape, const Eigen::Isometry3d& pose) {
  std::vector<Eigen::Vector3d> points;
  if (shape.kind == Kind::sphere) {
    points.emplace_back(pose.translation() - shape.size.x() * Eigen::Vector3d::UnitZ());
  } else if (shape.kind == Kind::box) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                                 (corner & 4) != 0 ? 0.5 : -0.5);
      points.emplace_back(pose * Eigen::Vector3d(sign.cwiseProduct(shape.size)));
    }
  } else {
    const Eigen::Vector3d axis = pose.linear().col(2);
    Eigen::Vector3d down = axis * axis.z() - Eigen::Vector3d::UnitZ();  // in the plane of the ends
    down = down.norm() > 1e-6 ? Eigen::Vector3d(down.normalized()) : Eigen::Vector3d(pose.linear().col(0));
    const Eigen::Vector3d aside = axis.cross(down);
    for (const double end : {-0.5, 0.5}) {
      const Eigen::Vector3d center = pose.translation() + end * shape.size.y() * axis;
      for (const Eigen::Vector3d& direction : {down, aside, Eigen::Vector3d(-aside), Eigen::Vector3d(-down)}) {
        points.emplace_back(center + shape.size.x() * direction);
      }
    }
  }
  return points;
}

bool isDeeper(const Contact& a, const Contact& b) { return a.distance < b.distance; }

class PairResult : public btCollisionWorld::ContactResultCallback {
 public:
  PairResult(int joint, int obstacle, const btCollisionObject& solid, std::vector<Contact>& contacts)
      : joint_(joint), obstacle_(obstacle), solid_(solid), contacts_(contacts) {
    m_closestDistanceThreshold = kReach;
  }

  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* first, int, int,
                           const btCollisionObjectWrapper* /*second*/, int, int) override {
    if (point.getDistance() > kReach) return 0.0;
    const bool solid_is_first = first->getCollisionObject() == &solid_;
    Contact contact;
    contact.joint = joint_;
    contact.point = toEigen(solid_is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB());
    contact.normal = (solid_is_first ? 1.0 : -1.0) * toEigen(point.m_normalWorldOnB);
    contact.distance = point.getDistance();
    contact.obstacle = obstacle_;
    contacts_.push_back(contact);
    return 0.0;
  }

 private:
  int joint_;
  int obstacle_;
  const btCollisionObject& solid_;
  std::vector<Contact>& contacts_;
};

}  // namespace

ContactFinder::ContactFinder(const RobotDescription& description, const Surroundings& surroundings)
    : floor_(surroundings.floor), dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &configuration_) {
  for (const CollisionShape& shape : surroundings.obstacles) {
    requireSize(shape);
    obstacles_.push_back(makeSolid(-1, shape));
    obstacles_.back().object->setWorldTransform(toBullet(shape.pose));
  }
  if (!empty()) addLinks(description, surroundings);
}

ContactFinder::~ContactFinder() = default;

ContactFinder::Solid ContactFinder::makeSolid(int joint, const CollisionShape& shape) {
  Solid solid{joint, shape, boundingRadius(shape), makeBulletShape(shape), std::make_unique<btCollisionObject>()};
  solid.object->setCollisionShape(solid.bullet_shape.get());
  return solid;
}

void ContactFinder::addLinks(const RobotDescription& description, const Surroundings& surroundings) {
  const int size = static_cast<int>(description.joints.size());
  std::vector<bool> has_shape(static_cast<std::size_t>(size), false);
  for (const AttachedLink& link : surroundings.links) {
    if (link.joint < 0) continue;
    for (CollisionShape shape : link.shapes) {
      shape.pose = link.X_body_link * shape.pose;
      links_.push_back(makeSolid(link.joint, shape));
      has_shape[static_cast<std::size_t>(link.joint)] = true;
    }
  }
  for (int i = 0; i < size; ++i) {
    if (has_shape[static_cast<std::size_t>(i)]) continue;
    const bool last = i + 1 == size;
    const Eigen::Isometry3d& next =
        last ? description.X_lastlink_tip : description.joints[static_cast<std::size_t>(i) + 1].X_parent_joint;
    links_.push_back(makeSolid(i, rod(next.translation())));
  }
}

void ContactFinder::find(const MovingChain& chain, std::vector<Contact>& contacts) {
  findAll(chain, contacts);
  std::stable_sort(contacts.begin(), contacts.end(), isDeeper);
  if (contacts.size() > kMostContacts) contacts.resize(kMostContacts);
}

std::vector<Contact> ContactFinder::overlaps(const MovingChain& chain) {
  std::vector<Contact> contacts, overlaps;
  findAll(chain, contacts);
  std::stable_sort(contacts.begin(), contacts.end(), isDeeper);
  for (const Contact& contact : contacts) {
    if (contact.distance > kTouching) break;
    const bool known = std::any_of(overlaps.begin(), overlaps.end(), [&](const Contact& other) {
      return other.joint == contact.joint && other.obstacle == contact.obstacle;
    });
    if (!known) overlaps.push_back(contact);
  }
  return overlaps;
}

void ContactFinder::findAll(const MovingChain& chain, std::vector<Contact>& contacts) {
  for (const Solid& solid : links_) {
    const Eigen::Isometry3d pose = chain.pose(solid.joint) * solid.shape.pose;
    if (floor_ && pose.translation().z() - *floor_ < solid.radius + kReach) findOnFloor(solid, pose, contacts);
    bool placed = false;
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
      const Solid& obstacle = obstacles_[i];
      const double between = (pose.translation() - obstacle.shape.pose.translation()).norm();
      if (between > solid.radius + obstacle.radius + kReach) continue;
      if (!std::exchange(placed, true)) solid.object->setWorldTransform(toBullet(pose));
      findOn(static_cast<int>(i), solid, contacts);
    }
  }
}

void ContactFinder::findOnFloor(const Solid& solid, const Eigen::Isometry3d& pose,
                                std::vector<Contact>& contacts) const {
  for (const Eigen::Vector3d& point : lowPoints(solid.shape, pose)) {
    const double distance = point.z() - *floor_;
    if (distance < kReach) contacts.push_back({solid.joint, point, Eigen::Vector3d::UnitZ(), distance, 0.0, -1});
  }
}

void ContactFinder::findOn(int obstacle, const Solid& solid, std::vector<Contact>& contacts) {
  PairResult result(solid.joint, obstacle, *solid.object, contacts);
  world_.contactPairTest(solid.object.get(), obstacles_[static_cast<std::size_t>(obstacle)].object.get(), result);
}

}  // namespace demo_logger
