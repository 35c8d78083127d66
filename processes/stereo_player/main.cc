#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "common/util/version.h"
#include "processes/node/lcm_transport.h"
#include "processes/node/process_cli.h"
#include "processes/node/process_usage.h"
#include "processes/stereo_player/player_loop.h"
#include "processes/stereo_player/player_options.h"

namespace {

int Play(const airdos::PlayerOptions& options, const airdos::CommonArguments& common) {
  airdos::InstallStopSignals();
  cv::setNumThreads(1);
  const std::unique_ptr<airdos::StereoSequence> sequence =
      airdos::OpenStereoSequence(options.data_folder);
  const std::int64_t session = options.session.value_or(airdos::WallClock_us());
  if (!options.write_log.empty()) {
    airdos::WriteLog(options, *sequence, session, &std::cerr);
    return 0;
  }
  airdos::RangeOf(options, *sequence);  // complains before anything starts
  airdos::LcmTransport transport(common.lcm_url);
  airdos::PlayerLoop loop(options, sequence.get(), session, &transport, &std::cerr);
  std::cout << "airdos-stereo-player READY version " << airdos::kVersion << " url "
            << common.lcm_url << " config " << common.config_file << " session " << session
            << std::endl;
  loop.Run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Plays a recorded stereo sequence as LCM messages", "airdos-stereo-player");
  const airdos::PlayerArguments arguments(&app);
  return airdos::RunProgram(argc, argv, &app,
                            [&] { return Play(arguments.Resolve(), arguments.common()); });
}
