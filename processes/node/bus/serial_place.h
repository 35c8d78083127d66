#ifndef AIRDOS_PROCESSES_NODE_BUS_SERIAL_PLACE_H_
#define AIRDOS_PROCESSES_NODE_BUS_SERIAL_PLACE_H_

#include <cstdint>
#include <tuple>
#include <vector>

namespace airdos {

/// Where a message stands in the order in which FifoBus carries messages: behind everything that
/// earlier inputs caused; among what one input caused, nearer causes first (breadth first), then in
/// the order of the causes, then of the nodes, then of what one node published. Known to whoever
/// knows the message's cause, without running the others.
struct SerialPlace {
  struct Step {
    std::size_t member = 0;   ///< the node that published
    std::int64_t number = 0;  ///< of what it published because of the same message
    friend bool operator<(const Step& a, const Step& b) {
      return std::tie(a.member, a.number) < std::tie(b.member, b.number);
    }
    friend bool operator==(const Step& a, const Step& b) {
      return a.member == b.member && a.number == b.number;
    }
  };

  std::int64_t input = 0;  ///< number of the input that it all began with
  std::vector<Step> path;  ///< from the input to the message

  /// Of what `step` publishes because of the message in this place.
  SerialPlace Then(const Step& step) const {
    SerialPlace place = *this;
    place.path.push_back(step);
    return place;
  }

  friend bool operator<(const SerialPlace& a, const SerialPlace& b) {
    if (a.input != b.input) return a.input < b.input;
    if (a.path.size() != b.path.size()) return a.path.size() < b.path.size();
    return a.path < b.path;
  }
  friend bool operator==(const SerialPlace& a, const SerialPlace& b) {
    return a.input == b.input && a.path == b.path;
  }
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_BUS_SERIAL_PLACE_H_
