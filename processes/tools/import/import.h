#ifndef AIRDOS_PROCESSES_TOOLS_IMPORT_IMPORT_H_
#define AIRDOS_PROCESSES_TOOLS_IMPORT_IMPORT_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "common/util/output_files.h"
#include "processes/stereo_player/image_packer.h"

namespace airdos {

/// What an input becomes.
enum class ImportTarget { kLog, kFolder };

/// By the name: .lcm, .lcmlog and .log are logs; a folder that is there, a name that ends in a
/// slash or has no ending is a folder. Throws InputError for others.
ImportTarget ImportTargetOf(const std::string& out);

/// What is imported, and how.
struct ImportOptions {
  std::string out;
  std::int64_t first = 0;                                        ///< frame
  std::int64_t last = std::numeric_limits<std::int64_t>::max();  ///< included
  std::int64_t session = 1;                                      ///< of a log
  ImagePackerOptions image;                                      ///< of a log
  OutputRules rules;
  std::function<void(double)> on_progress;          ///< after each frame with 0..1; may be empty
  std::function<void(const std::string&)> on_note;  ///< each line for the user
};

struct ImportResult {
  std::size_t num_frames = 0;
  std::int64_t num_bytes = 0;  ///< of a log
};

/// Writes a log with the messages that airdos-stereo-player publishes, stamped with their capture
/// times: the same sequence gives the same file. It has its name only when it is whole; until then
/// the name ends in .part. Throws InputError where the file is there, unless forced, and for what
/// is wrong with the sequence; WriteError if the log cannot be written.
ImportResult ImportToLog(std::unique_ptr<StereoSequence> sequence, const std::string& name,
                         const ImportOptions& options);

/// Writes a data set folder, see FolderWriter. Frames count from 0, without gaps.
ImportResult ImportToFolder(std::unique_ptr<StereoSequence> sequence, const std::string& name,
                            const ImportOptions& options);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_IMPORT_IMPORT_H_
