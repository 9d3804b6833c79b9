// Measures the inverse kinematics on every arm: random reachable poses against KDL's own solvers, and the tracking of
// paths. Everything is judged by KDL's forward kinematics and a rotation angle of its own. Prints Markdown.
//   inverse_kinematics URDF_FOLDER [POSES]       an absent folder leaves the project's own arm
// Times are of the calling thread (CPU), so that other jobs of the machine do not count.

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/robot/inverse_kinematics.h"
#include "demo_logger/robot/path_tracking.h"
#include "demo_logger/robot/robot_model.h"
#include "reachable_distance.h"
#include "test/robot/pose_by_hand.h"
#include "test/robot/subjects.h"
#include "test/robot/tracking_paths.h"

namespace {

using namespace demo_logger;

constexpr double kBudget = 5e-3;  // [s] per pose for KDL's solvers, as is usual

double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool withinLimits(const RobotDescription& arm, const Eigen::VectorXd& q, double slack) {
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const double value = q[static_cast<Eigen::Index>(i)];
    if (value < arm.joints[i].lower - slack || value > arm.joints[i].upper + slack) return false;
  }
  return true;
}

KDL::Frame toFrame(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  const Eigen::Vector3d p = X.translation();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          KDL::Vector(p.x(), p.y(), p.z())};
}

KDL::Chain toChain(const RobotDescription& arm) {
  KDL::Chain chain;
  for (const ArmJoint& joint : arm.joints) {
    const KDL::Frame X = toFrame(joint.X_parent_joint);
    const KDL::Vector axis(joint.axis.x(), joint.axis.y(), joint.axis.z());
    const auto type = joint.type == JointType::prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    chain.addSegment(KDL::Segment(joint.link, KDL::Joint(joint.name, X.p, X.M * axis, type), X));
  }
  chain.addSegment(KDL::Segment("tip", KDL::Joint("tip", KDL::Joint::Fixed), toFrame(arm.X_lastlink_tip)));
  return chain;
}

/// KDL's two solvers with limits or restarts, each given up to 5 ms: Newton-Raphson with joint limits, and
/// Levenberg-Marquardt whose result is put into limits and tested; both begin again from random postures.
class KdlPeers {
 public:
  explicit KdlPeers(const RobotDescription& arm)
      : arm_(arm),
        chain_(toChain(arm)),
        forward_(chain_),
        velocity_(chain_),
        size_(static_cast<int>(arm.joints.size())),
        lower_(arm.joints.size()),
        upper_(arm.joints.size()) {
    for (int i = 0; i < size_; ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
      lower_(i) = std::max(joint.lower, -1e6);
      upper_(i) = std::min(joint.upper, 1e6);
    }
    newton_ = std::make_unique<KDL::ChainIkSolverPos_NR_JL>(chain_, lower_, upper_, forward_, velocity_, 100, 1e-5);
    const Eigen::Matrix<double, 6, 1> weights = Eigen::Matrix<double, 6, 1>::Ones();
    marquardt_ = std::make_unique<KDL::ChainIkSolverPos_LMA>(chain_, weights, 1e-5, 100);
  }

  bool newton(const Eigen::Isometry3d& target, Eigen::VectorXd q, Eigen::VectorXd& result) {
    return restarted(*newton_, target, std::move(q), result);
  }
  bool marquardt(const Eigen::Isometry3d& target, Eigen::VectorXd q, Eigen::VectorXd& result) {
    return restarted(*marquardt_, target, std::move(q), result);
  }

 private:
  bool restarted(KDL::ChainIkSolverPos& solver, const Eigen::Isometry3d& target, Eigen::VectorXd q,
                 Eigen::VectorXd& result) {
    const double begin = threadSeconds();
    const KDL::Frame frame = toFrame(target);
    KDL::JntArray seed(static_cast<unsigned>(size_)), found(seed);
    do {
      seed.data = q;
      const int code = solver.CartToJnt(seed, frame, found);
      result = found.data;
      for (int i = 0; i < size_; ++i) {
        while (result[i] > upper_(i)) result[i] -= 2.0 * M_PI;
        while (result[i] < lower_(i)) result[i] += 2.0 * M_PI;
      }
      if (code >= 0 && result.allFinite() && withinLimits(arm_, result, 1e-9)) return true;
      q = randomPosture(arm_, generator_);
    } while (threadSeconds() - begin < kBudget);
    return false;
  }

  const RobotDescription& arm_;
  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive forward_;
  KDL::ChainIkSolverVel_pinv velocity_;
  int size_;
  KDL::JntArray lower_, upper_;
  std::unique_ptr<KDL::ChainIkSolverPos_NR_JL> newton_;
  std::unique_ptr<KDL::ChainIkSolverPos_LMA> marquardt_;
  std::mt19937_64 generator_{2};
};

struct Score {
  int poses = 0, solved = 0, out_of_limits = 0, false_claims = 0;
  std::vector<double> microseconds;

  double mean() const {
    double sum = 0.0;
    for (const double value : microseconds) sum += value;
    return sum / static_cast<double>(microseconds.size());
  }
  double quantile(double share) {
    std::sort(microseconds.begin(), microseconds.end());
    return microseconds[static_cast<std::size_t>(share * static_cast<double>(microseconds.size() - 1))];
  }
  void add(const Score& other) {
    poses += other.poses;
    solved += other.solved;
    out_of_limits += other.out_of_limits;
    false_claims += other.false_claims;
    microseconds.insert(microseconds.end(), other.microseconds.begin(), other.microseconds.end());
  }
};

using Solver = std::function<bool(const Eigen::Isometry3d& target, const Eigen::VectorXd& seed, Eigen::VectorXd& q)>;

Score score(const RobotDescription& arm, int poses, bool random_seed, double tolerance, const Solver& solver) {
  const RobotModel kdl(arm);
  const Eigen::VectorXd middle = InverseKinematics(arm).middle();
  std::mt19937_64 generator(1), seeds(7);
  Score result;
  Eigen::VectorXd q(kdl.size());
  for (int i = 0; i < poses; ++i) {
    const Eigen::Isometry3d target = kdl.forwardKinematics(randomPosture(arm, generator));
    const Eigen::VectorXd seed = random_seed ? randomPosture(arm, seeds) : middle;
    const double begin = threadSeconds();
    const bool claimed = solver(target, seed, q);
    result.microseconds.push_back(1e6 * (threadSeconds() - begin));
    ++result.poses;
    if (!claimed) continue;
    const bool inside = withinLimits(arm, q, 0.0);
    const bool right = poseDistance(kdl.forwardKinematics(q), target) <= tolerance;
    if (!inside) ++result.out_of_limits;
    if (!right) ++result.false_claims;
    if (inside && right) ++result.solved;
  }
  return result;
}

void printRow(const std::string& arm, const char* seed, const char* solver, Score& score) {
  std::printf("| %s | %s | %s | %d | %d | %d | %d | %.1f | %.1f | %.0f | %.0f |\n", arm.c_str(), seed, solver,
              score.poses, score.poses - score.solved, score.out_of_limits, score.false_claims, score.mean(),
              score.quantile(0.5), score.quantile(0.99), score.quantile(0.999));
}

void measureSolve(const std::vector<Subject>& subjects, int poses) {
  std::printf("## Random reachable poses\n\n");
  std::printf(
      "| arm | seed | solver | poses | not solved | out of limits | claimed but wrong | mean µs | p50 | p99 | p99.9 "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|\n");
  Score all, fine, newton_all, marquardt_all;
  for (const Subject& subject : subjects) {
    const InverseKinematics solver(subject.arm);
    KdlPeers peers(subject.arm);
    for (const bool random_seed : {false, true}) {
      const char* seed = random_seed ? "random" : "middle";
      const auto ours = [&](double tolerance) -> Solver {
        return [&, tolerance](const Eigen::Isometry3d& target, const Eigen::VectorXd& start, Eigen::VectorXd& q) {
          SolveOptions options;
          options.tolerance = tolerance;
          return solver.solve(target, start, q, options).solved;
        };
      };
      Score at5 = score(subject.arm, poses, random_seed, 1e-5 + 1e-12, ours(1e-5));
      Score at9 = score(subject.arm, poses, random_seed, 1e-9 + 1e-12, ours(1e-9));
      const double peer_tolerance = std::sqrt(3.0) * 1e-5;  // they test each component
      Score newton =
          score(subject.arm, poses / 10, random_seed, peer_tolerance,
                [&](const auto& target, const auto& start, auto& q) { return peers.newton(target, start, q); });
      Score marquardt =
          score(subject.arm, poses / 10, random_seed, peer_tolerance,
                [&](const auto& target, const auto& start, auto& q) { return peers.marquardt(target, start, q); });
      printRow(subject.name, seed, "demo_logger 1e-5", at5);
      printRow(subject.name, seed, "demo_logger 1e-9", at9);
      printRow(subject.name, seed, "KDL NR_JL", newton);
      printRow(subject.name, seed, "KDL LMA", marquardt);
      all.add(at5);
      fine.add(at9);
      newton_all.add(newton);
      marquardt_all.add(marquardt);
    }
  }
  printRow("all", "both", "demo_logger 1e-5", all);
  printRow("all", "both", "demo_logger 1e-9", fine);
  printRow("all", "both", "KDL NR_JL", newton_all);
  printRow("all", "both", "KDL LMA", marquardt_all);
}

/// Every joint that has limits at one of them, the others anywhere: what a descent within limits finds worst.
Eigen::VectorXd randomCorner(const RobotDescription& arm, std::mt19937_64& generator) {
  Eigen::VectorXd q = randomPosture(arm, generator);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    if (joint.type != JointType::continuous) q[i] = generator() % 2 == 0 ? joint.lower : joint.upper;
  }
  return q;
}

void measureCorners(const std::vector<Subject>& subjects) {
  constexpr int kPoses = 1000;
  std::printf("\n## Poses reached with every joint at a limit, from the middle\n\n");
  std::printf("| arm | poses | not solved (1e-5) | mean µs |\n|---|---|---|---|\n");
  for (const Subject& subject : subjects) {
    const RobotModel kdl(subject.arm);
    const InverseKinematics solver(subject.arm);
    std::mt19937_64 generator(5);
    SolveOptions options;
    options.tolerance = 1e-5;
    int failed = 0;
    double seconds = 0.0;
    Eigen::VectorXd q;
    for (int k = 0; k < kPoses; ++k) {
      const Eigen::Isometry3d target = kdl.forwardKinematics(randomCorner(subject.arm, generator));
      const double begin = threadSeconds();
      if (!solver.solve(target, solver.middle(), q, options).solved) ++failed;
      seconds += threadSeconds() - begin;
    }
    std::printf("| %s | %d | %d | %.1f |\n", subject.name.c_str(), kPoses, failed, 1e6 * seconds / kPoses);
  }
}

struct TrackScore {
  double position = 0.0, rotation = 0.0;  // [mm], [mrad] worst
  double within = 0.0;                    // share of the steps within 1 mm and 1 mrad
  int violations = 0;
  double microseconds = 0.0;
  double excess = 0.0;  // [mm] out of reach: position error beyond the true distance
  double behind = 0.0;  // [mm] position error after the hand's return
  double back = 0.0;    // [ms] out of reach: from the hand's return until the position is within 1 mm
};

TrackScore scoreTracking(const RobotDescription& arm, const TrackingPath& path, double rate, bool foresight,
                         const PathLimits& limits) {
  TrackingOptions options;
  options.max_velocity = limits.velocity;
  options.max_acceleration = limits.acceleration;
  options.patience = 1.0;  // as demo_tool ik
  std::vector<double> times;
  for (std::size_t k = 0; k < path.poses.size(); ++k) times.push_back(static_cast<double>(k) / rate);
  const RobotModel kdl(arm);
  ReachableDistance reachable(arm);
  PathTracker ahead(arm, path.poses, times, path.start, options);
  Tracker live(arm, options);
  live.reset(path.start);
  if (foresight) ahead.plan();
  Eigen::VectorXd before = path.start, last = path.start;
  TrackScore result;
  double returned = -1.0;
  bool was_out = false;
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    const double begin = threadSeconds();
    if (foresight) {
      ahead.step();
    } else if (k > 0) {
      live.step(path.poses[k], 1.0 / rate);
    }
    result.microseconds += 1e6 * (threadSeconds() - begin) / static_cast<double>(path.poses.size());
    const Eigen::VectorXd q = foresight ? ahead.q() : live.q();
    if (!withinLimits(arm, q, 0.0)) ++result.violations;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double fastest = std::min(arm.joints[static_cast<std::size_t>(i)].velocity_limit, limits.velocity);
      if (std::abs(q[i] - last[i]) * rate > fastest) ++result.violations;
      if (std::abs(q[i] - 2.0 * last[i] + before[i]) * rate * rate > limits.acceleration) ++result.violations;
    }
    before = last;
    last = q;
    const Eigen::Isometry3d X = kdl.forwardKinematics(q);
    const double position = 1e3 * (X.translation() - path.poses[k].translation()).norm();
    const double rotation = 1e3 * angleBetween(X.linear(), path.poses[k].linear());
    result.position = std::max(result.position, position);
    result.rotation = std::max(result.rotation, rotation);
    if (position <= 1.0 && rotation <= 1.0) result.within += 1.0 / static_cast<double>(path.poses.size());
    if (path.name != "out of reach" || k % static_cast<std::size_t>(rate / 100.0) != 0) continue;
    const double distance = 1e3 * reachable.to(path.poses[k].translation());
    if (distance > 0.1) {
      result.excess = std::max(result.excess, position - distance);
      was_out = true;
      returned = -1.0;
    } else if (was_out) {
      if (returned < 0.0) returned = times[k];
      result.behind = std::max(result.behind, position);
      if (position > 1.0) result.back = 1e3 * (times[k] - returned);
    }
  }
  return result;
}

void measureTracking(const std::vector<Subject>& subjects) {
  const PathLimits limits;
  std::printf("\n## Tracking, 10 s, velocity at most %.1f rad/s, acceleration %.0f rad/s²\n\n", limits.velocity,
              limits.acceleration);
  std::printf(
      "| arm | path | Hz | foresight | worst mm | worst mrad | steps within 1 mm and 1 mrad %% | limit violations | µs "
      "a step | beyond true distance mm | behind after return mm | back after ms |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Subject& subject : subjects) {
    for (const double rate : {100.0, 1000.0}) {
      const TrackingPaths paths(subject.arm, rate, limits);
      for (const TrackingPath& path : paths.all()) {
        for (const bool foresight : {true, false}) {
          const TrackScore result = scoreTracking(subject.arm, path, rate, foresight, limits);
          const bool out = path.name == "out of reach";
          std::printf("| %s | %s | %.0f | %s | %.3f | %.3f | %.1f | %d | %.1f | %s | %s | %s |\n", subject.name.c_str(),
                      path.name.c_str(), rate, foresight ? "yes" : "no", result.position, result.rotation,
                      100.0 * result.within, result.violations, result.microseconds,
                      out ? std::to_string(static_cast<int>(result.excess + 0.5)).c_str() : "",
                      out ? std::to_string(static_cast<int>(result.behind + 0.5)).c_str() : "",
                      out ? std::to_string(static_cast<int>(result.back + 0.5)).c_str() : "");
        }
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) setenv("DEMO_LOGGER_URDF", argv[1], 1);
  const int poses = argc > 2 ? std::atoi(argv[2]) : 10000;
  const std::vector<Subject> subjects = solverSubjects();
  measureSolve(subjects, poses);
  measureCorners(subjects);
  measureTracking(subjects);
}
