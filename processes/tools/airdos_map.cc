// airdos-map: what is in a 4-D map, and its exports.
#include <CLI/CLI.hpp>
#include <cinttypes>
#include <cstdio>
#include <exception>
#include <string>

#include "common/map/four_d_map.h"
#include "common/map/map_export.h"
#include "common/util/error.h"
#include "common/util/version.h"
#include "processes/tools/map_picture.h"

namespace airdos {
namespace {

FourDMap ReadAndSayWhatIsLost(const std::string& path, MapFileSummary* summary) {
  FourDMap map = ReadFourDMap(path, summary);
  if (!summary->drop_reason.empty()) {
    std::fprintf(stderr, "airdos-map: %s: %" PRId64 " bytes dropped after %" PRId64 " chunks: %s\n",
                 path.c_str(), summary->num_bytes_dropped, summary->num_chunks,
                 summary->drop_reason.c_str());
  } else if (!map.is_closed) {
    std::fprintf(stderr, "airdos-map: %s: the recording was cut short\n", path.c_str());
  }
  return map;
}

void PrintInfo(const std::string& path) {
  MapFileSummary summary;
  const FourDMap map = ReadAndSayWhatIsLost(path, &summary);
  std::size_t num_live = 0;
  std::size_t num_refined = 0;
  std::size_t num_truth = 0;
  for (const auto& [id, frame] : map.frames) {
    num_live += frame.live ? 1 : 0;
    num_refined += frame.refined ? 1 : 0;
    num_truth += frame.ground_truth ? 1 : 0;
  }
  std::set<HumanId> tracks;
  for (const auto& [key, human] : map.humans) tracks.insert(key.second);
  std::printf("file          version %u, %" PRId64 " chunks, %" PRId64 " bytes%s\n",
              kMapFileVersion, summary.num_chunks, summary.num_bytes_used,
              map.is_closed ? ", closed" : "");
  std::printf("session       %" PRId64 ", recorded by %s\n", map.session, map.program.c_str());
  if (map.camera) {
    std::printf("camera        %d x %d px, f %.3f px, baseline %.4f m\n", map.camera->width,
                map.camera->height, map.camera->fx_px, map.camera->baseline_m);
  }
  std::printf("frames        %zu", map.frames.size());
  if (!map.frames.empty()) {
    std::printf(" (%" PRId64 " to %" PRId64 ")", map.frames.begin()->first.value,
                map.frames.rbegin()->first.value);
  }
  std::printf(": %zu live, %zu refined, %zu ground truth\n", num_live, num_refined, num_truth);
  std::printf("landmarks     %zu\n", map.landmarks.size());
  std::printf("people        %zu tracks, %zu states\n", tracks.size(), map.humans.size());
}

void Export(const std::string& path, const std::string& folder) {
  MapFileSummary summary;
  for (const std::string& file : ExportMap(ReadAndSayWhatIsLost(path, &summary), folder)) {
    std::printf("%s\n", file.c_str());
  }
}

void Plot(const std::string& path, const std::string& picture) {
  MapFileSummary summary;
  WriteMapPicture(ReadAndSayWhatIsLost(path, &summary), picture);
  std::printf("%s\n", picture.c_str());
}

int Run(int argc, char** argv) {
  CLI::App app("What is in a 4-D map, and its exports");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  std::string file;
  std::string folder;
  CLI::App* const info = app.add_subcommand("info", "Print what a map holds");
  info->add_option("FILE", file, "map.airdos")->required();
  CLI::App* const export_command =
      app.add_subcommand("export", "Write trajectories, PLY and people of a map");
  export_command->add_option("FILE", file, "map.airdos")->required();
  export_command->add_option("--out", folder, "folder to write to")->required();
  std::string picture;
  CLI::App* const plot_command =
      app.add_subcommand("plot", "Draw a map from above: camera, people, static points");
  plot_command->add_option("FILE", file, "map.airdos")->required();
  plot_command->add_option("--out", picture, "PNG to write")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitBadInput;
  }
  if (info->parsed()) PrintInfo(file);
  if (export_command->parsed()) Export(file, folder);
  if (plot_command->parsed()) Plot(file, picture);
  return 0;
}

}  // namespace
}  // namespace airdos

int main(int argc, char** argv) {
  try {
    return airdos::Run(argc, argv);
  } catch (const airdos::InputError& error) {
    std::fprintf(stderr, "airdos-map: %s\n", error.what());
    return airdos::kExitBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "airdos-map: %s\n", error.what());
    return 1;
  }
}
