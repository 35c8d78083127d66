#ifndef AIRDOS_TESTS_SUPPORT_PRIVATE_NETWORK_H_
#define AIRDOS_TESTS_SUPPORT_PRIVATE_NETWORK_H_

#include <string>

namespace airdos {

/// Moves this process (which must have one thread) and its children into a network of their own
/// that has nothing but a loopback interface, with multicast if wanted, so that tests neither
/// disturb nor hear anybody. Returns why that is impossible here, or an empty text.
std::string EnterPrivateNetwork(bool with_multicast);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_PRIVATE_NETWORK_H_
