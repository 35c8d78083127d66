#include "processes/tools/import/import.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/dataset/file_name.h"
#include "common/dataset/folder_writer.h"
#include "common/util/error.h"
#include "processes/node/log/event_log.h"
#include "processes/stereo_player/dataset_source.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

std::string WithoutSlashes(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

/// A file under another name until it is whole; removed if it never is.
class PartFile {
 public:
  explicit PartFile(const std::string& path) : path_(path), part_(path + ".part") {}
  ~PartFile() {
    std::error_code ignored;
    if (!is_whole_) fs::remove(part_, ignored);
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::string& part() const { return part_; }
  void Finish() {
    std::error_code error;
    fs::rename(part_, path_, error);
    if (error) throw WriteError(path_ + ": cannot be written: " + error.message());
    is_whole_ = true;
  }

 private:
  std::string path_;
  std::string part_;
  bool is_whole_ = false;
};

void Say(const std::vector<std::string>& notes, const ImportOptions& options) {
  if (!options.on_note) return;
  for (const std::string& note : notes) options.on_note(note);
}

void Report(double fraction, const ImportOptions& options) {
  if (options.on_progress) options.on_progress(fraction);
}

}  // namespace

ImportTarget ImportTargetOf(const std::string& out) {
  if (out.empty()) throw InputError("--out: the name is empty");
  if (fs::is_directory(out) || out.back() == '/') return ImportTarget::kFolder;
  const std::string ending = EndingOf(out);
  if (ending.empty()) return ImportTarget::kFolder;
  if (ending == ".lcm" || ending == ".lcmlog" || ending == ".log") return ImportTarget::kLog;
  throw InputError(out +
                   ": neither a log (.lcm) nor a folder (no ending, or a slash at the "
                   "end)");
}

ImportResult ImportToLog(std::unique_ptr<StereoSequence> sequence, const std::string& name,
                         const ImportOptions& options) {
  if (!options.rules.force && fs::exists(fs::symlink_status(options.out))) {
    throw InputError(options.out + ": exists; --force replaces it");
  }
  PartFile file(options.out);
  const OutputFiles outputs({options.out, file.part()}, options.rules);
  DatasetSource source(std::move(sequence), name, options.first, options.last, options.session,
                       options.image);
  EventLogWriter writer(file.part());
  ImportResult result;
  for (;;) {
    const std::vector<Envelope> frame = source.NextFrame();
    Say(source.TakeNotes(), options);
    if (frame.empty()) break;
    const Header header =
        PeekHeader(frame[0].payload.data(), frame[0].payload.size()).value_or(Header{});
    for (const Envelope& message : frame) {
      writer.Append(header.utime, message.channel, message.payload.data(), message.payload.size());
    }
    ++result.num_frames;
    Report(source.fraction_done(), options);
  }
  if (result.num_frames == 0) throw InputError(name + ": none of its images can be used");
  writer.Sync();
  result.num_bytes = writer.num_bytes();
  file.Finish();
  return result;
}

ImportResult ImportToFolder(std::unique_ptr<StereoSequence> sequence, const std::string& name,
                            const ImportOptions& options) {
  const std::string out = WithoutSlashes(options.out);
  const auto end = static_cast<std::int64_t>(sequence->num_frames());
  const std::int64_t first = std::max<std::int64_t>(0, options.first);
  const std::int64_t last = std::min(end - 1, options.last);
  if (first > last) {
    throw InputError(name + ": has frames 0 to " + std::to_string(end - 1) +
                     ", so there is none from --first to --last");
  }
  ImportResult result;
  {
    FolderWriter writer(out, options.rules);
    Say(sequence->notes(), options);
    for (std::int64_t i = first; i <= last; ++i) {
      const std::optional<SequenceFrame> frame = sequence->TryLoad(static_cast<std::size_t>(i));
      Say(sequence->TakeLateNotes(), options);
      if (frame) writer.Add(*frame, sequence->ground_truth_axes());
      Report(static_cast<double>(i - first + 1) / static_cast<double>(last - first + 1), options);
    }
    result.num_frames = writer.num_frames();
    writer.Finish(sequence->camera());
  }
  // What its readers will say, or refuse, is said now.
  Say(OpenStereoSequence(out)->notes(), options);
  return result;
}

}  // namespace airdos
