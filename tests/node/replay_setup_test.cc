#include "processes/tools/replay/replay_setup.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "common/config/config_reader.h"
#include "common/util/error.h"
#include "processes/frontend/frontend_node.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

class ReplaySetupTest : public testing::Test {
 protected:
  ReplaySetupTest() {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    setup_.config_dir = std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/config";
    setup_.run_dir = (fs::temp_directory_path() /
                      ("airdos_replay_setup_" + std::to_string(getpid()) + "_" + info->name()))
                         .string();
  }
  ~ReplaySetupTest() override { fs::remove_all(setup_.run_dir); }

  /// The configuration that the frontend was given.
  FrontendOptions Frontend() {
    MakeReplayNodes(setup_);
    ConfigReader config = ConfigReader::FromFile(setup_.run_dir + "/frontend.yaml");
    return ReadFrontendOptions(&config);
  }
  ReplaySetup setup_;
};

TEST_F(ReplaySetupTest, PeopleOnAreUsedInThePoseOfAFrame) {
  setup_.people = "on";
  const FrontendOptions options = Frontend();
  EXPECT_TRUE(options.use_people);
  EXPECT_TRUE(options.use_masks);
}

TEST_F(ReplaySetupTest, MaskOnlyUsesMasksAndNoPeople) {
  setup_.people = "mask_only";
  const FrontendOptions options = Frontend();
  EXPECT_FALSE(options.use_people);
  EXPECT_TRUE(options.use_masks);
}

TEST_F(ReplaySetupTest, PeopleOffIsNeither) {
  setup_.people = "off";
  const FrontendOptions options = Frontend();
  EXPECT_FALSE(options.use_people);
  EXPECT_FALSE(options.use_masks);
}

TEST_F(ReplaySetupTest, MasksAreSetApartFromPeople) {
  setup_.people = "on";
  setup_.masks = "off";
  const FrontendOptions options = Frontend();
  EXPECT_TRUE(options.use_people);
  EXPECT_FALSE(options.use_masks);
}

TEST_F(ReplaySetupTest, TheLastWordIsThatOfTheOverrides) {
  setup_.people = "on";
  setup_.overrides = {"frontend:people.use=false"};
  EXPECT_FALSE(Frontend().use_people);
  setup_.overrides = {"frontend:people.nothing=1"};
  EXPECT_THROW(MakeReplayNodes(setup_), InputError);
  setup_.overrides = {"nobody:people.use=false"};
  EXPECT_THROW(MakeReplayNodes(setup_), InputError);
}

TEST_F(ReplaySetupTest, AKeyOfAnEarlierVersionIsAnsweredWithTheNewOne) {
  for (const char* text : {"people.huber=2", "optimizer:people.huber=2"}) {
    setup_.overrides = {text};
    try {
      MakeReplayNodes(setup_);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), setup_.config_dir +
                                  "/optimizer.yaml: key 'people.huber' is called "
                                  "'people.huber_sigmas' now");
    }
  }
}

TEST_F(ReplaySetupTest, WithoutAWordTheFilesDecide) {
  const FrontendOptions options = Frontend();
  ConfigReader config = ConfigReader::FromFile(setup_.config_dir + "/frontend.yaml");
  const FrontendOptions configured = ReadFrontendOptions(&config);
  EXPECT_EQ(options.use_people, configured.use_people);
  EXPECT_EQ(options.use_masks, configured.use_masks);
}

}  // namespace
}  // namespace airdos
