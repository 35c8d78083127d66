// Unrectified images, however they get in and whatever is claimed of them: player and replay say so
// on stderr at the start, with a command, or refuse them.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <opencv2/core.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "common/util/format.h"
#include "tests/support/child_process.h"
#include "tests/support/input_errors.h"
#include "tests/support/rendered_scene.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

constexpr int kNumPairs = 8;
constexpr double kDeadline_s = 120;
constexpr int kRows = 4;  // by which the right images are moved down
constexpr char kNotRectified[] = "the images are not rectified: rows of matches differ by 4";

class UnrectifiedProcessTest : public testing::Test {
 protected:
  UnrectifiedProcessTest() {
    const RenderedScene scene(3);
    const StereoCamera camera = SmallStereoCamera();
    for (int k = 0; k < kNumPairs; ++k) {
      const StereoPair pair = scene.Render(camera, SwayingPath(k));
      cv::Mat moved = cv::Mat::zeros(pair.right.size(), CV_8UC1);
      pair.right.rowRange(0, moved.rows - kRows).copyTo(moved.rowRange(kRows, moved.rows));
      folder_.WritePicture(Format("set/image_0/%06d.png", k), pair.left);
      folder_.WritePicture(Format("set/image_1/%06d.png", k), moved);
    }
    calibration_ = folder_.Write(
        "set/calib.json",
        Format(R"({"fx": %.17g, "fy": %.17g, "cx": %.17g, "cy": %.17g, "baseline_m": %.17g})",
               camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.baseline_m));
  }

  struct Answer {
    int exit_code = -1;
    std::vector<std::string> lines;  // of stderr, those about rows
  };
  Answer Run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), AIRDOS_BINARY_DIR "/bin/" + program);
    ChildProcess process(arguments, folder_.PathOf("said"));
    Answer answer;
    answer.exit_code = process.Wait(kDeadline_s).value_or(-1000);
    std::istringstream stream(process.Errors());
    for (std::string line; std::getline(stream, line);) {
      if (Holds(line, "rows")) answer.lines.push_back(line);
    }
    return answer;
  }
  Answer Play(std::vector<std::string> arguments, const std::string& log = "out.lcm") const {
    arguments.insert(arguments.end(), {"--write-log", folder_.PathOf(log), "--force"});
    return Run("airdos-stereo-player", arguments);
  }
  Answer Replay(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--no-progress", "--threads", "1"});
    return Run("airdos-replay", arguments);
  }

  /// One line of the program's own about the input, which ends with the command.
  static void ExpectSaid(const Answer& answer, const std::string& input,
                         const std::string& command) {
    EXPECT_TRUE(answer.exit_code == 0 || answer.exit_code == 1) << "1: replayed without a pose";
    const std::string begin = "warning: " + input + ": " + kNotRectified;
    std::vector<std::string> said;
    std::copy_if(answer.lines.begin(), answer.lines.end(), std::back_inserter(said),
                 [&](const std::string& line) { return Holds(line, begin); });
    ASSERT_EQ(said.size(), 1u) << input;
    EXPECT_EQ(said[0].substr(said[0].size() - std::min(said[0].size(), command.size())), command);
  }
  static void ExpectFrontendSaid(const Answer& answer) {
    const std::string text = std::string("airdos-replay: frontend: warning: ") + kNotRectified;
    EXPECT_TRUE(std::any_of(answer.lines.begin(), answer.lines.end(),
                            [&](const std::string& line) { return line.rfind(text, 0) == 0; }));
  }
  static void ExpectRefused(const Answer& answer) {
    EXPECT_EQ(answer.exit_code, 2);
    ASSERT_EQ(answer.lines.size(), 1u);
    EXPECT_TRUE(Holds(answer.lines[0], "--no-check continues anyway")) << answer.lines[0];
  }

  std::string set() const { return folder_.PathOf("set"); }
  std::vector<std::string> Recording(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "--images", set() + "/image_0", set() + "/image_1", "--rate",
        "10",       "--calibration",    calibration_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  ScratchFolder folder_{"unrectified_process"};
  std::string calibration_;
};

TEST_F(UnrectifiedProcessTest, AFolderIsRefusedAndWithoutTheCheckItIsSaid) {
  const std::string mend = " --images LEFT RIGHT --calibration FILE";
  ExpectRefused(Play({set()}));
  ExpectRefused(Replay({set()}));
  ExpectSaid(Play({set(), "--no-check"}), set(), "airdos-stereo-player" + mend);
  const Answer replayed = Replay({set(), "--no-check"});
  ExpectSaid(replayed, set(), "airdos-replay" + mend);
  ExpectFrontendSaid(replayed);
}

TEST_F(UnrectifiedProcessTest, OfALogItIsSaidCheckedOrNot) {
  Play({set(), "--no-check"}, "set.lcm");
  const std::string log = folder_.PathOf("set.lcm");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--no-check"}}) {
    std::vector<std::string> arguments = {log};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectSaid(Play(arguments), log, "--calibration FILE");
    const Answer replayed = Replay(arguments);
    ExpectSaid(replayed, log, "--calibration FILE");
    ExpectFrontendSaid(replayed);
    arguments.push_back("--digest");
    ExpectFrontendSaid(Replay(arguments));
  }
}

TEST_F(UnrectifiedProcessTest, WhoeverClaimsThatARecordingIsRectifiedIsNotBelieved) {
  ExpectRefused(Play(Recording({"--rectified"})));
  ExpectRefused(Replay(Recording({"--rectified"})));
  const std::string command = "airdos-calibration check " + calibration_ + " --images " + set() +
                              "/image_0 " + set() + "/image_1";
  ExpectSaid(Play(Recording({"--rectified", "--no-check"})), set() + "/image_0", command);
  const Answer replayed = Replay(Recording({"--rectified", "--no-check"}));
  ExpectSaid(replayed, set() + "/image_0", command);
  ExpectFrontendSaid(replayed);
  // And so the command says what is wrong.
  const Answer examined = Run("airdos-calibration", {"check", calibration_, "--images",
                                                     set() + "/image_0", set() + "/image_1"});
  EXPECT_EQ(examined.exit_code, 1);
}

}  // namespace
}  // namespace airdos
