#pragma once

// Builders of messages and a listener that keeps everything, for tests that feed a synchroniser or a recorder.

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "demo_logger/recording/sample.h"
#include "demo_logger/recording/synchroniser.h"

namespace demo_logger::testing_support {

constexpr Nanoseconds kMillisecond = 1'000'000;

inline Arrival makeArrival(Nanoseconds stamp, Nanoseconds receipt) {
  Arrival arrival;
  arrival.stamp = stamp;
  arrival.receipt = receipt;
  arrival.steady = receipt;
  return arrival;
}

inline JointStateSample makeJointState(Nanoseconds stamp, Nanoseconds receipt, std::vector<std::string> names,
                                       std::vector<double> positions) {
  JointStateSample sample;
  sample.arrival = makeArrival(stamp, receipt);
  sample.names = std::move(names);
  sample.position = std::move(positions);
  return sample;
}

inline StreamSample makeStreamSample(StreamType type, Nanoseconds stamp, Nanoseconds receipt,
                                     std::vector<double> values) {
  StreamSample sample;
  sample.arrival = makeArrival(stamp, receipt);
  sample.type = type;
  sample.values = std::move(values);
  return sample;
}

inline StreamSample makeNumber(Nanoseconds stamp, Nanoseconds receipt, double value) {
  return makeStreamSample(StreamType::number, stamp, receipt, {value});
}

/// A twist whose first component is `vx`; the others are zero.
inline StreamSample makeTwist(Nanoseconds stamp, Nanoseconds receipt, double vx) {
  return makeStreamSample(StreamType::twist, stamp, receipt, {vx, 0.0, 0.0, 0.0, 0.0, 0.0});
}

inline StreamSample makeJoy(Nanoseconds stamp, Nanoseconds receipt, std::vector<double> axes) {
  StreamSample sample = makeStreamSample(StreamType::joy, stamp, receipt, std::move(axes));
  for (std::size_t i = 0; i < sample.values.size(); ++i) sample.components.push_back("axis" + std::to_string(i));
  return sample;
}

inline StreamConfiguration makeStream(const std::string& name, std::optional<StreamType> type,
                                      Alignment alignment = Alignment::hold) {
  StreamConfiguration stream;
  stream.name = name;
  stream.topic = "/" + name;
  stream.type = type;
  stream.alignment = alignment;
  return stream;
}

inline bool sameBits(const std::vector<double>& one, const std::vector<double>& other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](double a, double b) {
    return a == b || (a != a && b != b);  // every NaN is the same missing value
  });
}

/// Keeps what it is told.
class RecordingListener : public RowListener {
 public:
  struct Episode {
    std::vector<Column> columns;
    Nanoseconds first_stamp = 0;
    std::vector<Row> rows;
  };
  struct Jump {
    Nanoseconds stamp;
    double seconds;
  };

  void opened(const std::vector<Column>& columns, Nanoseconds first_stamp) override {
    episodes.push_back({columns, first_stamp, {}});
  }
  void row(const Row& row) override { episodes.back().rows.push_back(row); }
  void clockJumped(Nanoseconds stamp, double seconds) override { jumps.push_back({stamp, seconds}); }

  /// The rows of the only episode, none if it was not opened.
  const std::vector<Row>& rows() const {
    static const std::vector<Row> none;
    return episodes.empty() ? none : episodes.back().rows;
  }
  std::vector<std::string> columnNames() const {
    std::vector<std::string> names;
    if (!episodes.empty()) {
      for (const Column& column : episodes.back().columns) names.push_back(column.name);
    }
    return names;
  }
  /// The value of the last episode's row in the column called `name`; throws std::out_of_range without it.
  double at(std::size_t row, const std::string& name) const {
    const std::vector<std::string> names = columnNames();
    const auto place = std::find(names.begin(), names.end(), name);
    return episodes.back().rows.at(row).values.at(static_cast<std::size_t>(place - names.begin()));
  }

  std::vector<Episode> episodes;
  std::vector<Jump> jumps;
};

}  // namespace demo_logger::testing_support
