#ifndef AIRDOS_PROCESSES_NODE_HEADER_H_
#define AIRDOS_PROCESSES_NODE_HEADER_H_

#include <cstdint>

namespace airdos {

/// What every message starts with.
struct Header {
  std::int64_t utime = 0;    ///< us, capture time of the image
  std::int64_t seq = 0;      ///< image number
  std::int64_t session = 0;  ///< chosen by the source of the images
};

template <class Message>
Header HeaderOf(const Message& message) {
  return {message.utime, message.seq, message.session};
}

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_HEADER_H_
