#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "tests/fuzz/fuzz_targets.h"

// All targets in one executable, which takes long to link: airdos_fuzz_NAME, a link to it, runs the
// target NAME. `airdos_fuzz_list` prints "NAME MAX_BYTES" of each; `airdos_fuzz_seeds FOLDER`
// writes the seeds of NAME into FOLDER/NAME.

namespace {

airdos::FuzzTarget* chosen = nullptr;

std::string NameOf(const char* program) {
  const std::string name = std::filesystem::path(program).filename();
  constexpr char kPrefix[] = "airdos_fuzz_";
  return name.rfind(kPrefix, 0) == 0 ? name.substr(std::strlen(kPrefix)) : "";
}

void List() {
  for (const airdos::FuzzTarget& target : airdos::FuzzTargets())
    std::printf("%s %d\n", target.name.c_str(), target.max_bytes);
}

void WriteSeeds(const std::string& folder, const std::string& log) {
  for (const airdos::FuzzTarget& target : airdos::FuzzTargets()) {
    std::filesystem::create_directories(folder + "/" + target.name);
    int number = 0;
    std::vector<airdos::FuzzBytes> seeds = target.seeds();
    if (target.name == "messages" && !log.empty()) {
      for (airdos::FuzzBytes& seed : airdos::MessageSeedsOfLog(log))
        seeds.push_back(std::move(seed));
    }
    for (const airdos::FuzzBytes& seed : seeds) {
      std::ofstream file(folder + "/" + target.name + "/seed_" + std::to_string(number++),
                         std::ios::binary);
      file.write(reinterpret_cast<const char*>(seed.data()),
                 static_cast<std::streamsize>(seed.size()));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const std::string name = NameOf((*argv)[0]);
  if (name == "list") {
    List();
    std::exit(0);
  }
  if (name == "seeds" && *argc >= 2) {
    WriteSeeds((*argv)[1], *argc > 2 ? (*argv)[2] : "");
    std::exit(0);
  }
  for (const airdos::FuzzTarget& target : airdos::FuzzTargets()) {
    if (target.name == name) chosen = new airdos::FuzzTarget(target);
  }
  if (chosen != nullptr) return 0;
  std::fprintf(stderr, "call it airdos_fuzz_NAME (a link) with NAME one of:\n");
  List();
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run(data, size);
  return 0;
}
