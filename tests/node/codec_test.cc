#include "processes/node/message/codec.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/allocation_watch.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

template <class Message>
class CodecTest : public testing::Test {};
using MessageTypes =
    testing::Types<image_t, stereo_calibration_t, person_keypoints_t, person_mask_t,
                   static_features_t, human_observations_t, state_estimate_t, map_update_t, pose_t,
                   frame_done_t, process_status_t>;
TYPED_TEST_SUITE(CodecTest, MessageTypes);

TYPED_TEST(CodecTest, ReadsWhatItWrote) {
  const std::vector<std::uint8_t> bytes = Encode(Sample<TypeParam>());
  TypeParam message = {};
  ASSERT_TRUE(Decode(bytes.data(), bytes.size(), &message));
  EXPECT_EQ(Encode(message), bytes);
  EXPECT_EQ(Validate(message), "");
}

TYPED_TEST(CodecTest, RefusesEveryTruncationAndTrailingBytes) {
  std::vector<std::uint8_t> bytes = Encode(Sample<TypeParam>());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    TypeParam message = {};
    // A copy of the right size, so that a sanitizer sees any read beyond it.
    const std::vector<std::uint8_t> cut(bytes.begin(),
                                        bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(Decode(cut.data(), cut.size(), &message)) << size;
  }
  bytes.push_back(0);
  TypeParam message = {};
  EXPECT_FALSE(Decode(bytes.data(), bytes.size(), &message));
}

/// Sets four bytes at each place to hostile counts, so every count in the message gets each once.
TYPED_TEST(CodecTest, HostileCountsCostNothing) {
  const std::vector<std::uint8_t> bytes = Encode(Sample<TypeParam>());
  ResetLargestAllocation();
  for (std::size_t place = 8; place + 4 <= bytes.size(); ++place) {
    for (const std::uint32_t count : {0x7fffffffu, 0x80000000u, 0xffffffffu, 0x40000000u, 0u}) {
      std::vector<std::uint8_t> hostile = bytes;
      for (std::size_t i = 0; i < 4; ++i) {
        hostile[place + i] = static_cast<std::uint8_t>(count >> (24 - 8 * i));
      }
      TypeParam message = {};
      EXPECT_NO_THROW(if (Decode(hostile.data(), hostile.size(), &message)) Validate(message));
    }
  }
  EXPECT_LT(LargestAllocation(), 1u << 20);
}

TYPED_TEST(CodecTest, MutatedMessagesNeitherCrashNorThrowNorGrow) {
  constexpr int kNumMutations = 20000;
  const std::vector<std::uint8_t> bytes = Encode(Sample<TypeParam>());
  std::mt19937 random(1);
  ResetLargestAllocation();
  int num_decoded = 0;
  for (int mutation = 0; mutation < kNumMutations; ++mutation) {
    std::vector<std::uint8_t> mutated = bytes;
    const unsigned num_changes = 1 + static_cast<unsigned>(random() % 4);
    for (unsigned change = 0; change < num_changes; ++change) {
      // Behind the fingerprint, which refuses everything else.
      mutated[8 + random() % (mutated.size() - 8)] = static_cast<std::uint8_t>(random());
    }
    if (random() % 8 == 0) mutated.resize(8 + random() % (mutated.size() - 8));
    TypeParam message = {};
    ASSERT_NO_THROW({
      if (Decode(mutated.data(), mutated.size(), &message)) {
        ++num_decoded;
        Validate(message);
      }
    });
  }
  EXPECT_GT(num_decoded, kNumMutations / 100) << "the mutations reach what is behind decode()";
  EXPECT_LT(LargestAllocation(), 1u << 20);
}

// As lcm-gen makes it, encode() would send what lies behind the list.
template <class Message>
std::string Refusal(const Message& message) {
  try {
    Encode(message);
  } catch (const std::length_error& error) {
    return error.what();
  }
  return "";
}

TEST(EncodeTest, RefusesAListThatIsNotAsLongAsItsCount) {
  auto image = Sample<image_t>();
  image.num_bytes = static_cast<std::int32_t>(image.data.size()) + 1;
  EXPECT_EQ(Refusal(image), "image_t: data does not have num_bytes elements");
  image.num_bytes = -1;
  EXPECT_EQ(Refusal(image), "image_t: data does not have num_bytes elements");

  auto keypoints = Sample<person_keypoints_t>();
  keypoints.v_px[1].pop_back();
  EXPECT_EQ(Refusal(keypoints),
            "person_keypoints_t: a row of v_px does not have num_joints elements");

  auto people = Sample<human_observations_t>();
  people.num_humans = -1;
  EXPECT_EQ(Refusal(people), "human_observations_t: humans does not have num_humans elements");
  people.num_humans = static_cast<std::int32_t>(people.humans.size());
  people.humans[1].covariance_C[0].pop_back();
  EXPECT_EQ(Refusal(people), "human_observation_t: a row of covariance_C does not have 6 elements");

  auto status = Sample<process_status_t>();
  status.warnings.pop_back();
  EXPECT_EQ(Refusal(status), "process_status_t: warnings does not have num_warnings elements");
}

}  // namespace
}  // namespace airdos
