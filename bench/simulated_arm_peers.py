#!/usr/bin/env python3
"""What one simulated millisecond of the demo arm costs in other simulators: CPU time, called from Python.

usage: simulated_arm_peers.py URDF
Prints rows for the table of simulated_arm_cost, and a sentence for each simulator that this Python does not have.
"""
import importlib.metadata
import sys
import time

BATCH, BATCHES, SUBSTEPS = 500, 9, 4
PERIOD = 0.001  # [s]


def measure(call):
    """Median and best batch [us per call]."""
    batches = []
    for _ in range(BATCHES):
        start = time.process_time()
        for _ in range(BATCH):
            call()
        batches.append(1e6 * (time.process_time() - start) / BATCH)
    batches.sort()
    return batches[BATCHES // 2], batches[0]


def print_row(what, call):
    median, best = measure(call)
    print("| %s | %.1f | %.1f | %.0f |" % (what, median, best, 1000.0 / median))


def bullet(urdf):
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, -9.81)
    pybullet.setPhysicsEngineParameter(fixedTimeStep=PERIOD / SUBSTEPS, numSubSteps=0)
    arm = pybullet.loadURDF(urdf, useFixedBase=True, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    movable = (pybullet.JOINT_REVOLUTE, pybullet.JOINT_PRISMATIC)
    joints = [j for j in range(pybullet.getNumJoints(arm)) if pybullet.getJointInfo(arm, j)[2] in movable]
    none = [0.0] * len(joints)
    for joint in joints:  # its motors would brake, or stand in for friction
        pybullet.setJointMotorControl2(arm, joint, pybullet.VELOCITY_CONTROL, force=0.5)

    print()  # pybullet warns of links without inertia, and does not end the line

    def tick():
        states = pybullet.getJointStates(arm, joints)
        torque = pybullet.calculateInverseDynamics(arm, [s[0] for s in states], [s[1] for s in states], none)
        for _ in range(SUBSTEPS):  # torques last for one step
            pybullet.setJointMotorControlArray(arm, joints, pybullet.TORQUE_CONTROL, forces=torque)
            pybullet.stepSimulation()

    print_row("pybullet %s, friction by joint motors, inverse dynamics, 4 steps" % importlib.metadata.version("pybullet"), tick)
    print_row("pybullet, a single step and nothing else", pybullet.stepSimulation)


def mujoco_arm(urdf):
    import mujoco

    model = mujoco.MjModel.from_xml_path(urdf)
    model.opt.timestep = PERIOD / SUBSTEPS
    model.dof_frictionloss[:] = 0.5
    model.dof_damping[:] = 0.5
    model.geom_contype[:] = 0  # the arm does not touch itself, as in the other rows
    data = mujoco.MjData(model)

    def tick():
        data.qfrc_applied[:] = data.qfrc_bias
        for _ in range(SUBSTEPS):
            mujoco.mj_step(model, data)
        data.qpos.copy()
        data.qvel.copy()

    print_row("MuJoCo %s, friction, 4 steps" % mujoco.__version__, tick)
    print_row("MuJoCo, a single step and nothing else", lambda: mujoco.mj_step(model, data))


def main():
    missing = []
    for name, run in (("pybullet", bullet), ("mujoco", mujoco_arm)):
        try:
            run(sys.argv[1])
        except ImportError:
            missing.append(name)
    if missing:
        print("\nNot compared, as this Python has no module of that name: %s." % ", ".join(missing))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
