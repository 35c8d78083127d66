#ifndef AIRDOS_PROCESSES_NODE_BUS_SERIAL_PLACE_H_
#define AIRDOS_PROCESSES_NODE_BUS_SERIAL_PLACE_H_

#include <cstdint>
#include <tuple>
#include <vector>

namespace airdos {

/// A message's place in the order in which FifoBus carries messages: after everything that earlier
/// inputs caused; among the consequences of one input, by causal distance (breadth first), then in
/// the order of the causes, then of the nodes, then in the order in which one node published. It
/// can be computed from the place of the message's cause, without running the other nodes.
struct SerialPlace {
  /// One causal step: a message that makes a node publish another.
  struct Step {
    std::size_t member = 0;   ///< the node that published
    std::int64_t number = 0;  ///< index among what it published because of this message
    friend bool operator<(const Step& a, const Step& b) {
      return std::tie(a.member, a.number) < std::tie(b.member, b.number);
    }
    friend bool operator==(const Step& a, const Step& b) {
      return a.member == b.member && a.number == b.number;
    }
  };

  std::int64_t input = 0;  ///< number of the input that started it all
  std::vector<Step> path;  ///< causal steps from the input to the message

  /// The place of what `step` publishes because of the message at this place.
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
