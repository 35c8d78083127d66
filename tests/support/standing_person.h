#ifndef AIRDOS_TESTS_SUPPORT_STANDING_PERSON_H_
#define AIRDOS_TESTS_SUPPORT_STANDING_PERSON_H_

#include <array>

namespace airdos {

/// A person who faces the camera, 100 px tall, COCO-18 order: where each joint is beside the neck.
inline constexpr std::array<std::array<double, 2>, 18> kStanding = {{{0, -12},
                                                                     {0, 0},
                                                                     {-10, 1},
                                                                     {-14, 18},
                                                                     {-15, 34},
                                                                     {10, 1},
                                                                     {14, 18},
                                                                     {15, 34},
                                                                     {-6, 32},
                                                                     {-7, 58},
                                                                     {-7, 84},
                                                                     {6, 32},
                                                                     {7, 58},
                                                                     {7, 84},
                                                                     {-2, -14},
                                                                     {2, -14},
                                                                     {-4, -13},
                                                                     {4, -13}}};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_STANDING_PERSON_H_
