#pragma once

#include <string>
#include <vector>

#include "demo_logger/recording/sample.h"

namespace demo_logger {

/// Where on the time line a message belongs.
enum class Placement { by_stamp, by_receipt, nowhere };

/// The nodes that send on one topic, and which of them stamp. One whose first message has no stamp does not stamp, and
/// its messages are placed by receipt; it does as soon as it has sent a stamp, and what it then sends without one
/// belongs nowhere. (Simulated time starts at zero, so a first stamp of zero may be the only one.)
class PublisherTable {
 public:
  /// More names than this share one entry: names are given by others.
  static constexpr std::size_t kCapacity = 64;

  struct Publisher {
    std::string name;
    bool stamps = false;
    bool heard = false;  // since forgetHeard()
  };

  Placement place(const Arrival& arrival);

  /// The index of the publisher of the last message placed.
  std::size_t last() const { return last_; }
  const std::string& nameOf(std::size_t index) const { return publishers_[index].name; }

  bool anyUnstamped() const;
  /// Those heard since forgetHeard(), without the nameless.
  std::vector<std::string> heard() const;
  /// Forgets who was heard but not who stamps.
  void forgetHeard();
  /// For the publisher of a message that is still in force.
  void hear(std::size_t index) { publishers_[index].heard = true; }

 private:
  std::size_t indexOf(const std::string& name);

  std::vector<Publisher> publishers_;
  std::size_t last_ = 0;
};

/// " of NODE" for sentences about its messages, or nothing where the name is not known.
std::string ofPublisher(const std::string& name);

}  // namespace demo_logger
