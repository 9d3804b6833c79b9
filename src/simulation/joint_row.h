#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace demo_logger {

/// One row of Bullet's constraint problem: an impulse [N m s or N s] at one joint, between `lowest` and `highest`, that
/// brings the joint's velocity as near to `target` as it can. Coulomb friction is the target 0 with bounds ± friction
/// times step; a stop is the velocity that just reaches it in this step, with an impulse of one sign only.
class JointRow final : public btMultiBodyConstraint {
 public:
  JointRow(btMultiBody& body, int joint);

  void activate(double target, double lowest, double highest);
  void deactivate();

  /// Given in the last step.
  double impulse();

 private:
  void finalizeMultiDof() override;
  int getIslandIdA() const override;
  int getIslandIdB() const override;
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& jacobians,
                            const btContactSolverInfo& solver) override;
  void debugDraw(btIDebugDraw* /*drawer*/) override {}

  bool active_ = false;
  double target_ = 0.0;
  double lowest_ = 0.0;
  double highest_ = 0.0;
};

}  // namespace demo_logger
