#include "processes/node/live/lcm_transport.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace airdos {
namespace {

// LCM has no authentication: what nobody asked to leave the machine must not.
TEST(LcmTransportTest, TheDefaultUrlStaysOnTheMachine) {
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(DefaultLcmUrl(), "udpm://239.255.76.67:7667?ttl=0");
  std::ifstream file(std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/common.sh");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(text.find("AIRDOS_DEFAULT_URL='" + DefaultLcmUrl() + "'"), std::string::npos);
}

}  // namespace
}  // namespace airdos
