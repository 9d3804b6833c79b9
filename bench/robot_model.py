#!/usr/bin/python3
"""What inverse dynamics cost and how far the solvers agree, arm by arm, as Markdown.

The arms are the package's own, and those of the folder that DEMO_LOGGER_URDF names. Pinocchio takes part if a Python
has it: python3 -m venv X && X/bin/pip install pin, then --pinocchio X/bin/python.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import xml.etree.ElementTree

PROJECT = pathlib.Path(__file__).resolve().parent.parent
OWN_ARMS = [("demo_arm", "base_link", "tool_tip"), ("two_link", "base_link", "tool_tip")]
REAL_ARMS = [
    ("panda", "panda_link0", "panda_hand_tcp"),
    ("iiwa14", "iiwa_link_0", "iiwa_link_ee"),
    ("gen3_7dof_2f85", "base_link", "tool_frame"),
    ("baxter", "base", "right_gripper"),
    ("baxter", "base", "left_gripper"),
    ("pr2", "torso_lift_link", "r_wrist_roll_link"),
    ("yumi", "yumi_base_link", "gripper_r_base"),
    ("yumi", "yumi_base_link", "gripper_l_base"),
    ("ur5", "base_link", "tool0"),
    ("gen3_lite", "base_link", "tool_frame"),
    ("vx300s", "vx300s/base_link", "vx300s/ee_gripper_link"),
]
# As Pinocchio's own CMake files ask of whoever includes its headers.
PINOCCHIO_DEFINITIONS = [
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12", "-DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION",
]


def arms():
    """Name, file, base, tip of each arm at hand."""
    for name, base, tip in OWN_ARMS:
        yield name, PROJECT / "urdf" / f"{name}.urdf", base, tip
    folder = os.environ.get("DEMO_LOGGER_URDF")
    for name, base, tip in REAL_ARMS if folder else []:
        yield name, pathlib.Path(folder) / f"{name}.urdf", base, tip


def held_positions(urdf, moving):
    """Where each joint beside the arm stays: 0 or the nearest limit, a mimic joint where its master puts it."""
    joints = {joint.get("name"): joint for joint in xml.etree.ElementTree.parse(urdf).getroot().findall("joint")}

    def position(name):
        joint = joints[name]
        mimic = joint.find("mimic")
        if mimic is not None:
            return float(mimic.get("multiplier", 1)) * position(mimic.get("joint")) + float(mimic.get("offset", 0))
        limit = joint.find("limit")
        if joint.get("type") == "continuous" or limit is None:
            return 0.0
        return min(max(0.0, float(limit.get("lower", 0))), float(limit.get("upper", 0)))

    movable = [name for name, joint in joints.items() if joint.get("type") in ("revolute", "continuous", "prismatic")]
    return {name: position(name) for name in movable if name not in moving}


def compile_pinocchio(python, folder):
    """The peer as a program, or None and why not."""
    found = subprocess.run([python, "-c", "import pinocchio; print(pinocchio.__file__)"],
                           capture_output=True, text=True, check=False)
    if found.returncode != 0:
        return None, f"{pathlib.Path(python).name} has no module pinocchio"
    prefix = next((place for place in pathlib.Path(found.stdout.strip()).parents
                   if (place / "include" / "pinocchio").is_dir()), None)
    if prefix is None:
        return None, "the module pinocchio has come without its headers"
    program = folder / "pinocchio_peer"
    compiled = subprocess.run(
        ["g++", "-std=c++17", "-O3", "-DNDEBUG", "-w", *PINOCCHIO_DEFINITIONS, "-isystem", prefix / "include",
         "-isystem", "/usr/include/eigen3", "-isystem", "/usr/include/urdfdom_headers",
         PROJECT / "bench" / "pinocchio_peer.cpp", "-o", program, "-L", prefix / "lib", "-lpinocchio_default",
         "-lpinocchio_parsers", f"-Wl,-rpath,{prefix / 'lib'}"], capture_output=True, text=True, check=False)
    if compiled.returncode != 0:
        return None, "its headers could not be compiled"
    return program, ""


def measure(program, peer, folder):
    """One dictionary per arm; with the peer's answers beside ours, taken right after them."""
    for name, urdf, base, tip in arms():
        states = folder / "states"
        result = json.loads(subprocess.run([program, urdf, base, tip, states], check=True, capture_output=True,
                                           text=True).stdout)
        result["name"] = f"{name} {tip}" if name in ("baxter", "yumi") else name
        if peer:
            locked = folder / "locked"
            with open(states, encoding="utf-8") as file:
                moving = file.readline().split()
            locked.write_text("".join(f"{joint} {position!r}\n"
                                      for joint, position in held_positions(urdf, moving).items()))
            answer = subprocess.run([peer, urdf, states, locked], check=False, capture_output=True, text=True)
            if answer.returncode == 0:
                result["pinocchio"] = json.loads(answer.stdout)
            else:
                result["pinocchio_refuses"] = answer.stderr.strip()
        yield result


def table(header, rows):
    print("|" + "|".join(f" {cell} " for cell in header) + "|")
    print("|" + "---|" * len(header))
    for row in rows:
        print("|" + "|".join(f" {cell} " for cell in row) + "|")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the built programs")
    parser.add_argument("--pinocchio", default="python3", help="a Python that has the module pinocchio")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        peer, reason = compile_pinocchio(arguments.pinocchio, folder)
        results = list(measure(arguments.programs / "robot_model", peer, folder))

    if peer:
        print(f"Pinocchio {results[0]['pinocchio']['version']}, compiled with the same compiler and `-O3`.\n")
        for result in results:
            if "pinocchio_refuses" in result:
                print(f"It cannot read {result['name']}: {result['pinocchio_refuses']}\n")
    else:
        print(f"Pinocchio is left out: {reason}.\n")
    if not os.environ.get("DEMO_LOGGER_URDF"):
        print("Only the package's own arms: `DEMO_LOGGER_URDF` names no folder of others.\n")

    def pinocchio(result, key, style):
        return format(result["pinocchio"][key], style) if "pinocchio" in result else "-"

    def of_kdl_parser(result, value):
        return value(result) if "kdl_parser_misses" in result else "-"

    print("### Inverse dynamics, ns per call\n")
    print("The fastest of 200 laps of 512 random states, one thread; the columns take turns in every lap (Pinocchio "
          "right after). `motorTorque` is the whole model: load, motor inertia, viscous and Coulomb friction; beside it "
          "the median over the laps of its time by that of KDL's RNE, which a busy machine disturbs least.\n")
    table(["arm", "joints", "KDL's RNE alone", "the same on kdl_parser's chain", "inverseDynamics", "motorTorque",
           "motorTorque / KDL's RNE", "Pinocchio's rnea"],
          [[r["name"], r["joints"], f"{r['ns']['kdl_rne_lumped']:.0f}",
            of_kdl_parser(r, lambda r: f"{r['ns']['kdl_rne_parsed']:.0f}"), f"{r['ns']['inverse_dynamics']:.0f}",
            f"{r['ns']['motor_torque']:.0f}", f"{r['whole_to_bare']:.2f}",
            pinocchio(r, "ns", ".0f")] for r in results])
    print("### Agreement, largest difference of any joint, N m\n")
    print("Bullet: its forward dynamics of our torque, and our torque of its acceleration (2,000 states). Pinocchio: its own "
          "reading of the whole URDF, joints beside the arm locked, 4,096 states. The last column is what a plain KDL chain "
          "misses: grippers and whatever else hangs beside it.\n")
    table(["arm", "largest torque", "to Bullet", "to Pinocchio", "kdl_parser's chain to ours"],
          [[r["name"], f"{r['largest_torque']:.1f}", f"{r['against_bullet']:.1e}", pinocchio(r, "difference", ".1e"),
            of_kdl_parser(r, lambda r: f"{r['kdl_parser_misses']:.2g}")] for r in results])
    print("### The other answers, ns per call\n")
    keys = ["forward_kinematics", "jacobian", "mass_matrix", "coriolis", "gravity"]
    table(["arm", *(key.replace("_", " ") for key in keys)],
          [[r["name"], *(f"{r['ns'][key]:.0f}" for key in keys)] for r in results])


if __name__ == "__main__":
    main()
