// Pinocchio on the same URDF and the same states, as an independent reader and an independent solver: the whole tree is
// read by its own parser, every joint that is not the arm's is locked. Not part of the build: bench/robot_model.py
// compiles it where Pinocchio is to be had.
//
//   pinocchio_peer FILE STATES LOCKED
//
// LOCKED: a line "joint position" for each joint that does not move.
// Prints one JSON object: nanoseconds per call of rnea (the fastest of 200 laps of 512 states) and the largest
// difference [N m] to the torques in STATES.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <pinocchio/algorithm/model.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/parsers/urdf.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr int kPasses = 25;
constexpr std::size_t kLap = 512;

/// Pinocchio writes an unlimited angle as its cosine and sine.
void set(const pinocchio::JointModel& joint, double angle, Eigen::VectorXd& q) {
  if (joint.nq() == 1) {
    q[joint.idx_q()] = angle;
  } else {
    q[joint.idx_q()] = std::cos(angle);
    q[joint.idx_q() + 1] = std::sin(angle);
  }
}

struct State {
  Eigen::VectorXd q, dq, ddq, torque;
};

void compare(char** argv) {
  std::ifstream states_file(argv[2]), locked_file(argv[3]);
  std::map<std::string, double> held;
  std::string line, joint_name;
  for (double position = 0.0; locked_file >> joint_name >> position;) held[joint_name] = position;
  std::getline(states_file, line);
  std::istringstream header(line);
  const std::vector<std::string> arm{std::istream_iterator<std::string>(header), {}};

  pinocchio::Model whole;
  pinocchio::urdf::buildModel(argv[1], whole);
  Eigen::VectorXd reference = Eigen::VectorXd::Zero(whole.nq);
  std::vector<pinocchio::JointIndex> locked;
  for (pinocchio::JointIndex i = 1; i < whole.joints.size(); ++i) {
    const auto position = held.find(whole.names[i]);
    set(whole.joints[i], position == held.end() ? 0.0 : position->second, reference);
    if (position != held.end()) locked.push_back(i);
  }
  pinocchio::Model model;
  pinocchio::buildReducedModel(whole, locked, reference, model);
  pinocchio::Data data(model);

  std::vector<pinocchio::JointIndex> order;  // Pinocchio's joint of each of the arm's
  for (const std::string& joint : arm) order.push_back(model.getJointId(joint));
  std::vector<State> states;
  const std::size_t n = arm.size();
  for (std::vector<double> row(4 * n); std::getline(states_file, line);) {
    std::istringstream values(line);
    for (double& value : row) values >> value;
    State state{Eigen::VectorXd::Zero(model.nq), Eigen::VectorXd::Zero(model.nv), Eigen::VectorXd::Zero(model.nv),
                Eigen::VectorXd::Zero(model.nv)};
    for (std::size_t i = 0; i < n; ++i) {
      const auto& joint = model.joints[order[i]];
      set(joint, row[i], state.q);
      state.dq[joint.idx_v()] = row[n + i];
      state.ddq[joint.idx_v()] = row[2 * n + i];
      state.torque[joint.idx_v()] = row[3 * n + i];
    }
    states.push_back(state);
  }
  double difference = 0.0;
  for (const State& state : states) {
    difference = std::max(
        difference, (pinocchio::rnea(model, data, state.q, state.dq, state.ddq) - state.torque).cwiseAbs().maxCoeff());
  }
  double nanoseconds = std::numeric_limits<double>::infinity();
  volatile double sink = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (std::size_t first = 0; first + kLap <= states.size(); first += kLap) {
      const auto start = std::chrono::steady_clock::now();
      for (std::size_t i = first; i < first + kLap; ++i) {
        sink = sink + pinocchio::rnea(model, data, states[i].q, states[i].dq, states[i].ddq)[0];
      }
      const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
      nanoseconds = std::min(nanoseconds, spent.count() / static_cast<double>(kLap));
    }
  }
  std::printf("{\"ns\": %.1f, \"difference\": %.3g, \"version\": \"%s\"}\n", nanoseconds, difference,
              PINOCCHIO_VERSION);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: pinocchio_peer FILE STATES LOCKED\n");
    return 2;
  }
  try {
    compare(argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
