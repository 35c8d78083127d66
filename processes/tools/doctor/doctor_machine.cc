#include "processes/tools/doctor/doctor_machine.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "common/util/format.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_hz = 30;
constexpr double kLogMbPerFrame = 0.25;  // two JPEG images of 90 kB, mask, keypoints, results
constexpr double kMapMbPerFrame = 0.02;  // crossings of 100 frames: 0.01
constexpr double kMinLog_min = 10;       // less causes a warning
constexpr double kMinMap_min = 1;        // less is a failure

std::string FirstLineOf(const char* command) {
  struct Close {
    void operator()(std::FILE* pipe) const { pclose(pipe); }
  };
  const std::unique_ptr<std::FILE, Close> pipe(popen(command, "r"));
  char line[256] = "";
  if (pipe == nullptr || std::fgets(line, sizeof(line), pipe.get()) == nullptr) return "";
  std::string text = line;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

bool Exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

}  // namespace

SpyPlaces DefaultSpyPlaces() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  SpyPlaces places;
  places.airdos_jar = {
      (program.parent_path().parent_path() / "share" / "java" / "airdos.jar").string()};
  return places;
}

Diagnoses JudgeSpy(const SpyPlaces& places) {
  Diagnoses result;
  const auto judge = [&](bool is_there, const std::string& what, const std::string& mend) {
    result.push_back({is_there ? Health::kOk : Health::kWarn, "spy",
                      is_there ? what : what + " is missing: lcm-spy cannot be used",
                      is_there ? "" : mend});
  };
  // Such a line comes from Java itself, not from a shell that did not find it.
  const std::string java = FirstLineOf("LC_ALL=C java -version 2>&1 | grep ' version '");
  judge(!java.empty(), java.empty() ? "java" : java, "sudo apt-get install default-jre");
  judge(Exists(places.lcm_jar), places.lcm_jar, "sudo apt-get install liblcm-java");
  judge(Exists(places.chart_jar), places.chart_jar, "sudo apt-get install libjchart2d-java");
  std::string airdos_jar;
  for (const std::string& path : places.airdos_jar) {
    if (airdos_jar.empty() && Exists(path)) airdos_jar = path;
  }
  judge(!airdos_jar.empty(), airdos_jar.empty() ? "airdos.jar" : airdos_jar,
        "sudo apt-get install default-jdk-headless, and build again");
  return result;
}

Diagnoses JudgeDisk(const std::string& folder) {
  std::error_code error;
  fs::path existing = fs::absolute(folder, error).lexically_normal();
  while (!error && !fs::exists(existing) && existing.has_relative_path()) {
    existing = existing.parent_path();
  }
  if (!fs::is_directory(existing, error) || access(existing.c_str(), W_OK) != 0) {
    return {{Health::kFail, "disk", existing.string() + " cannot be written to",
             "choose a writable --run-dir FOLDER"}};
  }
  const fs::space_info space = fs::space(existing, error);
  if (error) return {{Health::kFail, "disk", existing.string() + ": " + error.message(), ""}};
  const double free_mb = 1e-6 * static_cast<double>(space.available);
  const double log_min = free_mb / (kLogMbPerFrame * kRate_hz * 60);
  const double map_min = free_mb / (kMapMbPerFrame * kRate_hz * 60);
  const std::string text =
      Format("%.0f MB free: the map of %.0f min, or a log of everything of %.0f min, at 30 Hz",
             free_mb, map_min, log_min);
  const Health health = map_min < kMinMap_min   ? Health::kFail
                        : log_min < kMinLog_min ? Health::kWarn
                                                : Health::kOk;
  return {{health, "disk", existing.string() + ": " + text,
           health == Health::kOk ? "" : "remove files there, or choose another --run-dir"}};
}

}  // namespace airdos
