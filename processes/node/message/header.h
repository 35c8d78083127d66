#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_HEADER_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_HEADER_H_

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

template <class Message>
void SetHeader(const Header& header, Message* message) {
  message->utime = header.utime;
  message->seq = header.seq;
  message->session = header.session;
}

/// A message with this header; everything else is zero.
template <class Message>
Message MessageOf(const Header& header) {
  Message message{};
  SetHeader(header, &message);
  return message;
}

/// First of the running numbers (of landmarks or people) that a process assigns if it receives a
/// session from image `first_seq` on and assigns fewer than `most_per_frame` of them per frame; 1
/// at the start of a session. A process that was killed and restarted thus never reuses a number of
/// its predecessor, which other processes still remember.
inline std::int64_t FirstRunningNumber(std::int64_t first_seq, std::int64_t most_per_frame) {
  return 1 + first_seq * most_per_frame;
}

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_HEADER_H_
