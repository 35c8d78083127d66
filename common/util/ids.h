#ifndef AIRDOS_COMMON_UTIL_IDS_H_
#define AIRDOS_COMMON_UTIL_IDS_H_

#include <cstdint>

namespace airdos {

/// An integer that cannot be mistaken for another kind of id. Ordered, so that it can be the key of
/// a std::map.
template <class Tag>
struct Id {
  std::int64_t value = 0;

  friend bool operator==(Id a, Id b) { return a.value == b.value; }
  friend bool operator!=(Id a, Id b) { return a.value != b.value; }
  friend bool operator<(Id a, Id b) { return a.value < b.value; }
};

using FrameId = Id<struct FrameTag>;        ///< image number `seq`
using LandmarkId = Id<struct LandmarkTag>;  ///< static landmark, never used again in a session
using HumanId = Id<struct HumanTag>;        ///< track of one person, never used again in a session

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_IDS_H_
