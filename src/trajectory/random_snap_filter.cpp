#include "random_snap_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace demo_logger {
namespace {

constexpr std::size_t kOrder = 4;
constexpr std::size_t kKnownAfter = 8;  // samples measured, and a time constant
constexpr double kPi = 3.14159265358979323846;

/// The inverse of a positive definite matrix whose entries may differ by many orders of magnitude.
Eigen::Matrix4d inverseOf(const Eigen::Matrix4d& matrix) {
  const Eigen::Vector4d scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix4d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::Matrix4d inverse = scaled.ldlt().solve(Eigen::Matrix4d::Identity());
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

Eigen::Matrix4d symmetric(const Eigen::Matrix4d& matrix) { return 0.5 * (matrix + matrix.transpose()); }

/// P = F P Fᵀ + Q by what F has of ones and zeros, a third of the work: most of a search goes here.
void addStep(const Eigen::Matrix4d& F, const Eigen::Matrix4d& Q, Eigen::Matrix4d& P) {
  const double a = F(0, 1);
  const double b = F(0, 2);
  const double c = F(0, 3);
  Eigen::Matrix4d M = P;  // P Fᵀ
  M.col(0) += a * P.col(1) + b * P.col(2) + c * P.col(3);
  M.col(1) += a * P.col(2) + b * P.col(3);
  M.col(2) += a * P.col(3);
  for (int j = 0; j < 4; ++j) {
    P(0, j) = M(0, j) + a * M(1, j) + b * M(2, j) + c * M(3, j) + Q(0, j);
    if (j >= 1) P(1, j) = P(j, 1) = M(1, j) + a * M(2, j) + b * M(3, j) + Q(1, j);
    if (j >= 2) P(2, j) = P(j, 2) = M(2, j) + a * M(3, j) + Q(2, j);
    P(j, 0) = P(0, j);
  }
  P(3, 3) = M(3, 3) + Q(3, 3);
}

}  // namespace

RandomSnapFilter::RandomSnapFilter(const std::vector<double>& time, const Eigen::VectorXd& position, double interval,
                                   double time_constant)
    : time_(time), position_(position), interval_(interval), T_(time_constant) {}

RandomSnapFilter::Matrix RandomSnapFilter::transition(double duration) const {
  const double d = duration / T_;
  Matrix F = Matrix::Identity();
  F(0, 1) = F(1, 2) = F(2, 3) = d;
  F(0, 2) = F(1, 3) = d * d / 2.0;
  F(0, 3) = d * d * d / 6.0;
  return F;
}

/// ∫ φ φᵀ ds over the duration in units of T, φ = (s³/6, s²/2, s, 1), times the density, which is Δt/T by T's
/// definition.
RandomSnapFilter::Matrix RandomSnapFilter::processNoise(double duration) const {
  const double d = duration / T_;
  const double d2 = d * d;
  const double d3 = d2 * d;
  const double d4 = d2 * d2;
  Matrix Q;
  Q << d4 * d2 / 252.0, d4 * d / 72.0, d4 / 30.0, d3 / 24.0,  //
      d4 * d / 72.0, d4 / 20.0, d3 / 8.0, d2 / 6.0,           //
      d4 / 30.0, d3 / 8.0, d2 / 3.0, d / 2.0,                 //
      d3 / 24.0, d2 / 6.0, d / 2.0, 1.0;
  return interval_ / T_ * d * Q;
}

const RandomSnapFilter::Step& RandomSnapFilter::stepTo(std::size_t k) const {
  constexpr double kAlike = 1e-9;  // of a duration; what adding up doubles costs at most
  const double duration = time_[k] - time_[k - 1];
  const double liveliness = liveliness_.empty() ? 1.0 : liveliness_[k];
  const double jump = jumps_.size() == 0 ? 0.0 : jumps_[static_cast<Eigen::Index>(k)];
  if (std::abs(duration - step_.duration) > kAlike * duration || liveliness != step_.liveliness || jump != step_.jump) {
    step_ = {duration, liveliness, jump, transition(duration), liveliness * processNoise(duration)};
    step_.Q(2, 2) += jump;
  }
  return step_;
}

void RandomSnapFilter::predict(Knowledge& knowledge, std::size_t k) const {
  const Step& step = stepTo(k);
  if (!knowledge.is_information) {
    knowledge.vector = step.F * knowledge.vector;
    addStep(step.F, step.Q, knowledge.matrix);
    return;
  }
  // With A = F⁻ᵀ Y F⁻¹:  (A⁻¹ + Q)⁻¹ = (1 + A Q)⁻¹ A, which needs no inverse of Y.
  const Matrix back = transition(-step.duration);
  const Matrix A = back.transpose() * knowledge.matrix * back;
  const Eigen::PartialPivLU<Matrix> blurred(Matrix::Identity() + A * step.Q);
  knowledge.matrix = symmetric(blurred.solve(A));
  knowledge.vector = blurred.solve(back.transpose() * knowledge.vector);
}

void RandomSnapFilter::measure(Knowledge& knowledge, double position, std::size_t count) {
  if (!knowledge.is_information) {
    const double innovation = position - knowledge.vector[0];
    const double variance = knowledge.matrix(0, 0) + 1.0;
    addUp(innovation, variance);
    const Vector gain = knowledge.matrix.col(0) / variance;
    const Eigen::RowVector4d row = knowledge.matrix.row(0);
    knowledge.vector += gain * innovation;
    knowledge.matrix.noalias() -= gain * row;
    return;
  }
  if (count >= kOrder) {  // before that, any cubic goes through the samples
    const Matrix P = inverseOf(knowledge.matrix);
    addUp(position - P.row(0).dot(knowledge.vector), P(0, 0) + 1.0);
  }
  knowledge.matrix(0, 0) += 1.0;
  knowledge.vector[0] += position;
}

void RandomSnapFilter::addUp(double innovation, double variance) {
  ++innovations_;
  squares_ += innovation * innovation / variance;
  // A logarithm costs as much as a whole step; of a product of a few it costs that once.
  product_ *= variance;
  constexpr double kFar = 1e100;
  if (product_ < kFar && product_ > 1.0 / kFar) return;
  logarithms_ += std::log(product_);
  product_ = 1.0;
}

template <typename Visit>
void RandomSnapFilter::filter(std::size_t first, std::size_t last, const Visit& visit) {
  Knowledge knowledge;
  std::size_t measured = 0;
  for (std::size_t k = first; k < last; ++k) {
    if (k > first) predict(knowledge, k);
    const double position = position_[static_cast<Eigen::Index>(k)];
    if (!std::isnan(position)) measure(knowledge, position, measured++);
    if (knowledge.is_information && measured >= kKnownAfter && time_[k] - time_[first] > T_) {
      knowledge.is_information = false;
      knowledge.matrix = inverseOf(knowledge.matrix);
      knowledge.vector = knowledge.matrix * knowledge.vector;
    }
    visit(k, knowledge);
  }
}

void RandomSnapFilter::run(std::size_t first, std::size_t last) {
  filter(first, last, [](std::size_t, const Knowledge&) {});
}

std::vector<double> RandomSnapFilter::pieceLogLikelihoods(std::size_t samples, double r) {
  std::vector<double> pieces;
  double before = 0.0;
  filter(0, time_.size(), [&](std::size_t k, const Knowledge&) {
    if ((k + 1) % samples != 0 && k + 1 != time_.size()) return;
    const double until = -0.5 * (squares_ / r + sumOfLogarithms());
    pieces.push_back(until - before);
    before = until;
  });
  return pieces;
}

double RandomSnapFilter::sumOfLogarithms() const { return logarithms_ + std::log(product_); }

double RandomSnapFilter::variance() const { return squares_ / static_cast<double>(innovations_); }

double RandomSnapFilter::logLikelihood() const {
  const auto n = static_cast<double>(innovations_);
  return -0.5 * (n * std::log(2.0 * kPi * variance()) + n + sumOfLogarithms());
}

/// The likelihood of a jump δ is that of a state whose expectation is off by it: with the covariance P of what came
/// before, the samples from k on say that the state is off by u = (1 + Y P)⁻¹ (y − Y ξ), as information (1 + Y P)⁻¹ Y.
std::pair<double, double> RandomSnapFilter::evidenceOfJump(Knowledge before, std::size_t k, const Matrix& Y,
                                                           const Vector& y) const {
  if (before.is_information) return {0.0, 0.0};
  predict(before, k);
  const Eigen::PartialPivLU<Matrix> together(Matrix::Identity() + Y * before.matrix);
  return {together.solve(y - Y * before.vector)[2], together.solve(Y)(2, 2)};
}

SmoothedMotion RandomSnapFilter::smooth(std::optional<double> known_r, JumpEvidence* evidence) {
  const std::size_t count = time_.size();
  std::vector<Knowledge> until(count);  // each sample, and with it
  filter(0, count, [&](std::size_t k, const Knowledge& knowledge) { until[k] = knowledge; });

  SmoothedMotion motion;
  const double r = known_r.value_or(variance());
  motion.measurement_deviation = std::sqrt(r);
  motion.snap_density = r * interval_ / std::pow(T_, 8);
  motion.time_constant = T_;
  motion.log_likelihood = logLikelihood();
  const auto rows = static_cast<Eigen::Index>(count);
  motion.position.resize(rows);
  motion.velocity.resize(rows);
  motion.acceleration.resize(rows);
  motion.covariance.resize(count);
  if (evidence) evidence->score = evidence->information = Eigen::VectorXd::Zero(rows);

  const Eigen::Vector3d units(1.0, 1.0 / T_, 1.0 / (T_ * T_));
  Matrix Y = Matrix::Zero();  // what the samples after k say
  Vector y = Vector::Zero();
  for (std::size_t k = count; k-- > 0;) {
    const auto& [is_information, matrix, vector] = until[k];
    Matrix P;
    Vector state;
    if (is_information) {
      P = inverseOf(matrix + Y);
      state = P * (vector + y);
    } else {
      const Eigen::PartialPivLU<Matrix> together(Matrix::Identity() + matrix * Y);
      P = together.solve(matrix);
      state = together.solve(vector + matrix * y);
    }
    const auto row = static_cast<Eigen::Index>(k);
    motion.position[row] = state[0];
    motion.velocity[row] = units[1] * state[1];
    motion.acceleration[row] = units[2] * state[2];
    motion.covariance[k] = r * units.asDiagonal() * symmetric(P).topLeftCorner<3, 3>() * units.asDiagonal();
    if (k == 0) break;

    if (const double position = position_[row]; !std::isnan(position)) {
      Y(0, 0) += 1.0;
      y[0] += position;
    }
    if (evidence && r > 0.0) {
      const auto [score, information] = evidenceOfJump(until[k - 1], k, Y, y);
      evidence->score[row] = T_ * T_ / r * score;
      evidence->information[row] = std::pow(T_, 4) / r * information;
    }
    const Step& step = stepTo(k);
    const Eigen::PartialPivLU<Matrix> blurred(Matrix::Identity() + Y * step.Q);
    y = step.F.transpose() * blurred.solve(y);
    Y = symmetric(step.F.transpose() * blurred.solve(Y) * step.F);
  }
  return motion;
}

}  // namespace demo_logger
