#include "processes/map_recorder/session_files.h"

#include <filesystem>
#include <utility>

#include "common/map/map_export.h"
#include "common/util/error.h"
#include "common/util/free_disk.h"
#include "common/util/version.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr char kGroup[] = "run";  // in the folder's list

const std::string& CheckedDirectory(const std::string& directory) {
  if (directory.empty()) {
    throw InputError(
        "--run-dir FOLDER is missing: where should map and trajectories go? (It is "
        "output.directory of the configuration)");
  }
  return directory;
}

bool SelectAll(const std::string&, const std::string&) { return true; }

}  // namespace

SessionFiles::SessionFiles(const std::string& directory, const OutputRules& rules, SayLine say)
    : directory_(directory), say_(std::move(say)), results_(CheckedDirectory(directory), rules) {
  results_.RequireReplaceable(NamesToBeWritten(directory_), SelectAll);
}

std::optional<UnfinishedMap> SessionFiles::Open(const Header& header) {
  if (num_sessions_ >= kMaxSessions) {
    throw InputError(directory_ + ": session " + std::to_string(header.session) +
                     " is not recorded: there were " + std::to_string(kMaxSessions) + " before it");
  }
  Enter(num_sessions_ + 1);
  if (num_sessions_ == 1) {
    std::optional<UnfinishedMap> found = Resume(header);
    if (found) return found;
    ReplaceEarlierResults();
  }
  if (IsUnfinished(PathOf(kMapName))) KeepMap(PathOf(kMapName), say_);
  OpenMap(0);
  Append(HeadChunk(header.session, std::string("airdos map_recorder ") + kVersion));
  return std::nullopt;
}

void SessionFiles::Enter(int number) {
  num_sessions_ = number;
  prefix_ = SessionPrefix(number);
  session_directory_ = SessionDirectory(directory_, number);
}

std::optional<UnfinishedMap> SessionFiles::Resume(const Header& header) {
  // Each session after the first has its own folder.
  int number = 1;
  std::string directory = SessionDirectory(directory_, number);
  std::optional<UnfinishedMap> found = FindUnfinishedMap(directory, header);
  while (!found) {
    directory = SessionDirectory(directory_, ++number);
    if (!fs::exists(directory)) return std::nullopt;
    found = FindUnfinishedMap(directory, header);
  }
  Enter(number);
  OpenMap(found->num_bytes);
  return found;
}

void SessionFiles::ReplaceEarlierResults() {
  KeepMapsOfACutRun(directory_, say_);
  for (int number = 1; fs::exists(SessionDirectory(directory_, number)); ++number) {
    SayWhatIsReplaced(SessionDirectory(directory_, number) + "/" + kMapName, say_);
  }
  const std::string what = SayReplaced(results_.RemoveEarlier(SelectAll));
  if (!what.empty()) say_(directory_ + ": " + what);
}

void SessionFiles::OpenMap(std::int64_t num_bytes) {
  const std::string path = results_.Claim(prefix_ + kMapName, kGroup);
  file_ = num_bytes > 0 ? std::make_unique<MapFileWriter>(path, num_bytes)
                        : std::make_unique<MapFileWriter>(path);
}

void SessionFiles::Append(const MapChunk& chunk) {
  try {
    const std::string why = WhyDiskIsFull(session_directory_);
    if (!why.empty()) throw InputError(session_directory_ + ": " + why + ": recording ends");
    file_->Append(chunk);
  } catch (const InputError& error) {
    failure_ = error.what();
    file_.reset();  // reported once: nothing more is written
    throw;
  }
}

void SessionFiles::Note(std::int64_t session, const MapDelta& ground_truth,
                        const std::optional<StereoCamera>& camera, std::int8_t ground_truth_axes) {
  try {
    if (notes_ == nullptr) {
      notes_ = std::make_unique<MapFileWriter>(results_.Claim(prefix_ + kNotesName, kGroup));
      notes_->Append(HeadChunk(session, ""));
    }
    if (!ground_truth.empty()) notes_->Append(ground_truth.ToChunk());
    notes_->Append(EndChunk(camera, ground_truth_axes));
  } catch (const InputError&) {  // writing the map itself will report a full disk
  }
}

void SessionFiles::Close(const MapChunk& end, const Recorded& recorded, bool has_exports) {
  Append(end);
  const std::int64_t num_bytes = file_->num_bytes();
  file_.reset();
  notes_.reset();
  std::error_code ignored;
  fs::remove(PathOf(kNotesName), ignored);

  MapFileSummary summary;
  const FourDMap map = ReadFourDMap(PathOf(kMapName), &summary);
  CompareWithRecorded(map, summary, num_bytes, recorded);
  if (has_exports) Export(map);
  results_.Finish();
}

void SessionFiles::Export(const FourDMap& map) {
  ExportMap(map, prefix_, prefix_.empty() ? kExportGroup : kGroup, &results_);
  for (const std::string& name : ExportNames(directory_, prefix_)) {
    if (results_.IsListed(name) || !fs::exists(results_.PathOf(name))) continue;
    say_(results_.PathOf(name) + ": existed before and is not from this run");  // --force
  }
}

void SessionFiles::CompareWithRecorded(const FourDMap& map, const MapFileSummary& summary,
                                       std::int64_t num_bytes, const Recorded& recorded) const {
  const std::size_t num_live = CountLive(map);
  std::string difference;
  if (!summary.drop_reason.empty() || summary.num_bytes_used != num_bytes) {
    difference = std::to_string(summary.num_bytes_used) + " bytes of it can be read, " +
                 std::to_string(num_bytes) + " were written";
  } else if (num_live != recorded.num_live) {
    difference = "holds " + std::to_string(num_live) + " frames with a live pose, " +
                 std::to_string(recorded.num_live) + " were recorded";
  } else if (map.session != recorded.session || !map.is_closed) {
    difference = "is not the closed map of session " + std::to_string(recorded.session);
  }
  if (difference.empty()) return;
  throw InputError(PathOf(kMapName) + ": " + difference +
                   "; did something else write into it? Record again");
}

std::string SessionFiles::TakeFailure() { return std::exchange(failure_, ""); }

}  // namespace airdos
