// What inverse dynamics cost, and whether KDL and Bullet agree on them, for one arm.
//
//   robot_model FILE BASE TIP [STATES]
//
// Prints one JSON object: nanoseconds per call (the fastest of 200 laps of 512 random states; the competitors take
// turns in every lap) and the largest disagreements [N m] over 2,000 states. STATES: a file to write the states and our
// torques to, for a peer that is no library of this distribution.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#ifdef DEMO_LOGGER_HAS_KDL_PARSER
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#endif

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "demo_logger/trajectory/error.h"
#include "src/robot/kdl_chain.h"

namespace demo_logger {
namespace {

constexpr int kStates = 4096;
constexpr int kCompared = 2000;
constexpr int kPasses = 25;
constexpr int kLap = 512;

struct State {
  Eigen::VectorXd q, dq, ddq;
};

std::vector<State> randomStates(const RobotDescription& arm) {
  std::mt19937_64 generator(3);
  const auto n = static_cast<Eigen::Index>(arm.joints.size());
  const auto uniform = [&](double bound) {
    std::uniform_real_distribution<double> value(-bound, bound);
    return Eigen::VectorXd::NullaryExpr(n, [&] { return value(generator); }).eval();
  };
  std::vector<State> states(kStates);
  for (State& state : states) {
    state.q.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
      state.q[i] =
          std::uniform_real_distribution<double>(std::max(joint.lower, -M_PI), std::min(joint.upper, M_PI))(generator);
    }
    state.dq = uniform(2.0);
    state.ddq = uniform(5.0);
  }
  return states;
}

/// KDL's recursive Newton-Euler and nothing else.
class BareKdl {
 public:
  BareKdl(const KDL::Chain& chain, const Eigen::Vector3d& gravity)
      : chain_(chain),
        solver_(chain_, toKdl(gravity)),
        q_(chain_.getNrOfJoints()),
        dq_(q_),
        ddq_(q_),
        torque_(q_),
        wrenches_(chain_.getNrOfSegments(), KDL::Wrench::Zero()) {}
  BareKdl(const BareKdl&) = delete;
  BareKdl& operator=(const BareKdl&) = delete;

  const Eigen::VectorXd& operator()(const State& state) {
    q_.data = state.q;
    dq_.data = state.dq;
    ddq_.data = state.ddq;
    solver_.CartToJnt(q_, dq_, ddq_, wrenches_, torque_);
    return torque_.data;
  }

 private:
  KDL::Chain chain_;
  KDL::ChainIdSolver_RNE solver_;
  KDL::JntArray q_, dq_, ddq_, torque_;
  KDL::Wrenches wrenches_;
};

struct Competitor {
  std::string name;
  std::function<double(const State&)> call;  // returns something of the result, so that it cannot be left out
  std::vector<double> nanoseconds = {};      // per call, lap by lap

  double fastest() const { return *std::min_element(nanoseconds.begin(), nanoseconds.end()); }
};

/// In every lap of half a thousand states each competitor takes its turn, so that whatever else the machine does meets
/// them all.
void race(std::vector<Competitor>& competitors, const std::vector<State>& states) {
  volatile double sink = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    for (int first = 0; first < kStates; first += kLap) {
      for (Competitor& competitor : competitors) {
        const auto start = std::chrono::steady_clock::now();
        for (int i = first; i < first + kLap; ++i) {
          sink = sink + competitor.call(states[static_cast<std::size_t>(i)]);
        }
        const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
        competitor.nanoseconds.push_back(spent.count() / kLap);
      }
    }
  }
}

/// The median, over the laps, of how much longer the one took than the other.
double medianRatio(const Competitor& one, const Competitor& other) {
  std::vector<double> ratios;
  for (std::size_t lap = 0; lap < one.nanoseconds.size(); ++lap) {
    ratios.push_back(one.nanoseconds[lap] / other.nanoseconds[lap]);
  }
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
  return ratios[ratios.size() / 2];
}

/// The drives and a load that make the model whole; the values do not matter to the time.
RobotDescription wholeArm(const RobotDescription& arm) {
  std::map<std::string, JointDrive> drives;
  for (const ArmJoint& joint : arm.joints) drives[joint.name] = {0.1, 0.5, 1.0, 0.01};
  BodyInertia load;
  load.mass = 1.0;
  load.center = {0.01, 0.02, 0.05};
  load.inertia.diagonal() << 2e-3, 2e-3, 1e-3;
  return withDrives(withLoad(arm, load), drives);
}

double againstBullet(const RobotDescription& arm, const std::vector<State>& states) {
  const RobotModel model(arm);
  BulletArm bullet(arm);
  double worst = 0.0;
  for (int i = 0; i < kCompared; ++i) {
    const State& state = states[static_cast<std::size_t>(i)];
    const Eigen::VectorXd torque = model.inverseDynamics(state.q, state.dq, state.ddq);
    bullet.reset({state.q, state.dq});
    const Eigen::VectorXd ddq = bullet.acceleration(torque);
    worst = std::max(worst, (model.inverseDynamics(state.q, state.dq, ddq) - torque).cwiseAbs().maxCoeff());
  }
  return worst;
}

void writeStates(const std::string& path, const RobotDescription& arm, const std::vector<State>& states) {
  const RobotModel model(arm);
  std::ofstream file(path);
  file.precision(17);
  for (const ArmJoint& joint : arm.joints) file << joint.name << ' ';
  file << '\n';
  for (const State& state : states) {
    const Eigen::VectorXd torque = model.inverseDynamics(state.q, state.dq, state.ddq);
    for (const Eigen::VectorXd* part : {&state.q, &state.dq, &state.ddq, &torque}) file << part->transpose() << ' ';
    file << '\n';
  }
}

#ifdef DEMO_LOGGER_HAS_KDL_PARSER
KDL::Chain chainOfKdlParser(const std::string& path, const RobotDescription& arm) {
  std::ifstream file(path, std::ios::binary);
  KDL::Tree tree;
  KDL::Chain chain;
  if (!kdl_parser::treeFromString({std::istreambuf_iterator<char>(file), {}}, tree) ||
      !tree.getChain(arm.base, arm.tip, chain)) {
    throw ModelError("kdl_parser cannot read " + path);
  }
  return chain;
}
#endif

nlohmann::json measure(const std::string& path, const std::string& base, const std::string& tip,
                       const std::string& states_file) {
  DescriptionOptions options;
  options.base = base;
  options.tip = tip;
  const RobotDescription arm = describeRobotFile(path, options);
  const std::vector<State> states = randomStates(arm);
  const RobotModel ours(arm), whole(wholeArm(arm));
  BareKdl lumped_kdl(makeKdlChain(arm), arm.gravity);
  Eigen::VectorXd torque;
  Eigen::MatrixXd matrix;
  Eigen::Isometry3d pose;
  std::vector<Competitor> competitors = {
      {"kdl_rne_lumped", [&](const State& s) { return lumped_kdl(s)[0]; }},
      {"motor_torque", [&](const State& s) { return whole.motorTorque(s.q, s.dq, s.ddq, torque), torque[0]; }},
      {"inverse_dynamics", [&](const State& s) { return ours.inverseDynamics(s.q, s.dq, s.ddq, torque), torque[0]; }},
      {"forward_kinematics", [&](const State& s) { return ours.forwardKinematics(s.q, pose), pose(0, 3); }},
      {"jacobian", [&](const State& s) { return ours.jacobian(s.q, matrix), matrix(0, 0); }},
      {"mass_matrix", [&](const State& s) { return ours.massMatrix(s.q, matrix), matrix(0, 0); }},
      {"coriolis", [&](const State& s) { return ours.coriolis(s.q, s.dq, torque), torque[0]; }},
      {"gravity", [&](const State& s) { return ours.gravity(s.q, torque), torque[0]; }}};
  nlohmann::json result;
#ifdef DEMO_LOGGER_HAS_KDL_PARSER
  BareKdl parsed_kdl(chainOfKdlParser(path, arm), arm.gravity);
  competitors.push_back({"kdl_rne_parsed", [&](const State& s) { return parsed_kdl(s)[0]; }});
  double lost = 0.0;
  for (int i = 0; i < kCompared; ++i) {
    const State& state = states[static_cast<std::size_t>(i)];
    const Eigen::VectorXd difference = parsed_kdl(state) - ours.inverseDynamics(state.q, state.dq, state.ddq);
    lost = std::max(lost, difference.cwiseAbs().maxCoeff());
  }
  result["kdl_parser_misses"] = lost;
#endif
  race(competitors, states);
  result["joints"] = arm.joints.size();
  result["robot"] = arm.name;
  for (const Competitor& competitor : competitors) result["ns"][competitor.name] = competitor.fastest();
  result["whole_to_bare"] = medianRatio(competitors[1], competitors[0]);
  double largest = 0.0;
  for (const State& state : states) {
    largest = std::max(largest, ours.inverseDynamics(state.q, state.dq, state.ddq).cwiseAbs().maxCoeff());
  }
  result["largest_torque"] = largest;
  result["against_bullet"] = againstBullet(arm, states);
  if (!states_file.empty()) writeStates(states_file, arm, states);
  return result;
}

}  // namespace
}  // namespace demo_logger

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5) {
    std::fprintf(stderr, "usage: robot_model FILE BASE TIP [STATES]\n");
    return 2;
  }
  try {
    std::printf("%s\n", demo_logger::measure(argv[1], argv[2], argv[3], argc == 5 ? argv[4] : "").dump().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
