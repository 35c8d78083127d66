// airdos-simulate: a log of what the frontend and the human tracker would say of a simulated world.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <iostream>
#include <string>

#include "common/simulation/settings.h"
#include "common/util/version.h"
#include "processes/node/process_cli.h"
#include "processes/tools/simulated_log.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Simulates features and people, without images, and writes them as an LCM log that "
      "airdos-replay --from-features runs the optimizer on.",
      "airdos-simulate");
  std::string setting = "walkers8";
  std::uint64_t seed = 1;
  std::string out;
  app.add_option("--setting", setting, "what is simulated")
      ->check(CLI::IsMember(airdos::SettingNames()))
      ->capture_default_str();
  app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
  app.add_option("--out", out, "log to write")->required();
  app.set_version_flag("--version", std::string(airdos::kVersion));

  return airdos::RunProgram(argc, argv, &app, [&] {
    const airdos::SimulatedSequence sequence =
        airdos::Simulate(airdos::SettingByName(setting, seed));
    airdos::WriteSimulatedLog(sequence, out);
    std::cout << out << ": " << sequence.frames.size() << " frames, " << sequence.objects.size()
              << " objects\n";
    return 0;
  });
}
