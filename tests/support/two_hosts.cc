#include "tests/support/two_hosts.h"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "common/util/check.h"
#include "tests/support/private_network.h"

namespace airdos {
namespace {

constexpr double kDeadline_s = 60;
const std::string kAddressOfA = "10.77.0.1/24";
const std::string kAddressOfB = "10.77.0.2/24";

std::string SetUpEnd(const std::string& interface, const std::string& address) {
  return "ip link set lo up && ip addr add " + address + " dev " + interface + " && ip link set " +
         interface + " up && ip route add 224.0.0.0/4 dev " + interface;
}

}  // namespace

TwoHosts::TwoHosts(Link link, const std::string& folder) : folder_(folder) {
  obstacle_ = EnterPrivateNetwork(link == Link::kNothing);
  if (!obstacle_.empty()) return;
  holder_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{"unshare", "-n", "sleep", "infinity"}, folder_ + "host_b");
  std::error_code error;
  const auto own = std::filesystem::read_symlink("/proc/self/ns/net", error);
  const auto is_apart = [&] {
    const auto other = std::filesystem::read_symlink(network_of_b(), error);
    return (!other.empty() && other != own) || holder_->HasEnded();
  };
  if (!WaitUntil(is_apart, kDeadline_s) || holder_->HasEnded()) {
    obstacle_ = "no second network namespace: " + holder_->Errors();
    return;
  }
  if (link == Link::kNothing) {
    obstacle_ =
        Shell("ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo",
              true);
    return;
  }
  const std::string pid = std::to_string(holder_->pid());
  obstacle_ = Shell("ip link add veth_a type veth peer name veth_b netns " + pid, false);
  if (obstacle_.empty()) obstacle_ = Shell(SetUpEnd("veth_a", kAddressOfA), false);
  if (obstacle_.empty()) obstacle_ = Shell(SetUpEnd("veth_b", kAddressOfB), true);
}

std::string TwoHosts::network_of_b() const {
  return "/proc/" + std::to_string(holder_->pid()) + "/ns/net";
}

std::vector<std::string> TwoHosts::launcher_on_b() const {
  return {"nsenter", "--net=" + network_of_b(), "--"};
}

void TwoHosts::OnB(const std::function<void()>& work) const {
  const int a = open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
  const int b = open(network_of_b().c_str(), O_RDONLY | O_CLOEXEC);
  AIRDOS_CHECK(a >= 0 && b >= 0 && setns(b, CLONE_NEWNET) == 0);
  work();
  AIRDOS_CHECK(setns(a, CLONE_NEWNET) == 0);
  close(a);
  close(b);
}

std::string TwoHosts::Shell(const std::string& line, bool is_on_b) const {
  std::vector<std::string> command;
  if (is_on_b) command = launcher_on_b();
  command.insert(command.end(), {"sh", "-c", line});
  ChildProcess shell(command, folder_ + "shell");
  if (shell.Wait(kDeadline_s) == 0) return "";
  return "'" + line + "' failed: " + shell.Errors();
}

}  // namespace airdos
