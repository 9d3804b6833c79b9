#include "box_least_squares.h"

#include <array>

namespace demo_logger {
namespace {

enum class Place : char { free, at_lower, at_upper };

constexpr int kTriesAllAtOnce = 3;
constexpr int kMostRounds = 200;  // never seen; rounding could make two joints change places for ever

struct WorkSpace {
  std::array<Place, kMostJoints> place{};
  std::array<Eigen::Index, kMostJoints> free{};
  Eigen::Index count = 0;  // of the free ones
  SquareMatrix L;          // factor of their part of H: L D Lᵀ, D on the diagonal
  JointVector y;
};

/// Minimum over the free variables, the others staying where they are in `x`.
void solveFree(const SquareMatrix& H, const JointVector& g, WorkSpace& work, JointVector& x) {
  const Eigen::Index n = g.size();
  work.count = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (work.place[static_cast<std::size_t>(i)] == Place::free) work.free[static_cast<std::size_t>(work.count++)] = i;
  }
  const Eigen::Index m = work.count;
  work.L.resize(m, m);
  work.y.resize(m);
  const auto entry = [&H](Eigen::Index r, Eigen::Index c) { return r >= c ? H(r, c) : H(c, r); };
  for (Eigen::Index a = 0; a < m; ++a) {
    const Eigen::Index row = work.free[static_cast<std::size_t>(a)];
    double right = g[row];
    if (m < n) {
      for (Eigen::Index k = 0; k < n; ++k) {
        if (work.place[static_cast<std::size_t>(k)] != Place::free) right -= entry(row, k) * x[k];
      }
    }
    work.y[a] = right;
    for (Eigen::Index b = 0; b <= a; ++b) work.L(a, b) = H(row, work.free[static_cast<std::size_t>(b)]);
  }
  for (Eigen::Index j = 0; j < m; ++j) {
    const double inverse = 1.0 / work.L(j, j);
    for (Eigen::Index c = j + 1; c < m; ++c) {
      const double factor = work.L(c, j) * inverse;
      for (Eigen::Index r = c; r < m; ++r) work.L(r, c) -= work.L(r, j) * factor;
      work.y[c] -= factor * work.y[j];
    }
  }
  for (Eigen::Index i = m - 1; i >= 0; --i) {
    for (Eigen::Index k = i + 1; k < m; ++k) work.y[i] -= work.L(k, i) * work.y[k];
    work.y[i] /= work.L(i, i);
    x[work.free[static_cast<std::size_t>(i)]] = work.y[i];
  }
}

/// Moves the joints whose condition is broken, or only the last of them; returns how many there were.
int exchange(const SquareMatrix& H, const JointVector& g, const JointVector& lower, const JointVector& upper, bool all,
             WorkSpace& work, JointVector& x) {
  const Eigen::Index n = g.size();
  std::array<Place, kMostJoints> next = work.place;
  int broken = 0;
  Eigen::Index last = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (work.place[at] == Place::free) {
      if (x[i] >= lower[i] && x[i] <= upper[i]) continue;
      next[at] = x[i] < lower[i] ? Place::at_lower : Place::at_upper;
    } else {
      if (lower[i] == upper[i]) continue;
      double slope = -g[i];
      for (Eigen::Index k = 0; k < n; ++k) slope += (i >= k ? H(i, k) : H(k, i)) * x[k];
      if (work.place[at] == Place::at_lower ? slope >= 0.0 : slope <= 0.0) continue;
      next[at] = Place::free;
    }
    ++broken;
    last = i;
  }
  if (all) {
    work.place = next;
  } else if (broken > 0) {
    work.place[static_cast<std::size_t>(last)] = next[static_cast<std::size_t>(last)];
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Place place = work.place[static_cast<std::size_t>(i)];
    if (place != Place::free) x[i] = place == Place::at_lower ? lower[i] : upper[i];
  }
  return broken;
}

}  // namespace

void minimiseInBox(const SquareMatrix& H, const JointVector& g, const JointVector& lower, const JointVector& upper,
                   JointVector& x) {
  WorkSpace work;
  x.resize(g.size());
  int fewest = kMostJoints + 1;
  int tries = kTriesAllAtOnce;
  for (int round = 0; round < kMostRounds; ++round) {
    solveFree(H, g, work, x);
    const bool all = tries > 0;
    const int broken = exchange(H, g, lower, upper, all, work, x);
    if (broken == 0) return;
    if (broken < fewest) {
      fewest = broken;
      tries = kTriesAllAtOnce;
    } else if (tries > 0) {
      --tries;
    }
  }
  x = x.cwiseMax(lower).cwiseMin(upper);
}

}  // namespace demo_logger
