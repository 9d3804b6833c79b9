#pragma once

#include <cstdint>
#include <random>

namespace demo_logger {

class Snapshot;

/// Independent numbers of mean 0 and standard deviation 1 from a seed. Unlike std::normal_distribution, whose
/// arithmetic is each library's own choice, this is one algorithm: the same seed gives the same demonstration
/// elsewhere.
class GaussianNoise {
 public:
  explicit GaussianNoise(std::uint64_t seed) : generator_(seed) {}

  double next();
  /// Evenly between `lower` and `upper`.
  double uniform(double lower, double upper);

  void exchange(Snapshot& snapshot);

 private:
  std::mt19937_64 generator_;
};

}  // namespace demo_logger
