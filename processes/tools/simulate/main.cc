// airdos-simulate: writes a log of what frontend and human tracker would publish in a simulated
// world.
#include <cstdint>
#include <iostream>
#include <string>

#include "common/simulation/settings.h"
#include "common/util/output_files.h"
#include "processes/node/live/program_cli.h"
#include "processes/tools/simulate/simulated_log.h"

int main(int argc, char** argv) {
  airdos::CommandLine app(
      "Simulates features and people, without images, and writes them as an LCM log that "
      "airdos-replay --from-features runs the optimizer on.",
      "airdos-simulate");
  std::string setting = "walkers8";
  std::uint64_t seed = 1;
  std::string out;
  bool force = false;
  app.Add("--setting", &setting, "setting to simulate").OneOf(airdos::SettingNames()).ShowDefault();
  app.Add("--seed", &seed, "seed of the random numbers").ShowDefault();
  app.AddFile("--out", &out, "log to write").Required();
  app.AddForce(&force);

  return airdos::RunProgram(argc, argv, &app, [&] {
    const airdos::OutputFiles outputs({out}, {{}, force});
    const airdos::SimulatedSequence sequence =
        airdos::Simulate(airdos::SettingByName(setting, seed));
    airdos::WriteSimulatedLog(sequence, out);
    std::cout << out << ": " << sequence.frames.size() << " frames, " << sequence.objects.size()
              << " objects\n";
    return 0;
  });
}
