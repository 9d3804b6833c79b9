#include "removed_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kPi = 3.14159265358979323846;
constexpr double kSegment = 24.0;  // T; segments overlap by half
constexpr double kHop = 0.5 * kSegment;
constexpr int kLowest = 3;    // harmonic of a segment: ωT = 2π 3 / 24
constexpr int kHighest = 16;  // ditto
constexpr Index kHarmonics = kHighest - kLowest + 1;
constexpr std::array<Index, 5> kReaches = {0, 1, 2, 4, 8};  // segments to either side that are looked at together
constexpr double kSurprising = 3.5;                         // standard deviations: once in 4000 by chance
constexpr double kFast = 2.4;                               // ωT, beyond which chance is given less of a chance
constexpr double kFilled = 0.25;                            // of a segment, at least, is measured

double angularFrequency(Index harmonic) {  // [1/T]
  return 2.0 * kPi * static_cast<double>(kLowest + harmonic) / kSegment;
}

/// Of the noise, what is in the residuals: 1 − H.
double removedShare(double angular_frequency) {
  const double eighth = std::pow(angular_frequency, 8);
  return eighth / (1.0 + eighth);
}

/// How many standard deviations are taken for more than chance. What chance adds to the acceleration's variance grows
/// with ω⁵, so its probability, which goes like exp(−z²/2), has to fall like that.
double surpriseAt(double angular_frequency) {
  return std::sqrt(kSurprising * kSurprising + 10.0 * std::log(std::max(1.0, angular_frequency / kFast)));
}

/// What the mean of so many segments' powers, relative to what is expected, exceeds by chance only with a normal
/// variable's probability of so many standard deviations: the quantile of χ² (Wilson and Hilferty 1931). Neighbours
/// share 1/π² of their power, by the overlap of their windows.
double surprisingMean(Index segments, double standard_deviations) {
  const auto n = static_cast<double>(segments);
  const double independent = n * n / (n + 2.0 * (n - 1.0) / (kPi * kPi));
  const double q = 1.0 / (9.0 * independent);  // 2 / (9 degrees of freedom)
  return std::pow(1.0 - q + standard_deviations * std::sqrt(q), 3);
}

/// Segments of a record, each 24 T long as T is then. Every sample is in two of them; the squares of their windows add
/// up to 1.
class Segments {
 public:
  Segments(const std::vector<double>& time, double T, const std::vector<double>& liveliness)
      : T_(time.size(), T), age_(time.size(), 0.0) {
    for (std::size_t k = 0; k < time.size(); ++k) {
      if (!liveliness.empty()) T_[k] = T * std::pow(liveliness[k], -0.125);  // S goes with T⁻⁸
      // Samples that are further apart share no segment, so a long silence needs none.
      if (k > 0) age_[k] = age_[k - 1] + std::min((time[k] - time[k - 1]) / T_[k], kSegment);
    }
  }

  Index count() const { return static_cast<Index>(age_.back() / kHop) + 2; }
  double timeConstant(std::size_t sample) const { return T_[sample]; }
  double age(std::size_t sample) const { return age_[sample]; }  // [T]

  struct Place {
    Index segment;
    double here;  // the window of this segment
    double next;  // of the one after
  };
  Place placeOf(std::size_t sample) const {
    const double there = age_[sample] / kHop;
    const double whole = std::floor(there);
    const double angle = 0.5 * kPi * (there - whole);
    return {static_cast<Index>(whole), std::cos(angle), std::sin(angle)};
  }

 private:
  std::vector<double> T_;    // [s]
  std::vector<double> age_;  // since the first sample [T]
};

/// The power of residuals, segment by segment.
struct Spectrum {
  Eigen::ArrayXXd power;    // harmonics x segments: |Σ w e exp(iωt)|² / Σ w²
  Eigen::ArrayXd measured;  // Σ w² of each segment
};

Spectrum spectrumOf(const Eigen::VectorXd& residuals, const Segments& segments) {
  Spectrum spectrum;
  spectrum.measured = Eigen::ArrayXd::Zero(segments.count());
  Eigen::ArrayXXd real = Eigen::ArrayXXd::Zero(kHarmonics, segments.count());
  Eigen::ArrayXXd imaginary = real;
  for (Index k = 0; k < residuals.size(); ++k) {
    if (std::isnan(residuals[k])) continue;
    const Segments::Place place = segments.placeOf(static_cast<std::size_t>(k));
    const double angle = 2.0 * kPi / kSegment * segments.age(static_cast<std::size_t>(k));
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    double x = residuals[k] * std::cos(kLowest * angle);
    double y = residuals[k] * std::sin(kLowest * angle);
    for (Index harmonic = 0; harmonic < kHarmonics; ++harmonic) {
      real(harmonic, place.segment) += place.here * x;
      real(harmonic, place.segment + 1) += place.next * x;
      imaginary(harmonic, place.segment) += place.here * y;
      imaginary(harmonic, place.segment + 1) += place.next * y;
      const double turned = c * x - s * y;
      y = s * x + c * y;
      x = turned;
    }
    spectrum.measured[place.segment] += place.here * place.here;
    spectrum.measured[place.segment + 1] += place.next * place.next;
  }
  spectrum.power = (real.square() + imaginary.square()).rowwise() / spectrum.measured.transpose();
  return spectrum;
}

/// By how much the powers of one harmonic, relative to what is expected, exceed 1: the mean of as few segments around
/// each as show it beyond chance, else 0.
Eigen::ArrayXd excessOf(const Eigen::ArrayXd& powers, double standard_deviations) {
  const Index count = powers.size();
  Eigen::ArrayXd sums(count + 1);  // of all before
  sums[0] = 0.0;
  for (Index s = 0; s < count; ++s) sums[s + 1] = sums[s] + powers[s];
  Eigen::ArrayXd excess = Eigen::ArrayXd::Zero(count);
  for (const Index reach : kReaches) {
    for (Index s = 0; s < count; ++s) {
      if (excess[s] > 0.0) continue;
      const Index first = std::max<Index>(0, s - reach);
      const Index last = std::min(count, s + reach + 1);
      const double mean = (sums[last] - sums[first]) / static_cast<double>(last - first);
      if (mean > surprisingMean(last - first, standard_deviations)) excess[s] = mean - 1.0;
    }
  }
  return excess;
}

/// The smallest change from one measured position to the next that is one.
double smallestStep(const Eigen::VectorXd& position) {
  double smallest = std::numeric_limits<double>::infinity();
  double before = std::numeric_limits<double>::quiet_NaN();
  for (const double now : position) {
    if (std::isnan(now)) continue;
    if (now != before && !std::isnan(before)) smallest = std::min(smallest, std::abs(now - before));
    before = now;
  }
  return smallest;
}

/// An encoder's steps look like motion where a joint is slow, unless other noise of half a step at least blurs them:
/// r = (step/2)² + step²/12 then.
bool stepsShow(const Eigen::VectorXd& position, double r) { return std::pow(smallestStep(position), 2) > 3.0 * r; }

}  // namespace

void addRemovedMotion(const std::vector<double>& time, const Eigen::VectorXd& position, double interval,
                      const std::vector<double>& liveliness, SmoothedMotion& motion) {
  const double r = motion.measurement_deviation * motion.measurement_deviation;
  if (!(r > 0.0) || stepsShow(position, r)) return;
  const Segments segments(time, motion.time_constant, liveliness);
  const Spectrum spectrum = spectrumOf(position - motion.position, segments);
  const double full = 0.5 * kSegment * motion.time_constant / interval;  // Σ w² without a gap
  const Eigen::Array<bool, Eigen::Dynamic, 1> filled = spectrum.measured > kFilled * full;
  Eigen::Array3Xd removed = Eigen::Array3Xd::Zero(3, segments.count());  // ∫ p, ω² p, ω⁴ p in units of T
  for (Index harmonic = 0; harmonic < kHarmonics; ++harmonic) {
    const double w = angularFrequency(harmonic);
    if (w * interval > motion.time_constant) break;  // too fast for samples to look like a continuous motion
    const double expected = r * removedShare(w);
    const Eigen::ArrayXd powers = spectrum.power.row(harmonic).transpose() / expected;
    const Eigen::ArrayXd excess = excessOf(filled.select(powers, 1.0), surpriseAt(w));
    for (Index s = 0; s < segments.count(); ++s) {
      if (!filled[s] || excess[s] == 0.0) continue;
      const double variance = expected * excess[s] / spectrum.measured[s];  // both signs of ω, of 2 Σ w² harmonics
      removed.col(s) += variance * Eigen::Array3d(1.0, w * w, w * w * w * w);
    }
  }
  for (std::size_t k = 0; k < time.size(); ++k) {
    const Segments::Place place = segments.placeOf(k);
    const Eigen::Array3d share =
        place.here * place.here * removed.col(place.segment) + place.next * place.next * removed.col(place.segment + 1);
    const double T2 = std::pow(segments.timeConstant(k), 2);
    Eigen::Matrix3d& covariance = motion.covariance[k];
    covariance(0, 0) += share[0];
    covariance(1, 1) += share[1] / T2;
    covariance(2, 2) += share[2] / (T2 * T2);
    covariance(0, 2) -= share[1] / T2;  // an oscillation's acceleration is −ω² times its position
    covariance(2, 0) -= share[1] / T2;
  }
}

}  // namespace demo_logger
