#ifndef AIRDOS_TESTS_NODE_FAKE_NODES_H_
#define AIRDOS_TESTS_NODE_FAKE_NODES_H_

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "airdos/frame_done_t.hpp"
#include "processes/node/frame_node.h"

namespace airdos {

/// Any message will do where nodes only pass text on: the header and `process` as payload.
inline frame_done_t TextMessage(std::int64_t seq, const std::string& text,
                                std::int64_t session = 7) {
  frame_done_t message;
  // Unsigned product, because hostile image numbers overflow.
  message.utime = static_cast<std::int64_t>(1000U * static_cast<std::uint64_t>(seq));
  message.seq = seq;
  message.session = session;
  message.process = text;
  return message;
}

inline Envelope TextEnvelope(const std::string& channel, std::int64_t seq, const std::string& text,
                             std::int64_t session = 7) {
  return {channel, Encode(TextMessage(seq, text, session))};
}

struct TextInputs {
  std::optional<frame_done_t> first;
  std::optional<frame_done_t> second;
};

/// Publishes for each frame the texts of its inputs and of its feedback, so that any difference in
/// what the node saw changes all that follows.
class TextNode : public FrameNode<TextInputs> {
 public:
  /// One or two inputs; `feedback` (may be empty) must have come for frame seq - lag before frame
  /// seq is worked on.
  TextNode(const std::string& name, const std::vector<std::string>& inputs, std::string output,
           std::string feedback = "", int lag = 2)
      : FrameNode(name), output_(std::move(output)), feedback_(std::move(feedback)), lag_(lag) {
    Join(inputs.at(0), &TextInputs::first);
    if (inputs.size() > 1) Join(inputs.at(1), &TextInputs::second);
    if (feedback_.empty()) return;
    Subscribe<frame_done_t>(feedback_, [this](frame_done_t&& message) {
      feedback_texts_[{message.session, message.seq}] = message.process;
      return std::string();
    });
  }

 protected:
  std::vector<std::string> MissingFeedback(const Header& header) const override {
    const std::int64_t seq = header.seq - lag_;
    if (feedback_.empty() || header.session != first_.session || seq < first_.seq) return {};
    if (feedback_texts_.count({header.session, seq}) > 0) return {};
    return {feedback_};
  }
  void StartSession(const Header& header) override { first_ = header; }
  void ProcessFrame(const Header& header, TextInputs inputs) override {
    std::string text = name() + "(";
    text += (inputs.first ? inputs.first->process : "-") + ",";
    text += (inputs.second ? inputs.second->process : "-") + ",";
    if (!feedback_.empty()) {
      const auto it = feedback_texts_.find({header.session, header.seq - lag_});
      text += "back " + (it == feedback_texts_.end() ? "-" : std::to_string(it->second.size()));
    }
    frame_done_t message = TextMessage(header.seq, text + ")", header.session);
    message.utime = header.utime;
    Publish(output_, message);
  }

 private:
  std::string output_;
  std::string feedback_;
  int lag_;
  Header first_;                                                                 // of the session
  std::map<std::pair<std::int64_t, std::int64_t>, std::string> feedback_texts_;  // by session, seq
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_NODE_FAKE_NODES_H_
