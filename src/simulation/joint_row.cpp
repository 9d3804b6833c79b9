#include "joint_row.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace demo_logger {
namespace {

constexpr int kRow = 0;              // there is only one
constexpr int kBaseCoordinates = 6;  // Bullet counts the base's velocity before the joints', also of a fixed base

}  // namespace

JointRow::JointRow(btMultiBody& body, int joint)
    : btMultiBodyConstraint(&body, &body, joint, joint, /*numRows=*/1, /*isUnilateral=*/false,
                            MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR) {}

void JointRow::activate(double target, double lowest, double highest) {
  active_ = true;
  target_ = target;
  lowest_ = lowest;
  highest_ = highest;
}

void JointRow::deactivate() { active_ = false; }

double JointRow::impulse() { return active_ ? getAppliedImpulse(kRow) : 0.0; }

void JointRow::finalizeMultiDof() {
  allocateJacobiansMultiDof();
  jacobianA(kRow)[kBaseCoordinates + m_bodyA->getLink(m_linkA).m_dofOffset] = 1.0;
  m_numDofsFinalized = m_jacSizeBoth;
}

int JointRow::getIslandIdA() const { return m_bodyA->getLink(m_linkA).m_collider->getIslandTag(); }

int JointRow::getIslandIdB() const { return getIslandIdA(); }

void JointRow::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& jacobians,
                                    const btContactSolverInfo& solver) {
  if (!active_) return;
  if (m_numDofsFinalized != m_jacSizeBoth) finalizeMultiDof();
  btMultiBodySolverConstraint& row = rows.expandNonInitializing();
  row.m_orgConstraint = this;
  row.m_orgDofIndex = kRow;
  row.m_multiBodyA = m_bodyA;
  row.m_multiBodyB = m_bodyB;
  const btVector3 none(0.0, 0.0, 0.0);
  fillMultiBodyConstraint(row, jacobians, jacobianA(kRow), jacobianB(kRow), none, none, none, none, /*posError=*/0.0,
                          solver, lowest_, highest_, /*angConstraint=*/false, /*relaxation=*/1.0,
                          /*isFriction=*/false, target_);
}

}  // namespace demo_logger
