// airdos-map: shows and exports the contents of a 4-D map.
#include <cinttypes>
#include <cstdio>
#include <string>

#include "common/map/four_d_map.h"
#include "common/map/map_export.h"
#include "common/util/output_files.h"
#include "processes/node/live/program_cli.h"
#include "processes/tools/map/map_picture.h"

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

void Export(const std::string& path, const std::string& folder, bool force) {
  MapFileSummary summary;
  int num_replaced = 0;
  for (const std::string& file :
       ExportMap(ReadAndSayWhatIsLost(path, &summary), path, folder, force, &num_replaced)) {
    std::printf("%s\n", file.c_str());
  }
  const std::string what = SayReplaced(num_replaced);
  if (!what.empty()) std::fprintf(stderr, "airdos-map: %s: %s\n", folder.c_str(), what.c_str());
}

void Plot(const std::string& path, const std::string& picture, bool force) {
  const OutputFiles outputs({picture}, {{path}, force});
  MapFileSummary summary;
  WriteMapPicture(ReadAndSayWhatIsLost(path, &summary), picture);
  std::printf("%s\n", picture.c_str());
}

struct Arguments {
  std::string input;
  std::string out;
  bool force = false;
};

CommandLine AddCommand(const std::string& name, const std::string& text, Arguments* arguments,
                       CommandLine* app) {
  CommandLine command = app->AddCommand(name, text);
  command.AddFile("INPUT", &arguments->input, "map.airdos").Required();
  return command;
}

int Run(int argc, char** argv) {
  CommandLine app("Shows and exports the contents of a 4-D map", "airdos-map");
  app.RequireCommand();
  Arguments arguments;
  const CommandLine info_command =
      AddCommand("info", "Print what a map contains", &arguments, &app);
  CommandLine export_command =
      AddCommand("export", "Write trajectories, PLY and people of a map", &arguments, &app);
  export_command.AddFolder("--out", &arguments.out, "folder to write to").Required();
  export_command.AddForce(&arguments.force);
  CommandLine plot_command =
      AddCommand("plot", "Plot a map from above: camera, people, static points", &arguments, &app);
  plot_command.AddFile("--out", &arguments.out, "PNG file to write").Required();
  plot_command.AddForce(&arguments.force);
  return RunProgram(argc, argv, &app, [&] {
    if (info_command.is_given()) PrintInfo(arguments.input);
    if (export_command.is_given()) Export(arguments.input, arguments.out, arguments.force);
    if (plot_command.is_given()) Plot(arguments.input, arguments.out, arguments.force);
    return 0;
  });
}

}  // namespace
}  // namespace airdos

int main(int argc, char** argv) { return airdos::Run(argc, argv); }
