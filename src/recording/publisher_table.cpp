#include "publisher_table.h"

#include <algorithm>

namespace demo_logger {

Placement PublisherTable::place(const Arrival& arrival) {
  last_ = indexOf(arrival.publisher);
  Publisher& publisher = publishers_[last_];
  publisher.heard = true;
  if (arrival.stamp != 0) {
    publisher.stamps = true;
    return Placement::by_stamp;
  }
  return publisher.stamps ? Placement::nowhere : Placement::by_receipt;
}

std::size_t PublisherTable::indexOf(const std::string& name) {
  if (last_ < publishers_.size() && publishers_[last_].name == name) return last_;
  const auto known = std::find_if(publishers_.begin(), publishers_.end(),
                                  [&name](const Publisher& publisher) { return publisher.name == name; });
  if (known != publishers_.end()) return static_cast<std::size_t>(known - publishers_.begin());
  if (publishers_.size() == kCapacity) return kCapacity - 1;
  publishers_.push_back(Publisher{name, false, false});
  return publishers_.size() - 1;
}

bool PublisherTable::anyUnstamped() const {
  return std::any_of(publishers_.begin(), publishers_.end(),
                     [](const Publisher& publisher) { return publisher.heard && !publisher.stamps; });
}

std::vector<std::string> PublisherTable::heard() const {
  std::vector<std::string> names;
  for (const Publisher& publisher : publishers_) {
    if (publisher.heard && !publisher.name.empty()) names.push_back(publisher.name);
  }
  return names;
}

void PublisherTable::forgetHeard() {
  for (Publisher& publisher : publishers_) publisher.heard = false;
}

std::string ofPublisher(const std::string& name) { return name.empty() ? std::string() : " of " + name; }

}  // namespace demo_logger
