#ifndef AIRDOS_COMMON_UTIL_IDS_H_
#define AIRDOS_COMMON_UTIL_IDS_H_

#include <cstdint>

namespace airdos {

/// An integer id that cannot be confused with other kinds of ids. Ordered, so it can be a key in a
/// std::map.
template <class Tag>
struct Id {
  std::int64_t value = 0;

  friend bool operator==(Id a, Id b) { return a.value == b.value; }
  friend bool operator!=(Id a, Id b) { return a.value != b.value; }
  friend bool operator<(Id a, Id b) { return a.value < b.value; }
};

using FrameId = Id<struct FrameTag>;        ///< image number `seq`
using LandmarkId = Id<struct LandmarkTag>;  ///< static landmark, never reused in a session
using HumanId = Id<struct HumanTag>;        ///< track of one person, never reused in a session

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_IDS_H_
