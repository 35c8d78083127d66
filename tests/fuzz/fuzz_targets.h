#ifndef AIRDOS_TESTS_FUZZ_FUZZ_TARGETS_H_
#define AIRDOS_TESTS_FUZZ_FUZZ_TARGETS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace airdos {

using FuzzBytes = std::vector<std::uint8_t>;

/// One door through which bytes of others come in. `run` takes any bytes; it must neither crash nor
/// throw, nor ask for more than 64 MB at once. libFuzzer drives it (launch_scripts/fuzz.sh), and a
/// test with its seeds and changed copies of them does in every build.
struct FuzzTarget {
  std::string name;
  void (*run)(const std::uint8_t* data, std::size_t size);
  std::vector<FuzzBytes> (*seeds)();  ///< good inputs, small
  int max_bytes;                      ///< of one input
};

/// Every target; names are unique.
std::vector<FuzzTarget> FuzzTargets();

// By file of this folder.
std::vector<FuzzTarget> NodeTargets();         ///< handlers of the processes
std::vector<FuzzTarget> MessageTargets();      ///< message types, images, what listens to STATUS
std::vector<FuzzTarget> FileTargets();         ///< logs, maps, configurations
std::vector<FuzzTarget> DatasetTargets();      ///< data sets and their files
std::vector<FuzzTarget> PictureTargets();      ///< images, masks, their names, the camera
std::vector<FuzzTarget> RecordingTargets();    ///< folders and times of recordings
std::vector<FuzzTarget> EvaluationTargets();   ///< what airdos-evaluate reads
std::vector<FuzzTarget> KeypointTargets();     ///< people that other programs found
std::vector<FuzzTarget> CalibrationTargets();  ///< calibration files of other tools

/// Further seeds of the target "messages": the first messages on each channel of a log that are
/// small enough.
std::vector<FuzzBytes> MessageSeedsOfLog(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_TESTS_FUZZ_FUZZ_TARGETS_H_
