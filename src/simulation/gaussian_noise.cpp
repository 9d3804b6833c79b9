#include "demo_logger/simulation/gaussian_noise.h"

#include <cmath>
#include <locale>
#include <sstream>

#include "snapshot.h"

namespace demo_logger {
namespace {

constexpr double kTwoPi = 6.283185307179586;

}  // namespace

double GaussianNoise::uniform(double lower, double upper) {
  const double fraction = static_cast<double>(generator_() >> 11) * 0x1p-53;  // [0, 1), all 53 bits
  return lower + (upper - lower) * fraction;
}

double GaussianNoise::next() {  // Box and Muller's transform; its second number is not worth the memory
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
  return radius * std::cos(uniform(0.0, kTwoPi));
}

void GaussianNoise::exchange(Snapshot& snapshot) {
  std::stringstream numbers;  // the standard says how a generator writes itself, and that it reads itself back
  numbers.imbue(std::locale::classic());
  numbers << generator_;
  std::string text = numbers.str();
  snapshot.value("generator", text);
  if (!snapshot.reading()) return;
  constexpr std::size_t kLongest = 312 * 21 + 10;  // the numbers of this generator, and how many are used
  std::mt19937_64 generator;
  if (text.size() <= kLongest) numbers.str(text);
  if (text.size() > kLongest || !(numbers >> generator)) {
    Snapshot::refuse("generator", "of " + std::to_string(text.size()) +
                                      " characters is not the text of a std::mt19937_64, which is 312 numbers and one");
  }
  generator_ = generator;
}

}  // namespace demo_logger
