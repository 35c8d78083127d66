// A bad cable between two network namespaces, in user space because not every kernel has netem:
// forwards LCM's datagrams between the two, with delay and losses. Which messages are lost depends
// on the seed, their channel and their number, not on who sends first.
//
//   airdos-lossy-link PATH_OF_OTHER_NETWORK LOSS_PERCENT DELAY_MS SEED
//
// Prints READY, and a line `lost CHANNEL SEQ` for each lost message (`lost a_part` for a fragment
// of a large one); stops on SIGTERM.
#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <random>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<unsigned char>;

constexpr char kGroup[] = "239.255.76.67";
constexpr int kPort = 7667;
constexpr int kBuffer_bytes = 4 << 20;

volatile std::sig_atomic_t is_stopped = 0;

[[noreturn]] void Fail(const char* what) {
  std::perror(what);
  std::exit(1);
}

sockaddr_in Group() {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(kPort);
  inet_pton(AF_INET, kGroup, &address.sin_addr);
  return address;
}

/// The end of the link in one network.
struct End {
  int receiver = -1;
  int sender = -1;
  in_port_t own_port = 0;  // of the sender: whatever comes from it is our own echo
  std::deque<std::pair<Clock::time_point, Bytes>> waiting;  // to be sent in this network
};

End OpenEnd() {
  End end;
  end.receiver = socket(AF_INET, SOCK_DGRAM, 0);
  end.sender = socket(AF_INET, SOCK_DGRAM, 0);
  const int yes = 1;
  setsockopt(end.receiver, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  setsockopt(end.receiver, SOL_SOCKET, SO_REUSEPORT, &yes, sizeof(yes));
  setsockopt(end.receiver, SOL_SOCKET, SO_RCVBUF, &kBuffer_bytes, sizeof(kBuffer_bytes));
  setsockopt(end.sender, SOL_SOCKET, SO_SNDBUF, &kBuffer_bytes, sizeof(kBuffer_bytes));
  const sockaddr_in group = Group();
  ip_mreq membership = {};
  membership.imr_multiaddr = group.sin_addr;
  if (bind(end.receiver, reinterpret_cast<const sockaddr*>(&group), sizeof(group)) != 0 ||
      setsockopt(end.receiver, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) != 0)
    Fail("receiver");
  const unsigned char ttl = 0;
  setsockopt(end.sender, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl));
  sockaddr_in own = {};
  socklen_t size = sizeof(own);
  if (connect(end.sender, reinterpret_cast<const sockaddr*>(&group), sizeof(group)) != 0 ||
      getsockname(end.sender, reinterpret_cast<sockaddr*>(&own), &size) != 0)
    Fail("sender");
  end.own_port = own.sin_port;
  return end;
}

/// `CHANNEL SEQ` of an unfragmented message: "LC02", number, channel, 0, fingerprint, utime, seq.
std::string NameOf(const Bytes& datagram) {
  const bool is_whole = datagram.size() > 40 && std::memcmp(datagram.data(), "LC02", 4) == 0;
  const auto end =
      std::find(datagram.begin() + std::min<std::ptrdiff_t>(8, datagram.end() - datagram.begin()),
                datagram.end(), 0);
  if (!is_whole || datagram.end() - end < 25) return "a_part";
  unsigned long long seq = 0;
  for (int i = 0; i < 8; ++i) seq = seq << 8 | *(end + 17 + i);
  return std::string(datagram.begin() + 8, end) + " " + std::to_string(seq);
}

class Link {
 public:
  Link(double loss, std::chrono::milliseconds delay, unsigned seed)
      : loss_(loss), delay_(delay), seed_(seed), parts_(seed) {}

  void Receive(const End& from, End* to) {
    Bytes datagram(1 << 16);
    sockaddr_in source = {};
    socklen_t size = sizeof(source);
    const ssize_t length = recvfrom(from.receiver, datagram.data(), datagram.size(), MSG_DONTWAIT,
                                    reinterpret_cast<sockaddr*>(&source), &size);
    if (length <= 0 || source.sin_port == from.own_port) return;
    datagram.resize(static_cast<std::size_t>(length));
    const std::string name = NameOf(datagram);
    if (IsLost(name)) {
      std::printf("lost %s\n", name.c_str());
      return;
    }
    to->waiting.emplace_back(Clock::now() + delay_, std::move(datagram));
  }
  static void SendDue(End* end) {
    while (!end->waiting.empty() && end->waiting.front().first <= Clock::now()) {
      const Bytes& datagram = end->waiting.front().second;
      if (send(end->sender, datagram.data(), datagram.size(), 0) < 0) std::perror("send");
      end->waiting.pop_front();
    }
  }

 private:
  bool IsLost(const std::string& name) {
    std::seed_seq seeds(name.begin(), name.end());
    std::mt19937_64 of_message(seeds);
    of_message.seed(of_message() + seed_);
    const std::uint64_t draw = name == "a_part" ? parts_() : of_message();
    return static_cast<double>(draw) < loss_ * static_cast<double>(std::mt19937_64::max());
  }

  double loss_;
  std::chrono::milliseconds delay_;
  unsigned seed_;
  std::mt19937_64 parts_;  // for fragments of large messages, in order
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::signal(SIGTERM, [](int) { is_stopped = 1; });
  End here = OpenEnd();
  const int other_network = open(argv[1], O_RDONLY | O_CLOEXEC);
  if (other_network < 0 || setns(other_network, CLONE_NEWNET) != 0) Fail(argv[1]);
  End there = OpenEnd();
  Link link(std::atof(argv[2]) / 100, std::chrono::milliseconds(std::atoi(argv[3])),
            static_cast<unsigned>(std::atoi(argv[4])));
  std::printf("READY\n");
  while (is_stopped == 0) {
    const bool is_waiting = !here.waiting.empty() || !there.waiting.empty();
    pollfd inputs[] = {{here.receiver, POLLIN, 0}, {there.receiver, POLLIN, 0}};
    if (poll(inputs, 2, is_waiting ? 1 : 100) < 0 && errno != EINTR) Fail("poll");
    if ((inputs[0].revents & POLLIN) != 0) link.Receive(here, &there);
    if ((inputs[1].revents & POLLIN) != 0) link.Receive(there, &here);
    Link::SendDue(&here);
    Link::SendDue(&there);
  }
  return 0;
}
