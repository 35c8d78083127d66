#ifndef AIRDOS_TESTS_SUPPORT_PRIVATE_NETWORK_H_
#define AIRDOS_TESTS_SUPPORT_PRIVATE_NETWORK_H_

#include <string>

namespace airdos {

/// Moves this process (which must have a single thread) and its children into their own network
/// with only a loopback interface, optionally with multicast, so that tests neither disturb others
/// nor are disturbed. Returns why that is impossible, or an empty text.
std::string EnterPrivateNetwork(bool with_multicast);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_PRIVATE_NETWORK_H_
