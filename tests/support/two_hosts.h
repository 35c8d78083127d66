#ifndef AIRDOS_TESTS_SUPPORT_TWO_HOSTS_H_
#define AIRDOS_TESTS_SUPPORT_TWO_HOSTS_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/child_process.h"

namespace airdos {

/// Two network namespaces that act as two machines: A, into which the calling process (which must
/// have a single thread) moves, and B. Each sends its multicast through the interface to the other.
class TwoHosts {
 public:
  /// What connects A and B.
  enum class Link {
    kCable,   ///< a pair of virtual Ethernet interfaces
    kNothing  ///< nothing: the test may connect them, see lossy_link_main.cc
  };
  /// `folder` is for the output of its functions.
  TwoHosts(Link link, const std::string& folder);

  /// Why two hosts are not possible here, or an empty text.
  const std::string& obstacle() const { return obstacle_; }
  /// Prefix that runs a command on B.
  std::vector<std::string> launcher_on_b() const;
  /// The file that represents B's network.
  std::string network_of_b() const;
  /// Runs `work` in B's network, in this thread.
  void OnB(const std::function<void()>& work) const;
  /// Runs a shell command line on A or B; returns its errors, or an empty text.
  std::string Shell(const std::string& line, bool is_on_b) const;

 private:
  std::string folder_;
  std::string obstacle_;
  std::unique_ptr<ChildProcess> holder_;  // keeps B's network alive
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_TWO_HOSTS_H_
