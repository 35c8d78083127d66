#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>

#include "common/config/config_reader.h"
#include "common/evaluation/help_curve.h"
#include "common/evaluation/people_files.h"
#include "common/evaluation/speed_report.h"
#include "common/evaluation/trajectory_file.h"
#include "common/map/four_d_map.h"
#include "common/map/map_export.h"
#include "common/map/map_file.h"
#include "common/util/input_file.h"
#include "common/util/output_files.h"
#include "common/util/output_folder.h"
#include "common/util/suggestion.h"
#include "common/util/text_file.h"
#include "tests/support/folder_test.h"
#include "tests/support/input_errors.h"

// What is written, what is not, and what is said of it.

namespace airdos {
namespace {

namespace fs = std::filesystem;

bool SelectAll(const std::string&, const std::string&) { return true; }

class UserCases : public FolderTest {
 protected:
  UserCases() : FolderTest("user_cases_outputs") {}

  /// Whether the file system remembers who wrote a file.
  bool KnowsMarks() const {
    const std::string probe = Write("probe", "");
    return setxattr(probe.c_str(), "user.airdos.probe", "1", 1, 0) == 0;
  }
};

TEST_F(UserCases, CaseC01AnInputIsNeverWrittenOver) {
  const std::string input = Write("in.lcm", "events");
  fs::create_hard_link(input, Path("hard.lcm"));
  fs::create_symlink(input, Path("soft.lcm"));
  fs::create_directory_symlink(folder_, Path("door"));
  const std::string same[] = {input, Path("hard.lcm"), Path("soft.lcm"), Path("door/in.lcm"),
                              Path("./in.lcm")};
  for (const std::string& path : same) {
    for (const std::string& named : {input, Path("soft.lcm")}) {
      for (const bool force : {false, true}) {
        const std::string message = ErrorOf([&] { CheckOutputFile(path, {{named}, force}); });
        EXPECT_TRUE(Holds(message, "is an input")) << path << ": " << message;
      }
    }
  }
  MarkWritten(input);  // even a file of our own
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(input, {{input}, false}); }), "is an input"));
  EXPECT_EQ(TextOf("in.lcm"), "events");
}

TEST_F(UserCases, CaseC01NothingIsWrittenIntoAnInputFolder) {
  Write("data/image_0/000000.png", "picture");
  const std::string outside = Write("elsewhere/000001.png", "picture");
  fs::create_symlink(outside, Path("data/image_0/000001.png"));
  fs::create_hard_link(Path("data/image_0/000000.png"), Path("hard.png"));
  fs::create_directory_symlink(Path("data"), Path("door"));
  const OutputRules rules{{Path("data")}, true};
  for (const char* name :
       {"data/new.json", "data/image_0/000000.png", "data/image_0/new.png", "door/new.json",
        "data/new/new/new.json", "hard.png", "elsewhere/000001.png"}) {
    EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(Path(name), rules); }), "input folder"))
        << name;
  }
  EXPECT_EQ(ErrorOf([&] { CheckOutputFile(Path("new.json"), rules); }), "");
  EXPECT_TRUE(Holds(ErrorOf([&] { OutputFolder(Path("data/run"), rules); }), "input folder"));
  EXPECT_TRUE(Holds(ErrorOf([&] { OutputFolder(Path("data"), rules); }), "is an input"));
  EXPECT_FALSE(fs::exists(Path("data/run")));
}

TEST_F(UserCases, CaseC01AFileOfSomebodyElseNeedsForce) {
  const std::string path = Write("thesis.json", "mine");
  EXPECT_EQ(ErrorOf([&] { CheckOutputFile(path, {}); }),
            path +
                ": exists and was not written by airdos, or changed since, or cut short; "
                "--force replaces it");
  EXPECT_EQ(ErrorOf([&] { CheckOutputFile(path, {{}, true}); }), "");
  EXPECT_EQ(ErrorOf([&] { CheckOutputFile("/dev/null", {}); }), "");
  EXPECT_EQ(ErrorOf([&] { CheckOutputFile("/dev/stdout", {}); }), "");
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(Path("none/x"), {}); }), "there is no folder"));
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(Path("thesis.json/x"), {}); }), "written"));
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(folder_.string(), {}); }), "is a folder"));
}

TEST_F(UserCases, CaseC01AFileThatTheSameProgramWroteIsReplacedUntilItIsChanged) {
  if (!KnowsMarks()) GTEST_SKIP() << "no extended attributes here";
  const std::string path = Path("a.json");
  for (int run = 0; run < 2; ++run) {
    const OutputFiles outputs({path, ""}, {});
    Write("a.json", "run " + std::to_string(run));
  }
  EXPECT_EQ(ErrorOf([&] { CheckOutputFile(path, {}); }), "");
  Write("a.json", "run 1, and my remarks");
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(path, {}); }), "--force"));
  const std::string other = "21 " + std::to_string(StampOf(path)->mtime_ns) + " airdos-other";
  setxattr(path.c_str(), "user.airdos.written", other.data(), other.size(), 0);
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(path, {}); }), "was written by airdos-other"));
}

TEST_F(UserCases, CaseC01AFileThatWasNotWrittenAfterAllIsNotMarked) {
  const std::string path = Write("thesis.json", "mine");
  { const OutputFiles outputs({path}, {{}, true}); }
  EXPECT_EQ(WriterOf(path), "");
}

TEST_F(UserCases, CaseC01TwoOutputsOfOneNameAreRefused) {
  fs::create_directory_symlink(folder_, Path("door"));
  EXPECT_TRUE(Holds(ErrorOf([&] { OutputFiles({Path("a"), Path("door/a")}, {}); }), "twice"));
  EXPECT_EQ(ErrorOf([&] { OutputFiles({"/dev/null", "/dev/null"}, {}); }), "");
}

void WriteMap(const std::string& path, int num_frames, bool has_truth) {
  MapDelta changes;
  for (std::int64_t seq = 0; seq < num_frames; ++seq) {
    MapFrame frame;
    frame.utime = 100000 * seq;
    frame.live = frame.refined = Se3();
    if (has_truth) frame.ground_truth = Se3();
    changes.SetFrame({seq}, frame);
    MapHuman human;
    human.joints[1] = MapJoint();
    changes.SetHuman({seq}, {seq}, human);
  }
  MapFileWriter writer(path);
  writer.Append(HeadChunk(1, "test"));
  writer.Append(changes.ToChunk());
  writer.Append(EndChunk(std::nullopt, 1));
}

class ExportCases : public UserCases {
 protected:
  int Export(const std::string& map_name, const std::string& out, bool force = false) {
    MapFileSummary summary;
    int num_replaced = 0;
    ExportMap(ReadFourDMap(Path(map_name), &summary), Path(map_name), Path(out), force,
              &num_replaced);
    return num_replaced;
  }
};

TEST_F(ExportCases, CaseC03AnExportLeavesTheFilesOfTheUserAlone) {
  WriteMap(Path("map.airdos"), 2, true);
  Write("out/people/thesis.txt", "mine");
  Write("out/people/holiday/photo.txt", "mine");
  Write("out/notes.txt", "mine");
  Export("map.airdos", "out");
  Export("map.airdos", "out");
  for (const char* name : {"people/thesis.txt", "people/holiday/photo.txt", "notes.txt"}) {
    EXPECT_EQ(TextOf(std::string("out/") + name), "mine") << name;
  }
  EXPECT_TRUE(fs::exists(Path("out/people/1.tum")));
}

TEST_F(ExportCases, CaseC03AFileOfTheUserInTheWayIsNotReplacedWithoutForce) {
  WriteMap(Path("map.airdos"), 2, true);
  for (const char* name : {"trajectory.tum", "ground_truth.tum", "people/77.tum"}) {
    Write(std::string("out/") + name, "mine");
    EXPECT_TRUE(Holds(ErrorOf([&] { Export("map.airdos", "out"); }), name));
    EXPECT_EQ(TextOf(std::string("out/") + name), "mine");
    EXPECT_EQ(std::distance(fs::recursive_directory_iterator(Path("out")), {}),
              std::string(name).find('/') == std::string::npos ? 1 : 2)
        << "something was written beside " << name;
    fs::remove_all(Path("out"));
  }
  Write("out/trajectory.tum", "mine");
  Export("map.airdos", "out", true);
  EXPECT_TRUE(Holds(TextOf("out/trajectory.tum"), "0.100000 "));
}

TEST_F(ExportCases, CaseC03AnExportThatWasChangedIsTheUsers) {
  WriteMap(Path("map.airdos"), 2, true);
  Export("map.airdos", "out");
  Write("out/people.jsonl", "edited");
  EXPECT_TRUE(Holds(ErrorOf([&] { Export("map.airdos", "out"); }), "changed since"));
  EXPECT_EQ(TextOf("out/people.jsonl"), "edited");
}

TEST_F(ExportCases, CaseC03AListThatSomebodyWroteLeadsNowhereElse) {
  WriteMap(Path("map.airdos"), 2, true);
  Write("thesis.txt", "mine");
  Write("out/.airdos_results",
        "- - export ../thesis.txt\n- - export " + Path("thesis.txt") + "\n- - export a/../../x\n");
  Export("map.airdos", "out");
  EXPECT_EQ(TextOf("thesis.txt"), "mine");
}

TEST_F(ExportCases, CaseC11NothingOfAnEarlierExportStandsBesideANewOne) {
  WriteMap(Path("long.airdos"), 4, true);
  WriteMap(Path("short.airdos"), 2, false);
  EXPECT_EQ(Export("long.airdos", "out"), 0);
  EXPECT_TRUE(fs::exists(Path("out/ground_truth.tum")));
  EXPECT_EQ(Export("short.airdos", "out"), 10);
  EXPECT_FALSE(fs::exists(Path("out/ground_truth.tum")));
  EXPECT_FALSE(fs::exists(Path("out/people/3.tum")));
  EXPECT_TRUE(fs::exists(Path("out/people/1.tum")));
}

TEST_F(UserCases, CaseC11WhatAKilledRunAnnouncedIsItsOwn) {
  {
    OutputFolder killed(Path("run"), {});
    killed.Claim("trajectory.tum", "run");
    Write("run/trajectory.tum", "half a li");
    fs::copy(Path("run"), Path("left"));
  }
  OutputFolder next(Path("left"), {});
  next.RequireReplaceable({"trajectory.tum"}, SelectAll);
  EXPECT_EQ(next.RemoveEarlier(SelectAll), 1);
}

TEST_F(UserCases, CaseC11AnEarlierResultThatIsReadIsNotRemoved) {
  {
    OutputFolder earlier(Path("run"), {});
    earlier.Claim("output.lcm", "run");
    Write("run/output.lcm", "events");
  }
  OutputFolder next(Path("run"), {{Path("run/output.lcm")}, true});
  EXPECT_TRUE(Holds(ErrorOf([&] { next.RequireReplaceable({}, SelectAll); }), "is an input"));
  EXPECT_TRUE(Holds(ErrorOf([&] { next.RemoveEarlier(SelectAll); }), "is an input"));
  EXPECT_EQ(TextOf("run/output.lcm"), "events");
}

TEST_F(UserCases, CaseC09TheSecondRunIntoAFolderIsRefused) {
  auto first = std::make_unique<OutputFolder>(Path("run"), OutputRules());
  first->Claim("a", "run");
  const std::string message = ErrorOf([&] { OutputFolder(Path("run"), {{}, true}); });
  EXPECT_TRUE(Holds(message, "another run is writing here (process " + std::to_string(getpid())))
      << message;
  Write("run/a", "whole");
  first.reset();
  EXPECT_EQ(ErrorOf([&] { OutputFolder(Path("run"), {}); }), "");
  EXPECT_EQ(TextOf("run/a"), "whole");
}

TEST_F(UserCases, CaseC07AFolderInWhichNothingWasWrittenIsLeftAsItWas) {
  { OutputFolder unused(Path("new"), {}); }
  EXPECT_FALSE(fs::exists(Path("new")));
  fs::create_directories(Path("old"));
  { OutputFolder unused(Path("old"), {}); }
  EXPECT_TRUE(fs::is_empty(Path("old")));
  Write("file", "");
  EXPECT_TRUE(Holds(ErrorOf([&] { OutputFolder(Path("file"), {}); }), "cannot be created"));
}

TEST_F(UserCases, CaseC06InputsOfAnotherKindAreOneLineAndNoWait) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  const std::function<void(const std::string&)> readers[] = {
      RequireRegularFile,
      [](const std::string& path) { ReadTextLines(path); },
      [](const std::string& path) { ConfigReader::FromFile(path); },
      [](const std::string& path) { ReadTrajectory(path); },
      [](const std::string& path) { ReadPeople(path); },
      [](const std::string& path) { ReadTruePeople(path); },
      [](const std::string& path) { ReadCappedRuns(path); },
      [](const std::string& path) { ReadChainSpeeds(path); },
      [](const std::string& path) { ReadSolveTimes(path); },
      [](const std::string& path) {
        MapFileSummary summary;
        ReadFourDMap(path, &summary);
      },
  };
  for (const auto& read : readers) {
    const std::string inputs[] = {Path("pipe"), folder_.string(), "/dev/zero", Path("none")};
    const std::string reasons[] = {"is a pipe", "is a folder", "is a pipe, device",
                                   "cannot be read"};
    for (int i = 0; i < 4; ++i) {
      const std::string message = ErrorOf([&] { read(inputs[i]); });
      EXPECT_EQ(message.rfind(inputs[i] + ": ", 0), 0u) << message;
      EXPECT_TRUE(Holds(message, reasons[i])) << message;
      EXPECT_FALSE(Holds(message, "\n"));
    }
  }
}

TEST(Suggestions, NameWhatAMistypedWordIsNearTo) {
  const std::vector<std::string> options = {"--run-dir", "--out", "--config", "--force"};
  EXPECT_EQ(DidYouMean("--rundir", options), "; did you mean '--run-dir'?");
  EXPECT_EQ(DidYouMean("--run_dir", options), "; did you mean '--run-dir'?");
  EXPECT_EQ(DidYouMean("--ot", options), "; did you mean '--out'?");
  EXPECT_EQ(DidYouMean("--output", options), "; did you mean '--out'?");
  EXPECT_EQ(DidYouMean("--conf", options), "; did you mean '--config'?");
  EXPECT_EQ(DidYouMean("--focre", options), "; did you mean '--force'?");
  EXPECT_EQ(DidYouMean("--verbose", options), "");
  EXPECT_EQ(DidYouMean("--", options), "");
  EXPECT_EQ(DidYouMean("iterations", {"solver.iterations"}), "; did you mean 'solver.iterations'?");
  EXPECT_EQ(EditDistance("abc", "acb"), 1);
  EXPECT_EQ(EditDistance("abc", ""), 3);
}

TEST(Suggestions, ComeWithKeysAndChoicesOfAConfiguration) {
  const std::string text = "tracking:\n  window: 3\n  mode: fast\n";
  ConfigReader config = ConfigReader::FromString(text, "x.yaml");
  EXPECT_EQ(ErrorOf([&] { config.Override("trackng.window=4"); }),
            "x.yaml: key 'trackng.window' with value '4': there is no such key; did you mean "
            "'tracking.window'?");
  EXPECT_EQ(ErrorOf([&] {
              config.ReadChoice("tracking.mode", {"slow", "fasts"});
            }),
            "x.yaml: key 'tracking.mode' with value 'fast': must be one of slow, fasts; did you "
            "mean 'fasts'?");
  ConfigReader typo = ConfigReader::FromString("a:\n  window: 3\n  windwo: 4\n", "y.yaml");
  int window = 0;
  typo.Read("a.window", &window, 0, 9);
  EXPECT_TRUE(Holds(ErrorOf([&] { typo.Finish(); }), "did you mean 'a.window'?"));
}

TEST(Suggestions, ValuesThatAreNotPlainAreReadAgain) {
  ConfigReader config = ConfigReader::FromString("a:\n  b: \"\"\n  c: \"x: #1\"\n", "x.yaml");
  ConfigReader again = ConfigReader::FromString(config.Resolved(), "again.yaml");
  std::string b = "?", c;
  again.Read("a.b", &b);
  again.Read("a.c", &c);
  EXPECT_EQ(b, "");
  EXPECT_EQ(c, "x: #1");
}

}  // namespace
}  // namespace airdos
