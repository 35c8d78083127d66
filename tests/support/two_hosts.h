#ifndef AIRDOS_TESTS_SUPPORT_TWO_HOSTS_H_
#define AIRDOS_TESTS_SUPPORT_TWO_HOSTS_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/child_process.h"

namespace airdos {

/// Two network namespaces, as two machines: A, into which the calling process (which must have one
/// thread) moves, and B. Each sends its multicast through the interface that leads to the other.
class TwoHosts {
 public:
  enum class Link {
    kCable,   ///< a pair of virtual Ethernet interfaces
    kNothing  ///< none: whoever wants to connect them does, see lossy_link_main.cc
  };
  /// `folder`: for what its functions say.
  TwoHosts(Link link, const std::string& folder);

  /// Why there are no two hosts here, or an empty text.
  const std::string& obstacle() const { return obstacle_; }
  /// Command that runs another one on B: put in front of it.
  std::vector<std::string> launcher_on_b() const;
  /// File that stands for B's network.
  std::string network_of_b() const;
  /// Does something in B's network, in this thread.
  void OnB(const std::function<void()>& work) const;
  /// Runs a line of shell on A or B; its errors, or an empty text.
  std::string Shell(const std::string& line, bool is_on_b) const;

 private:
  std::string folder_;
  std::string obstacle_;
  std::unique_ptr<ChildProcess> holder_;  // as long as it lives, so does B's network
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_TWO_HOSTS_H_
