#include "processes/map_recorder/session_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

void Ignore(const std::string&) {}

class SessionFilesTest : public ::testing::Test {
 protected:
  SessionFilesTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = testing::TempDir() + "airdos_session_files_" + std::to_string(getpid()) + "_" +
              info->name();
    fs::remove_all(folder_);
  }
  ~SessionFilesTest() override { fs::remove_all(folder_); }

  /// A frame with a live pose.
  static MapChunk Frame(std::int64_t seq) {
    MapDelta changes;
    MapFrame frame;
    frame.utime = 100 * seq;
    frame.live = Se3();
    changes.SetFrame({seq}, frame);
    return changes.ToChunk();
  }
  FourDMap Read(const std::string& name) const {
    MapFileSummary summary;
    return ReadFourDMap(folder_ + "/" + name, &summary);
  }
  bool Exists(const std::string& name) const { return fs::exists(folder_ + "/" + name); }

  std::string folder_;
};

TEST_F(SessionFilesTest, EachSessionHasItsMap) {
  SessionFiles files(folder_, {}, Ignore);
  EXPECT_FALSE(files.is_open());
  EXPECT_EQ(files.session_directory(), "");
  EXPECT_FALSE(files.Open({500, 5, 31}));
  EXPECT_TRUE(files.is_open());
  EXPECT_EQ(files.session_directory(), folder_);
  files.Append(Frame(5));
  files.Append(Frame(6));
  files.Close(EndChunk(std::nullopt, 3), {31, 2}, false);
  EXPECT_FALSE(files.is_open());
  EXPECT_FALSE(files.Open({700, 7, 32}));
  EXPECT_EQ(files.session_directory(), folder_ + "/session_2");
  files.Append(Frame(7));
  files.Close(EndChunk(std::nullopt, 3), {32, 1}, false);
  EXPECT_EQ(files.TakeFailure(), "");
  const FourDMap first = Read("map.airdos"), second = Read("session_2/map.airdos");
  EXPECT_TRUE(first.is_closed);
  EXPECT_EQ(first.session, 31);
  EXPECT_EQ(first.ground_truth_axes, 3);
  EXPECT_EQ(CountLive(first), 2u);
  EXPECT_EQ(second.session, 32);
  EXPECT_EQ(CountLive(second), 1u);
}

TEST_F(SessionFilesTest, AMapThatWasNotClosedIsGoneOnWithAndSoAreItsNotes) {
  MapDelta truth;
  MapFrame frame;
  frame.ground_truth = Se3();
  truth.SetFrame({5}, frame);
  {
    SessionFiles killed(folder_, {}, Ignore);
    killed.Open({500, 5, 31});
    killed.Append(Frame(5));
    killed.Note(31, truth, StereoCamera{640, 480, 500, 500, 320, 240, 0.25}, 2);
  }
  EXPECT_TRUE(Exists(kNotesName));
  SessionFiles files(folder_, {}, Ignore);
  const std::optional<UnfinishedMap> found = files.Open({600, 6, 31});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->num_live, 1u);
  EXPECT_EQ(found->notes.frames.count({5}), 1u);
  EXPECT_EQ(found->notes.ground_truth_axes, 2);
  ASSERT_TRUE(found->notes.camera);
  EXPECT_EQ(found->notes.camera->width, 640);
  files.Append(Frame(6));
  files.Close(EndChunk(std::nullopt, 2), {31, 2}, false);
  EXPECT_FALSE(Exists(kNotesName)) << "what is in the map need not lie beside it";
  EXPECT_EQ(CountLive(Read("map.airdos")), 2u);
}

TEST_F(SessionFilesTest, AMapOfAnotherSessionThatWasNotClosedIsKept) {
  {
    SessionFiles killed(folder_, {}, Ignore);
    killed.Open({500, 5, 31});
    killed.Append(Frame(5));
  }
  SessionFiles files(folder_, {}, Ignore);
  EXPECT_FALSE(files.Open({600, 6, 32}));
  EXPECT_EQ(Read("map.airdos.unfinished_1").session, 31);
}

TEST_F(SessionFilesTest, WhatIsNotAsItWasRecordedIsSaid) {
  SessionFiles files(folder_, {}, Ignore);
  files.Open({500, 5, 31});
  files.Append(Frame(5));
  EXPECT_THROW(files.Close(EndChunk(std::nullopt, 3), {31, 2}, false), InputError) << "one pose";
  files.Open({600, 6, 32});
  EXPECT_THROW(files.Close(EndChunk(std::nullopt, 3), {33, 0}, false), InputError) << "session 32";
}

TEST_F(SessionFilesTest, ExportsOnlyWhereItIsTold) {
  SessionFiles files(folder_, {}, Ignore);
  for (const bool has_exports : {false, true}) {
    files.Open({500, 5, 31});
    files.Append(Frame(5));
    files.Append(Frame(6));
    files.Close(EndChunk(std::nullopt, 3), {31, 2}, has_exports);
    std::size_t num_files = 0;
    for (const auto& entry : fs::directory_iterator(files.session_directory()))
      num_files += entry.is_regular_file() && entry.path().extension() == ".tum" ? 1 : 0;
    EXPECT_EQ(num_files > 0, has_exports);
  }
}

TEST_F(SessionFilesTest, AFolderMustBeNamed) {
  EXPECT_THROW(SessionFiles("", {}, Ignore), InputError);
}

TEST_F(SessionFilesTest, OneRunAtATimeWritesThere) {
  const SessionFiles files(folder_, {}, Ignore);
  EXPECT_THROW(SessionFiles(folder_, {}, Ignore), InputError);
}

}  // namespace
}  // namespace airdos
