#ifndef AIRDOS_TESTS_NODE_SMALL_LOG_TEST_H_
#define AIRDOS_TESTS_NODE_SMALL_LOG_TEST_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "common/check/check_findings.h"
#include "processes/node/log/event_log.h"
#include "processes/node/node.h"
#include "processes/stereo_player/dataset_source.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_sequence.h"

namespace airdos {

/// A test about a log of the small sequence: what the player publishes of it, to be changed before
/// it is written.
class SmallLogTest : public testing::Test {
 protected:
  SmallLogTest(const std::string& name, std::int64_t session)
      : scratch_(name),
        folder_(scratch_.path()),
        path_(scratch_.PathOf("input.lcm")),
        session_(session),
        messages_(SoundMessages()) {}

  const std::vector<Envelope>& SoundMessages() const {
    static const std::vector<Envelope> messages = [this] {
      const std::filesystem::path data = folder_ / "data";
      SmallSequence::Make().Write(data);
      DatasetSource source(data.string(), 0, 1000, session_, {});
      std::vector<Envelope> all;
      for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
        all.insert(all.end(), frame.begin(), frame.end());
      }
      return all;
    }();
    return messages;
  }
  void Remove(const std::string& channel) {
    messages_.erase(std::remove_if(messages_.begin(), messages_.end(),
                                   [&](const Envelope& m) { return m.channel == channel; }),
                    messages_.end());
  }
  /// Writes the messages as a log, 1 ms apart.
  void Write() const {
    EventLogWriter writer(path_);
    for (const Envelope& message : messages_) {
      writer.Append(1000 * writer.num_events(), message.channel, message.payload.data(),
                    message.payload.size());
    }
  }

  const ScratchFolder scratch_;
  const std::filesystem::path folder_;
  const std::string path_;
  const std::int64_t session_;
  std::vector<Envelope> messages_;
  FindingList findings_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_NODE_SMALL_LOG_TEST_H_
