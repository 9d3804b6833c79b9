#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include <memory>
#include <vector>

#include "demo_logger/simulation/bullet_arm.h"
#include "moving_chain.h"

namespace demo_logger {

/// Where the links of an arm touch what is around, or will within a step. Obstacles by Bullet's narrow phase, pair by
/// pair; the floor, which wants several points at once, by the corners of boxes and points on the rims of cylinders.
/// Nothing is remembered between calls, unlike in Bullet's manifolds, so that an arm can go on from its state alone.
class ContactFinder {
 public:
  /// Throws ModelError for an obstacle without size.
  ContactFinder(const RobotDescription& description, const Surroundings& surroundings);
  ~ContactFinder();

  bool empty() const { return !floor_ && obstacles_.empty(); }

  /// Adds to `contacts`, deepest first and the most important ones only.
  void find(const MovingChain& chain, std::vector<Contact>& contacts);

  /// What touches or overlaps, the deepest contact of each link and obstacle.
  std::vector<Contact> overlaps(const MovingChain& chain);

 private:
  struct Solid {
    int joint;  // whose link it moves with
    CollisionShape shape;
    double radius;  // [m] of the sphere around it
    std::unique_ptr<btCollisionShape> bullet_shape;
    std::unique_ptr<btCollisionObject> object;
  };
  static Solid makeSolid(int joint, const CollisionShape& shape);
  void addLinks(const RobotDescription& description, const Surroundings& surroundings);
  void findAll(const MovingChain& chain, std::vector<Contact>& contacts);
  void findOnFloor(const Solid& solid, const Eigen::Isometry3d& pose, std::vector<Contact>& contacts) const;
  void findOn(int obstacle, const Solid& solid, std::vector<Contact>& contacts);

  std::optional<double> floor_;
  std::vector<Solid> links_;
  std::vector<Solid> obstacles_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_;  // empty: only asked about pairs
};

}  // namespace demo_logger
